"""The ray model made of a table and closed forms, against the float64 twin of `schwarzschild` and against itself."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.physics import deflection, orbit_table, relativity
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets
from tests.shaders.sampling import SCREEN_ANGLES, random_rays, shadow_edge

# Of rays at least 1e-2 from the critical curve: escape direction in rad, radius of crossings relatively. Closer in both grow as the
# inverse of the distance, as those of every method in float32 do.
DIRECTION_99, CROSSING_99 = 1e-5, 2e-5


def _scene(distance: float, inclination: float, **changes: object) -> Scene:
    values = {"rays.model": "schwarzschild_table", "camera.distance": distance, "camera.inclination_deg": inclination, "rays.orders": 3}
    return presets.load(["schwarzschild"], {**values, **changes})


def _compare(renderer: Renderer, scene: Scene, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Errors of directions (rad) and of crossing radii (relative, per 100 r_s beyond); the same rays escape and cross.

    One ray in 500 may have one missing or too many: a ray that ends almost in the plane, seen through a critical curve that blows up rounding.
    """
    found = listed_rays.trace_by_shader(renderer, scene, rays)
    twin = listed_rays.trace_by_reference(scene, rays)
    np.testing.assert_array_equal(found.fate, twin.fate)
    there = ~np.isnan(found.crossing_r) & ~np.isnan(twin.crossing_r)
    assert np.sum(np.isnan(found.crossing_r) != np.isnan(twin.crossing_r)) <= -(-len(rays) // 500)
    turned = np.abs(np.exp(1j * found.crossing_phi) - np.exp(1j * twin.crossing_phi))[there]
    assert turned.max(initial=0.0) <= 1e-6  # the line of nodes is plain geometry
    radius = np.abs(found.crossing_r / twin.crossing_r - 1.0) / np.maximum(1.0, twin.crossing_r / 100.0)
    return np.linalg.norm(found.direction - twin.direction, axis=1)[twin.fate == 1], radius[there]


@pytest.mark.parametrize(
    "distance, inclination",
    [(1.001, 60.0), (1.05, 80.0), (1.3, 80.0), (1.5, 60.0), (1.6, 85.0), (3.0, 80.0), (4.0, 3.0), (10.0, 80.0), (20.0, 90.0), (200.0, 45.0), (1e4, 80.0)],
)
def test_rays_against_the_twin(renderer: Renderer, distance: float, inclination: float) -> None:
    scene = _scene(distance, inclination)
    direction, radius = _compare(renderer, scene, random_rays(scene, 1000, seed=20))
    assert np.quantile(direction, 0.99) <= DIRECTION_99
    assert np.quantile(radius, 0.99) <= CROSSING_99


@pytest.mark.parametrize("distance", [1.2, 4.0, 50.0])
@pytest.mark.parametrize("away", [1e-2, 1e-3, 1e-4])
def test_near_the_critical_curve_errors_grow_as_the_inverse_of_the_distance(renderer: Renderer, distance: float, away: float) -> None:
    scene = _scene(distance, 75.0)
    edge = float(relativity.schwarzschild_shadow_angle(distance))
    chi = np.tile(2.0 * np.pi * (np.arange(200) + 0.3) / 200, 2)
    psi = edge * np.repeat([1.0 - away, 1.0 + away], 200)
    direction, radius = _compare(renderer, scene, np.stack([psi, chi], axis=-1))
    assert direction.max() <= 2e-6 / away
    # The third crossing stands behind a whole turn more than the first: its light has been bent e^(2π) times as sensitively.
    assert np.median(radius) <= 1e-6 / away and radius.max() <= 1e-5 / away


def test_parallel_rays_of_a_far_observer(renderer: Renderer) -> None:
    scene = _scene(float("inf"), 60.0)
    rng = np.random.default_rng(5)
    radius, turn = rng.uniform(0.1, 25.0, 1000), rng.uniform(0.0, 2.0 * np.pi, 1000)
    kept = np.abs(radius / (2.0 * relativity.CRITICAL_IMPACT) - 1.0) >= 1e-2
    rays = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=-1)[kept]
    direction, crossing = _compare(renderer, scene, rays)
    assert np.quantile(direction, 0.99) <= DIRECTION_99
    assert np.quantile(crossing, 0.99) <= CROSSING_99


@pytest.mark.parametrize("distance", [1.3, 20.0])
def test_radial_and_nearly_radial_rays(renderer: Renderer, distance: float) -> None:
    psi = np.array([0.0, 1e-4, 1e-7, np.pi, np.pi - 1e-4, np.pi - 1e-7, 0.5 * np.pi, 0.5 * np.pi - 1e-4, 0.5 * np.pi + 1e-4])
    rays = np.stack([np.tile(psi, 4), np.repeat([0.0, 0.5 * np.pi, 2.0, np.pi], len(psi))], axis=-1)
    for inclination in (0.0, 60.0, 89.99, 90.0):
        direction, _ = _compare(renderer, _scene(distance, inclination), rays)
        assert direction.max() <= 5e-6


@pytest.mark.parametrize("distance", [1.1, 1.5, 3.0, 15.0])
def test_the_shadow_has_the_exact_size(renderer: Renderer, distance: float) -> None:
    edge = shadow_edge(renderer, _scene(distance, 60.0), SCREEN_ANGLES)
    np.testing.assert_allclose(edge, relativity.schwarzschild_shadow_angle(distance), rtol=1e-6)


def test_the_table_is_made_anew_only_when_the_radius_changes(renderer: Renderer) -> None:
    tables = renderer.hit_map.tables
    renderer.render(_scene(7.0, 60.0), 0.0, (72, 40))
    made, traces = tables.made, renderer.hit_map.traces
    for step in range(1, 5):
        renderer.render(_scene(7.0, 60.0 + step, **{"camera.azimuth_deg": 10.0 * step, "camera.fov_deg": 40.0 + step}), 0.0, (72, 40))
    assert tables.made == made and renderer.hit_map.traces == traces + 4
    renderer.render(_scene(7.5, 60.0), 0.0, (72, 40))
    assert tables.made == made + 1


@pytest.mark.parametrize("distance", [1.01, 1.49, 1.5, 1.51, 4.0, 1e4, float("inf")])
def test_the_tables_cubics_hold_between_their_nodes(distance: float) -> None:
    """Against the integral itself. Half a float32 unit of angles up to 20 is 1e-6."""
    rng = np.random.default_rng(1)
    cubics = orbit_table.table(distance).astype(float)
    for row, sign, reach in ((0, -1.0, -0.5), (1, 1.0, 20.0)):
        size = np.exp2(rng.uniform(orbit_table.FIRST_OCTAVE, reach, 5000))
        fraction, octave = np.frexp(size)
        place = (2.0 * fraction - 1.0) * orbit_table.CELLS
        cell = np.floor(place)
        c = cubics[row, ((octave - 1 - orbit_table.FIRST_OCTAVE) * orbit_table.CELLS + cell).astype(int)]
        value = sum(c[:, k] * (place - cell - 0.5) ** k for k in range(4))
        np.testing.assert_allclose(value, orbit_table.swept_angle(sign * size, distance), rtol=0.0, atol=1.5e-6)


def test_the_swept_angle_is_the_known_deflection_of_far_rays() -> None:
    x = np.geomspace(1e-6, 1e3, 40)
    swept = orbit_table.swept_angle(x, float("inf"))
    np.testing.assert_allclose(swept - np.pi, deflection.exact(relativity.CRITICAL_IMPACT * (1.0 + x)), rtol=1e-9, atol=1e-12)
