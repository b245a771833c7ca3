"""Crossings of tilted planes through the hole, against geometry, symmetry, the second form of Kerr and the equatorial plane itself."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.physics import relativity
from blackhole_gl.reference import ReferenceHits, models, trace, twin_of
from tests.sampled import sampled

TILTED = [(1.0, 0.0, 0.3), (0.2, 0.9, -0.5), (0.0, 1.0, 0.0)]


def rays(count: int, distance: float, seed: int = 3) -> np.ndarray:
    """Look directions, most of them at the hole and around it."""
    n = np.random.default_rng(seed).normal(size=(count, 3))
    n[:, 0] = -np.abs(n[:, 0]) * max(1.0, distance / 3.0)
    return n


def unit_vectors(theta: np.ndarray, phi: np.ndarray) -> np.ndarray:
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


@pytest.mark.parametrize("model", models())
def test_places_lie_in_their_planes_and_come_in_order(model):
    spin = 0.9 if twin_of(model).spins else 0.0
    found = trace(model, spin=spin, distance=8.0, inclination_deg=70.0, azimuth_deg=20.0, directions=rays(200, 8.0), planes=TILTED)
    normals = np.array([(0.0, 0.0, 1.0), *TILTED])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    off = np.einsum("rokx,ox->rok", unit_vectors(found.crossings.theta, found.crossings.phi), normals)
    assert np.sum(~np.isnan(off)) > 300
    assert np.nanmax(np.abs(off)) < 1e-12  # rounding of steps of order 14
    event, met = found.crossings.in_order()
    assert event.shape == met.r.shape == (200, 12)
    assert not np.any(np.diff(met.along, axis=1) < 0.0)
    assert np.array_equal(event == -1, np.isnan(met.along))
    for k in range(4):
        mine = np.where(event == k, met.along, np.nan)
        np.testing.assert_array_equal(np.sort(mine, axis=1)[:, :3], found.crossings.along[:, k])


def test_flat_space_meets_each_plane_where_geometry_says():
    found = trace("flat", distance=10.0, inclination_deg=90.0, directions=[[-0.8, 0.0, 0.6]], planes=[(0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)])
    # The line (10 - 0.8 s, 0.6 s, 0) lies in z = 0, starts in y = 0, and meets x = 0 at s = 12.5 and x + y = 0 at s = 50.
    assert np.isnan(found.crossings.r[0, :2]).all()
    np.testing.assert_allclose(found.crossings.along[0, 2:, 0], [12.5, 50.0], rtol=1e-14)
    np.testing.assert_allclose(found.crossings.r[0, 2:, 0], [7.5, 30.0 * np.sqrt(2.0)], rtol=1e-14)
    np.testing.assert_allclose(found.crossings.phi[0, 2:, 0], [0.5 * np.pi, 0.75 * np.pi], rtol=1e-14)


@pytest.mark.parametrize("model", sampled(["schwarzschild", "schwarzschild_binet", "post_newtonian", "weak_field", "kerr"],
                                          ["schwarzschild", "post_newtonian", "weak_field", "kerr"]))
def test_without_spin_a_tilted_plane_is_the_equator_of_a_turned_camera(model):
    """Turn camera and plane together about the y axis, so that the plane is z = 0."""
    tilt = np.radians(25.0)
    given = dict(spin=0.0, distance=9.0, directions=rays(300, 9.0))
    tilted = trace(model, inclination_deg=60.0, planes=[(np.sin(tilt), 0.0, np.cos(tilt))], **given)
    turned = trace(model, inclination_deg=35.0, **given)
    # The camera's meridian y = 0 contains the tilted normal, so that its frame turns along.
    np.testing.assert_array_equal(tilted.fate, turned.fate)
    np.testing.assert_array_equal(np.isnan(tilted.crossings.r[:, 1]), np.isnan(turned.crossings.r[:, 0]))
    # Shorter steps where planes are tilted: each has 1e-12; far crossings move by r^2 times the angle, near critical ones more.
    near = turned.crossings.r[:, 0] < 100.0
    np.testing.assert_allclose(tilted.crossings.r[:, 1][near], turned.crossings.r[:, 0][near], rtol=1e-8)
    assert np.sum(near) > 200


@pytest.mark.parametrize("spin, distance, inclination", sampled(
    [(0.9, 10.0, 60.0), (-0.9, 2.0, 90.0), (0.5, 200.0, 20.0), (0.998, 2.0, 90.0), (0.9999, 3.0, 100.0)], [(0.9, 10.0, 60.0), (-0.9, 2.0, 90.0)],
))
def test_both_forms_of_kerr_meet_the_same_planes_in_the_same_order(spin, distance, inclination):
    """Near the horizon dragging takes a ray round many times, by steps of other lengths in the two forms: none may be overlooked."""
    n = rays(80, distance)
    one, two = (trace(model, spin=spin, distance=distance, inclination_deg=inclination, azimuth_deg=25.0, directions=n, planes=TILTED, orders=8)
                for model in ("kerr", "kerr_schild"))
    np.testing.assert_array_equal(one.fate, two.fate)
    np.testing.assert_array_equal(np.isnan(one.crossings.r), np.isnan(two.crossings.r))
    kept = ~np.isnan(_ordered(one).r)
    np.testing.assert_array_equal(one.crossings.in_order()[0][kept], two.crossings.in_order()[0][kept])
    # 1e-12 a step; next to the critical curve, and in r^2 for far crossings, the forms drift apart.
    off = np.abs(one.crossings.r - two.crossings.r) / np.maximum(1.0, one.crossings.r) ** 2
    assert np.nanquantile(off, 0.99) < 1e-9
    assert np.nanmin(one.crossings.r) >= 1.02 * relativity.horizon_radius(spin)


def _ordered(found: ReferenceHits):
    return found.crossings.in_order()[1]


def test_a_dragged_ray_that_grazes_a_plane_meets_it_twice():
    """Rays over the pole, nearly in the plane that contains the axis: dragging takes them through it and back, within a step."""
    offset = np.linspace(-0.3, 0.3, 61)
    screen = np.stack([offset, np.full(61, 7.0)], axis=1)
    given = dict(spin=0.9, distance=np.inf, inclination_deg=90.0, screen=screen, planes=[(0.0, 1.0, 0.0)], orders=4)
    found = [trace(model, **given) for model in ("kerr", "kerr_schild")]
    counts = [np.sum(~np.isnan(hits.crossings.r[:, 1]), axis=1) for hits in found]
    np.testing.assert_array_equal(counts[0], counts[1])
    assert set(counts[0]) >= {1, 2}


def test_further_planes_leave_the_equator_as_it_is():
    given = dict(spin=0.9, distance=6.0, inclination_deg=75.0, directions=rays(80, 6.0))
    alone, among = trace("kerr", **given), trace("kerr", planes=TILTED, **given)
    again = trace("kerr", planes=[(0.0, 0.0, -2.0)], **given)
    np.testing.assert_array_equal(alone.fate, among.fate)
    np.testing.assert_allclose(among.crossing_r, alone.crossing_r, rtol=1e-8)  # other steps, each to 1e-12, and rays near the critical curve
    # The equator asked for again costs no shorter steps and is met at the same places.
    np.testing.assert_array_equal(again.crossing_r, alone.crossing_r)
    np.testing.assert_array_equal(again.crossings.r[:, 1], alone.crossing_r)


@pytest.mark.parametrize("azimuth", sampled([25.0, 30.0, 77.0], [30.0]))
def test_a_camera_in_a_tilted_plane_does_not_count_its_own_place(azimuth):
    """Where rounding alone says on which side of the plane it is."""
    normal = (-np.sin(np.radians(azimuth)), np.cos(np.radians(azimuth)), 0.0)
    for model in ("flat", "weak_field", "schwarzschild", "kerr"):
        found = trace(model, distance=12.0, inclination_deg=70.0, azimuth_deg=azimuth, directions=rays(100, 12.0), planes=[normal])
        assert not np.any(np.abs(found.crossings.r[:, 1] - 12.0) < 1e-6)
        assert np.all(~(found.crossings.along[:, 1] < 1e-6))


@pytest.mark.parametrize("normal", [(0.0, 0.0, 0.0), (np.nan, 0.0, 1.0), (np.inf, 0.0, 0.0)])
def test_a_normal_that_is_none_is_named(normal):
    with pytest.raises(ValueError, match="normals"):
        trace("flat", distance=10.0, inclination_deg=60.0, directions=[[-1, 0, 0]], planes=[normal])
