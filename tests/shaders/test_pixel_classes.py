"""Pixels are sorted by what they need, so that the disk's and the sky's shaders run only there: no pixel may lose its light by it."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.refinement import CoarseGrid
from blackhole_gl.rendering.squares import Patches
from blackhole_gl.scene import presets

SIZE = (240, 135)
VIEWS = {
    "default": {},
    "steep": {"camera.inclination_deg": 25.0},
    "edge on": {"camera.inclination_deg": 89.5},
    "close": {"camera.distance": 4.0, "camera.fov_deg": 90.0},
    "a disk of a few pixels": {"camera.distance": 3000.0, "camera.fov_deg": 20.0},
}


def _radiance(renderer: Renderer, values: dict, **how: bool) -> np.ndarray:
    renderer.hit_map.forget()
    renderer.render(presets.load(["kerr"], {"rays.edges": 1, **values}), 30.0, SIZE, **how)
    return renderer.radiance()


@pytest.mark.parametrize("view", VIEWS)
def test_a_refined_map_shows_the_picture_of_the_exact_one(renderer: Renderer, view: str) -> None:
    """Refined maps bring classes of their own. 2 % of the pixels: hits are half a pixel off at most, which sharp filaments and stars show."""
    exact, refined = (_radiance(renderer, VIEWS[view], progressive=how) for how in (False, True))
    different = np.abs(refined - exact).max(axis=-1) > 0.02 + 0.2 * exact.max(axis=-1)
    assert different.mean() < 0.02


@pytest.mark.parametrize("view", VIEWS)
def test_disk_and_sky_are_drawn_wherever_there_is_light(renderer: Renderer, view: str) -> None:
    """Of an additive disk the picture is the disk's alone and the sky's alone, added up.

    Half floats: 2⁻¹⁰. The method is stated: without a disk the plan may choose another.
    """
    stated = {"rays.model": "kerr", "rays.integrator": "rk4", "rays.step_angle": 0.2}
    clear = {**VIEWS[view], **stated, "post.exposure_mode": "fixed", "disk.compositing": "additive"}
    both = _radiance(renderer, clear)
    disk, sky = _radiance(renderer, {**clear, "sky.enabled": False}), _radiance(renderer, {**clear, "disk.enabled": False})
    assert disk.max() > 0.0 and sky.max() > 0.0
    np.testing.assert_allclose(both, disk + sky, rtol=2e-3, atol=1e-4)


@pytest.mark.parametrize("view", VIEWS)
def test_what_is_drawn_within_the_disks_bounds_is_the_whole_disk(renderer: Renderer, view: str) -> None:
    """From the second frame of the same hits on the disk is drawn within its bounds alone. Of a camera elsewhere those bounds say nothing."""
    first = _radiance(renderer, VIEWS[view])
    scene = presets.load(["kerr"], {"rays.edges": 1, **VIEWS[view]})
    for _ in range(2):
        renderer.render(scene, 30.0, SIZE)
        np.testing.assert_array_equal(renderer.radiance(), first)
    steeper = {"rays.edges": 1, **VIEWS[view], "camera.inclination_deg": 50.0}
    for _ in range(2):
        renderer.render(presets.load(["kerr"], steeper), 30.0, SIZE)
    moved = renderer.radiance()
    np.testing.assert_array_equal(moved, _radiance(renderer, steeper))


@pytest.mark.parametrize(
    "scene, values",
    [
        ("knot_behind_a_hole", {}),
        ("objects_black_hole", {}),
        ("objects_black_hole", {"disk.enabled": True, "disk.opacity": 0.5}),
        ("objects_potential", {}),
        ("cloudy_slab", {}),
    ],
)
@pytest.mark.parametrize("size", [SIZE, (331, 207)])
def test_squares_leave_out_nothing_that_is_seen(renderer: Renderer, monkeypatch: pytest.MonkeyPatch, scene: str, values: dict, size: tuple[int, int]) -> None:
    """Of a moving camera's things and of the flat sky about them: the same picture to the bit as in boxes of all that may show any."""
    pieces, kinds = CoarseGrid.pieces, set()

    def noted(grid: CoarseGrid, where: object) -> object:
        found = pieces(grid, where)
        kinds.add(type(found))
        return found

    def drawn() -> np.ndarray:
        renderer.hit_map.forget()
        renderer.render(presets.load([scene], values), 3.0, size, progressive=True)
        return renderer.radiance()

    monkeypatch.setattr(CoarseGrid, "pieces", noted)
    drawn()  # a first picture takes rays at every second pixel wherever it may, to have their programs compiled
    in_squares = drawn()
    assert Patches in kinds or scene == "cloudy_slab"
    monkeypatch.setattr(CoarseGrid, "pieces", CoarseGrid.bands)
    np.testing.assert_array_equal(in_squares, drawn())
