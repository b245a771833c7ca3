"""A disk tilted out of the equator: crossings and frequency shifts against the float64 twins, and that it is the level one where it should be.

`-rP` shows the figures.
"""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.planning import plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, catalogue, presets
from tests.shaders.sampling import random_rays

PLACE_99 = 1e-4  # r_s, by the fine steps of the preset `reference`: five times what level disks' have
G_99 = 1e-4  # relative
FAR = 20.0  # r_s: the outermost that a disk may be
TILTED = sorted(key for key, model in catalogue.plug_ins("ray_model").items() if model.traits.tilted_disk and not model.traits.field)
WITH_MOMENTA = {"kerr", "kerr_schild", "schwarzschild", "schwarzschild_binet", "schwarzschild_table", "flat"}  # rays that are light of a metric, in the twins


def scene_of(model: str, **changes: object) -> Scene:
    values = {"rays.model": model, "camera.distance": 12.0, "camera.inclination_deg": 78.0, "camera.azimuth_deg": 25.0, "disk.tilt_azimuth_deg": 40.0}
    return presets.load(["kerr", "reference"], values | {key.replace("__", "."): value for key, value in changes.items()})


def places(rays: listed_rays.TracedRays) -> np.ndarray:
    sine = np.sin(rays.crossing_theta)
    n = np.stack([sine * np.cos(rays.crossing_phi), sine * np.sin(rays.crossing_phi), np.cos(rays.crossing_theta)], axis=-1)
    return rays.crossing_r[..., None] * n


def agree(renderer: Renderer, scene: Scene, count: int = 250) -> None:
    rays = random_rays(scene, count, seed=20)
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    np.testing.assert_array_equal(found.fate, twin.fate)
    inner = plan(scene, keep_crossings=True).disk_inner
    on_disk = (twin.crossing_r > inner) & (twin.crossing_r < FAR)
    assert on_disk.sum() > count / 4
    assert np.isfinite(found.crossing_r[on_disk]).all()
    off = np.quantile(np.linalg.norm(places(found) - places(twin), axis=-1)[on_disk], 0.99)
    assert off < PLACE_99
    shift = np.nan
    if scene.rays.model in WITH_MOMENTA:
        shift = np.quantile(np.abs(found.crossing_g / twin.crossing_g - 1.0)[on_disk], 0.99)
        assert shift < G_99
    print(f"{scene.rays.model}, a* = {scene.hole.spin:g}, {scene.disk.tilt_deg:g}°: 99 % of places within {off:.1e} r_s, of g {shift:.1e}")


@pytest.mark.parametrize("model", TILTED)
def test_crossings_and_g_are_the_twin_s(renderer: Renderer, model: str) -> None:
    agree(renderer, scene_of(model, hole__spin=0.9, disk__tilt_deg=35.0))


@pytest.mark.parametrize("tilt, lean, orbit", [(4.0, -170.0, "prograde"), (90.0, 60.0, "retrograde")])
def test_they_are_at_any_tilt_round_the_fastest_hole(renderer: Renderer, tilt: float, lean: float, orbit: str) -> None:
    agree(renderer, scene_of("kerr", hole__spin=0.998, disk__tilt_deg=tilt, disk__tilt_azimuth_deg=lean, disk__orbit=orbit))


@pytest.mark.parametrize("model", ["kerr", "schwarzschild", "schwarzschild_table"])
def test_a_tilt_that_goes_to_nothing_leaves_the_disk_that_lies_level(renderer: Renderer, model: str) -> None:
    """Two texts of the shader: they agree to what rounding makes of a tilt of 1e-4 degrees."""
    level, tilted = scene_of(model), scene_of(model, disk__tilt_deg=1e-4)
    rays = random_rays(level, 300, seed=3)
    before, after = (listed_rays.trace_by_shader(renderer, scene, rays) for scene in (level, tilted))
    near = (before.crossing_r > plan(level, keep_crossings=True).disk_inner) & (before.crossing_r < FAR)
    assert np.quantile(np.linalg.norm(places(before) - places(after), axis=-1)[near], 0.99) < 2e-4  # 1.7e-6 rad at 20 r_s, where rays graze the plane
    assert np.quantile(np.abs(before.crossing_g / after.crossing_g - 1.0)[near], 0.99) < 1e-5


