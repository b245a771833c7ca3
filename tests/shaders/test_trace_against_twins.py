"""What the pictures' shader finds for listed rays, against the float64 twins. `-rP` shows the figures."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.physics import relativity
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets
from tests.sampled import sampled
from tests.shaders.sampling import random_rays

# README.md states these bounds, for rays at least 1e-2 from the critical curve.
DIRECTION_MEDIAN, DIRECTION_99 = 5e-6, 5e-5  # rad
CROSSING_99, G_99 = 2e-5, 2e-5  # relative

# A crossing at r lies where the ray has come down to the plane at an angle of about b/r: what one rounding of a float32 direction
# moves it by grows with r. The bound is relative up to here, five times as far as the largest disk, and grows with r beyond.
FAR = 100.0

# Just above the horizon k_r and the azimuth of a crossing have a pole, and follow the least change of its radius.
NEAR = 1.5

# model, a*, inclination in degrees, distance in r_s, observer
SCENES = [
    ("kerr", 0.0, 80.0, 10.0, "static"),
    ("kerr", 0.3, 3.0, 30.0, "static"),
    ("kerr", 0.6, 60.0, 4.0, "static"),
    ("kerr", 0.9, 45.0, 200.0, "static"),
    ("kerr", 0.99, 85.0, 20.0, "zamo"),
    ("kerr", 0.999, 90.0, 6.0, "static"),
    ("auto", 0.95, 70.0, 8.0, "static"),
    ("auto", 0.0, 70.0, 8.0, "static"),
    ("schwarzschild", 0.0, 80.0, 10.0, "static"),
    ("schwarzschild", 0.0, 45.0, 200.0, "static"),
    ("schwarzschild", 0.0, 3.0, 4.0, "static"),
    ("kerr_like", 0.9, 80.0, 10.0, "static"),
    ("kerr_like", -0.6, 30.0, 60.0, "static"),
    ("flat", 0.9, 60.0, 15.0, "static"),
]


# The others cost a second each: the twins of light round a hole that spins, and of `auto`, are slow.
SLOW = [scene for scene in SCENES if scene[0] in ("kerr", "auto") and scene[1] not in (0.99, 0.999) and scene[:2] != ("auto", 0.0)]


@pytest.mark.parametrize("model, spin, inclination, distance, observer", sampled(SCENES, [scene for scene in SCENES if scene not in SLOW]))
def test_listed_rays_against_the_twin(renderer: Renderer, model: str, spin: float, inclination: float, distance: float, observer: str) -> None:
    changes = {
        "rays.model": model,
        "hole.spin": spin,
        "camera.inclination_deg": inclination,
        "camera.distance": distance,
        "camera.observer": observer,
    }
    scene = presets.load(["kerr", "reference"], changes)
    rays = random_rays(scene, 1000, seed=20)
    assert len(rays) == 1000
    found = listed_rays.trace_by_shader(renderer, scene, rays)
    twin = listed_rays.trace_by_reference(scene, rays)
    _agree(found, twin, f"{model}, a* = {spin:g}, r = {distance:g} r_s, i = {inclination:g}°, {observer}")
    turned = np.abs(np.exp(1j * found.crossing_phi) - np.exp(1j * twin.crossing_phi))
    assert np.nanquantile(turned[twin.crossing_r > NEAR], 0.99) <= CROSSING_99


# k_r and k_θ against the twin, relative to the larger of k_r r and k_θ; and how far the photon is from null, relative to the largest term.
MOMENTUM_99, NULL_99 = 1e-5, 1e-5


WITH_MOMENTA = ("kerr", "kerr_schild", "schwarzschild", "schwarzschild_binet", "schwarzschild_table", "kerr_like", "flat")
PLACES = ((20.0, 75.0), (4.0, 100.0))
IN_TURN = [(model, *PLACES[count % 2]) for count, model in enumerate(reversed(WITH_MOMENTA))]


@pytest.mark.parametrize("model, distance, inclination", sampled([(model, *place) for model in WITH_MOMENTA for place in PLACES], IN_TURN))
def test_crossings_have_the_twin_s_momentum_and_it_is_null(renderer: Renderer, model: str, distance: float, inclination: float) -> None:
    spins = (0.5, 0.998) if model.startswith("kerr") else (0.0,)
    for spin in spins:
        changes = {"rays.model": model, "hole.spin": spin, "camera.distance": distance, "camera.inclination_deg": inclination}
        scene = presets.load(["kerr", "reference"], changes)
        rays = random_rays(scene, 1000, seed=21)
        found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
        there = np.isfinite(found.crossing_r) & np.isfinite(twin.crossing_k_r) & np.isfinite(twin.crossing_k_theta) & (twin.crossing_r < FAR)
        there &= twin.crossing_r > NEAR
        assert there.sum() > 300
        r = 2.0 * twin.crossing_r[there]  # M
        k_r, k_theta, lam = (np.broadcast_to(values, there.shape)[there] for values in (found.crossing_k_r, found.crossing_k_theta, found.lambda_[:, None]))
        size = np.maximum(np.abs(twin.crossing_k_r[there]) * r, np.abs(twin.crossing_k_theta[there]))
        off_r = np.quantile(np.abs(k_r - twin.crossing_k_r[there]) * r / size, 0.99)
        off_theta = np.quantile(np.abs(k_theta - twin.crossing_k_theta[there]) / size, 0.99)
        print(f"{model}, a* = {spin:g}, r = {distance:g} r_s: 99 % of k_r {off_r:.1e}, of k_θ {off_theta:.1e}")
        assert off_r < MOMENTUM_99 and off_theta < MOMENTUM_99
        a, mass = (spin if model in ("kerr", "kerr_schild") else 0.0), (0.0 if model == "flat" else 1.0)
        off = relativity.null_residual(found.crossing_r[there], found.crossing_theta[there], a, lam, k_r, k_theta, mass=mass)
        assert np.quantile(np.abs(off), 0.99) < NULL_99
        assert np.all(np.isnan(found.crossing_k_r) == np.isnan(found.crossing_r))


def test_listed_rays_through_a_medium_are_those_without_it(renderer: Renderer) -> None:
    """Their momenta, too: GL has eight targets at once, and two meetings leave none for them, so that they are traced apart."""
    scene = presets.load(["kerr"])
    rays = random_rays(scene, 100, seed=5)
    without, through = (listed_rays.trace_by_shader(renderer, scene.with_values(changes), rays) for changes in ({}, {"media.fog.kind": "ball"}))
    np.testing.assert_array_equal(through.fate, without.fate)
    near = without.crossing_r < 100.0  # a crossing far out is met later than the reach of the things' own steps
    np.testing.assert_allclose(through.crossing_r[near], without.crossing_r[near], rtol=1e-4)
    assert near.sum() > 50
    np.testing.assert_array_equal(through.crossing_k_r, np.where(np.isnan(through.crossing_r), np.nan, without.crossing_k_r))
    np.testing.assert_array_equal(np.isnan(through.crossing_k_theta), np.isnan(through.crossing_r))


@pytest.mark.parametrize("spin, inclination", sampled([(0.0, 60.0), (0.9, 17.0), (-0.998, 85.0)], [(0.9, 17.0), (-0.998, 85.0)]))
def test_parallel_rays_of_a_far_observer_against_the_twin(renderer: Renderer, spin: float, inclination: float) -> None:
    changes = {"hole.spin": spin, "camera.inclination_deg": inclination, "camera.distance": float("inf")}
    scene = presets.load(["kerr", "reference"], changes)
    rng = np.random.default_rng(5)
    radius, turn = rng.uniform(6.5, 25.0, 500), rng.uniform(0.0, 2.0 * np.pi, 500)  # M; outside every critical curve's 6.1 M with room
    rays = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=-1)
    found = listed_rays.trace_by_shader(renderer, scene, rays)
    twin = listed_rays.trace_by_reference(scene, rays)
    _agree(found, twin, f"kerr, a* = {spin:g}, far observer, i = {inclination:g}°")


@pytest.mark.parametrize("model", ["schwarzschild", "kerr"])
def test_rays_that_break_other_viewers(renderer: Renderer, model: str) -> None:
    """Exactly radial, 0.006° from it, and near-tangential outward rays."""
    psi = np.array([0.0, 1e-4, 1e-7, np.pi, np.pi - 1e-4, np.pi - 1e-7, 0.5 * np.pi, 0.5 * np.pi - 1e-4, 0.5 * np.pi + 1e-4])
    rays = np.stack([np.tile(psi, 4), np.repeat([0.0, 0.5 * np.pi, 2.0, np.pi], len(psi))], axis=-1)
    scene = presets.load(["schwarzschild", "reference"], {"rays.model": model, "camera.distance": 20.0})
    found = listed_rays.trace_by_shader(renderer, scene, rays)
    twin = listed_rays.trace_by_reference(scene, rays)
    np.testing.assert_array_equal(found.fate, twin.fate)
    assert np.linalg.norm(found.direction - twin.direction, axis=1)[twin.fate == 1].max() <= DIRECTION_MEDIAN


@pytest.mark.parametrize("distance, impact", [(20.0, 0.5), (20.0, 1.5), (20.0, 2.4)])
def test_coarse_fixed_steps_do_not_tunnel_through_the_horizon(renderer: Renderer, distance: float, impact: float) -> None:
    """Steps of 1 to 2 r_s lose these rays in other viewers. Ours are captured with the coarsest preset shipped."""
    psi = np.arcsin(impact * np.sqrt(1.0 - 1.0 / distance) / distance)
    rays = np.stack([np.full(16, psi), 2.0 * np.pi * np.arange(16) / 16], axis=-1)
    scene = presets.load(["schwarzschild", "blackholegpu_low"], {"camera.distance": distance})
    assert np.all(listed_rays.trace_by_shader(renderer, scene, rays).fate == 2)


def _agree(found: listed_rays.TracedRays, twin: listed_rays.TracedRays, name: str) -> None:
    """Fates are equal, the same crossings are there, and directions, crossings and g are within the bounds."""
    np.testing.assert_array_equal(found.fate, twin.fate)
    np.testing.assert_array_equal(np.isnan(found.crossing_r), np.isnan(twin.crossing_r))
    np.testing.assert_array_equal(np.isnan(found.crossing_g), np.isnan(twin.crossing_g))
    np.testing.assert_allclose(found.crossing_theta, twin.crossing_theta, atol=1e-12)  # the equator, in both
    # λ is linear in a float32 direction: what one rounding moves it by is that of the largest λ in the list.
    assert np.abs(found.lambda_ - twin.lambda_).max() <= 1e-6 * np.abs(twin.lambda_).max()
    angle = np.linalg.norm(found.direction - twin.direction, axis=1)[twin.fate == 1]
    crossing = _quantile(np.abs(found.crossing_r / twin.crossing_r - 1.0) / np.maximum(1.0, twin.crossing_r / FAR))
    g = _quantile(np.abs(found.crossing_g / twin.crossing_g - 1.0))
    print(f"{name}: direction median {np.median(angle):.1e}, 99 % {np.quantile(angle, 0.99):.1e} rad; 99 % of crossing r {crossing:.1e}, of g {g:.1e}")
    assert np.median(angle) <= DIRECTION_MEDIAN
    assert np.quantile(angle, 0.99) <= DIRECTION_99
    assert crossing <= CROSSING_99
    assert g <= G_99


def _quantile(error: np.ndarray) -> float:
    """The 99 % quantile of what is there; 0 where nothing is."""
    return float(np.nanquantile(error, 0.99)) if np.any(~np.isnan(error)) else 0.0


@pytest.mark.parametrize("model", ["kerr", "schwarzschild_binet"])
def test_nearly_radial_rays_from_far_away_enter_a_medium_where_its_surface_is(renderer: Renderer, model: str) -> None:
    """A ball on the line of sight; their first step leads from infinity past it."""
    centre = 1.5 * np.array([np.sqrt(3.0), 0.0, 1.0])
    ball = {"media.fog.kind": "ball", "media.fog.radius": 1.5, **{f"media.fog.{axis}": float(at) for axis, at in zip("xyz", centre)}}
    scene = presets.load(["kerr"], {"rays.model": model, "camera.distance": float("inf"), "camera.inclination_deg": 60.0, **ball})
    rays = np.outer([1e-6, 1e-4, 1e-2, 0.3, 2.0], [0.6, 0.8])
    hits = renderer.trace_listed(scene, listed_rays.local_vectors(rays, scene))[0]
    assert hits.met is not None and hits.met_place is not None and np.all(hits.met[:, 0, 0] >= 0)
    off = np.abs(np.linalg.norm(hits.met_place[:, 0] - centre, axis=-1) - 1.5)
    assert off.max() < 1e-5  # as places of things are; 4e-7 was found
