"""Closed forms of where circles of the disk's plane are seen, against the float64 march and against one another."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl import reference
from blackhole_gl.physics import lensed_circles, relativity
from blackhole_gl.physics.observer import local_directions, observe, parallel_rays
from blackhole_gl.scene import Scene

# spin, distance in r_s, inclination, observer
CAMERAS = [
    (0.9, 20.0, 80.0, "static"),
    (0.0, 15.0, 60.0, "static"),
    (-0.7, 8.0, 120.0, "zamo"),
    (0.998, 2.0, 85.0, "static"),
    (0.998, 0.6, 70.0, "zamo"),
    (0.5, math.inf, 30.0, "static"),
    (0.9, 20.0, 90.0, "static"),
    (0.6, 30.0, 0.0, "static"),
]


def seen_by(spin: float, distance: float, inclination: float, observer: str):
    scene = Scene().with_values(
        {"hole.spin": spin, "camera.distance": distance, "camera.inclination_deg": inclination, "camera.observer": observer, "rays.model": "kerr"}
    )
    return observe(scene)


def traced(directions: np.ndarray, spin: float, distance: float, inclination: float, observer: str) -> reference.hits.ReferenceHits:
    rays = {"screen": np.column_stack([directions[:, 2], -directions[:, 1]])} if math.isinf(distance) else {"directions": directions}
    return reference.trace("kerr", spin=spin, distance=distance, inclination_deg=inclination, observer=observer, **rays)


@pytest.mark.parametrize("camera", CAMERAS)
def test_crossings_are_those_of_the_march(camera) -> None:
    """1e-6: an error of the march of 1e-12 a step grows by e^π with every half turn; near the line where crossings run off to infinity it shows."""
    spin, distance = camera[:2]
    random = np.random.default_rng(7)
    if math.isinf(distance):
        directions = parallel_rays(*random.uniform(-9.0, 9.0, (2, 150)))
    else:
        directions = local_directions(random.uniform(0.0, 0.6 if distance > 5.0 else 1.4, 150), random.uniform(0.0, 2.0 * np.pi, 150))
    march, light = traced(directions, *camera), lensed_circles.light(seen_by(*camera), directions)
    np.testing.assert_array_equal(light.is_bound, march.energy_sign < 0.0)
    free, met = ~light.is_bound, 0
    np.testing.assert_allclose(light.lam[free], march.lambda_[free], rtol=1e-10, atol=1e-10)
    for order in range(3):
        mine, theirs = lensed_circles.crossing_radius(light, np.array(order))[free], march.equatorial.r[free, order]
        kept = mine > 1.03 * float(relativity.horizon_radius(spin))  # the march drops those still closer to the horizon
        there = np.isfinite(theirs)
        both = kept & np.isfinite(mine)
        assert not (both & ~there).any() and not (there & ~both & (theirs > 1.04 * float(relativity.horizon_radius(spin)))).any()
        np.testing.assert_allclose(mine[both], theirs[both], rtol=1e-6)
        met += both.sum()
    assert met > 30


@pytest.mark.parametrize("camera", [camera for camera in CAMERAS if camera[1] > 5.0])
def test_the_march_meets_circles_where_they_are_said_to_be_seen(camera) -> None:
    """3e-6 rad of bisection, 60 r_s of change of radius to a radian in the direct image; a ring's is a e^π times steeper for every half turn."""
    radius, angles = float(relativity.isco_radius(camera[0])), np.linspace(0.3, 6.3, 24, endpoint=False)
    observer = seen_by(*camera)
    images = lensed_circles.circles(observer, np.full(3, radius), np.arange(3), angles)
    for order, directions in enumerate(lensed_circles.directions(observer, images, angles)):
        if camera[2] == 90.0 and order == 0:
            continue  # edge-on the direct image of what lies before the hole is a line, which no angle but two meets
        found = traced(directions, *camera).equatorial.r[:, order]
        there = np.isfinite(found)
        assert there.mean() > 0.9, order
        assert np.abs(found[there] / radius - 1.0).max() < 3e-4 * math.exp(math.pi * order), order


@pytest.mark.parametrize("spin", [0.0, 0.9, -0.998])
def test_rings_close_in_on_the_critical_curve(spin: float) -> None:
    """Each half turn by e^π in Schwarzschild (Ohanian 1987)."""
    observer, angles = seen_by(spin, 30.0, 20.0, "static"), np.linspace(0.0, 2.0 * np.pi, 40)
    first, second = lensed_circles.circles(observer, np.array([6.0, 6.0]), np.array([1, 2]), angles)
    edge = lensed_circles.shadow_edge(observer, angles)
    gaps = [ring - edge for ring in (first, second)]
    assert (gaps[1] < 0.2 * gaps[0]).all()
    if spin == 0.0:
        assert np.median(gaps[0] / gaps[1]) == pytest.approx(math.exp(math.pi), rel=0.15), "the first ring is still a little wide for the limit"


EXTREME = [(0.998, 12.0, 90.0, "static"), (-0.998, 12.0, 60.0, "static"), (0.9, 1.3, 40.0, "zamo"), (0.9999, 20.0, 88.0, "static")]


