"""Lines over the picture lie where light paths put them, and cost nothing where none is asked for."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.physics import screen_curves
from blackhole_gl.physics.space_time import space_time
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets
from tests.shaders.test_labels import distances

SIZE = (240, 150)
DARK = {
    "hole.spin": 0.9, "camera.distance": 15.0, "camera.inclination_deg": 60.0, "camera.fov_deg": 40.0, "disk.enabled": False, "sky.enabled": False,
    "post.bloom": False, "post.dither": False, "rays.edges": 1,
}  # fmt: skip


def dark(**more: object) -> Scene:
    """A hole alone."""
    return presets.load(["kerr"], {**DARK, **{f"post.{name}": value for name, value in more.items()}})


def lit(renderer: Renderer, scene: Scene, *, progressive: bool = False) -> np.ndarray:
    """Middles (N, 2) of the pixels that shine, from the top left."""
    renderer.render(scene, 0.0, SIZE, progressive=progressive)
    return np.argwhere(renderer.read_rgb8().max(axis=-1) > 60)[:, ::-1] + 0.5


@pytest.mark.parametrize("progressive", [False, True], ids=["at_rest", "moving"])
def test_the_innermost_stable_orbit_is_where_the_closed_form_has_it(renderer: Renderer, progressive: bool) -> None:
    """All of its direct image is drawn, and nothing that is not within 1.6 pixels of it or of a ring: a line is one wide, to within a pixel's middle 1; as wide
    again is what changes between a pixel and the next one beside the critical curve, where the map goes as a logarithm."""
    scene = dark(show_isco=True)
    isco = space_time(scene).isco_radius(scene.disk)
    curves = [np.column_stack(curve.in_pixels(scene, SIZE)) for curve in screen_curves.isoradials(scene, [isco], (0, 1, 2))]
    drawn = lit(renderer, scene, progressive=progressive)
    assert len(drawn) > 100
    assert np.min([distances(drawn, np.vstack([curve, curve[:1]])) for curve in curves], axis=0).max() < 1.6
    assert np.linalg.norm(curves[0][:, None] - drawn, axis=-1).min(axis=1).max() < 1.2  # a pixel's middle is 0.71 from its corners


def test_the_skys_lines_are_straight_ahead_where_nothing_bends(renderer: Renderer) -> None:
    """From the equator the horizon of the sky is a straight line through the middle, and those of 15° latitude meet the middle column at tan 15°."""
    scene = dark(show_sky_grid=True).with_values({"rays.lensing": False, "camera.inclination_deg": 90.0, "camera.azimuth_deg": 7.0})
    renderer.render(scene, 0.0, SIZE)
    light = renderer.read_rgb8().max(axis=-1).astype(int)
    column = np.flatnonzero(light[:, SIZE[0] // 2] > 30) + 0.5
    offset = 0.5 * SIZE[1] * np.tan(np.radians(15.0)) / np.tan(np.radians(20.0))
    expected = 0.5 * SIZE[1] + np.array([-offset, offset])  # in the very middle is the hole
    assert np.abs(column[:, None] - expected).min(axis=1).max() < 1.0  # a line is one pixel wide
    assert np.abs(expected[:, None] - column).min(axis=1).max() < 1.0
    dark_columns = np.flatnonzero(light[SIZE[1] // 2 - 1 : SIZE[1] // 2 + 1].max(axis=0) <= 60)
    assert np.all(np.abs(dark_columns + 0.5 - 0.5 * SIZE[0]) < 0.5 * SIZE[1] * 1.1 / 15.0 / np.tan(np.radians(20.0)))


def test_the_horizons_tint_is_the_shadow(renderer: Renderer) -> None:
    renderer.render(dark(show_horizon=True), 0.0, SIZE)
    tinted = renderer.read_rgb8().max(axis=-1) > 20
    fates, _ = renderer.fates_and_steps()
    assert np.array_equal(tinted, fates[::-1] == 2)


def test_each_line_is_drawn_and_none_without(renderer: Renderer) -> None:
    names = ("horizon", "ergosphere", "photon_shell", "isco", "plane_grid", "sky_grid")
    counts = {name: len(lit(renderer, dark(**{f"show_{name}": True}))) for name in names if name != "horizon"}
    assert min(counts.values()) > 30, counts
    before = renderer.programs.compiled
    assert not len(lit(renderer, dark()))
    assert renderer.programs.compiled <= before + 1, "a scene without lines has no program of theirs"


def test_lines_are_as_bright_whatever_the_exposure(renderer: Renderer) -> None:
    pictures = []
    for exposure in (-3.0, 3.0):
        renderer.render(dark(show_isco=True, exposure=exposure), 0.0, SIZE)
        pictures.append(renderer.read_rgb8().astype(int))
    assert np.abs(pictures[0] - pictures[1]).max() <= 1  # rounding of half floats
