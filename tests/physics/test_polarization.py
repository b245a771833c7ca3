"""Polarization by Walker and Penrose's constant, against parallel transport along the light and against what symmetry says."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.physics import lensed_circles, plunging, polarization, relativity
from blackhole_gl.physics.observer import Observer, local_directions, observe, parallel_rays
from blackhole_gl.physics.polarization import MagneticField
from blackhole_gl.reference import transport
from blackhole_gl.reference.observers import Place
from blackhole_gl.scene import Scene
from tests.sampled import sampled

FIELDS = {"vertical": (1.0, 0.0, 0.0), "radial": (0.0, 1.0, 0.0), "toroidal": (0.0, 0.0, 1.0), "mixed": (0.5, 0.7, -0.4)}


def seen_by(spin: float, distance: float, inclination: float, observer: str = "static", **more: float) -> Observer:
    values = {"hole.spin": spin, "camera.distance": distance, "camera.inclination_deg": inclination, "camera.observer": observer, "rays.model": "kerr"}
    return observe(Scene().with_values(values | {f"camera.{key}": value for key, value in more.items()}))


def screen(observer: Observer, random: np.random.Generator, count: int, reach_m: float) -> np.ndarray:
    """Directions (count, 3) within a square of 2 `reach_m` about the hole."""
    aside, up = random.uniform(-reach_m, reach_m, (2, count))
    if observer.w == 0.0:
        return parallel_rays(aside, up)
    return local_directions(np.hypot(aside, up) * observer.w, np.arctan2(up, aside))


def angles(observer: Observer, directions: np.ndarray, order: int, field: tuple[float, float, float], orbit: str = "prograde") -> tuple[np.ndarray, np.ndarray]:
    """(position angle, radius in r_s) by the constant; radius NaN where nothing shines between the ISCO and 20 r_s."""
    spin = observer.spin
    light = lensed_circles.light(observer, directions)
    r = lensed_circles.crossing_radius(light, np.array(order))
    r = np.where((r > relativity.isco_radius(spin, orbit)) & (r < 20.0), r, np.nan)
    momentum = lensed_circles.crossing_momentum(light, np.array(order), r)
    left = polarization.emitted(r, momentum, polarization.circular_velocity(r, spin, orbit), MagneticField(*field).local, spin)
    return polarization.position_angle(observer, directions, polarization.arriving(observer, directions, left.constant)), r


def apart(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Difference of two position angles, which mean the same half a turn on."""
    return np.abs((first - second + 0.5 * np.pi) % np.pi - 0.5 * np.pi)


CAMERAS = ((math.inf, "static"), (20.0, "static"), (5.0, "zamo"))
SPINS = (-0.7, 0.0, 0.5, 0.9, 0.998)
# Each spin, of which 0.5 has a disk that goes the other way round, each inclination and each camera.
FEW = [(-0.7, 60.0, *CAMERAS[2]), (0.0, 17.0, *CAMERAS[0]), (0.5, 130.0, *CAMERAS[1]), (0.5, 60.0, *CAMERAS[0]), (0.9, 17.0, *CAMERAS[2]),
       (0.998, 130.0, *CAMERAS[1])]


@pytest.mark.parametrize("spin, inclination, distance, observer", sampled(
    [(spin, inclination, *camera) for inclination in (17.0, 60.0, 130.0) for spin in SPINS for camera in CAMERAS], FEW,
))
def test_the_constant_gives_what_parallel_transport_gives(spin: float, inclination: float, distance: float, observer: str) -> None:
    """1e-4: the camera that stands for a far one is at 1e6 M (4e-6 rad); errors grow by e^π in the first ring, and where light all but follows the field."""
    random, place = np.random.default_rng(5), Place.from_degrees(2.0 * distance, inclination, 0.0)
    camera, orbit = seen_by(spin, distance, inclination, observer), "retrograde" if spin == 0.5 else "prograde"
    for order, count, reach in ((0, 40, 14.0), (1, 100, 6.5)):
        directions = screen(camera, random, count, reach)
        found = {name: angles(camera, directions, order, field, orbit) for name, field in FIELDS.items()}
        met = np.isfinite(found["mixed"][1])
        rays = np.column_stack([directions[:, 2], -directions[:, 1]]) if math.isinf(distance) else directions
        carried = transport.carried_to_plane(place, spin, observer, rays[met], order)
        rate = 0.5 * relativity.orbital_frequency(found["mixed"][1][met], spin, orbit)
        assert met.sum() >= (10, 2)[order]
        for name, field in FIELDS.items():
            error = apart(found[name][0][met], transport.angle_of_synchrotron(carried, spin, rate, field))
            assert np.quantile(error, 0.99) < 1e-4, (name, order)


def test_transport_keeps_lengths_and_right_angles() -> None:
    """1e-8 of a march at 1e-11 a step: k stays light, and the two vectors unit vectors across it."""
    rays = local_directions(np.linspace(0.15, 0.5, 20), np.linspace(0.0, 6.0, 20))
    carried = transport.carried_to_plane(Place.from_degrees(20.0, 60.0, 0.0), 0.9, "static", rays, 0)
    met = np.isfinite(carried.place[0])
    g = transport.metric(carried.place[:, met], 0.9)
    k, right, up = (vectors[:, met] for vectors in (carried.k, carried.right, carried.up))
    for first, second, product in ((k, k, 0.0), (k, right, 0.0), (k, up, 0.0), (right, up, 0.0), (right, right, 1.0), (up, up, 1.0)):
        np.testing.assert_allclose(np.einsum("ab...,a...,b...->...", g, first, second), product, atol=1e-8)
    assert met.sum() > 10