@pytest.mark.parametrize("camera", [*CAMERAS, *EXTREME])
def test_the_critical_curve_is_where_fates_change(camera) -> None:
    """1e-4: its points lie on it and chords between them within 3e-5 of its size, a hundredth of a pixel of a picture that it fills."""
    spin, distance, inclination, kind = camera
    angles = np.linspace(0.0, 2.0 * np.pi, 90)
    found = lensed_circles.shadow_edge(seen_by(*camera), angles)
    if math.isinf(distance):
        near = 2e4 * lensed_circles.shadow_edge(seen_by(spin, 1e4, inclination, kind), angles)
        np.testing.assert_allclose(found, near, rtol=3e-4)  # M/r is 5e-5
    else:
        np.testing.assert_allclose(found, relativity.shadow_angle(angles, distance, math.radians(inclination), spin, seen_by(*camera).kind), rtol=1e-4)


@pytest.mark.parametrize(
    "camera, turned_deg",
    [
        ((0.9, 20.0, 80.0, "static"), 2.0),
        ((0.9, 20.0, 89.5, "static"), 0.3),  # across the critical curve, and in a line that is thinner than a pixel
        ((0.0, 15.0, 60.0, "static"), 2.0),
        ((0.998, 12.0, 45.0, "static"), 2.0),
        ((0.5, math.inf, 30.0, "static"), 2.0),
    ],
)
def test_circles_are_found_from_where_they_were_by_a_fifth_of_the_looks(camera, turned_deg: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """4e-5 rad, of the thousandth of a radius that is asked for at the direct image's 60 r_s to a radian and of the bisection, and
    for a far camera as much of its 40 M; rings lie far closer."""
    spin, distance, inclination, kind = camera
    angles, radii, orders = np.linspace(0.0, 2.0 * np.pi, 90), np.full(3, float(relativity.isco_radius(spin))), np.arange(3)
    before, now = seen_by(*camera), seen_by(spin, distance * 1.05, inclination - turned_deg, kind)
    guess = lensed_circles.circles(before, radii, orders, angles)
    guess *= lensed_circles.shadow_edge(now, angles) / lensed_circles.shadow_edge(before, angles)
    looks = []
    whole = lensed_circles.crossing_radius
    monkeypatch.setattr(lensed_circles, "crossing_radius", lambda rays, order: looks.append(rays.lam.size) or whole(rays, order))
    exact = lensed_circles.circles(now, radii, orders, angles)
    asked, _ = sum(looks), looks.clear()
    found = lensed_circles.circles(now, radii, orders, angles, guess)
    np.testing.assert_allclose(found, exact, atol=4e-5 if distance < math.inf else 2e-3)
    assert sum(looks) < 0.2 * asked


def test_a_guess_that_leads_nowhere_is_not_used() -> None:
    observer, angles, radii, orders = seen_by(0.9, 20.0, 80.0, "static"), np.linspace(0.0, 2.0 * np.pi, 20), np.full(3, 6.0), np.arange(3)
    exact = lensed_circles.circles(observer, radii, orders, angles)
    guesses = [np.full((3, 20), away) for away in (2.5, 1e-3, np.nan)]
    for guess in (*guesses, np.broadcast_to(lensed_circles.shadow_edge(observer, angles), (3, 20))):
        np.testing.assert_allclose(lensed_circles.circles(observer, radii, orders, angles, guess), exact, atol=4e-5)


def test_a_camera_inside_a_circle_is_refused() -> None:
    with pytest.raises(ValueError, match="r = 9 r_s is asked for from r = 8 r_s"):
        lensed_circles.circles(seen_by(0.0, 8.0, 60.0, "static"), np.array([9.0]), np.array([0]), np.zeros(3))


def test_a_crossing_is_no_coarser_than_its_time() -> None:
    """Of a far camera's ray near its turning point: w stayed within 5e-10 where the argument was always doubled four times, and is good to 1e-14."""
    observer = seen_by(-0.7, math.inf, 17.0, "static")
    rays = lensed_circles.light(observer, np.array([[-1.0, -8.35865368, 10.4214731]]))
    time = lensed_circles._crossing_time(rays, np.array(0)) * (1.0 + np.spacing(1.0) * np.arange(-3, 4))
    assert np.ptp(lensed_circles._inverse_radius(rays, time[None])) < 1e-14


def test_weierstrass_function_satisfies_its_equation() -> None:
    """℘'² = 4℘³ − g₂℘ − g₃, and ℘ is even with a double pole. 1e-11: doubling the argument twice costs that many digits."""
    g2, g3 = np.array([1.3, 0.0, -2.0, 12.0]), np.array([-0.4, 1.0, 0.5, -8.0 + 1e-9])
    for z in (0.05, 0.4, 0.9):
        value, rate = lensed_circles.weierstrass(np.full(4, z), g2, g3)
        np.testing.assert_allclose(rate**2, 4.0 * value**3 - g2 * value - g3, rtol=1e-11)
        even, odd = lensed_circles.weierstrass(np.full(4, -z), g2, g3)
        np.testing.assert_allclose(even, value)
        np.testing.assert_allclose(odd, -rate)
    assert lensed_circles.weierstrass(np.array([1e-3]), np.array([1.0]), np.array([1.0]))[0][0] == pytest.approx(1e6, rel=1e-9)
