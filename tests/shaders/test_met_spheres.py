"""Spheres on rays against the float64 twins, which meet them on steps too short to jump any: what is met first, where, and that nothing is missed."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl import listed_rays, reference
from blackhole_gl.glsl.declared import Fate
from blackhole_gl.physics import observer
from blackhole_gl.physics.space_time import space_time
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets

MODELS = ("flat", "schwarzschild", "kerr", "lorenz")
COUNT, SMALLEST, LARGEST = 8, 0.5, 3.0
WIDEST = 0.6  # rad from the hole
STEPS = {"rays.step_angle": 0.1, "rays.step_length": 0.1, "rays.integrator": "rk4"}  # the march's own error is then far below what is asked


def _scene(model: str, balls: np.ndarray, **values: object) -> Scene:
    spin = 0.9 if model == "kerr" else 0.0
    stated: dict[str, object] = {"rays.model": model, "hole.spin": spin, "disk.enabled": False, "camera.inclination_deg": 70.0, **STEPS}
    for number, (x, y, z, radius) in enumerate(balls):
        name = f"things.ball_{number}"
        stated |= {f"{name}.kind": "sphere", f"{name}.x": x, f"{name}.y": y, f"{name}.z": z, f"{name}.radius": radius}
    return presets.load(["kerr"], {**stated, **{key.replace("__", "."): value for key, value in values.items()}})


def _about_the_hole(rng: np.random.Generator, count: int) -> np.ndarray:
    """Spheres (count, 4) between 3 and 12 r_s from the hole, overlapping as they come."""
    n = rng.normal(size=(count, 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    return np.hstack([n * rng.uniform(3.0, 12.0, (count, 1)), rng.uniform(SMALLEST, LARGEST, (count, 1))])


def _rays(rng: np.random.Generator, count: int) -> np.ndarray:
    return np.stack([rng.uniform(0.02, WIDEST, count), rng.uniform(-np.pi, np.pi, count)], axis=-1)


def _twin(scene: Scene, rays: np.ndarray, **asked: object) -> reference.ReferenceHits:
    camera = scene.camera
    directions = observer.local_directions(rays[:, 0], rays[:, 1])
    model = scene.rays.model
    where = {"distance": camera.distance, "inclination_deg": camera.inclination_deg, "azimuth_deg": camera.azimuth_deg}
    return reference.trace(model, spin=space_time(scene).spin, directions=directions, tolerance=1e-10, **where, **asked)


def _places(crossings: reference.hits.Crossings, where: tuple) -> np.ndarray:
    r, theta, phi = crossings.r[where], crossings.theta[where], crossings.phi[where]
    return r[:, None] * np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


def _compare(renderer: Renderer, model: str, count: int) -> None:
    rng = np.random.default_rng(3)
    balls, rays = _about_the_hole(rng, COUNT), _rays(rng, count)
    scene = _scene(model, balls)
    hits, _, _ = renderer.trace_listed(scene, listed_rays.local_vectors(rays, scene))
    twin = _twin(scene, rays, balls=balls, orders=1)
    events, crossings = twin.crossings.in_order()
    of_balls = events > 0
    first = np.argmax(of_balls, axis=1)
    row = np.arange(count)
    expected = np.where(of_balls.any(axis=1), events[row, first] - 1, -1)
    met = np.where(hits.met[:, 0, 0] >= 0, hits.met[:, 0, 1], -1)
    assert np.mean(met == expected) > 0.99, "beside the outlines, and beside the critical curve"
    both = (met >= 0) & (met == expected)
    assert both.sum() > 0.15 * count and np.all(hits.fate[both] == Fate.MET)
    place = _places(crossings, (row[both], first[both]))

    apart = np.linalg.norm(hits.met_place[both, 0] - place, axis=1) / np.linalg.norm(place, axis=1)
    assert np.quantile(apart, 0.99) < 1e-4


@pytest.mark.parametrize("model", MODELS)
def test_the_first_sphere_on_a_ray_is_the_twins(renderer: Renderer, model: str) -> None:
    _compare(renderer, model, 60)


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS)
def test_the_first_sphere_on_each_of_many_rays_is_the_twins(renderer: Renderer, model: str) -> None:
    _compare(renderer, model, 1000)


def _small_on_rays(rng: np.random.Generator, scene: Scene, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Rays (N, 2), at most `count`, and a sphere (N, 4) of 0.02 r_s on each where it crosses some plane: its centre is at most half its radius from the ray."""
    rays = np.stack([rng.uniform(0.0, min(12.0 / scene.camera.distance, 1.2), count), rng.uniform(-np.pi, np.pi, count)], axis=-1)
    normal = rng.normal(size=3)
    crossings = _twin(scene, rays, planes=[normal], orders=1).crossings.of(1)
    found = np.flatnonzero((crossings.r[:, 0] > 1.5) & (crossings.r[:, 0] < 15.0))
    aside = rng.normal(size=(found.size, 3))
    aside *= 0.01 / np.linalg.norm(aside, axis=1, keepdims=True)
    return rays[found], np.hstack([_places(crossings, (found, 0)) + aside, np.full((found.size, 1), 0.02)])


