"""The observer's frame, checked with the metric, closed forms and the independent tetrad of the float64 twins."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from blackhole_gl.physics import observer, relativity
from blackhole_gl.physics.space_time import space_time
from blackhole_gl.reference import observers as twin
from blackhole_gl.scene import Scene, catalogue


def scene_of(model: str = "kerr", **camera) -> Scene:
    spin = camera.pop("spin", 0.0)
    return Scene().with_values({"rays.model": model, "hole.spin": spin, **{f"camera.{name}": value for name, value in camera.items()}})


def directions(count: int = 50, seed: int = 3) -> np.ndarray:
    local = np.random.default_rng(seed).normal(size=(count, 3))
    return local / np.linalg.norm(local, axis=1, keepdims=True)


def start(scene: Scene, local: np.ndarray) -> tuple[observer.Observer, np.ndarray]:
    """The observer and (N, 4) = (E, w'/E, n'_θ/E, n'_φ/E)."""
    seen = observer.observe(scene)
    rates = np.concatenate([np.ones((len(local), 1)), local], axis=1) @ seen.observer_map.T
    rates[:, 1:] /= rates[:, :1]
    return seen, rates


@pytest.mark.parametrize("kind", ["static", "zamo"])
@pytest.mark.parametrize("spin, distance, inclination", [(0.0, 3.0, 80.0), (0.9, 20.0, 80.0), (0.998, 2.0, 35.0), (-0.6, 1.3, 120.0), (0.5, 1e4, 5.0)])
def test_rays_start_null_with_the_twins_constants(spin, distance, inclination, kind):
    local = directions()
    scene = scene_of(spin=spin, distance=distance, inclination_deg=inclination, observer=kind)
    seen, rates = start(scene, local)
    place = twin.Place.from_degrees(2.0 * distance, inclination, 0.0)
    # The twin follows what moves along n: the physical photon has momentum −n, and time-reversed spin makes it a photon again.
    momenta = twin.momenta(local, place, -spin, kind)
    energy, w_rate, n_theta, n_phi = rates.T
    np.testing.assert_allclose(energy, momenta.energy, rtol=1e-12)
    lam = -n_phi * place.sin_theta
    np.testing.assert_allclose(lam, -momenta.l_over_sin * place.sin_theta / momenta.energy, rtol=1e-11, atol=1e-11)
    # w'² = 1 + c₂w² + ⅔c₃w³ + ½c₄w⁴ with K = η + λ² = n'² − a² n_z²
    k = n_theta**2 + n_phi**2 - (spin * place.cos_theta) ** 2
    eta, w = k - lam**2, seen.w
    c2, c3, c4 = spin**2 - lam**2 - eta, 3.0 * (eta + (lam - spin) ** 2), -2.0 * spin**2 * eta
    norm = 1.0 + c2 * w**2 + 2.0 / 3.0 * c3 * w**3 + 0.5 * c4 * w**4
    np.testing.assert_allclose(w_rate**2, norm, rtol=1e-9, atol=1e-9 * (1.0 + np.abs(k).max() * w * w))
    assert np.all(np.sign(w_rate) == -np.sign(local[:, 0]) * np.sign(energy))


@given(spin=st.floats(-0.9999, 0.9999), inclination=st.floats(0.0, 180.0), above=st.floats(1e-3, 100.0), kind=st.sampled_from(["static", "zamo"]))
@settings(max_examples=100, deadline=None)
def test_every_camera_outside_the_horizon_has_a_finite_frame(spin, inclination, above, kind):
    distance = max(float(relativity.horizon_radius(spin)) * (1.0 + above), 1.0001)
    seen = observer.observe(scene_of(spin=spin, distance=distance, inclination_deg=inclination, observer=kind))
    assert np.all(np.isfinite(seen.observer_map))
    frame = np.stack([seen.n, seen.e_theta, seen.e_phi])
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(frame) == pytest.approx(1.0)
    assert seen.kind in (kind, "zamo")


@pytest.mark.parametrize("distance", [1.7, 3.0, 15.0, 100.0])
def test_static_observers_of_schwarzschild_see_the_lapse(distance):
    for model in ("kerr", "schwarzschild"):
        _, rates = start(scene_of(model, distance=distance, inclination_deg=60.0), directions(5))
        np.testing.assert_allclose(rates[:, 0], math.sqrt(1.0 - 1.0 / distance), rtol=1e-14)


def test_the_zamo_sees_no_angular_momentum_of_its_own():
    """A ray with n_φ = 0 has L_z = 0: that is what the ZAMO is."""
    local = np.array([[-0.6, 0.8, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    _, rates = start(scene_of(spin=0.9, distance=2.0, inclination_deg=70.0, observer="zamo"), local)
    np.testing.assert_allclose(rates[:, 3], 0.0, atol=1e-14)


@pytest.mark.parametrize(
    "inclination, distance, kind", [(90.0, 1.0001, "static"), (90.0, 0.95, "zamo"), (90.0, 0.8, "zamo"), (0.0, 0.8, "static"), (5.0, 0.73, "static")]
)
def test_in_the_ergosphere_the_static_observer_gives_way(inclination, distance, kind):
    assert distance > relativity.horizon_radius(0.9)
    seen = observer.observe(scene_of(spin=0.9, distance=distance, inclination_deg=inclination))
    assert seen.kind == kind
    assert (distance > relativity.ergosphere_radius(0.9, math.radians(inclination))) == (kind == "static")


@pytest.mark.parametrize("model, spin, distance, horizon", [("kerr", 0.0, 1.0, "1 r_s"), ("kerr", 0.6, 0.9, "0.9 r_s"), ("schwarzschild", 0.9, 0.99, "1 r_s")])
def test_a_camera_that_is_not_outside_is_told_where_the_horizon_is(model, spin, distance, horizon):
    with pytest.raises(ValueError, match=f"camera.distance.*{horizon}"):
        observer.observe(scene_of(model, spin=spin, distance=distance))


def test_directions_of_the_screen():
    np.testing.assert_allclose(observer.local_directions(0.0, 1.0), [-1.0, 0.0, 0.0], atol=1e-16)
    np.testing.assert_allclose(observer.local_directions(0.5 * np.pi, 0.0), [0.0, 0.0, 1.0], atol=1e-16)  # right is +e_φ
    np.testing.assert_allclose(observer.local_directions(0.5 * np.pi, 0.5 * np.pi), [0.0, -1.0, 0.0], atol=1e-16)  # up is −e_θ
    assert observer.local_directions(np.zeros((2, 3)), 0.0).shape == (2, 3, 3)
    np.testing.assert_array_equal(observer.parallel_rays(3.0, 4.0), [-1.0, -4.0, 3.0])


def test_parallel_rays_have_the_screens_angular_momentum():
    """λ = −α sin θ_o (Bardeen)."""
    local = observer.parallel_rays(np.array([5.0, -3.0]), np.array([1.0, 2.0]))
    seen, rates = start(scene_of(spin=0.9, distance=math.inf, inclination_deg=30.0), local)
    assert seen.kind == "infinity" and seen.w == 0.0
    np.testing.assert_allclose(-rates[:, 3] * math.hypot(seen.n[0], seen.n[1]), [-2.5, 1.5])


def test_world_frame():
    seen = observer.observe(scene_of(azimuth_deg=90.0, inclination_deg=90.0))
    np.testing.assert_array_equal(seen.n, [0.0, 1.0, 0.0])
    np.testing.assert_array_equal(seen.e_theta, [0.0, 0.0, -1.0])
    np.testing.assert_array_equal(seen.e_phi, [-1.0, 0.0, 0.0])


@pytest.mark.parametrize("degrees", [*range(-360, 361, 90), 30.0, -123.4, 359.9])
def test_cosines_are_exact_at_right_angles(degrees):
    c, s = observer.cos_sin_deg(degrees)
    assert (c, s) == pytest.approx((math.cos(math.radians(degrees)), math.sin(math.radians(degrees))), abs=1e-15)
    if degrees % 90 == 0:
        assert {abs(c), abs(s)} == {0.0, 1.0}


@pytest.mark.parametrize("model", catalogue.keys("ray_model"))
def test_every_ray_model_has_an_observer(model):
    assert observer.observe(scene_of(model)).observer_map.shape == (4, 4)


def test_spin_belongs_to_models_that_have_it():
    spinning = {"spin": 0.9}
    assert space_time(scene_of("kerr", **spinning)).spin == 0.9
    assert space_time(scene_of("schwarzschild", **spinning)).spin == 0.0
    assert space_time(scene_of("kerr_like", **spinning)).horizon_spin == 0.0


@pytest.mark.parametrize("spin", [0.0, 0.5, 0.9, 0.998, 0.9999, -0.9999])
def test_rays_are_taken_as_captured_between_the_horizon_and_the_photon_orbit(spin):
    stop = space_time(scene_of("kerr", spin=spin)).stop_radius
    assert relativity.horizon_radius(spin) < stop < relativity.photon_orbit_radius(spin)
