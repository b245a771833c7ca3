"""The compass: what a camera sees of the world's directions."""

import math

import numpy as np
import pytest

from blackhole_gl.app import compass
from blackhole_gl.rendering.drawing_matrices import Axes
from blackhole_gl.scene import Scene

MIDDLE = (0.5, 0.5)


def of(**values):
    return compass.of(Scene().with_values({key.replace("_", ".", 1): value for key, value in values.items()}))


@pytest.mark.parametrize("inclination", [0.0, 5.0, 80.0, 90.0, 140.0, 180.0])
@pytest.mark.parametrize("azimuth", [0.0, 77.0])
def test_all_of_it_lies_in_its_square_and_the_hole_in_the_middle(inclination, azimuth):
    shown = of(camera_inclination_deg=inclination, camera_azimuth_deg=azimuth, hole_spin=0.9)
    for places in (shown.circle, shown.axis, shown.hole[np.newaxis]):
        assert np.all((places > 0.0) & (places < 1.0))
    assert shown.hole == pytest.approx(MIDDLE) and shown.hole_is_ahead


def test_the_arrow_points_where_the_spin_does():
    tail, tip = of(hole_spin=0.9, camera_inclination_deg=90.0).axis
    assert tip[1] < 0.5 < tail[1] and tip[0] == pytest.approx(0.5), "up"
    tail, tip = of(hole_spin=-0.9, camera_inclination_deg=90.0).axis
    assert tip[1] > 0.5 > tail[1]
    assert of(hole_spin=0.9).spins and not of(hole_spin=0.0).spins
    assert not of(hole_spin=0.9, rays_model="schwarzschild").spins, "a model without spin"


def test_the_near_side_of_the_disk_is_below_seen_from_above_and_above_seen_from_below():
    for inclination, below in ((60.0, True), (120.0, False)):
        shown = of(camera_inclination_deg=inclination)
        near, far = shown.circle[shown.circle_is_near][:, 1].mean(), shown.circle[~shown.circle_is_near][:, 1].mean()
        assert (near > far) == below
    assert of(camera_inclination_deg=0.0).circle_is_near.all(), "seen from the pole no side is far"


def test_the_circle_is_flattened_by_the_inclination():
    """But for the perspective, which enlarges its near half by up to a quarter, and its far half as much less."""
    shown = of(camera_inclination_deg=60.0)
    width, height = np.ptp(shown.circle, axis=0)
    assert height / width == pytest.approx(math.cos(math.radians(60.0)), rel=0.05)


def test_a_camera_that_turns_to_the_right_has_the_hole_at_its_left():
    plain = Axes(np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]))
    for degrees, ahead in ((30.0, True), (80.0, True), (100.0, False), (170.0, False)):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        turned = Axes(c * plain.right + s * plain.back, plain.up, c * plain.back - s * plain.right)
        shown = compass.seen(turned, -plain.back, 0.9)
        assert shown.hole[0] < 0.5 and shown.hole[1] == pytest.approx(0.5)
        assert shown.hole_is_ahead == ahead


def test_a_camera_infinitely_far_has_a_compass_too():
    assert of(camera_distance=math.inf).hole == pytest.approx(MIDDLE)


def test_a_camera_within_the_horizon_has_none():
    with pytest.raises(ValueError, match="outside"):
        of(camera_distance=0.6, hole_spin=0.0)
