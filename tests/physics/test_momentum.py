"""The photon's momentum at the crossings: null in the model's metric, the same by two forms, conserved, and of the right sign."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.physics import relativity
from blackhole_gl.reference import CAPTURED, ReferenceHits, models, trace, twin_of
from tests.sampled import sampled

PLANES = [(1.0, 0.0, 0.3), (0.2, 0.9, -0.5)]
# r in r_s, inclination: near and far, in the plane and over it, by the axis; the first within the ergosphere of fast holes.
CAMERAS = [(0.9, 88.0), (1.1, 80.0), (2.0, 90.0), (10.0, 60.0), (30.0, 3.0), (1000.0, 120.0)]
KERR = ("kerr", "kerr_schild")


def rays(count: int, distance: float, seed: int = 3) -> np.ndarray:
    """Look directions, most of them at the hole and around it."""
    n = np.random.default_rng(seed).normal(size=(count, 3))
    n[:, 0] = -np.abs(n[:, 0]) * max(1.0, distance / 3.0)
    n[: count // 8, 0] *= -1.0
    return n


def residual(found: ReferenceHits, metric: str, spin: float) -> np.ndarray:
    """Of every crossing, (N, events, orders)."""
    met, a = found.crossings, spin if metric == "kerr" else 0.0
    return relativity.null_residual(met.r, met.theta, a, found.lambda_[:, None, None], met.k_r, met.k_theta, mass=0.0 if metric == "flat" else 1.0)


SPINS = (0.0, 0.5, 0.9, 0.998)


def spins_of(model: str) -> tuple[float, ...]:
    return SPINS if twin_of(model).spins else (0.0,)


def null_cases() -> list:
    """(model, spin, distance, inclination): of the twins that take longest every second camera always."""
    cases = [(model, spin, *camera) for model in models() if twin_of(model).metric for spin in spins_of(model) for camera in CAMERAS]
    usual = [case for case in cases if case[1] == (0.9 if twin_of(case[0]).spins else 0.0)]
    return sampled(cases, [case for case in usual if case[0] not in ("kerr", "schwarzschild_binet") or case[2:] in CAMERAS[::2]])


@pytest.mark.parametrize("model, spin, distance, inclination", null_cases())
def test_light_is_null_in_the_metric_that_the_twin_names(model, spin, distance, inclination):
    twin = twin_of(model)
    horizon = 1.0 if twin.metric == "schwarzschild" else relativity.horizon_radius(spin)
    if distance <= horizon:
        return
    found = trace(model, spin=spin, distance=distance, inclination_deg=inclination, azimuth_deg=25.0, directions=rays(80, distance), planes=PLANES)
    met = found.crossings
    there = ~np.isnan(met.r)
    assert np.array_equal(~np.isnan(met.k_r), there) and np.array_equal(~np.isnan(met.k_theta), there)
    # Steps of 1e-12 each, up to a hundred of them near the horizon of a fast hole.
    assert np.max(residual(found, twin.metric, spin)[there], initial=0.0) <= 1e-9


def test_a_wrong_momentum_is_not_null():
    found = trace("kerr", spin=0.9, distance=10.0, inclination_deg=70.0, directions=rays(100, 10.0))
    met, lam = found.equatorial, found.lambda_[:, None]
    for wrong in ({"k_r": met.k_r * (1.0 + 1e-6)}, {"k_theta": met.k_theta * 1.001}, {"lam": lam + 1e-3}, {"spin": 0.9001}, {"r": met.r * 1.0001}):
        given = {"r": met.r, "theta": met.theta, "spin": 0.9, "lam": lam, "k_r": met.k_r, "k_theta": met.k_theta} | wrong
        # A change of some 1e-6 of the largest term shows as that, unless the ray has next to none of what was changed.
        assert np.nanmedian(relativity.null_residual(**given)) > 1e-8


def from_critical_curve(directions: np.ndarray, distance: float, inclination: float, spin: float, observer: str) -> np.ndarray:
    """|psi/psi_c - 1| of look directions (N, 3)."""
    psi, chi = np.arctan2(np.hypot(directions[:, 1], directions[:, 2]), -directions[:, 0]), np.arctan2(-directions[:, 1], directions[:, 2])
    return np.abs(psi / relativity.shadow_angle(chi, distance, np.radians(inclination), spin, observer) - 1.0)


@pytest.mark.parametrize("spin, distance, inclination", sampled(
    [(spin, *camera) for spin in SPINS for camera in ((2.0, 90.0), (10.0, 60.0), (1000.0, 120.0))], [(0.9, 2.0, 90.0)],
))
def test_both_forms_of_kerr_give_the_same_momentum(spin, distance, inclination):
    directions = rays(100, distance)
    one, two = (trace(model, spin=spin, distance=distance, inclination_deg=inclination, azimuth_deg=25.0, directions=directions, tolerance=3e-13,
                      planes=PLANES) for model in KERR)
    # Near the critical curve an error grows as its inverse distance, and crossings come and go.
    clear = from_critical_curve(directions, distance, inclination, spin, one.observer) > 1e-3
    a, b = one.crossings, two.crossings
    np.testing.assert_array_equal(np.isnan(a.r)[clear], np.isnan(b.r)[clear])
    # The larger term of the two in one unit: those of the null condition, sqrt(Delta) k_r and k_theta.
    root = np.sqrt((2.0 * a.r - 1.0) ** 2 - (1.0 - spin**2))
    size = np.maximum(np.abs(root * a.k_r), np.abs(a.k_theta))
    off = np.maximum(np.abs(root * (a.k_r - b.k_r)), np.abs(a.k_theta - b.k_theta)) / size
    # 1e-12 a step, times 1e3 near the critical curve and up to 10 where a place far out, or at 1.02 r_+, moves the components with it.
    assert np.nanmax(off[clear]) <= 1e-8


@pytest.mark.parametrize("model", KERR)
@pytest.mark.parametrize("spin", sampled((0.5, 0.998), (0.5,)))
def test_carters_constant_is_the_same_at_all_crossings_of_a_ray(model, spin):
    """From theta and k_theta alone, against that of the start by the closed form of the observer's frame."""
    distance, inclination = 10.0, 60.0
    n = rays(300, distance)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    found = trace(model, spin=spin, distance=distance, inclination_deg=inclination, directions=n, planes=PLANES, orders=4)
    lam = found.lambda_[:, None, None]
    q = relativity.carter_constant(found.crossings.theta, spin, lam, found.crossings.k_theta)
    photon = relativity.photon_constants(n[:, 1], n[:, 2], distance, np.radians(inclination), spin)
    l_z = photon.l_over_sin * np.sin(np.radians(inclination))
    start = ((photon.k - (l_z - spin * photon.energy) ** 2) / photon.energy**2)[:, None, None]
    assert np.sum(~np.isnan(q)) > 600
    # Ten to a hundred steps of 1e-12 each, against Q + lambda^2 + a^2, whose parts cancel in Q.
    assert np.nanmax(np.abs(q - start) / (np.abs(start) + lam**2 + spin**2)) <= 1e-10


