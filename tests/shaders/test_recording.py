"""The recorded ways of rays: where they cross planes against the float64 twins, and a method so coarse that it goes through the hole."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl import reference
from blackhole_gl.glsl.declared import Fate
from blackhole_gl.physics import observer
from blackhole_gl.physics.space_time import space_time
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.recording import RayPath, Recorder, pixel_direction
from blackhole_gl.scene import Scene, presets

SIZE = (320, 200)
PIXELS = [(200.5, 120.5), (150.5, 70.5), (161.5, 125.5), (100.5, 100.5), (165.5, 103.5), (158.5, 101.5)]

# Equator and two more planes: their crossings tell where the way goes, and not its ends alone.
PLANES = ((0.0, 0.0, 1.0), (0.3, 1.0, 0.2), (1.0, -0.2, 0.4))

AGREES = 1e-3
"""Relative, for places. What the steps are wrong by is smaller with every method here, and so is what lines between a step's points cut off."""

BESIDE = 1.3
"""Radii of the hole. Closer to a horizon that drags all round with it, lines between points cut off more."""

METHODS = [
    {"rays.model": "kerr", "rays.integrator": "rk4", "rays.step_angle": 0.1},
    {"rays.model": "kerr", "rays.integrator": "dopri5", "rays.step_control": "embedded"},
    {"rays.model": "kerr_schild"},
    {"rays.model": "schwarzschild", "rays.integrator": "rk4"},
    {"rays.model": "schwarzschild_binet", "rays.step_control": "doubling", "rays.doubling.tolerance": 1e-6},
    {"rays.model": "kerr_like"},
    {"rays.model": "flat"},
]


@pytest.fixture(scope="module")
def recorder(renderer: Renderer) -> Recorder:
    return Recorder(renderer.ctx, renderer.programs)


def scene_of(**changes) -> Scene:
    return presets.load(["kerr"], {"camera.azimuth_deg": 40.0, "camera.yaw_deg": 2.0, "camera.pitch_deg": -1.0, "camera.roll_deg": 5.0, **changes})


def crossings_of(path: RayPath, normal: tuple[float, float, float], reach: float) -> np.ndarray:
    """Places (C, 3) where the lines between a path's points cross a plane, beside the hole and within `reach`."""
    height = path.points @ np.array(normal)
    at = np.flatnonzero((height[:-1] < 0.0) != (height[1:] < 0.0))
    share = (height[at] / (height[at] - height[at + 1]))[:, None]
    places = path.points[at] + share * (path.points[at + 1] - path.points[at])
    distance = np.linalg.norm(places, axis=1)
    return places[(distance > BESIDE * path.hole_radius) & (distance < reach)]


def twin_of(scene: Scene, local: np.ndarray) -> reference.ReferenceHits:
    parameters = {name: scene.get(key) for name, key in reference.twin_of(scene.rays.model).parameters.items()}
    camera = scene.camera
    return reference.trace(
        scene.rays.model,
        spin=space_time(scene).spin,
        distance=camera.distance,
        inclination_deg=camera.inclination_deg,
        azimuth_deg=camera.azimuth_deg,
        observer=camera.observer,
        orders=6,
        directions=(observer.look_rotation(camera) @ local)[None],
        planes=PLANES[1:],
        **parameters,
    )


@pytest.mark.parametrize("method", METHODS, ids=lambda method: "-".join(str(value) for value in method.values()))
def test_a_way_goes_where_the_twins_ray_goes(recorder: Recorder, method: dict) -> None:
    scene, compared = scene_of(**method), 0
    for pixel in PIXELS:
        local = pixel_direction(scene, SIZE, pixel)
        path, twin = recorder.record(scene, local), twin_of(scene, local)
        assert path.fate == twin.fate[0]
        assert path.tunnels == ()
        if path.fate == Fate.ESCAPED:
            assert np.linalg.norm(path.direction - twin.direction[0]) < AGREES
        for event, normal in enumerate(PLANES):
            met = twin.crossings.of(event)
            r, theta, phi = met.r[0], met.theta[0], met.phi[0]
            places = np.stack([r * np.sin(theta) * np.cos(phi), r * np.sin(theta) * np.sin(phi), r * np.cos(theta)], axis=-1)
            # What lies far outside is finished in closed form, and told as a line.
            wanted = places[(r > BESIDE * path.hole_radius) & (r < 5.0)]
            found = crossings_of(path, normal, 5.0)
            assert len(found) == len(wanted), (pixel, normal)
            assert np.all(np.linalg.norm(found - wanted, axis=1) < AGREES * np.linalg.norm(wanted, axis=1)), (pixel, normal)
            compared += len(wanted)
    assert compared > (3 if scene.rays.model == "flat" else 8)


