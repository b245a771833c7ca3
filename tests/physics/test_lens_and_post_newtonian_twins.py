"""The twins of approximate and of wrong models: each is off from light in Schwarzschild by just what its law says."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import integrate, optimize

from blackhole_gl.physics import deflection, relativity
from blackhole_gl.reference import CAPTURED, ESCAPED, trace

MASS = 0.5  # r_s = 1


def far_deflection(model: str, b: np.ndarray, **given) -> np.ndarray:
    """Deflection in radians of parallel rays with impact parameter `b` (r_s) in the equatorial plane, to the camera's right."""
    found = trace(model, distance=math.inf, inclination_deg=90.0, screen=np.stack([2.0 * b, 0.0 * b], axis=1), **given)
    assert np.all(found.fate == ESCAPED)
    return np.arctan2(-found.direction[:, 1], -found.direction[:, 0])


def looking(psi: np.ndarray, chi: np.ndarray) -> np.ndarray:
    return np.stack([-np.cos(psi), -np.sin(psi) * np.sin(chi), np.sin(psi) * np.cos(chi)], axis=-1)


def test_weak_field_lacks_the_next_order():
    b = np.array([100.0, 1000.0])
    exact = deflection.exact(b)
    first, second = (exact - far_deflection("weak_field", b, second_order=order) for order in (False, True))
    np.testing.assert_allclose(first * b**2, 15.0 * np.pi / 16.0, rtol=0.03)
    np.testing.assert_allclose(second * b**3, 16.0 / 3.0, rtol=0.05)  # 128 M³/(3 b³): Keeton & Petters 2005


@pytest.mark.parametrize("distance", [100.0, 1000.0])
def test_weak_field_is_of_first_order_from_any_distance(distance):
    psi = np.linspace(0.15, 3.0, 60)
    given = dict(distance=distance, inclination_deg=60.0, directions=looking(psi, np.full(60, 0.7)))
    off = np.linalg.norm(trace("weak_field", second_order=False, **given).direction - trace("schwarzschild", **given).direction, axis=1)
    b = distance * np.sin(psi)
    assert np.max(off * b**2) < 5.0  # first order would be off by 2/b at once


def test_screen_lens_is_a_thin_lens_for_the_sky():
    b = np.linspace(6.0, 40.0, 20)
    distance = 2000.0
    given = dict(distance=distance, inclination_deg=90.0, directions=looking(b / distance, np.full(20, 0.4)))
    off = np.linalg.norm(trace("screen_lens", **given).direction - trace("schwarzschild", **given).direction, axis=1)
    assert np.max(off * b**2) < 6.0  # deflection 2/b, but for 15π/(16 b²), third orders and the tangent's


def test_screen_lens_takes_nothing_for_the_disk():
    """What is nearer than the sky is displaced as if it were the sky: a ring of light inside which the picture is upside down."""
    distance = 25.0
    ring = math.atan(math.sqrt(2.0 / distance))
    found = trace("screen_lens", distance=distance, inclination_deg=80.0, directions=looking(np.array([0.9, 1.1]) * ring, np.full(2, 0.5 * np.pi)))
    above = found.direction[:, 2] > -math.cos(math.radians(80.0))
    assert list(above) == [False, True]


def pn_deflection(b: float) -> float:
    """The post-Newtonian law by quadrature: u'' + u = M/b² + 3M u², so (du/dφ)² = 1/b² − u² + 2M u/b² + 2M u³, with v = 1 far away."""
    turning = optimize.brentq(lambda u: 1.0 / b**2 - u * u + u / b**2 + u**3, 0.0, min(2.0 / 3.0, 1.5 / b))

    def slope(s: float) -> float:
        """dφ/ds with u = turning · sin² s, which takes the root out of the end point."""
        u = turning * math.sin(s) ** 2
        return 2.0 * turning * math.sin(s) * math.cos(s) / math.sqrt(max(1.0 / b**2 + u / b**2 - u**2 + u**3, 1e-300))

    swept = integrate.quad(slope, 0.0, 0.5 * math.pi, epsabs=1e-11, limit=400)[0]
    return 2.0 * swept - math.pi


@pytest.mark.parametrize("b", [4.5, 6.0, 12.0, 60.0])
def test_post_newtonian_against_quadrature(b):
    assert far_deflection("post_newtonian", np.array([b]))[0] == pytest.approx(pn_deflection(b), abs=2e-7)


def test_post_newtonian_bends_half_too_much_far_away():
    b = np.array([1e3, 1e4])
    np.testing.assert_allclose(far_deflection("post_newtonian", b) * b / (6.0 * MASS), 1.0, rtol=5e-3)


def shadow_edge(model: str, side: float, **given) -> float:
    """|α| in r_s at which rays in the equatorial plane begin to escape, on one side of the picture."""
    low, high = 0.5, 8.0
    for _ in range(7):
        trials = np.linspace(low, high, 18)[1:-1]
        fate = trace(model, distance=math.inf, inclination_deg=90.0, screen=np.stack([2.0 * side * trials, 0.0 * trials], axis=1), **given).fate
        captured = int(np.sum(fate == CAPTURED))
        edges = np.concatenate([[low], trials, [high]])
        low, high = edges[captured], edges[captured + 1]
    return 0.5 * (low + high)


def test_post_newtonian_shadow_is_a_third_too_large():
    """The largest b without a turning point: a double root of 1/b² − u² + u/b² + u³."""
    u = optimize.brentq(lambda x: (2.0 * x - 3.0 * x * x) * (1.0 + x) - (x * x - x**3), 0.3, 0.9)
    critical = math.sqrt((1.0 + u) / (u * u - u**3))
    edge = shadow_edge("post_newtonian", 1.0)
    assert edge == pytest.approx(critical, rel=1e-6)
    assert 1.25 < edge / relativity.CRITICAL_IMPACT < 1.4


def test_drag_flattens_the_side_where_the_disk_approaches():
    left, right = shadow_edge("post_newtonian_drag", -1.0, spin=0.9), shadow_edge("post_newtonian_drag", 1.0, spin=0.9)
    still = shadow_edge("post_newtonian", 1.0)
    assert left < still < right


def test_drag_is_mirrored_with_the_spin_and_gone_without():
    rays = looking(np.linspace(0.3, 1.2, 40), np.linspace(0.0, 6.0, 40))
    given = dict(distance=20.0, inclination_deg=70.0, orders=0)
    plus = trace("post_newtonian_drag", spin=0.8, directions=rays, **given).direction
    minus = trace("post_newtonian_drag", spin=-0.8, directions=rays * [1.0, 1.0, -1.0], **given).direction
    np.testing.assert_allclose(plus, minus * [1.0, -1.0, 1.0], atol=1e-10)
    none = trace("post_newtonian_drag", spin=0.0, directions=rays, **given).direction
    np.testing.assert_allclose(none, trace("post_newtonian", directions=rays, **given).direction, atol=1e-11)
