"""Twins without spin, and kerr_like, against elliptic integrals, scaling laws and geometry."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.physics import deflection, relativity
from blackhole_gl.reference import CAPTURED, ESCAPED, trace

B_C = relativity.CRITICAL_IMPACT


def swept_angle(model: str, b: np.ndarray, **options) -> np.ndarray:
    """Deflection (mod 2 pi) of rays from infinity in the equatorial plane, b in r_s."""
    hits = trace(model, distance=np.inf, inclination_deg=90, screen=np.stack([2 * b, 0 * b], axis=1), **options)
    assert np.all(hits.fate == ESCAPED)
    return np.mod(hits.phi + np.pi, 2 * np.pi)


def assert_same_angle(actual, expected, tolerance):
    difference = np.mod(actual - expected + np.pi, 2 * np.pi) - np.pi
    assert np.all(np.abs(difference) <= tolerance), difference


@pytest.mark.parametrize("model", ["schwarzschild", "kerr"])
def test_deflection_is_the_elliptic_integral(model):
    epsilon = np.array([1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 1e3])
    b = B_C * (1 + epsilon)
    # An error of the step, 1e-12, grows as 1/epsilon along the critical curve.
    assert_same_angle(swept_angle(model, b), deflection.exact(b), 1e-11 + 1e-13 / epsilon)


def test_near_critical_logarithm():
    epsilon = np.array([1e-6, 1e-5])
    b = B_C * (1 + epsilon)
    # The limit is right to O(epsilon ln epsilon) = 1.4e-4 for the larger one.
    assert_same_angle(swept_angle("schwarzschild", b), deflection.strong(b), 2 * epsilon * np.abs(np.log(epsilon)))


@pytest.mark.parametrize("strength", [0.1, 2.5, 10.0])
def test_gravity_strength_scales_lengths(strength):
    b = B_C * strength * np.array([1.01, 1.5, 4.0])
    angle = swept_angle("schwarzschild", b, gravity_strength=strength, horizon_size=0.1)
    assert_same_angle(angle, deflection.exact(b / strength), 2e-11)


@pytest.mark.parametrize("model", ["schwarzschild", "kerr_like", "kerr"])
@pytest.mark.parametrize("distance", [1.0001, 1.2, 1.5, 1.7, 3.0, 15.0, 1e4])
def test_shadow_edge(model, distance):
    edge = float(relativity.schwarzschild_shadow_angle(distance))
    psi = edge * (1 + np.array([-1e-9, 1e-9]))
    directions = np.stack([-np.cos(psi), -0.6 * np.sin(psi), 0.8 * np.sin(psi)], axis=1)
    hits = trace(model, distance=distance, inclination_deg=70, directions=directions)
    assert list(hits.fate) == [CAPTURED, ESCAPED]


def test_photon_sphere_holds_a_ray():
    hits = trace("schwarzschild", distance=1.5 * (1 + 1e-10), inclination_deg=30, directions=[[0.0, 1.0, 0.0]])
    # A displacement grows by e^pi each half turn; the third crossing comes after 1.3 turns.
    np.testing.assert_allclose(hits.crossing_r[0] / 1.5 - 1, 0.0, atol=1e-10 * np.exp(2.7 * np.pi))


def test_each_order_is_demagnified_by_e_to_minus_pi():
    """Face-on, the image of a ring of order n lies at b_n, and b_n - b_c falls by e^-pi an order (Luminet 1979)."""
    target = 10.0

    def gap_of_order(order):
        low, high = np.log(1e-9), np.log(10.0)  # of b/b_c - 1
        for _ in range(7):
            sections = np.linspace(low, high, 20)
            screen = np.stack([2 * B_C * (1 + np.exp(sections)), 0 * sections], axis=1)
            r = trace("schwarzschild", distance=np.inf, inclination_deg=0, screen=screen, orders=order + 1).crossing_r[:, order]
            outside = np.flatnonzero(~(r < target))[0]
            low, high = sections[outside - 1], sections[outside]
        return np.exp(low)

    gaps = [gap_of_order(order) for order in (1, 2, 3)]
    # The law is asymptotic: the ratio is off by a fifth for the first pair, by a hundredth for the second.
    assert gaps[0] / gaps[1] == pytest.approx(np.exp(np.pi), rel=0.25)
    assert gaps[1] / gaps[2] == pytest.approx(np.exp(np.pi), rel=2e-2)


def test_schwarzschild_and_kerr_without_spin_agree():
    directions = np.random.default_rng(2).normal(size=(300, 3)) * [4, 1, 1] * [-1, 1, 1]
    one, two = (trace(model, distance=12, inclination_deg=77, azimuth_deg=33, directions=directions) for model in ("schwarzschild", "kerr"))
    np.testing.assert_array_equal(one.fate, two.fate)
    # 300 rays: the closest to the critical curve lies at about 1e-2 and costs two digits
    np.testing.assert_allclose(one.direction, two.direction, atol=2e-11)
    np.testing.assert_allclose(one.crossing_r, two.crossing_r, rtol=1e-9)  # far crossings: r changes by r^2 times the angle
    np.testing.assert_allclose(one.g, two.g, rtol=1e-10)
    np.testing.assert_allclose(one.lambda_, two.lambda_, rtol=1e-13)


@pytest.mark.parametrize("strength", [1.0, 2.5])
def test_radial_rays(strength):
    straight = [[-1, 0, 0], [1, 0, 0], [-1, 1e-4, 0], [1, -1e-4, 0]]
    for inclination in (0, 45, 90, 180):
        hits = trace("schwarzschild", distance=8, inclination_deg=inclination, directions=straight, gravity_strength=strength)
        assert list(hits.fate) == [CAPTURED, ESCAPED, CAPTURED, ESCAPED]
        position = [np.sin(np.radians(inclination)), 0, np.cos(np.radians(inclination))]
        np.testing.assert_allclose(hits.direction[1], position, atol=1e-15)


def test_kerr_like_is_schwarzschild_turned():
    directions = np.random.default_rng(3).normal(size=(50, 3)) * [4, 1, 1] * [-1, 1, 1]
    view = {"distance": 10, "inclination_deg": 60, "directions": directions}
    plain, zero, off, one, mirrored = (trace(model, **view, **options) for model, options in (
        ("schwarzschild", {}), ("kerr_like", {"spin": 0.9, "drag": 0.0}), ("kerr_like", {"spin": 0.9, "twist": False}),
        ("kerr_like", {"spin": 0.9}), ("kerr_like", {"spin": -0.9})))
    np.testing.assert_allclose(zero.direction, plain.direction, atol=1e-14)
    np.testing.assert_array_equal(off.direction, zero.direction)
    np.testing.assert_array_equal(one.fate, plain.fate)
    np.testing.assert_allclose(one.crossing_r, plain.crossing_r, rtol=1e-10)
    np.testing.assert_allclose(one.theta, plain.theta, atol=1e-11)
    there = one.fate == ESCAPED
    assert_same_angle((one.phi + mirrored.phi)[there], 2 * plain.phi[there], 1e-10)


@pytest.mark.parametrize("b", [30.0, 300.0])
def test_kerr_like_turns_light_as_kerr_does_far_away(b):
    """Rays over the pole (L_z = 0): the turn is a*/b^2 in both, against the spin, because the rays run backwards."""
    spin = 0.8
    screen = [[0.0, 2 * b]]
    turn = [trace(model, spin=spin, distance=np.inf, inclination_deg=90, screen=screen).phi[0] - np.pi for model in ("kerr_like", "kerr")]
    turn = [(t + np.pi) % (2 * np.pi) - np.pi for t in turn]
    assert turn[0] == pytest.approx(-spin / b**2, rel=5 / b)  # next order in M/b
    assert turn[1] == pytest.approx(turn[0], rel=5 / b)


def test_flat_is_geometry():
    view = {"distance": 10.0, "inclination_deg": 60.0}
    down = np.array([-np.cos(np.radians(60)), np.sin(np.radians(60)), 0.0])  # straight to the plane, along -z
    tangent = np.arcsin(0.1)
    rays = [down, [-np.cos(tangent - 1e-9), 0, np.sin(tangent - 1e-9)], [-np.cos(tangent + 1e-9), 0, np.sin(tangent + 1e-9)], [1, 0, 0]]
    hits = trace("flat", **view, directions=rays)
    assert list(hits.fate) == [ESCAPED, CAPTURED, ESCAPED, ESCAPED]
    assert hits.crossing_r[0, 0] == pytest.approx(10 * np.sin(np.radians(60)), rel=1e-14)
    assert np.isnan(hits.crossing_r[[1, 3]]).all() and np.isnan(hits.crossing_r[:, 1:]).all()
    np.testing.assert_allclose(hits.direction[0], [0, 0, -1], atol=1e-15)
    parallel = trace("flat", distance=np.inf, inclination_deg=60, screen=[[8.0, 2.0], [0.5, 0.5]])
    assert list(parallel.fate) == [ESCAPED, CAPTURED]
    # beta foreshortened: the plane is met at y = alpha, x = -beta/cos(60), in M
    assert 2 * parallel.crossing_r[0, 0] == pytest.approx(np.hypot(8, 4), rel=1e-14)
    assert parallel.crossing_phi[0, 0] == pytest.approx(np.arctan2(8, -4), rel=1e-14)
