"""Matter that falls in from the ISCO: its four-velocity against the metric and the circular orbit, and how hot it is."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.physics import plunging, relativity

CASES = [(0.0, "prograde"), (0.6, "prograde"), (0.6, "retrograde"), (-0.9, "prograde"), (0.998, "prograde"), (0.998, "retrograde")]


def metric(r: np.ndarray, a: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """g_tt, g_tφ, g_φφ, g_rr in the plane at r in M, of a hole that turns counter-clockwise where a > 0."""
    return -(1.0 - 2.0 / r), -2.0 * a / r, r * r + a * a * (1.0 + 2.0 / r), r * r / (r * r - 2.0 * r + a * a)


def inside(spin: float, orbit: str) -> np.ndarray:
    """Five radii in r_s between the horizon and the ISCO."""
    horizon, isco = float(relativity.horizon_radius(spin)), float(relativity.isco_radius(spin, orbit))
    return horizon + (isco - horizon) * np.array([0.03, 0.2, 0.5, 0.8, 0.99])


@pytest.mark.parametrize("spin, orbit", CASES)
def test_it_keeps_the_energy_and_the_angular_momentum_of_the_isco(spin: float, orbit: str) -> None:
    r = inside(spin, orbit)
    u = plunging.four_velocity(r, spin, orbit)
    g_tt, g_tp, g_pp, g_rr = metric(2.0 * r, spin)
    norm = g_tt * u.time**2 + 2.0 * g_tp * u.time * u.around + g_pp * u.around**2 + g_rr * u.radial**2
    np.testing.assert_allclose(norm, -1.0, atol=1e-9)
    isco = float(relativity.isco_radius(spin, orbit))
    rate, time = 0.5 * relativity.orbital_frequency(isco, spin, orbit), relativity.orbital_u_t(isco, spin, orbit)
    g_tt_i, g_tp_i, g_pp_i, _ = metric(2.0 * isco, spin)
    np.testing.assert_allclose(-(g_tt * u.time + g_tp * u.around), -time * (g_tt_i + g_tp_i * rate), rtol=1e-11)
    np.testing.assert_allclose(g_tp * u.time + g_pp * u.around, time * (g_tp_i + g_pp_i * rate), rtol=1e-11)
    assert np.all(u.radial < 0.0)


@pytest.mark.parametrize("spin, orbit", CASES)
def test_at_the_isco_it_is_the_circular_orbit(spin: float, orbit: str) -> None:
    isco = float(relativity.isco_radius(spin, orbit))
    u = plunging.four_velocity(isco, spin, orbit)
    assert float(u.time) == pytest.approx(float(relativity.orbital_u_t(isco, spin, orbit)), rel=1e-11)
    assert float(u.around / u.time) == pytest.approx(0.5 * float(relativity.orbital_frequency(isco, spin, orbit)), rel=1e-11)
    lam, k_r = np.array([-3.0, 0.0, 1.5]), np.array([0.8, -0.8, 0.1])
    just_inside = plunging.emission_shift(isco * (1.0 - 1e-8), lam, k_r, spin, orbit)
    np.testing.assert_allclose(just_inside, relativity.circular_orbit_g(isco, lam, spin, orbit), rtol=1e-7)  # u^r goes as the distance to the 3/2


def test_without_spin_against_a_fall_by_hand() -> None:
    """r = 3 M, a = 0: E = √(8/9), L = √12, u^t = 3E, u^φ = L/9, u^r = −1/3; light straight out has k_r = 3."""
    u = plunging.four_velocity(1.5, 0.0)
    energy = np.sqrt(8.0 / 9.0)
    np.testing.assert_allclose([u.time, u.radial, u.around], [3.0 * energy, -1.0 / 3.0, np.sqrt(12.0) / 9.0], rtol=1e-13)
    assert float(plunging.emission_shift(1.5, 0.0, 3.0, 0.0)) == pytest.approx(1.0 / (3.0 * energy + 1.0), rel=1e-13)
    assert float(plunging.emission_shift(1.5, 0.0, -3.0, 0.0)) == pytest.approx(1.0 / (3.0 * energy - 1.0), rel=1e-13)


def test_there_is_none_outside_the_isco_and_within_the_horizon() -> None:
    assert np.all(np.isnan(plunging.four_velocity(np.array([0.9, 1.0, 3.01]), 0.0).time))


def test_its_heat_is_that_of_matter_that_keeps_its_entropy() -> None:
    """ρ ∝ Σ/H and p ∝ ρ^(4/3), H ∝ r² √(p/ρ), Σ ∝ 1/(r u), and T⁴ ∝ p/Σ, as light leaves through a scattering opacity."""
    r = np.linspace(1.02, 3.0, 50)
    speed = 1.0 + (3.0 / r - 1.0) ** 1.5 / 0.01
    density = (1.0 / (r * speed) / r**2) ** (6.0 / 7.0)
    column = 1.0 / (r * speed)
    np.testing.assert_allclose(density, column / (r**2 * np.sqrt(density ** (1.0 / 3.0))), rtol=1e-12)
    temperature = (density ** (4.0 / 3.0) / column) ** 0.25
    np.testing.assert_allclose(plunging.heating(r, 0.0), temperature / temperature[-1], rtol=1e-12)