@pytest.mark.parametrize("model", sampled(["flat", "schwarzschild", "schwarzschild_binet", "kerr_like", *KERR], ["flat", "schwarzschild", "kerr_like", *KERR]))
def test_light_comes_up_through_the_plane_to_a_camera_above_it_and_down_before(model):
    found = trace(model, spin=0.9, distance=10.0, inclination_deg=60.0, directions=rays(400, 10.0))
    k_theta = found.equatorial.k_theta
    counted = ~np.isnan(k_theta)
    assert np.all(k_theta[:, 0][counted[:, 0]] < 0.0)  # towards smaller theta
    if model != "flat":
        assert np.sum(counted[:, 1]) > 10 and np.all(k_theta[:, 1][counted[:, 1]] > 0.0)
        below = trace(model, spin=0.9, distance=10.0, inclination_deg=120.0, directions=rays(400, 10.0)).equatorial.k_theta[:, 0]
        assert np.all(below[~np.isnan(below)] > 0.0)


@pytest.mark.parametrize("model", sampled(["flat", "screen_lens", "schwarzschild", "schwarzschild_binet", *KERR],
                                          ["flat", "screen_lens", "schwarzschild", "schwarzschild_binet", "kerr_schild"]))
def test_the_ray_runs_against_the_momentum(model):
    """From one plane to one beside it: backwards along the ray r and theta change as -g^rr k_r and -g^thth k_theta."""
    spin = 0.8 if twin_of(model).spins else 0.0
    metric = twin_of(model).metric
    normal = np.array([0.3, 0.2, 1.0])
    beside = normal + [1e-5, 0.0, 0.0]
    found = trace(model, spin=spin, distance=12.0, inclination_deg=50.0, azimuth_deg=10.0, directions=rays(300, 12.0), planes=[normal, beside])
    one, two = found.crossings.of(1), found.crossings.of(2)
    later = np.sign(two.along - one.along)
    r = 2.0 * one.r
    delta = r * r if metric == "flat" else r * r - 2.0 * r + (spin if metric == "kerr" else 0.0) ** 2
    moved_r, moved_theta = 2.0 * (two.r - one.r) * later, (two.theta - one.theta) * later
    along = np.stack([moved_r, r * moved_theta]) / np.hypot(moved_r, r * moved_theta)
    momentum = -np.stack([delta * one.k_r, r * one.k_theta]) / np.hypot(delta * one.k_r, r * one.k_theta)
    angle = np.linalg.norm(along - momentum, axis=0)
    assert np.sum(~np.isnan(angle)) > 150
    # What is left is the bend between the planes, 1e-5 of the way round, where a ray runs across them; along them it goes far in between.
    assert np.nanmedian(angle) < 1e-4 and np.nanmax(angle) < 0.1