def _none_is_jumped(renderer: Renderer, rng: np.random.Generator, count: int, *, planned: bool) -> int:
    """In one more view, by the method that the plan takes, with steps a hundred times as long as the spheres are wide, or by `STEPS`, thirty times as long.
    Returns of how many spheres that was asked."""
    view = {"camera__distance": rng.uniform(5.0, 40.0), "camera__inclination_deg": rng.uniform(5.0, 175.0), "camera__azimuth_deg": rng.uniform(-180.0, 180.0)}
    plain = _scene("kerr", np.zeros((0, 4)), **view)
    rays, balls = _small_on_rays(rng, plain, count)
    scene = _scene("kerr", balls, **view)
    if planned:
        scene = scene.with_values({key: scene.field(key).default for key in ("rays.model", *STEPS)})
    hits, _, _ = renderer.trace_listed(scene, listed_rays.local_vectors(rays, scene))
    met, own = hits.met[:, 0, 1], np.arange(len(balls))
    assert np.all(hits.met[:, 0, 0] >= 0), balls[hits.met[:, 0, 0] < 0]
    assert np.mean(met == own) > 0.95, "another may stand in the way"
    return len(balls)


def test_no_sphere_smaller_than_a_step_is_jumped(renderer: Renderer) -> None:
    assert _none_is_jumped(renderer, np.random.default_rng(5), 300, planned=True) > 200


@pytest.mark.slow
def test_no_sphere_smaller_than_a_step_is_jumped_in_ten_thousand_views(renderer: Renderer) -> None:
    """Of the plan's own method, one ray in 5,000 is farther than half a sphere from the twin's, by the march's error; by these steps none is."""
    rng, asked = np.random.default_rng(6), 0
    while asked < 10_000:
        asked += _none_is_jumped(renderer, rng, 150, planned=False)


def test_two_that_overlap_are_met_as_the_ray_meets_them_and_not_by_depth(renderer: Renderer) -> None:
    """A ray that goes round the hole: what it comes to first, behind the hole, hides what is nearer to the camera."""
    plain = _scene("schwarzschild", np.zeros((0, 4)), camera__inclination_deg=90.0)
    towards = observer.observe(plain).n
    rays = np.stack([np.linspace(0.1, 0.2, 200), np.zeros(200)], axis=-1)
    angles = np.arange(0.0, np.pi, 0.3)
    twin = _twin(plain, rays, planes=np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=-1), orders=3)
    _, crossings = twin.crossings.in_order()
    escaped = np.flatnonzero(twin.fate == reference.ESCAPED)
    row, first, second = next((row, *pair) for row in escaped for pair in _turning_back(_places(crossings, (row, crossings.r[row] > 1.6)), towards))
    balls = np.array([[*second, 0.5], [*first, 0.5]])
    nearest_by_depth = int(np.argmax(balls[:, :3] @ towards))
    assert nearest_by_depth == 0, "the second one is nearer to the camera"
    beside = rays[row] + 1e-5 * np.stack(np.meshgrid(np.arange(-4, 5), np.arange(-4, 5)), axis=-1).reshape(-1, 2)
    scene = _scene("schwarzschild", balls, camera__inclination_deg=90.0)
    met = renderer.trace_listed(scene, listed_rays.local_vectors(beside, scene))[0].met[:, 0, 1]
    assert np.all(met == 1)
    alone = _scene("schwarzschild", balls[:1], camera__inclination_deg=90.0)
    hits, _, _ = renderer.trace_listed(alone, listed_rays.local_vectors(beside, alone))
    assert np.all(hits.fate == Fate.MET), "the other one is on these rays too"


def _turning_back(places: np.ndarray, towards: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Pairs of `places` along a ray that are apart, the second nearer to the camera than the first."""
    return [(a, b) for k, a in enumerate(places) for b in places[k + 1 :] if (b - a) @ towards > 1.2 and np.linalg.norm(b - a) > 1.2]
