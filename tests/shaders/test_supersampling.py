"""A picture at rest with more and more rays a pixel: it begins as the sharp one, and ends as a still with as many."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.rendering import supersampling
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

SIZE = (240, 136)


def test_places_cover_the_pixel_evenly_about_its_middle() -> None:
    """Pairs about the middle, or a finer picture would be a shifted one; an edge at any angle passes them one by one."""
    places = np.array([supersampling.place(k) for k in range(supersampling.MOST_SAMPLES)])
    assert tuple(places[0]) == (0.0, 0.0)
    np.testing.assert_array_equal(places[1::2], -places[2::2])
    for bins in ((4, 4), (16, 1), (1, 16)):
        assert np.all(np.histogram2d(*places[1:].T, bins=bins, range=[[-0.5, 0.5]] * 2)[0] == 1)


def test_it_begins_as_the_sharp_picture(renderer: Renderer) -> None:
    scene = presets.load()
    renderer.render(scene, 3.0, SIZE)
    sharp = renderer.read_rgb8()
    assert renderer.render_finer(scene, 3.0, SIZE) == 1
    np.testing.assert_array_equal(renderer.read_rgb8(), sharp)
    hits = renderer.hits()
    assert renderer.render_finer(scene, 3.0, SIZE) == 2
    np.testing.assert_array_equal(renderer.hits().direction, hits.direction, "the kept map stays the one through the middles")


def test_it_comes_nearer_to_a_still_with_many_rays_a_pixel(renderer: Renderer) -> None:
    """The still's rays lie on a regular grid of 36, which has nothing to do with these places."""
    scene = presets.load([], {"post.bloom": False, "post.dither": False})
    renderer.render_still(scene, 3.0, SIZE, samples=6)
    still = renderer.read_rgb8().astype(int)
    errors = []
    for count in range(1, supersampling.MOST_SAMPLES + 1):
        assert renderer.render_finer(scene, 3.0, SIZE) == count
        errors.append(np.abs(renderer.read_rgb8() - still).mean())
    assert errors[1] == errors[0] and errors[3] == errors[2], "shown in whole pairs"
    assert errors[-1] < errors[4] < errors[2] < errors[0]
    assert errors[-1] < 0.1 * errors[0]
    renderer.render(scene, 3.0, SIZE)
    assert renderer.render_finer(scene, 3.0, SIZE) == supersampling.MOST_SAMPLES
    assert np.abs(renderer.read_rgb8() - still).mean() == errors[-1], "a mean that is whole is shown again"


def test_another_picture_begins_anew(renderer: Renderer) -> None:
    scene = presets.load()
    assert [renderer.render_finer(scene, time, SIZE) for time in (1.0, 1.0, 2.0, 2.0, 1.0)] == [1, 2, 1, 2, 1]


@pytest.mark.parametrize("view", ["unresolved", "difference", "conservation"])
def test_views_of_single_rays_are_refused(renderer: Renderer, view: str) -> None:
    """One ray in seventeen that ended nowhere would not be seen."""
    with pytest.raises(ValueError, match=f"post.view: '{view}'"):
        renderer.render_finer(presets.load([], {"post.view": view}), 0.0, SIZE)
