"""Free flight without a window: where the camera comes to, and what a gamepad asks for."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.app import free_flight
from blackhole_gl.app.commands import Hand, advance
from blackhole_gl.app.gamepad import of_axes
from blackhole_gl.app.state import WindowState
from blackhole_gl.physics.observer import look_rotation, observe
from blackhole_gl.scene import Scene, presets

SCENE = presets.load(["kerr"], {"camera.yaw_deg": 40.0, "camera.pitch_deg": -20.0, "camera.roll_deg": 70.0, "camera.azimuth_deg": 130.0})


def world(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    seen = observe(scene)
    return 0.5 / seen.w * seen.n, seen.axes


@pytest.mark.parametrize("look", [(40.0, -20.0, 70.0), (-170.0, 85.0, -130.0), (0.0, 90.0, 30.0), (0.0, -90.0, -60.0), (0.0, 0.0, 0.0)])
def test_angles_of_a_look_are_found_again(look: tuple[float, float, float]) -> None:
    made = look_rotation(Scene().with_values(dict(zip(("camera.yaw_deg", "camera.pitch_deg", "camera.roll_deg"), look))).camera)
    np.testing.assert_allclose(free_flight.look_angles(made), look, atol=1e-6)


@pytest.mark.parametrize("way", [(0.1, 0.0, 0.0), (0.0, 0.2, 0.0), (0.0, 0.0, -0.3), (0.1, -0.2, 0.3)])
def test_the_camera_goes_along_its_own_axes_and_looks_where_it_looked(way: tuple[float, float, float]) -> None:
    place, (back, down, right) = world(SCENE)
    after, axes = world(SCENE.with_values(free_flight.flown(SCENE, way)))
    height = SCENE.camera.distance - 0.5 * (1.0 + math.sqrt(1.0 - 0.81))
    np.testing.assert_allclose(after - place, height * (way[0] * right - way[1] * down - way[2] * back), atol=1e-6)
    np.testing.assert_allclose(axes, [back, down, right], atol=1e-7)


def test_over_the_pole_nothing_turns() -> None:
    scene = Scene().with_values({"camera.inclination_deg": 1.0, "camera.distance": 10.0})
    axes = world(scene)[1]
    for _ in range(20):
        scene = scene.with_values(free_flight.flown(scene, (0.0, 0.005, 0.0)))
        np.testing.assert_allclose(world(scene)[1], axes, atol=1e-5)
    assert abs(scene.camera.azimuth_deg) > 179.0, "it has come over to the other side"


def test_a_flight_takes_as_long_however_frames_cut_it() -> None:
    ends = []
    for frames in (1, 30):
        moved, way = free_flight.FreeFlight(), np.zeros(3)
        for _ in range(frames):
            moved, step = moved.advanced((0.0, 0.0, 1.0), 0.6 / frames)
            way += step
        ends.append((way[2], moved.speed[2]))
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-9)
    for _ in range(100):
        moved, _ = moved.advanced((0.0, 0.0, 0.0), 0.05)
    assert moved.at_rest


def test_it_comes_to_rest_above_the_horizon() -> None:
    state = WindowState.start(Scene().with_values({"camera.distance": 3.0}))
    for _ in range(400):
        advance(state, Hand(held=("fly_forward",)), 0.05)
        assert state.camera_moves and state.scene.camera.distance > 1.0
    assert state.scene.camera.distance < 1.001


def test_keys_together_are_no_faster_than_one() -> None:
    assert np.linalg.norm(free_flight.wanted(("fly_forward", "fly_right", "fly_up"), (0.0, 0.0, 1.0))) == pytest.approx(1.0)
    assert free_flight.wanted(("fly_forward", "fly_back", "orbit_left")) == (0.0, 0.0, 0.0)


def test_a_camera_at_infinity_is_told_that_it_cannot_fly() -> None:
    state = WindowState.start(Scene().with_values({"camera.distance": math.inf}))
    advance(state, Hand(held=("fly_forward",)), 0.1)
    assert "infinitely far" in state.notice.text and state.scene.camera.distance == math.inf


def test_a_gamepad_flies_and_looks() -> None:
    """GLFW's axes: left x, y, right x, y (down is positive), left and right trigger, −1 where they are let go."""
    assert of_axes((0.1, -0.1, 0.0, 0.0, -1.0, -1.0)) == of_axes((0.0, 0.0, 0.0, 0.0, -1.0, -1.0)), "a worn stick's middle"
    pushed = of_axes((1.0, -1.0, 1.0, 1.0, -1.0, 1.0))
    assert pushed.fly == pytest.approx((1.0, 1.0, 1.0)) and pushed.look == pytest.approx((1.0, 1.0))
    state = WindowState.start(SCENE.with_values({"camera.roll_deg": 0.0}))
    before = state.scene.camera
    advance(state, Hand().turned((1.0, 1.0), 0.1), 0.1)
    assert state.scene.camera.yaw_deg > before.yaw_deg and state.scene.camera.pitch_deg < before.pitch_deg
