"""Matter that turns about the axis, and the Polish doughnut: closed forms against the metric, Kepler's orbits and hydrostatic equilibrium."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize

from blackhole_gl.physics import circling, relativity
from blackhole_gl.physics.torus import Torus, bound_radius, kepler_momentum, momentum_range, stable_radius

TORI = ((0.0, 3.9), (0.9, 2.6), (-0.5, 4.3))


@pytest.mark.parametrize("spin", [-0.9, 0.0, 0.5, 0.998])
def test_circular_geodesics_are_those_of_their_angular_momentum_and_velocity(spin):
    r = np.array([10.0, 30.0, 1e3])
    metric = circling.turning_metric(r, 1.0, spin)
    orbit = "prograde" if spin >= 0.0 else "retrograde"
    by_momentum = circling.with_angular_momentum(kepler_momentum(r, spin), metric)
    omega = 1.0 / (r**1.5 + spin)
    by_velocity = circling.with_angular_velocity(omega, metric)
    u_t = relativity.orbital_u_t(0.5 * r, spin, orbit)
    for matter in (by_momentum, by_velocity):
        # A kilo-M away l Omega is a thousandth: of its differences sixteen digits leave twelve.
        np.testing.assert_allclose(matter.omega, omega, rtol=1e-11)
        np.testing.assert_allclose(matter.u_t, u_t, rtol=1e-12)
        np.testing.assert_allclose(matter.energy_down, by_velocity.energy_down, rtol=1e-12)
    lam = np.array([-3.0, 0.0, 5.0])
    np.testing.assert_allclose(circling.shift(by_momentum, lam), 1.0 / (u_t * (1.0 - omega * lam)), rtol=1e-12)


def test_the_velocity_is_a_unit_vector_off_the_plane_too():
    r, sine2 = np.array([1.6, 2.5, 8.0]), np.array([0.9, 0.3, 0.05])
    metric = circling.turning_metric(r, sine2, 0.9)
    matter = circling.with_angular_momentum([0.0, 0.4, 1.0], metric)
    square = matter.u_t**2 * (metric.tt + matter.omega * (2.0 * metric.tphi + matter.omega * metric.phiphi))
    np.testing.assert_allclose(square, -1.0, rtol=1e-12)
    np.testing.assert_allclose(metric.det, metric.tphi**2 - metric.tt * metric.phiphi, rtol=1e-11)


def test_where_nothing_can_turn_so_there_is_no_matter():
    assert np.isnan(circling.with_angular_velocity(0.2, circling.turning_metric(6.0, 1.0, 0.0)).u_t)
    assert np.isnan(circling.with_angular_momentum(4.0, circling.turning_metric(1.9, 1.0, 0.0)).u_t)
    assert np.isnan(circling.with_angular_momentum(3.6, circling.turning_metric(1.1, 1.0, 0.998)).u_t)  # backwards in time


def test_without_mass_matter_turns_as_in_flat_space():
    matter = circling.with_angular_momentum(2.0, circling.turning_metric(5.0, 0.64, 0.0, mass=0.0))
    # l = R^2 Omega with R = 4: v = 1/2
    assert matter.omega == pytest.approx(0.125, rel=1e-14)
    assert matter.u_t == pytest.approx(1.0 / np.sqrt(0.75), rel=1e-14)


def test_cusp_and_centre_without_spin():
    torus = Torus(0.0, 4.0)
    assert torus.cusp == pytest.approx(4.0, abs=1e-7)  # l = 4 is the marginally bound orbit's, where the slope of l is finite
    assert torus.centre == pytest.approx(10.4721, abs=5e-5)
    assert torus.centre == pytest.approx(6.0 + 2.0 * np.sqrt(5.0), rel=1e-12)
    assert momentum_range(0.0) == pytest.approx((1.5 * np.sqrt(6.0), 4.0), rel=1e-12)


@pytest.mark.parametrize("spin, momentum", TORI)
def test_the_potential_has_its_extremes_at_cusp_and_centre(spin, momentum):
    torus = Torus(spin, momentum, filling=0.7)
    found = [optimize.minimize_scalar(lambda r, s=sign: s * float(torus.potential(r, 1.0)), bounds=bounds, method="bounded", options={"xatol": 1e-9}).x
             for sign, bounds in ((-1.0, (bound_radius(spin), stable_radius(spin))), (1.0, (stable_radius(spin), 40.0)))]
    # A minimum is flat: half of sixteen digits say where it is.
    np.testing.assert_allclose(found, [torus.cusp, torus.centre], rtol=1e-6)
    edges = np.array([torus.inner_radius, torus.outer_radius])
    np.testing.assert_allclose(torus.potential(edges, 1.0), torus.surface_potential, rtol=1e-12)
    assert torus.cusp < torus.inner_radius < torus.centre < torus.outer_radius


@pytest.mark.parametrize("spin, momentum", TORI)
def test_pressure_holds_the_matter(spin, momentum):
    """grad W = -grad p/(rho h), with p = K rho^Gamma and the enthalpy h = 1 + Gamma/(Gamma - 1) p/rho: so ln h + W is the same everywhere."""
    torus = Torus(spin, momentum, filling=0.9, gamma=5.0 / 3.0)
    r, sine2 = torus.centre * np.array([0.9, 1.0, 1.2]), np.array([0.97, 1.0, 0.99])
    density = torus.density(r, sine2)
    assert np.all(density > 0.0) and density[1] == 1.0
    k = (torus.gamma - 1.0) / torus.gamma * np.expm1(torus.surface_potential - float(torus.potential(torus.centre, 1.0)))  # where rho is 1
    enthalpy = 1.0 + torus.gamma / (torus.gamma - 1.0) * k * density ** (torus.gamma - 1.0)
    np.testing.assert_allclose(np.log(enthalpy) + torus.potential(r, sine2), torus.surface_potential, rtol=1e-12)


def test_a_full_torus_of_the_marginally_bound_orbit_has_no_end():
    assert Torus(0.0, 4.0).outer_radius == np.inf
    assert Torus(0.0, 4.0).density([3.9, 3e3], 1.0) == pytest.approx([0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("spin, inner, centre", [(0.0, 6.0, 10.0), (0.9, 3.0, 5.0), (-0.9, 12.0, 20.0), (0.0, 25.0, 40.0), (0.998, 7.0, 10.0)])
def test_a_torus_is_told_by_its_inner_edge_and_its_centre(spin, inner, centre):
    """The last two with more angular momentum than the circular orbit of light has, and so without a cusp."""
    torus = Torus.between(spin, inner, centre)
    assert torus.inner_radius == pytest.approx(inner, rel=1e-9)
    assert torus.centre == pytest.approx(centre, rel=1e-9)
    assert np.isfinite(torus.outer_radius)


@pytest.mark.parametrize("options, message", [
    ({"momentum": 3.5}, "3.5; at spin 0 it is above 3.67423"),
    ({"momentum": 3.9, "filling": 0.0}, "filling 0"),
    ({"momentum": 3.9, "gamma": 1.0}, "adiabatic index 1"),
])
def test_what_has_no_closed_torus_is_refused(options, message):
    with pytest.raises(ValueError, match=message):
        Torus(0.0, **options)
