"""Values of a pixel: those of the float64 march along the same ray."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl import reference
from blackhole_gl.glsl.declared import Fate
from blackhole_gl.physics import disk_profile
from blackhole_gl.physics.observer import observe
from blackhole_gl.planning import plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.recording import pixel_direction
from blackhole_gl.rendering.views import linear_light
from blackhole_gl.scene import Scene, presets

SIZE = (96, 60)

# The asked accuracy, of anything shown; of crossings the shader's 2e-5, of λ float64's.
RELATIVE = 1e-3

SCENES = {
    "kerr": {"camera.azimuth_deg": 70.0, "camera.yaw_deg": 3.0, "camera.roll_deg": 25.0},
    "kerr, retrograde": {"hole.spin": -0.7, "disk.orbit": "retrograde", "disk.outer_radius": 15.0, "camera.observer": "zamo"},
    "schwarzschild": {"hole.spin": 0.0, "rays.model": "schwarzschild", "camera.inclination_deg": 65.0, "camera.azimuth_deg": -130.0},
    "far": {"camera.distance": math.inf},
}


def scene_of(name: str) -> Scene:
    return presets.load(["kerr", "reference"], {"rays.model": "kerr", **SCENES[name]})


@pytest.mark.parametrize("name", SCENES)
def test_values_are_those_of_the_march(renderer: Renderer, name: str) -> None:
    scene = scene_of(name)
    renderer.render(scene, 0.0, SIZE)
    pixels = [(x, y) for x in range(6, SIZE[0], 9) for y in range(4, SIZE[1], 7)]
    observer = observe(scene)
    rays = np.array([observer.look @ pixel_direction(scene, SIZE, (x + 0.5, y + 0.5)) for x, y in pixels])
    given = {"screen": np.column_stack([rays[:, 2], -rays[:, 1]])} if observer.w == 0.0 else {"directions": rays}
    camera, made = scene.camera, plan(scene)
    march = reference.trace(
        "kerr", spin=scene.hole.spin, distance=camera.distance, inclination_deg=camera.inclination_deg, azimuth_deg=camera.azimuth_deg,
        observer=camera.observer, orbit=scene.disk.orbit, **given,
    )  # fmt: skip
    met = escaped = 0
    for k, (x, y) in enumerate(pixels):
        found = renderer.last.values_at(((x + 0.3) / SIZE[0], (y + 0.7) / SIZE[1]))
        assert found.fate == march.fate[k]
        assert found.lam == pytest.approx(march.lambda_[k], rel=RELATIVE, abs=1e-9)
        if scene.hole.spin == 0.0:
            assert found.impact == pytest.approx(math.hypot(march.lambda_[k], math.sqrt(found.eta)), rel=RELATIVE)
        r = march.equatorial.r[k]
        on = np.flatnonzero((r >= made.disk_inner) & (r <= made.disk_outer))
        assert (found.disk is None) == (on.size == 0)
        if found.disk is not None:
            first = int(on[0])
            assert found.disk.order == first
            assert found.disk.radius == pytest.approx(r[first], rel=RELATIVE)
            assert math.remainder(found.disk.azimuth - march.equatorial.phi[k, first], 2.0 * math.pi) == pytest.approx(0.0, abs=RELATIVE)
            g = march.g[k, first] * _energy(observer, rays[k])
            assert found.disk.g == pytest.approx(g, rel=RELATIVE)
            kelvin = scene.disk.temperature_k * disk_profile.temperature(
                "page_thorne", r[[first]], spin=scene.hole.spin, orbit=scene.disk.orbit, r_in=made.disk_inner, r_out=made.disk_outer
            )
            assert found.disk.temperature == pytest.approx(g * kelvin[0], rel=RELATIVE)
            met += 1
        if found.fate == Fate.ESCAPED:
            assert found.sky[0] == pytest.approx(march.theta[k], abs=RELATIVE)
            assert math.remainder(found.sky[1] - march.phi[k], 2.0 * math.pi) * math.sin(march.theta[k]) == pytest.approx(0.0, abs=RELATIVE)
            escaped += 1
    assert met > 8 and escaped > 20


def _energy(observer, local: np.ndarray) -> float:
    """E_observer/E_infinity."""
    return 1.0 / float(observer.tetrad[0] @ np.array([1.0, *local]))


@pytest.mark.parametrize("formula", ["exact", "s0", "s1"])
def test_g_is_that_of_the_view(renderer: Renderer, formula: str) -> None:
    """In the plane of Schwarzschild's disk `s0` is exact and `s1` is not; all are what the picture is shaded by."""
    scene = presets.load(["schwarzschild"], {"disk.frequency_shift": formula, "post.view": "g_factor"})
    renderer.render(scene, 0.0, SIZE)
    scale = renderer.view_of(scene).scale
    shown = renderer.radiance()[::-1]
    values = [(x, y, renderer.last.values_at(((x + 0.5) / SIZE[0], (y + 0.5) / SIZE[1]))) for x in range(4, SIZE[0], 6) for y in range(4, SIZE[1], 6)]
    on = [(x, y, found.disk.g) for x, y, found in values if found.disk is not None]
    entries = linear_light(scale.colours(1025))
    for x, y, g in on:
        expected = [np.interp(scale.place(g), np.linspace(0.0, 1.0, 1025), entries[:, k]) for k in range(3)]
        np.testing.assert_allclose(shown[y, x], expected, atol=4e-3)
    assert len(on) > 20


def test_far_cameras_tell_screen_coordinates(renderer: Renderer) -> None:
    scene = scene_of("far")
    renderer.render(scene, 0.0, SIZE)
    found = renderer.last.values_at((0.75, 0.25))
    x, y = (math.floor(0.75 * SIZE[0]) + 0.5, math.floor(0.25 * SIZE[1]) + 0.5)
    half = 0.5 * scene.camera.field_m
    assert found.screen == pytest.approx(((2.0 * x - SIZE[0]) * half / SIZE[1], (2.0 * y - SIZE[1]) * half / SIZE[1]))
    assert found.lam == pytest.approx(-found.screen[0] * math.sin(math.radians(scene.camera.inclination_deg)))


def test_there_are_none_beside_the_picture_nor_of_interpolated_pixels(renderer: Renderer) -> None:
    scene = scene_of("kerr")
    renderer.render(scene, 0.0, SIZE)
    assert renderer.last.values_at((1.0, 0.5)) is None and renderer.last.values_at((0.5, -0.01)) is None
    renderer.render(scene.with_values({"camera.distance": 23.0}), 0.0, SIZE, progressive=True)
    assert renderer.hit_map.is_sharp or renderer.last.values_at((0.5, 0.5)) is None


def test_one_pixel_is_read_and_not_the_map(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    renderer.render(scene_of("kerr"), 0.0, SIZE)
    monkeypatch.setattr(renderer.hit_map, "read", lambda: pytest.fail("the whole map was read"))
    assert renderer.last.values_at((0.1, 0.9)).fate == Fate.ESCAPED