@pytest.mark.parametrize("name, from_round, within", [("toroidal", 0.5 * np.pi, 1e-6), ("radial", 0.0, 0.1), ("vertical", 0.5 * np.pi, 0.6)])
@pytest.mark.parametrize("inclination", [0.0, 180.0])
def test_a_ring_seen_along_the_axis_is_polarized_alike_all_round(name: str, from_round: float, within: float, inclination: float) -> None:
    """Along the radius for a field that goes round, round for one along the radius, but for aberration by v = 0.29 at 6.5 r_s of light that was tilted
    outwards there to come here straight. In a vertical field the tilt alone would leave light polarized round; aberration, which is more, along the radius."""
    camera, chi = seen_by(0.0, math.inf, inclination), np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    found, r = angles(camera, parallel_rays(13.0 * np.cos(chi), 13.0 * np.sin(chi)), 0, FIELDS[name])
    away = (found - chi - from_round + 0.5 * np.pi) % np.pi - 0.5 * np.pi
    assert np.isfinite(r).all()
    assert np.ptp(away) < 1e-6  # of a radius that is good to 1e-7
    assert np.abs(away).max() < within


def test_the_angle_turns_with_the_camera() -> None:
    """A camera that rolls clockwise sees every angle grow by as much."""
    straight, rolled = seen_by(0.9, math.inf, 60.0), seen_by(0.9, math.inf, 60.0, roll_deg=30.0)
    directions = parallel_rays(*np.random.default_rng(3).uniform(-9.0, 9.0, (2, 40)))
    before, r = angles(straight, directions, 0, FIELDS["mixed"])
    after, _ = angles(rolled, directions, 0, FIELDS["mixed"])
    met = np.isfinite(r)
    np.testing.assert_allclose(apart(after[met], before[met] + math.radians(30.0)), 0.0, atol=1e-12)


def test_a_field_without_a_direction_is_refused() -> None:
    with pytest.raises(ValueError, match="no direction"):
        _ = MagneticField(0.0, 0.0, 0.0).local


@pytest.mark.parametrize("spin, orbit", [(0.0, "prograde"), (0.9, "prograde"), (0.5, "retrograde"), (-0.7, "prograde")])
def test_matter_that_falls_in_shifts_light_as_its_closed_form_has_it(spin: float, orbit: str) -> None:
    """1e-9: both are closed forms. At the innermost stable orbit it moves as matter on circular orbits does."""
    isco = float(relativity.isco_radius(spin, orbit))
    r = np.linspace(1.1 * float(relativity.horizon_radius(spin)), 0.999 * isco, 12)
    lam, eta, m = np.linspace(-2.0, 1.5, 12), np.full(12, 1.0), 2.0 * r
    delta = m * (m - 2.0) + spin**2
    k_r = np.sqrt((m * m + spin**2 - spin * lam) ** 2 - delta * (eta + (lam - spin) ** 2)) / delta
    momentum = np.stack([k_r, -np.sqrt(eta), lam], axis=-1)
    assert np.isfinite(k_r).all()
    left = polarization.emitted(r, momentum, polarization.falling_velocity(r, spin, orbit), MagneticField().local, spin)
    np.testing.assert_allclose(left.g, plunging.emission_shift(r, lam, k_r, spin, orbit), rtol=1e-9)
    at = np.array([isco])
    np.testing.assert_allclose(polarization.falling_velocity(at, spin, orbit), polarization.circular_velocity(at, spin, orbit), atol=1e-7)


@pytest.mark.parametrize("spin, orbit, distance", [
    (0.5, "prograde", 20.0), pytest.param(0.0, "prograde", math.inf, marks=pytest.mark.slow), pytest.param(0.9, "retrograde", 20.0, marks=pytest.mark.slow),
])
def test_light_of_matter_that_falls_in_is_polarized_as_parallel_transport_has_it(spin: float, orbit: str, distance: float) -> None:
    """1e-3 rad at 99 %; the matter's motion, by its energy and angular momentum alone, in Kerr–Schild coordinates."""
    place, camera = Place.from_degrees(2.0 * distance, 60.0, 0.0), seen_by(spin, distance, 60.0)
    directions = screen(camera, np.random.default_rng(8), 250, 7.0)
    r = lensed_circles.crossing_radius(lensed_circles.light(camera, directions), np.array(0))
    falls = (r > 1.1 * float(relativity.horizon_radius(spin))) & (r < 0.99 * float(relativity.isco_radius(spin, orbit)))
    assert falls.sum() > 10
    directions, r = directions[falls], r[falls]
    rays = np.column_stack([directions[:, 2], -directions[:, 1]]) if math.isinf(distance) else directions
    carried = transport.carried_to_plane(place, spin, "static", rays, 0)
    fixed = plunging.constants(spin, orbit)
    for name, field in FIELDS.items():
        momentum = lensed_circles.crossing_momentum(lensed_circles.light(camera, directions), np.array(0), r)
        left = polarization.emitted(r, momentum, polarization.falling_velocity(r, spin, orbit), MagneticField(*field).local, spin)
        found = polarization.position_angle(camera, directions, polarization.arriving(camera, directions, left.constant))
        turned = fixed.momentum * float(relativity.orbit_sense(spin, orbit))
        error = apart(found, transport.angle_of_falling(carried, spin, fixed.energy, turned, field))
        print(f"a* = {spin:g}, {orbit}, {name}: 99 % within {np.quantile(error, 0.99):.1e} rad of {len(r)}")
        assert np.quantile(error, 0.99) < 1e-3