@pytest.mark.parametrize("method", METHODS, ids=lambda method: "-".join(str(value) for value in method.values()))
def test_a_way_is_that_of_the_pixel(renderer: Renderer, recorder: Recorder, method: dict) -> None:
    """Fate, steps and crossings as in the hit map of a picture; a dot for every step that was taken."""
    scene = scene_of(**method)
    renderer.render(scene, 0.0, SIZE)
    hits = renderer.hits()
    for x, y in PIXELS:
        path = recorder.record(scene, pixel_direction(scene, SIZE, (x, y)))
        at = int(y), int(x)
        assert path.fate == hits.fate[at]
        there = np.any(hits.crossing[at] != 0.0, axis=-1)
        np.testing.assert_allclose(path.crossings[: there.sum(), :2], hits.crossing[at][there], rtol=AGREES, atol=AGREES)
        if scene.rays.model == "flat":
            assert path.steps == 0 and not path.is_state.any()
            continue
        # Whether one is refused hangs on the last digit, and another program rounds otherwise.
        assert abs(path.steps - hits.steps[at]) <= int("embedded" in path.method or "doubling" in path.method)
        assert path.is_state.sum() <= path.steps  # a step that ends in the hole is cut off at its rim, and refused ones are left out
        assert path.step.max() == path.steps or path.fate == Fate.ESCAPED
        if path.fate == Fate.CAPTURED:
            assert np.linalg.norm(path.points[-1]) == pytest.approx(path.hole_radius, rel=0.011)  # a march may stop 1 % before it
    x, y = PIXELS[0]
    np.testing.assert_allclose(recorder.record(scene, pixel_direction(scene, SIZE, (x, y))).points[0], 20.0 * observer.observe(scene).n)


def test_straight_rays_end_on_the_ball(recorder: Recorder) -> None:
    scene = scene_of(**{"rays.model": "flat"})
    path = recorder.record(scene, pixel_direction(scene, SIZE, PIXELS[5]))
    assert path.fate == Fate.CAPTURED and np.linalg.norm(path.points[-1]) == pytest.approx(path.hole_radius)
    way = path.points[-1] - path.points[0]
    back = observer.observe(scene).axes.T @ -pixel_direction(scene, SIZE, PIXELS[5])
    np.testing.assert_allclose(way / np.linalg.norm(way), -back, atol=1e-6)  # by way of the float32 crossing


def test_a_coarse_march_is_seen_to_go_through_the_hole(recorder: Recorder) -> None:
    """Against the same steps by hand: x' = v, v' = −(3/2) h² x/r⁵, two long each."""
    scene = presets.load(
        ["schwarzschild"],
        {"rays.model": "schwarzschild", "rays.integrator": "euler", "rays.step_control": "fixed", "rays.step_length": 2.0, "camera.distance": 5.0},
    )
    local = pixel_direction(scene, (1280, 720), (640.0, 400.0))
    path = recorder.record(scene, local)
    assert path.fate == Fate.ESCAPED and path.tunnels == (3,)
    exact = recorder.record(scene.with_values({"rays.model": "kerr", "rays.integrator": "rk4", "rays.step_control": "mino", "rays.step_angle": 0.05}), local)
    assert exact.fate == Fate.CAPTURED and exact.tunnels == ()

    seen = observer.observe(scene)
    rates = seen.observer_map @ np.array([1.0, *local])
    w_rate, across = rates[1] / rates[0], rates[2:] / rates[0]
    n_rate = across[0] * seen.e_theta + across[1] * seen.e_phi
    x, v = 5.0 * seen.n, seen.w * n_rate - w_rate * seen.n
    h2 = 0.25 * float(n_rate @ n_rate)
    for place in path.points[path.is_state]:
        x, v = x + 2.0 * v, v - 3.0 * h2 * x / np.linalg.norm(x) ** 5
        np.testing.assert_allclose(place, x, rtol=1e-4, atol=1e-4)  # float32, through a pass beside the singularity


def test_the_error_of_a_step_falls_as_its_order_says(recorder: Recorder) -> None:
    """Halving RK4's steps divides the error of each by 2⁵; steps are chosen at which rounding, 1e-7, is far away."""
    local = pixel_direction(scene_of(), SIZE, PIXELS[0])
    coarse, fine = (
        recorder.record(scene_of(**{"rays.model": "kerr", "rays.integrator": "rk4", "rays.step_angle": angle}), local) for angle in (0.5, 0.25)
    )
    ratio = np.nanmax(coarse.error) / np.nanmax(fine.error)
    assert 16.0 < ratio < 64.0, ratio
    assert np.nanmax(fine.error) > 1e-6 and np.nanmax(coarse.drift) > np.nanmax(fine.drift)


def test_a_long_way_has_a_point_for_every_few_steps(recorder: Recorder) -> None:
    scene = scene_of(**{"rays.model": "schwarzschild", "rays.step_control": "fixed", "rays.step_length": 0.005})
    path = recorder.record(scene, pixel_direction(scene, SIZE, PIXELS[0]))
    assert path.steps > 2000 and 700 < path.is_state.sum() <= 1500
    steps = path.step[path.is_state]
    assert np.all(np.diff(steps) <= 2) and steps[-1] == path.steps


def test_a_camera_at_infinity_has_ways_too(recorder: Recorder) -> None:
    scene = scene_of(**{"rays.model": "kerr", "camera.distance": float("inf"), "camera.yaw_deg": 0.0, "camera.pitch_deg": 0.0})
    path = recorder.record(scene, pixel_direction(scene, SIZE, PIXELS[1]))
    assert path.fate in (Fate.ESCAPED, Fate.CAPTURED)
    first = path.points[0]
    alpha, beta = (2.0 * np.array(PIXELS[1]) - SIZE) * 0.5 * scene.camera.field_m / SIZE[1]
    assert np.linalg.norm(np.cross(first, observer.observe(scene).n)) == pytest.approx(0.5 * np.hypot(alpha, beta), rel=1e-6)
    assert np.all(np.isfinite(path.points))
