"""Closed forms against the metric itself, against quadrature, and against each other in their limits."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import integrate, special

from blackhole_gl.physics import deflection, relativity

SPINS = [-0.9999, -0.5, -1e-7, 0.0, 1e-7, 0.3, 0.9, 0.998, 0.9999]
ORBITS = ["prograde", "retrograde"]
# A few dozen roundings of float64; used wherever both sides are closed forms.
ROUNDING = 1e-13


def metric(r_m: float, theta: float, a: float) -> np.ndarray:
    """Kerr in Boyer-Lindquist coordinates (t, r, theta, phi) at M = 1, as printed in Misner, Thorne & Wheeler 33.2."""
    sigma, delta, sine2 = r_m**2 + (a * np.cos(theta)) ** 2, r_m**2 - 2 * r_m + a * a, np.sin(theta) ** 2
    g = np.diag([-(1 - 2 * r_m / sigma), sigma / delta if delta else np.inf, sigma, (r_m**2 + a * a + 2 * r_m * a * a * sine2 / sigma) * sine2])
    g[0, 3] = g[3, 0] = -2 * a * r_m * sine2 / sigma
    return g


def signed(spin: float, orbit: str) -> float:
    return abs(spin) if orbit == "prograde" else -abs(spin)


@pytest.mark.parametrize("spin", SPINS)
def test_horizons_are_roots_of_delta(spin):
    for radius in (relativity.horizon_radius(spin), relativity.inner_horizon_radius(spin)):
        r = 2 * radius
        assert abs(r * r - 2 * r + spin * spin) < ROUNDING


@pytest.mark.parametrize("spin", SPINS)
def test_static_limit_is_where_g_tt_vanishes(spin):
    for theta in (0.0, 0.7, np.pi / 2):
        assert abs(metric(2 * relativity.ergosphere_radius(spin, theta), theta, spin + 0.0)[0, 0]) < ROUNDING


@pytest.mark.parametrize("orbit", ORBITS)
@pytest.mark.parametrize("spin", SPINS)
def test_isco_and_photon_orbit_satisfy_their_equations(spin, orbit):
    a, r = signed(spin, orbit), 2 * relativity.isco_radius(spin, orbit)
    # Near a = 1 the quartic has a triple root: an error of 1e-16 in its value is 1e-12 of (r - 1)^3.
    assert abs(r * r - 6 * r + 8 * a * np.sqrt(r) - 3 * a * a) < 1e-11
    r = 2 * relativity.photon_orbit_radius(spin, orbit)
    assert abs(r * (r - 3) ** 2 - 4 * a * a) < 1e-12


def test_radii_known_by_name():
    assert relativity.horizon_radius(0.0) == 1.0
    assert relativity.isco_radius(0.0) == pytest.approx(3.0, rel=ROUNDING)
    assert relativity.photon_orbit_radius(0.0) == 1.5
    assert relativity.isco_radius(0.998) == pytest.approx(1.2369706551 / 2, abs=1e-10)  # Thorne 1974, to the digits given
    assert relativity.isco_radius(1.0, "retrograde") == pytest.approx(4.5, rel=ROUNDING)
    assert relativity.photon_orbit_radius(1.0, "retrograde") == pytest.approx(2.0, rel=ROUNDING)


@pytest.mark.parametrize("orbit", ORBITS)
@pytest.mark.parametrize("spin", SPINS)
def test_circular_orbits_are_geodesics_of_the_metric(spin, orbit):
    for r in np.array([1.2, 2.0, 7.0]) * relativity.isco_radius(spin, orbit):
        r_m, omega = 2 * r, 0.5 * relativity.orbital_frequency(r, spin, orbit)
        step = 1e-5 * r_m
        slope = (metric(r_m + step, np.pi / 2, spin) - metric(r_m - step, np.pi / 2, spin)) / (2 * step)
        terms = np.array([slope[0, 0], 2 * omega * slope[0, 3], omega**2 * slope[3, 3]])
        assert abs(terms.sum()) < 1e-8 * np.abs(terms).max()  # central differences: step^2 = 1e-10 and 1e-16/step
        g = metric(r_m, np.pi / 2, spin)
        norm = g[0, 0] + 2 * omega * g[0, 3] + omega**2 * g[3, 3]
        # 1 - a = 1e-4 leaves the printed metric, unlike the closed form, with about twelve digits.
        assert relativity.orbital_u_t(r, spin, orbit) == pytest.approx(1 / np.sqrt(-norm), rel=1e-11)
        lam = -1.3
        expected = np.sqrt(-norm) / (1 - omega * lam)
        assert relativity.circular_orbit_g(r, lam, spin, orbit) == pytest.approx(expected, rel=1e-11)


def test_prograde_follows_the_spin():
    assert relativity.orbital_frequency(5.0, 0.5) > 0 > relativity.orbital_frequency(5.0, -0.5)
    assert relativity.orbital_frequency(5.0, 0.0) > 0 > relativity.orbital_frequency(5.0, 0.0, "retrograde")
    with pytest.raises(ValueError, match="orbit"):
        relativity.isco_radius(0.5, "sideways")


def test_s0_formula_is_exact_in_schwarzschild_and_s1_is_not():
    r, lam = np.array([2.0, 3.0, 10.0, 50.0]), np.array([1.0, -4.0, 5.0, 0.0])
    cosine = relativity.azimuthal_cosine(r, lam)
    exact = relativity.circular_orbit_g(r, lam, 0.0)
    np.testing.assert_allclose(relativity.g_s0(r, cosine), exact, rtol=ROUNDING)
    assert np.all(np.abs(relativity.g_s1(r, cosine) / exact - 1) > 1e-3)


@pytest.mark.parametrize("spin", SPINS)
def test_observers_against_the_metric(spin):
    for r, theta in ((1.5, 1.2), (4.0, 0.4), (100.0, np.pi / 2)):
        g = metric(2 * r, theta, spin)
        assert relativity.static_lapse(r, theta, spin) == pytest.approx(np.sqrt(-g[0, 0]), rel=ROUNDING)
        omega = -g[0, 3] / g[3, 3]
        assert 0.5 * relativity.frame_dragging(r, theta, spin) == pytest.approx(omega, rel=ROUNDING, abs=1e-300)
        lapse = np.sqrt(-g[0, 0] - omega * g[0, 3])
        assert relativity.zamo_lapse(r, theta, spin) == pytest.approx(lapse, rel=ROUNDING)


@pytest.mark.parametrize("observer", ["static", "zamo"])
@pytest.mark.parametrize("spin", [0.9, -0.998, 0.0])
def test_photon_constants_are_those_of_a_gram_schmidt_tetrad(spin, observer):
    r, theta = 1.3, 0.9
    g = metric(2 * r, theta, spin)
    first = np.array([1.0, 0, 0, 0 if observer == "static" else -g[0, 3] / g[3, 3]])
    tetrad = []
    for vector in (first, *np.eye(4)[1:]):
        for e in tetrad:
            vector = vector - (e @ g @ vector) / (e @ g @ e) * e
        tetrad.append(vector / np.sqrt(abs(vector @ g @ vector)))
    n = np.array([0.3, -0.5, 0.81])
    n /= np.linalg.norm(n)
    p = g @ (tetrad[0] - n @ np.array(tetrad[1:]))
    photon = relativity.photon_constants(n[1], n[2], r, theta, spin, observer)
    assert photon.energy == pytest.approx(-p[0], rel=ROUNDING)
    assert photon.l_over_sin * np.sin(theta) == pytest.approx(p[3], rel=ROUNDING)
    carter = p[2] ** 2 + np.cos(theta) ** 2 * ((p[3] / np.sin(theta)) ** 2 - (spin * p[0]) ** 2)
    assert photon.k == pytest.approx(carter + (p[3] + spin * p[0]) ** 2, rel=ROUNDING)


def test_schwarzschild_shadow():
    r = np.array([1.2, 1.5, 1.7, 3.0, 10.0, 100.0, 1e4])
    psi = relativity.schwarzschild_shadow_angle(r)
    np.testing.assert_allclose(np.sin(psi), relativity.CRITICAL_IMPACT * np.sqrt(1 - 1 / r) / r, rtol=ROUNDING)
    np.testing.assert_array_equal(psi > np.pi / 2, r < 1.5)
    for theta in (0.0, 1.0, np.pi / 2):
        for observer in ("static", "zamo"):
            kerr = [relativity.shadow_angle(np.linspace(0, 6, 7), x, theta, 0.0, observer) for x in r]
            np.testing.assert_allclose(kerr, np.repeat(psi[:, None], 7, axis=1), rtol=ROUNDING)


@pytest.mark.parametrize("spin", [1e-12, -1e-6, 0.5, -0.9, 0.9999, 1.0])
def test_spherical_photon_orbits_are_double_roots(spin):
    ends = [(2 * float(relativity.photon_orbit_radius(spin, orbit)) - 3) / abs(spin) for orbit in ORBITS]
    s = np.linspace(*ends, 11)[1:-1] * np.sign(spin)
    lam, eta = relativity.spherical_photon_orbit(s, spin)
    r = 3 + spin * s
    k = eta + (lam - spin) ** 2
    p, delta = r * r + spin * spin - spin * lam, r * r - 2 * r + spin * spin
    np.testing.assert_allclose(p * p, delta * k, rtol=1e-11)
    np.testing.assert_allclose(4 * r * p, (2 * r - 2) * k, rtol=1e-11)


@pytest.mark.parametrize("spin", [0.0, 1e-6, 0.3, -0.9, 0.998])
def test_photon_shell_is_where_spherical_orbits_turn(spin):
    r, cosine = relativity.photon_shell(spin, 33)
    assert r[0] == pytest.approx(relativity.photon_orbit_radius(spin)) and r[-1] == pytest.approx(relativity.photon_orbit_radius(spin, "retrograde"))
    assert cosine[0] < 1e-6 and cosine[-1] < 1e-6 and 0.99 < cosine.max() <= 1.0
    if spin:
        inner = slice(1, -1)
        lam, eta = relativity.spherical_photon_orbit((2.0 * r[inner] - 3.0) / spin, spin)
        u = cosine[inner] ** 2
        # k_theta^2 = eta + a^2 u - lambda^2 u/(1 - u) is 0 there, against the size of its terms
        np.testing.assert_allclose((eta + spin**2 * u) * (1 - u), lam**2 * u, rtol=1e-6, atol=1e-7)


def test_critical_curve_goes_over_into_the_circle():
    for spin, theta in ((0.0, 1.0), (1e-9, 1.0), (-1e-9, np.pi / 2), (1e-9, 0.0)):
        alpha, beta = relativity.critical_curve(spin, theta, 64)
        np.testing.assert_allclose(np.hypot(alpha, beta), np.sqrt(27), rtol=3e-9)  # the displacement is 2a
    near_axis, axis = (relativity.critical_curve(0.9, theta, 64) for theta in (1e-5, 0.0))
    np.testing.assert_allclose(np.hypot(*near_axis), np.hypot(*axis), rtol=1e-4)  # displacement 2 a sin(theta)


@pytest.mark.parametrize("spin", [0.5, -0.9, 0.998])
@pytest.mark.parametrize("theta", [0.05, 1.0, np.pi / 2])
def test_shadow_angle_tends_to_bardeens_curve(spin, theta):
    alpha, beta = relativity.critical_curve(spin, theta, 32)
    distance = 1e7
    psi = relativity.shadow_angle(np.arctan2(beta, alpha), distance, theta, spin)
    # lapse and curvature at 2e7 M change the angle by 1e-7 of itself
    np.testing.assert_allclose(2 * distance * psi, np.hypot(alpha, beta), rtol=5e-7)


def test_flat_side_of_the_shadow_is_the_approaching_side():
    # At +x with +e_phi to the right, matter that turns counter-clockwise approaches on the left.
    right, left = relativity.shadow_angle(np.array([0.0, np.pi]), 100.0, np.pi / 2, 0.9)
    assert left < 0.6 * right
    r, lam = 6.0, 2 * np.array([6.0, -6.0])
    assert relativity.circular_orbit_g(r, lam[0], 0.9) > 1 > relativity.circular_orbit_g(r, lam[1], 0.9)


def test_carlson_rf():
    x, y, z = np.random.default_rng(1).uniform(0, 10, (3, 200))
    x[:50] = 0.0
    np.testing.assert_allclose(deflection.carlson_rf(x, y, z), special.elliprf(x, y, z), rtol=1e-14)


@pytest.mark.parametrize("b", [2.6, 2.7, 3.0, 5.0, 20.0, 1e3])
def test_deflection_against_quadrature(b):
    # u = u_t (1 - s^2) takes the root out of the integrand; u_t by Newton from the closed cubic.
    turning = max(np.roots([1, -1, 0, 1 / b**2]).real[np.abs(np.roots([1, -1, 0, 1 / b**2]).imag) < 1e-9], key=lambda u: -abs(u - 1 / b))

    def integrand(s):
        u = turning * (1 - s * s)
        # (1/b^2 - u^2 + u^3)/(u_t - u) by division, 1/b^2 being u_t^2 - u_t^3
        return 2 * np.sqrt(turning) / np.sqrt(turning + u - turning**2 - turning * u - u * u)

    swept = 2 * integrate.quad(integrand, 0, 1, epsabs=1e-13, epsrel=1e-13, limit=200)[0]
    # np.roots and quad together are good to about 1e-12/(b/b_c - 1)
    assert deflection.exact(b) == pytest.approx(swept - np.pi, abs=2e-11)


def test_deflection_limits():
    # The next term of the weak series is (128/3) (M/b)^3 = 16/(3 b^3).
    b = np.array([1e3, 1e4])
    np.testing.assert_allclose((deflection.exact(b) - deflection.weak(b, 2)) * b**3, 16 / 3, rtol=0.02)
    epsilon = np.array([1e-5, 1e-7])
    b = relativity.CRITICAL_IMPACT * (1 + epsilon)
    # The logarithmic limit is right to O(epsilon ln epsilon).
    assert np.all(np.abs(deflection.exact(b) - deflection.strong(b)) < 2 * epsilon * np.abs(np.log(epsilon)))
    assert np.isinf(deflection.exact(relativity.CRITICAL_IMPACT)) and np.isnan(deflection.exact(2.0))


def test_a_shadow_of_each_size_is_seen_from_some_distance():
    distance = np.geomspace(1.5, 1e4, 50)
    found = relativity.schwarzschild_shadow_distance(np.minimum(relativity.schwarzschild_shadow_angle(distance), 0.5 * np.pi))
    # At the photon sphere the size changes by the square root of a rounding error.
    np.testing.assert_allclose(found, distance, rtol=1e-7)
