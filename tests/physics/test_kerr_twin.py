"""The Kerr twin against conserved quantities, Bardeen's critical curve, quadratures and the symmetries of the metric."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import integrate, optimize

from blackhole_gl.physics import relativity
from blackhole_gl.reference import CAPTURED, ESCAPED, UNRESOLVED, trace
from blackhole_gl.reference.integrator import march
from blackhole_gl.reference.kerr_schild_form import CHART, ENERGY, L_Z, P_N, KerrSchildSystem, W
from blackhole_gl.reference.observers import Place, momenta
from tests.sampled import sampled


def random_directions(count: int, seed: int, inward: float = 4.0) -> np.ndarray:
    n = np.random.default_rng(seed).normal(size=(count, 3))
    n[:, 0] = -np.abs(n[:, 0]) * inward
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def at_screen_angle(psi, chi) -> np.ndarray:
    psi, chi = np.broadcast_arrays(psi, chi)
    return np.stack([-np.cos(psi), -np.sin(psi) * np.sin(chi), np.sin(psi) * np.cos(chi)], axis=-1)


def constants(state: np.ndarray, spin: float) -> np.ndarray:
    """(H, Carter's Q) of Kerr-Schild states, from the definitions in x and p."""
    n, w, momentum = state[:3], state[W], state[4:7]
    a, e = spin * state[CHART], state[CHART] * state[ENERGY]
    x, p = n / w, n * state[P_N] + w * np.cross(momentum.T, n.T).T
    square = (x**2).sum(0) - a * a
    r = np.sqrt(0.5 * (square + np.sqrt(square**2 + 4 * (a * x[2]) ** 2)))
    f = 2 * r**3 / (r**4 + (a * x[2]) ** 2)
    principal = np.stack([(r * x[0] + a * x[1]) / (r * r + a * a), (r * x[1] - a * x[0]) / (r * r + a * a), x[2] / r])
    hamiltonian = 0.5 * ((p**2).sum(0) - e * e - f * (e + (principal * p).sum(0)) ** 2)
    cosine = x[2] / r
    sine = np.sqrt(1 - cosine**2)
    azimuth = np.arctan2(x[1], x[0]) - np.arctan2(a, r)
    u = np.array([np.cos(azimuth), np.sin(azimuth), 0 * r])
    v = np.array([-np.sin(azimuth), np.cos(azimuth), 0 * r])
    p_theta = cosine * (r * (u * p).sum(0) + a * (v * p).sum(0)) - r * sine * p[2]
    return np.stack([hamiltonian, p_theta**2 + cosine**2 * ((state[L_Z] / sine) ** 2 - (a * e) ** 2)])


@pytest.mark.parametrize("spin", [0.6, -0.998])
def test_conserved_quantities_along_the_ray(spin):
    system, place = KerrSchildSystem(-spin), Place.from_degrees(12.0, 65.0, 20.0)
    directions = random_directions(100, 4)
    photons = momenta(directions, place, -spin, "static")
    state = system.start(place, photons)
    start = constants(state, system.spin)
    carter = photons.carter_k - (photons.l_over_sin * place.sin_theta - system.spin * photons.energy) ** 2
    np.testing.assert_allclose(start[1], carter, atol=1e-12 * 144)  # Q up to r^2, formed in two ways
    drift = np.zeros(100)

    def watch(rays, before, after, step):
        near = (after[W] > 1e-3) & (after[W] < 0.5)
        change = np.abs(constants(after, system.spin) - start[:, rays])
        scale = np.stack([np.ones(rays.size), 1 + np.abs(start[1, rays])])
        drift[rays] = np.maximum(drift[rays], np.where(near, (change / scale).max(0), 0.0))
        assert np.all(after[L_Z] == before[L_Z])
        return (after[W] <= 0) | system.captured(after)

    march(system, state, 0.05 * system.longest_step(state), watch, tolerance=1e-12, max_steps=1000)
    # About ten steps of 1e-12 each on momenta of order 10
    assert 0 < drift.max() < 1e-9


EDGES = [(0.5, 60, 10, "static"), (0.9, 90, 100, "static"), (-0.998, 17, 3, "zamo"), (0.999, 85, 1.2, "zamo"), (0.9, 0, 4, "static"),
         (0.998, 90, 0.85, "zamo"), (1e-8, 45, 10, "static"), (0.9, 90, 1e4, "static")]


@pytest.mark.parametrize("spin, inclination, distance, observer", sampled(EDGES, [edge for edge in EDGES if edge[0] != 0.999]))
def test_shadow_edge_is_bardeens_curve_through_the_tetrad(spin, inclination, distance, observer):
    chi = np.linspace(0, 2 * np.pi, 7, endpoint=False) + 0.1
    theta = np.radians(inclination)
    edge = relativity.shadow_angle(chi, distance, theta, spin, observer)
    # Bisection would find the twin's own edge; that it lies within 1e-8 shows in two rays to either side of it.
    psi = np.concatenate([edge * (1 - 1e-8), edge * (1 + 1e-8)])
    hits = trace("kerr", spin=spin, distance=distance, inclination_deg=inclination, observer=observer,
                 directions=at_screen_angle(psi, np.tile(chi, 2)))
    assert hits.observer == observer
    np.testing.assert_array_equal(hits.fate, np.repeat([CAPTURED, ESCAPED], chi.size))


@pytest.mark.parametrize("spin, inclination", sampled([(0.9, 75), (-0.998, 90), (0.5, 1)], [(-0.998, 90)]))
def test_shadow_edge_at_infinity_is_bardeens_curve(spin, inclination):
    alpha, beta = relativity.critical_curve(spin, np.radians(inclination), 8)
    middle = 0.5 * (alpha.min() + alpha.max())
    screen = [np.stack([middle + side * (alpha - middle), side * beta], axis=1) for side in (1 - 1e-8, 1 + 1e-8)]
    hits = trace("kerr", spin=spin, distance=np.inf, inclination_deg=inclination, screen=np.concatenate(screen))
    np.testing.assert_array_equal(hits.fate, np.repeat([CAPTURED, ESCAPED], 8))


@pytest.mark.parametrize("spin", sampled([0.3, -0.95, 0.0, 0.9999], [-0.95]))
def test_every_ray_has_its_exact_fate_and_nothing_is_nan(spin):
    """Everywhere: poles, plane, ergosphere, just above the horizon, far away; radial and tangential rays among them."""
    special = np.array([[-1, 0, 0], [1, 0, 0], [0, 0, 1], [0, 0, -1], [0, 1, 0], [0, -1, 0], [-0.6, 0, 0.8], [0.6, 0, -0.8]], float)
    for inclination, factor in ((0, 1.0001), (180, 2.0), (90, 1.0001), (90, 1.05), (89.9999, 30.0), (3, 1.01), (45, 1.3), (90, 1e4)):
        distance = factor * float(relativity.horizon_radius(spin))
        directions = np.concatenate([special, random_directions(12, 5, inward=factor), -random_directions(8, 6, inward=20.0)])
        hits = trace("kerr", spin=spin, distance=distance, inclination_deg=inclination, directions=directions)
        assert not np.any(hits.fate == UNRESOLVED)
        exact = relativity.falls_in(*directions.T, distance, np.radians(inclination), spin, hits.observer)
        np.testing.assert_array_equal(hits.fate == CAPTURED, exact)
        assert np.all(np.isfinite(hits.direction)) and np.all(np.isfinite(hits.lambda_))
        escaped = hits.fate == ESCAPED
        np.testing.assert_allclose(np.linalg.norm(hits.direction[escaped], axis=1), 1.0, rtol=1e-15)
        assert np.all(hits.direction[~escaped] == 0) and np.array_equal(np.isnan(hits.theta), ~escaped)
        assert np.all(np.isfinite(hits.crossing_r) == np.isfinite(hits.crossing_phi))


def test_static_observer_gives_way_to_the_zamo_in_the_ergosphere():
    for distance, inclination, used in ((0.9, 90, "zamo"), (1.1, 90, "static"), (0.75, 0, "static")):
        view = {"spin": 0.9, "distance": distance, "inclination_deg": inclination, "directions": random_directions(5, 7)}
        hits = trace("kerr", **view)
        assert hits.observer == used
        if used == "zamo":
            np.testing.assert_array_equal(hits.direction, trace("kerr", observer="zamo", **view).direction)


def equatorial_deflection(b_m: float, spin: float) -> float:
    """Angle swept from infinity to infinity in the plane z = 0, by quadrature of d phi/dr; b_m = |alpha| in M, sign with lambda."""
    def radial(r):
        return r**4 + (spin**2 - b_m**2) * r**2 + 2 * (b_m - spin) ** 2 * r

    turn = optimize.brentq(radial, abs(b_m) * 0.7, abs(b_m) * 1.001, xtol=1e-15, rtol=1e-15)

    def integrand(s):
        r = turn / (1 - s * s)  # removes the root at the turning point and brings infinity to s = 1
        p = r * r + spin**2 - spin * b_m
        slope = (spin * p / (r * r - 2 * r + spin**2) + b_m - spin) / np.sqrt(radial(r))
        return slope * 2 * s * turn / (1 - s * s) ** 2

    return 2 * integrate.quad(integrand, 0, 1, epsabs=1e-12, epsrel=1e-12, limit=400)[0] - np.pi * np.sign(b_m)


@pytest.mark.parametrize("spin", [0.9, -0.6])
def test_equatorial_deflection_is_the_quadrature(spin):
    lam = np.array([-12.0, -9.0, 8.0, 15.0, 100.0])
    hits = trace("kerr", spin=spin, distance=np.inf, inclination_deg=90, screen=np.stack([-lam, 0 * lam], axis=1))
    assert np.all(hits.direction[:, 2] == 0) and np.isnan(hits.crossing_r).all()
    np.testing.assert_allclose(hits.lambda_, lam, rtol=1e-15)
    # Backwards: the azimuth falls by what the photon gains.
    expected = np.array([-equatorial_deflection(b, spin) - np.pi * np.sign(b) for b in lam])
    difference = np.mod(hits.phi - expected + np.pi, 2 * np.pi) - np.pi
    # The quadrature asks for 1e-12 of angles up to 10 and knows its turning point to 1e-15; the twin's steps add 1e-12 each.
    assert np.all(np.abs(difference) < 1e-11), difference


def hamilton_boyer_lindquist(_, y, spin, lam, energy):
    """Hamilton's equations of (r, theta, phi, p_r, p_theta) in Boyer-Lindquist coordinates and Mino time: a third form."""
    r, theta, _, p_r, p_theta = y
    delta, s, c = r * r - 2 * r + spin**2, np.sin(theta), np.cos(theta)
    p = (r * r + spin**2) * energy - spin * lam
    d_radial = 2 * p * 2 * r * energy / delta - p * p * (2 * r - 2) / delta**2
    d_polar = 2 * (lam / s - spin * energy * s) * (-lam * c / s**2 - spin * energy * c)
    return [delta * p_r, p_theta, spin * p / delta + lam / s**2 - spin * energy,
            0.5 * (d_radial - (2 * r - 2) * p_r**2), -0.5 * d_polar]


@pytest.mark.parametrize("spin", [0.95, -0.7])
def test_crossings_and_azimuth_against_boyer_lindquist(spin):
    distance, theta = 10.0, np.radians(70)
    directions = at_screen_angle(np.array([0.33, 0.4, 0.5, 0.35]), np.array([0.4, 2.0, 3.6, 5.5]))
    hits = trace("kerr", spin=spin, distance=distance, inclination_deg=70, azimuth_deg=15, directions=directions)
    for ray, n in enumerate(directions):
        photon = relativity.photon_constants(n[1], n[2], distance, theta, spin)
        sigma = (2 * distance) ** 2 + (spin * np.cos(theta)) ** 2
        delta = (2 * distance) ** 2 - 4 * distance + spin**2
        start = [2 * distance, theta, np.radians(15), -n[0] * np.sqrt(sigma / delta), -n[1] * np.sqrt(sigma)]

        def plane(t, y, *_):
            return y[1] - np.pi / 2

        lam = float(photon.l_over_sin * np.sin(theta))
        path = integrate.solve_ivp(hamilton_boyer_lindquist, (0, -1.0), start, method="DOP853", rtol=1e-12, atol=1e-12,
                                   args=(spin, lam, float(photon.energy)),
                                   events=[plane, event_far, event_near])
        found = path.y_events[0]
        assert len(found), "the ray should meet the plane"
        for order, y in enumerate(found[:3]):
            # scipy locates events on its interpolant, which is of lower order than its steps
            assert 2 * hits.crossing_r[ray, order] == pytest.approx(y[0], rel=1e-7)
            assert np.cos(hits.crossing_phi[ray, order] - y[2]) > 1 - 1e-13


def event_far(t, y, *_):
    return y[0] - 300.0


def event_near(t, y, *_):
    return y[0] - 2.1


event_far.terminal = event_near.terminal = True


def test_mirror_images():
    """a -> -a is the mirror y -> -y; theta -> 180 - theta is the mirror z -> -z."""
    n = random_directions(60, 8)
    view = {"distance": 6.0, "observer": "zamo"}
    one = trace("kerr", spin=0.97, inclination_deg=60, directions=n, **view)
    two = trace("kerr", spin=-0.97, inclination_deg=60, directions=n * [1, 1, -1], **view)
    three = trace("kerr", spin=0.97, inclination_deg=120, directions=n * [1, -1, 1], **view)
    # The same steps are taken in mirrored numbers, rounding alone differs; the closest ray to the edge multiplies it.
    for other, mirror in ((two, [1, -1, 1]), (three, [1, 1, -1])):
        np.testing.assert_array_equal(one.fate, other.fate)
        np.testing.assert_allclose(one.direction * mirror, other.direction, atol=1e-11)
        np.testing.assert_allclose(one.crossing_r, other.crossing_r, rtol=1e-10)
        np.testing.assert_allclose(one.g, other.g, rtol=1e-10)


def test_the_axis_is_no_special_place():
    """A camera on the axis sees what its neighbours see, and turning it about the axis turns the picture."""
    n = random_directions(40, 9)
    on_axis, beside = (trace("kerr", spin=0.9, distance=8, inclination_deg=i, directions=n) for i in (0.0, 1e-7))
    np.testing.assert_allclose(on_axis.direction, beside.direction, atol=1e-4)  # 1e-7 degrees, times up to 1e4 near the edge
    turned = trace("kerr", spin=0.9, distance=8, inclination_deg=0, azimuth_deg=90, directions=n)
    np.testing.assert_allclose(on_axis.direction @ [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], turned.direction, atol=1e-12)
    # A ray with L_z = 0 from the side passes through the axis.
    over = trace("kerr", spin=0.9, distance=np.inf, inclination_deg=40, screen=[[0.0, 9.0], [1e-9, 9.0]])
    np.testing.assert_allclose(over.direction[0], over.direction[1], atol=1e-8)


def test_camera_in_the_plane_does_not_count_its_own_place():
    directions = np.array([[0.0, 0.6, 0.8], [-0.9, 0.1, 0.2], [-0.6, 0.0, 0.8], [0.8, 0.6, 0.0]])
    hits = trace("kerr", spin=0.5, distance=12, inclination_deg=90, directions=directions)
    assert not np.any(np.abs(hits.crossing_r[:, 0] - 12) < 1e-6)
    assert np.isnan(hits.crossing_r[2]).all() and np.isnan(hits.crossing_r[3]).all()


def test_g_is_the_metric_contracted():
    spin = 0.8
    hits = trace("kerr", spin=spin, distance=15, inclination_deg=75, directions=random_directions(200, 10))
    retro = trace("kerr", spin=spin, distance=15, inclination_deg=75, directions=random_directions(200, 10), orbit="retrograde")
    for found, orbit in ((hits, "prograde"), (retro, "retrograde")):
        lam = np.repeat(found.lambda_[:, None], 3, axis=1)
        inside = found.crossing_r < relativity.isco_radius(spin, orbit)
        assert np.array_equal(np.isnan(found.g), np.isnan(found.crossing_r) | inside)
        good = np.isfinite(found.g)
        np.testing.assert_allclose(found.g[good], relativity.circular_orbit_g(found.crossing_r, lam, spin, orbit)[good], rtol=1e-13)


def test_orders_and_cut_off():
    directions = at_screen_angle(0.9 * relativity.shadow_angle(np.linspace(0, 6, 40), 10.0, np.radians(85), 0.6), np.linspace(0, 6, 40))
    view = {"spin": 0.6, "distance": 10, "inclination_deg": 85, "directions": directions}
    all_orders, none, one = (trace("kerr", orders=k, **view) for k in (3, 0, 1))
    assert none.crossing_r.shape == (40, 0)
    np.testing.assert_array_equal(one.crossing_r[:, 0], all_orders.crossing_r[:, 0])
    assert np.nanmin(all_orders.crossing_r) >= 1.02 * relativity.horizon_radius(0.6)


@pytest.mark.parametrize("options, text", [
    ({"model": "newton"}, "newton"), ({"distance": 0.4}, "horizon"), ({"distance": np.inf}, "screen"), ({"screen": [[1, 2]]}, "screen")])
def test_errors_name_what_is_wrong(options, text):
    arguments = {"model": "kerr", "spin": 0.5, "distance": 10.0, "inclination_deg": 60.0, "directions": [[-1, 0, 0]], **options}
    with pytest.raises(ValueError, match=text):
        trace(arguments.pop("model"), **arguments)
