"""The hot spot: where it is, how it is shaped, and that a coarse picture gets the same light of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.physics import hot_spot, relativity
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets

TEN_HOURS = 36_000.0 * 4.0  # of playback at the default 4 r_s/c a second


def scene_of(**changes: object) -> Scene:
    values = {
        "hole.spin": 0.6, "camera.inclination_deg": 0.0, "camera.distance": math.inf, "camera.field_m": 30.0, "disk.temperature_law": "shakura_sunyaev",
        "disk.colour": "white", "disk.compositing": "additive", "disk.beaming": False, "sky.enabled": False, "post.bloom": False, "rays.edges": 1,
        "disk.hot_spot": True,
    }  # fmt: skip
    return presets.load(["kerr", "reference", "smooth"], values | {key.replace("__", "."): value for key, value in changes.items()})


def added(renderer: Renderer, scene: Scene, time: float, size: tuple[int, int]) -> np.ndarray:
    """Light of the spot over that of the disk below it, (height, width), bottom row first; 0 off the disk's direct image."""
    light = []
    for lit in (True, False):
        renderer.render(scene.with_values({"disk.hot_spot": lit}), time, size)
        light.append(renderer.radiance()[::-1, :, 0].astype(float))
    return np.where(light[1] > 1e-3 * light[1].max(), light[0] / np.maximum(light[1], 1e-9) - 1.0, 0.0)


@pytest.mark.parametrize("orbit", ["prograde", "retrograde"])
@pytest.mark.parametrize("time", [0.0, 11.0, TEN_HOURS])
def test_it_is_where_its_circular_orbit_takes_it_and_gaussian(renderer: Renderer, orbit: str, time: float) -> None:
    """Against exp(−(ln²(r/r₀) + 4 sin²(Δφ/2))/(2σ²)) at the crossings of the plane; half floats, and pixels a tenth of σ wide: a hundredth of the peak."""
    scene = scene_of(disk__orbit=orbit, disk__hot_spot__radius=6.0, disk__hot_spot__phase_deg=40.0, disk__hot_spot__size=0.2, rays__orders=1)
    found = added(renderer, scene, time, (160, 160))
    point = renderer.hits().crossing[..., 0, :].astype(float)
    r, phi = np.hypot(point[..., 0], point[..., 1]), np.arctan2(point[..., 1], point[..., 0])
    at = math.radians(40.0) + math.fmod(float(relativity.orbital_frequency(6.0, 0.6, orbit)) * time, 2.0 * math.pi)
    expected = 8.0 * np.exp(-0.5 * (np.log(np.maximum(r, 1e-6) / 6.0) ** 2 + 4.0 * np.sin(0.5 * (phi - at)) ** 2) / 0.2**2)
    there = (r > 4.0) & (r < 9.0)
    assert found[there].max() > 7.5
    np.testing.assert_allclose(found[there], expected[there], atol=0.08)


def test_a_coarse_picture_gets_as_much_of_its_light(renderer: Renderer) -> None:
    """A spot half a pixel wide in the coarse one."""
    scene = scene_of(disk__hot_spot__size=0.02, disk__hot_spot__phase_deg=20.0, rays__orders=1)
    fine, coarse = (added(renderer, scene, 0.0, (n, n)).sum() / n**2 for n in (480, 60))
    assert coarse == pytest.approx(fine, rel=0.05)


def test_it_keeps_out_of_the_innermost_stable_orbit_and_a_model_without_spin_has_none() -> None:
    isco = float(relativity.isco_radius(0.6))
    assert hot_spot.place(0.5, 0.0, "prograde", 0.0, 0.6, "kerr", True, 0.0) == (1.0, 0.0, isco, relativity.orbital_frequency(isco, 0.6))
    assert hot_spot.place(0.5, 90.0, "prograde", 0.0, 0.6, "schwarzschild", True, 0.0)[2] == 3.0
    assert hot_spot.place(0.5, 0.0, "prograde", 0.0, 0.6, "schwarzschild", False, 0.0)[2] == isco