def test_in_flat_space_it_is_the_line_itself():
    found = trace("flat", distance=10.0, inclination_deg=60.0, directions=[[-np.cos(np.radians(60.0)), np.sin(np.radians(60.0)), 0.0], [-0.8, 0.36, 0.48]])
    met = found.equatorial
    # The first looks along -z: the light comes straight up, so that at the plane it has no radial part and k_theta = -r.
    assert met.k_r[0, 0] == pytest.approx(0.0, abs=1e-15)
    assert met.k_theta[0, 0] == pytest.approx(-2.0 * met.r[0, 0], rel=1e-15)
    # b^2 = k_theta^2 + lambda^2 at the plane, b = 20 M sin(psi)
    assert np.hypot(met.k_theta[1, 0], found.lambda_[1]) == pytest.approx(20.0 * 0.6, rel=1e-14)


def test_no_momentum_where_there_is_no_light():
    bent = [("schwarzschild", {"gravity_strength": 2.0}), ("kerr_like", {"gravity_strength": 0.5})]
    for model, given in bent + [(model, {}) for model in models() if twin_of(model).metric is None]:
        met = trace(model, distance=12.0, inclination_deg=60.0, directions=rays(100, 12.0), **given).equatorial
        assert np.sum(~np.isnan(met.r)) > 50 and np.isnan(met.k_r).all() and np.isnan(met.k_theta).all()


def test_light_of_negative_energy():
    """A ZAMO in the ergosphere sees light that is bound to the hole, with E < 0."""
    n = rays(400, 1.0)
    found = [trace(model, spin=0.95, distance=0.8, inclination_deg=85.0, observer="zamo", directions=n, planes=PLANES) for model in KERR]
    for hits in found:
        bound = hits.energy_sign < 0.0
        there = ~np.isnan(hits.crossings.r) & bound[:, None, None]
        assert np.sum(there) > 5
        assert np.max(residual(hits, "kerr", 0.95)[there]) <= 1e-9  # as for light of positive energy
        # It falls in, and as it falls in forward in time too, it never was outside the ergosphere.
        assert np.all(hits.fate[bound] == CAPTURED) and np.all(hits.crossings.r[there] < 1.0)


def test_on_the_axis_theta_has_no_direction():
    found = trace("kerr", spin=0.9, distance=8.0, inclination_deg=0.0, directions=rays(200, 8.0), planes=[(0.0, 1.0, 0.0)])
    on_axis = np.sin(found.crossings.theta[:, 1]) < 1e-6
    assert np.any(on_axis) and np.array_equal(np.isnan(found.crossings.k_theta[:, 1]), np.isnan(found.crossings.r[:, 1]) | on_axis)
    assert np.array_equal(np.isnan(found.crossings.k_r[:, 1]), np.isnan(found.crossings.r[:, 1]))