def test_without_spin_a_tilted_disk_is_the_level_one_seen_from_elsewhere(renderer: Renderer) -> None:
    """Tilted by 30° towards the camera's own azimuth, seen from 70°: a level one seen from 40°, radiance and all."""
    common = {"hole.spin": 0.0, "camera.distance": 20.0, "camera.azimuth_deg": 50.0, "sky.enabled": False, "post.exposure_mode": "fixed"}
    pictures = []
    for changes in ({"camera.inclination_deg": 70.0, "disk.tilt_deg": 30.0, "disk.tilt_azimuth_deg": 50.0}, {"camera.inclination_deg": 40.0}):
        renderer.render(presets.load(["kerr", "smooth"], {**common, **changes}), 0.0, (96, 54))
        pictures.append(renderer.radiance())
    assert pictures[0].max() > 0.3
    off = np.abs(pictures[0] - pictures[1]).max(axis=-1)
    assert np.quantile(off, 0.99) < 2e-3 * pictures[1].max()  # a half float's 5e-4, a few of them


def test_the_picture_depends_on_the_camera_s_azimuth(renderer: Renderer) -> None:
    scene = presets.load(["kerr", "smooth"], {"disk.tilt_deg": 40.0, "disk.tilt_azimuth_deg": 70.0, "sky.enabled": False})
    pictures = []
    for azimuth in (0.0, 120.0):
        renderer.render(scene.with_values({"camera.azimuth_deg": azimuth}), 0.0, (72, 40))
        pictures.append(renderer.radiance())
    assert np.abs(pictures[0] - pictures[1]).max() > 0.1


@pytest.mark.parametrize("pixel", [(0.3, 0.5), (0.7, 0.45)])
def test_the_values_of_a_pixel_are_the_twin_s(renderer: Renderer, pixel: tuple[float, float]) -> None:
    scene = presets.load(["kerr", "reference"], {"disk.tilt_deg": 40.0, "disk.tilt_azimuth_deg": 70.0, "camera.azimuth_deg": 15.0})
    width, height = size = 72, 40
    renderer.render(scene, 0.0, size)
    seen = renderer.last.values_at(pixel)
    assert seen is not None and seen.disk is not None
    x, y = (2.0 * (int(pixel[0] * width) + 0.5) - width) / height, (2.0 * (int(pixel[1] * height) + 0.5) - height) / height
    half = np.tan(np.radians(0.5 * scene.camera.fov_deg))
    psi, chi = np.arctan(half * np.hypot(x, y)), np.arctan2(y, x)
    twin = listed_rays.trace_by_reference(scene, np.array([[psi, chi]]))
    assert seen.disk.radius == pytest.approx(twin.crossing_r[0, seen.disk.order], rel=1e-4)
    lapse = seen.disk.g / twin.crossing_g[0, seen.disk.order]
    assert 1.0 < lapse < 1.1  # the observer's own clock, at 20 r_s


@pytest.mark.parametrize("model", ["kerr_like", "post_newtonian_drag"])
def test_models_that_find_crossings_of_the_equator_alone_say_so(model: str) -> None:
    made = plan(presets.load(["kerr"], {"rays.model": model, "disk.tilt_deg": 20.0}))
    assert made.scene.disk.tilt_deg == 0.0
    assert any(model in warning and "not tilted" in warning for warning in made.warnings)


def test_nothing_falls_in_from_a_tilted_disk_and_the_plan_says_so() -> None:
    made = plan(presets.load(["kerr"], {"disk.plunging": True, "disk.tilt_deg": 20.0}))
    assert not made.scene.disk.plunging and any("tilted" in reason for reason in made.reasons)


def test_grazing_light_that_dragging_takes_through_the_plane_and_back_is_met_by_long_steps(renderer: Renderer) -> None:
    """Of the preset, by the plan's own method: the near part of the disk's inner edge, which was ragged where both crossings lay in one step."""
    scene = presets.load(["tilted_disk"], {"camera.fov_deg": 50.0})
    x, y = np.meshgrid(np.arange(20) * 2.0 + 327.0 - 320.0, 180.0 - np.arange(20) * 2.0 - 161.0)  # pixels of a picture 360 high with 16° of view
    half = np.tan(np.radians(8.0)) / 180.0
    rays = np.stack([np.arctan(half * np.hypot(x, y)).ravel(), np.arctan2(y, x).ravel()], axis=-1)
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    inner = plan(scene).disk_inner
    seen, there = ((rays.crossing_r[:, 0] > inner) & (rays.crossing_r[:, 0] < FAR) for rays in (found, twin))
    assert 100 < there.sum() < 300
    assert np.count_nonzero(seen != there) <= 4  # of 400: what is left lies within the tolerance of the edge
