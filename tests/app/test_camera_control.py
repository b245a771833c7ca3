"""The camera's smooth motion: the same path at every frame rate, and never over the poles or through the horizon."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from blackhole_gl.app.camera_control import Motion, Pose, floor_radius, limited, pose_of, values_of
from blackhole_gl.app.commands import Hand, advance
from blackhole_gl.app.state import WindowState
from blackhole_gl.scene import Scene, fields


def state_of(**values) -> WindowState:
    return WindowState.start(Scene().with_values({key.replace("__", "."): value for key, value in values.items()}))


def path(frames_per_second: int) -> list[Pose]:
    """The camera at every tenth of a second while arrows are held for 1 s and the mouse is dragged evenly for another."""
    state, poses = state_of(camera__inclination_deg=90.0), []
    dt = 1.0 / frames_per_second
    for frame in range(3 * frames_per_second):
        second = frame // frames_per_second
        hand = (Hand(held=("orbit_left", "zoom_in")), Hand(drag=(0.3 * dt, 0.2 * dt)), Hand())[second]
        advance(state, hand, dt)
        if (frame + 1) % (frames_per_second // 6) == 0:
            poses.append(state.motion.current)
    return poses


def test_path_does_not_depend_on_the_frame_rate():
    # 1e-3 rest distance: where the camera snaps onto its target once it is nearer than can be seen.
    for slow, fast in zip(path(30), path(144), strict=True):
        assert slow.azimuth == pytest.approx(fast.azimuth, abs=5e-3)
        assert slow.inclination == pytest.approx(fast.inclination, abs=5e-3)
        assert slow.reach == pytest.approx(fast.reach, abs=5e-5)


def test_camera_comes_to_rest_on_its_target():
    state = state_of()
    advance(state, Hand(wheel=2.0), 1 / 60)
    assert not state.motion.at_rest
    for _ in range(120):
        advance(state, Hand(), 1 / 60)
    assert state.motion.at_rest
    assert math.log(state.scene.camera.distance - 1.0) == pytest.approx(math.log(19.0) - 0.3, abs=1e-9)


def test_drag_moves_the_near_side_with_the_hand():
    state = state_of(camera__inclination_deg=90.0)
    advance(state, Hand(drag=(0.1, 0.0)), 0.5)
    assert state.motion.target.azimuth == pytest.approx(-18.0)
    advance(state, Hand(drag=(0.0, 0.1)), 0.5)
    assert state.motion.target.inclination == pytest.approx(72.0)


@given(st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(-40, 40), st.floats(0, 0.5)), max_size=12), st.floats(-0.9999, 0.9999), st.booleans())
def test_nothing_leaves_its_range(moves, spin, far):
    state = state_of(hole__spin=spin, camera__distance=math.inf if far else 20.0)
    for right, down, wheel, dt in moves:
        advance(state, Hand((right, down), (down, right), wheel=wheel), dt)  # with_values refuses what is out of range
    assert 0.0 <= state.scene.camera.inclination_deg <= 180.0
    if not far:
        assert state.scene.camera.distance > floor_radius(state.scene)
    else:
        assert math.isinf(state.scene.camera.distance)


@pytest.mark.parametrize("distance", [1.0001, 1.5, 20.0, 1e4, math.inf])
def test_a_pose_that_is_there_changes_nothing(distance):
    scene = Scene().with_values({"camera.distance": distance})
    assert values_of(pose_of(scene), scene) == {}


def test_zoom_is_limited_by_the_field():
    scene = Scene()
    far = limited(Pose(0.0, 80.0, 100.0), scene)
    assert values_of(far, scene)["camera.distance"] == fields()["camera.distance"].high


def test_motion_without_time_keeps_the_camera():
    motion = Motion(Pose(0, 90, 1), Pose(0, 90, 1))
    assert motion.advanced(Pose(5, 90, 1), 0.0).current == motion.current


def test_what_is_looked_at_follows_the_hand_however_the_camera_is_rolled():
    state = state_of(camera__roll_deg=90.0, camera__fov_deg=60.0)
    advance(state, Hand(look=(0.1, 0.0)), 1 / 60)
    # Rolled clockwise by 90°, the picture's right is down.
    assert (state.scene.camera.yaw_deg, state.scene.camera.pitch_deg) == (pytest.approx(0.0, abs=1e-9), pytest.approx(6.0))


def test_a_far_camera_cannot_look_aside():
    state = state_of(camera__distance=math.inf)
    advance(state, Hand(look=(0.1, 0.1)), 1 / 60)
    assert state.scene.camera.yaw_deg == 0.0 and "parallel" in state.notice.text
