"""A camera that falls through the horizon: the shadow and the light on its edge by closed form, rays against the Kerr–Schild twin, and pictures from inside."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.physics import relativity
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets

CHI = 2.0 * np.pi * (np.arange(8) + 0.3) / 8

# r in r_s → half-angle of the shadow of a hole without spin, for who fell from rest at infinity; degrees. p = (b²/r² − 1)/(β + √(1 − (1 − β²)b²/r²)) inside
# r = 1.5, the other root outside, b² = 27/4, β = r^(−1/2); cos ψ = p/(1 + βp).
SHADOWS = {100.0: 1.33989, 10.0: 10.31011, 3.0: 24.20343, 2.0: 30.50621, 1.5: 35.26439, 1.0: 42.10345, 0.5: 53.27027, 0.1: 72.26381}


def falling(spin: float, distance: float, inclination: float = 80.0, **values: object) -> Scene:
    camera = {"camera.observer": "rain", "camera.distance": distance, "camera.inclination_deg": inclination}
    return presets.load(["kerr", "reference"], {"hole.spin": spin, "rays.model": "kerr", **camera, **values})


@pytest.mark.parametrize("distance, degrees", SHADOWS.items())
def test_the_shadow_of_who_falls_has_its_size_down_to_the_centre(renderer: Renderer, distance: float, degrees: float) -> None:
    """Within 1e-4: what is that much nearer to its middle is dark, what is that much farther is sky. The angles above are known to 7e-6 at worst."""
    psi = np.radians(degrees) * np.array([[1.0 - 1e-4], [1.0 + 1e-4]])
    found = listed_rays.trace_by_shader(renderer, falling(0.0, distance), np.stack(np.broadcast_arrays(psi, CHI), axis=-1).reshape(-1, 2))
    np.testing.assert_array_equal(found.fate.reshape(2, 8), [[2] * 8, [1] * 8])
    np.testing.assert_allclose(found.energy.reshape(2, 8).mean(axis=0), 1.0 - math.cos(math.radians(degrees)) / math.sqrt(distance), rtol=1e-4)


@pytest.mark.parametrize("distance, degrees, shift", [(3.0, 24.20343, 0.473401), (1.0, 42.10345, 8.0 / 31.0)])
def test_the_light_on_its_edge_is_shifted_as_known(renderer: Renderer, distance: float, degrees: float, shift: float) -> None:
    found = listed_rays.trace_by_shader(renderer, falling(0.0, distance), np.column_stack([np.full(8, np.radians(degrees)), CHI]))
    np.testing.assert_allclose(found.energy, shift, rtol=1e-5)


def _agree(renderer: Renderer, scene: Scene, count: int) -> None:
    random = np.random.default_rng(11)
    rays = np.column_stack([np.arccos(random.uniform(-1.0, 1.0, count)), random.uniform(0.0, 2.0 * np.pi, count)])
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    np.testing.assert_array_equal(found.fate, twin.fate)
    escaped = found.fate == 1
    off = np.linalg.norm(found.direction - twin.direction, axis=1)[escaped]
    assert escaped.sum() > 0.6 * count
    assert np.quantile(off, 0.99) <= 5e-5, np.quantile(off, (0.5, 0.99))
    np.testing.assert_allclose(found.energy, twin.energy, rtol=1e-9)
    # The first crossing outside the horizon: inside there is no disk, and the twin leaves a place empty for it. Far out rays graze the plane.
    first = [rays_.crossing_r[np.arange(count), np.argmax(np.isfinite(rays_.crossing_r), axis=1)] for rays_ in (found, twin)]
    both = (first[1] > 1.2 * float(relativity.horizon_radius(scene.hole.spin))) & (first[1] < 30.0) & (first[0] > 0.0)
    assert both.sum() > 0.01 * count
    assert np.quantile(np.abs(first[0] / first[1] - 1.0)[both], 0.98) < 1e-4


@pytest.mark.parametrize("spin, distance, inclination", [(0.9, 0.75, 80.0), (0.9, 0.6, 40.0), (-0.7, 0.5, 50.0)])
def test_rays_of_a_fall_are_those_of_kerr_and_schild(renderer: Renderer, spin: float, distance: float, inclination: float) -> None:
    """Just above the horizon, where the twist has a pole that the regular form has not, and inside; down to just above the inner horizon the slow test goes."""
    _agree(renderer, falling(spin, distance, inclination), 120)


@pytest.mark.parametrize("spin, distance, inclination", [(0.0, 0.12, 80.0), (0.9, 0.6, 80.0), (0.998, 0.52, 60.0)])
def test_the_plans_own_steps_inside_err_by_less_than_half_a_pixel(renderer: Renderer, spin: float, distance: float, inclination: float) -> None:
    """At 99 % of the whole sky, in pixels of a picture 1080 high and 45° wide: what the plan promises there. With plain steps of rk4 it was 5, 30 and 33."""
    camera = {"camera.observer": "rain", "camera.distance": distance, "camera.inclination_deg": inclination}
    scene = presets.load(["kerr"], {"hole.spin": spin, "rays.model": "kerr", **camera})
    random = np.random.default_rng(3)
    rays = np.column_stack([np.arccos(random.uniform(-1.0, 1.0, 400)), random.uniform(0.0, 2.0 * np.pi, 400)])
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    np.testing.assert_array_equal(found.fate, twin.fate)
    off = np.linalg.norm(found.direction - twin.direction, axis=1)[found.fate == 1]
    assert np.quantile(off, 0.99) < 0.5 * math.radians(45.0) / 1080


@pytest.mark.parametrize("spin, distance", [(0.0, 0.12), (0.9, 0.6)])
def test_steps_that_are_refused_leave_no_trace(renderer: Renderer, spin: float, distance: float) -> None:
    """Of a step that an adaptive control refuses nothing is left but a shorter one to try: its twist was 0/0, and a third of the rays had no end."""
    steps = {"rays.integrator": "dopri5", "rays.step_control": "embedded", "rays.embedded.tolerance": 1e-4}
    scene = falling(spin, distance, **steps)
    psi = np.radians([20.0, 60.0, 75.0, 85.0, 100.0, 150.0])
    rays = np.column_stack([np.repeat(psi, len(CHI)), np.tile(CHI, len(psi))])
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    np.testing.assert_array_equal(found.fate, twin.fate)
    off = np.linalg.norm(found.direction - twin.direction, axis=1)[found.fate == 1]
    assert off.max() < 1e-3  # a dozen steps of 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("spin, distance", [(0.9, 3.0), (0.9, 1.5), (0.9, 0.9), (0.9, 0.75), (0.9, 0.6), (0.9, 0.3), (0.0, 0.5), (0.0, 0.1)])
def test_a_thousand_rays_of_a_fall_are_those_of_kerr_and_schild(renderer: Renderer, spin: float, distance: float) -> None:
    _agree(renderer, falling(spin, distance), 1000)


@pytest.mark.parametrize("spin, distance", [(0.0, 0.5), (0.0, 0.11), (0.9, 0.6), (0.9, 0.3)])
def test_pictures_from_inside_are_finite_and_not_dark(renderer: Renderer, spin: float, distance: float) -> None:
    scene = presets.load(["kerr"], {"hole.spin": spin, "camera.observer": "rain", "camera.distance": distance, "camera.fov_deg": 150.0})
    renderer.render(scene, 0.0, (120, 80))
    light, hits = renderer.radiance(), renderer.hits()
    assert np.isfinite(light).all() and np.all(hits.fate > 0)
    assert 0.05 < np.mean(hits.fate == 2) < 0.95 and np.mean(light.sum(axis=-1) > 1e-3) > 0.1


def test_light_of_no_energy_from_afar_shines_on_nobody(renderer: Renderer) -> None:
    """In the ergosphere light of E ≤ 0 arrives, too: its shift was taken for a million, and dots as bright as half floats hold stood in the shadow."""
    scene = presets.load(["kerr"], {"camera.observer": "rain", "camera.distance": 0.73, "camera.fov_deg": 110.0, "disk.plunging": False, "rays.edges": 1})
    renderer.render(scene, 0.0, (240, 150))
    light, hits = renderer.radiance()[::-1].sum(axis=-1), renderer.hits()
    inner = np.hypot(hits.crossing[..., 0, 0], hits.crossing[..., 0, 1])
    alone = (hits.fate == 2) & (inner > 0.0) & (inner < 0.8)
    assert alone.any() and light[alone].max() < 1e3
