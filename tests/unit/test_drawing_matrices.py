"""Matrices for drawing over a picture, against plain formulas: a camera's coordinates by scalar products, a perspective by similar triangles."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.physics.observer import observe
from blackhole_gl.rendering.drawing_matrices import Axes, perspective, project, view_matrix
from blackhole_gl.scene import Scene

CLOSE = 1e-12  # float64, of numbers up to a hundred

X, Y, Z = np.eye(3)
PLAIN = Axes(X, Y, Z)  # looks along −z


def turned(seed: int) -> Axes:
    """Axes in any direction."""
    vectors, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    right, up = vectors[:, 0], vectors[:, 1]
    return Axes(right, up, np.cross(right, up))


def points(seed: int, count: int = 40) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-30.0, 30.0, (count, 3))


@pytest.mark.parametrize("seed", range(4))
def test_a_camera_s_coordinates_are_scalar_products_with_its_axes(seed: int) -> None:
    axes, place, world = turned(seed), np.array([3.0, -20.0, 7.5]), points(seed)
    rows = np.column_stack([world, np.ones(len(world))]) @ view_matrix(place, axes)
    expected = np.stack([(world - place) @ axis for axis in (axes.right, axes.up, axes.back)], axis=1)
    np.testing.assert_allclose(rows[:, :3], expected, rtol=0.0, atol=100.0 * CLOSE)
    np.testing.assert_allclose(rows[:, 3], 1.0, rtol=CLOSE)


@pytest.mark.parametrize("fov_deg, aspect", [(45.0, 16.0 / 9.0), (90.0, 1.0), (10.0, 0.5)])
def test_places_are_those_of_similar_triangles(fov_deg: float, aspect: float) -> None:
    axes, place, world = turned(9), np.array([0.0, 5.0, 1.0]), points(9)
    found, in_front = project(world, view_matrix(place, axes), perspective(math.radians(fov_deg), aspect, 0.5, 100.0))
    away = world - place
    depth = -(away @ axes.back)
    np.testing.assert_array_equal(in_front, depth >= 0.5)
    assert 0 < in_front.sum() < len(world)
    half_height = depth * math.tan(math.radians(0.5 * fov_deg))
    across, down = 0.5 + 0.5 * (away @ axes.right) / (half_height * aspect), 0.5 - 0.5 * (away @ axes.up) / half_height
    np.testing.assert_allclose(found[in_front], np.stack([across, down], axis=1)[in_front], rtol=1e-10, atol=1e-10)
    assert np.isnan(found[~in_front]).all()


def test_depth_goes_from_minus_one_to_one_between_near_and_far() -> None:
    clip = np.array([[0.0, 0.0, -2.0, 1.0], [0.0, 0.0, -50.0, 1.0]]) @ perspective(1.0, 1.0, 2.0, 50.0)
    np.testing.assert_allclose(clip[:, 2] / clip[:, 3], [-1.0, 1.0], rtol=CLOSE)


def test_integers_mean_what_the_same_floats_mean() -> None:
    """Left to pyrr, matrices of integers are rounded, down to zeros, and short integers overflow."""
    whole = np.array([[1, 2, -7], [-3, 1, -9]], np.int8)
    near, far = np.array([50, 100], np.int8)
    np.testing.assert_array_equal(perspective(1, 2, near, far), perspective(1.0, 2.0, 50.0, 100.0))
    axes = Axes(*np.eye(3, dtype=np.uint8))
    np.testing.assert_array_equal(view_matrix(np.array([1, 2, 3], np.uint8), axes), view_matrix(np.array([1.0, 2.0, 3.0]), PLAIN))
    view, projection = view_matrix(np.array([0, 0, 3], np.uint8), axes), perspective(1, 2, 1, 10)
    np.testing.assert_array_equal(project(whole, view, projection)[0], project(whole.astype(float), view, projection)[0])
    for matrix in (view, projection):
        assert matrix.dtype == np.float64 and np.abs(np.linalg.det(matrix)) > 0.0


def test_right_is_right_and_up_is_up() -> None:
    """A camera on the x axis that looks at the hole: +y is to its right, +z above."""
    scene = Scene().with_values({"camera.inclination_deg": 90.0, "camera.azimuth_deg": 0.0})
    axes = Axes.of(observe(scene))
    view, projection = view_matrix(20.0 * axes.back, axes), perspective(math.radians(45.0), 1.0, 0.1, 100.0)
    places, in_front = project(np.array([[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], [30.0, 0.0, 0.0]]), view, projection)
    np.testing.assert_array_equal(in_front, [True, True, True, False])
    np.testing.assert_allclose(places[0], [0.5, 0.5], atol=CLOSE)
    assert places[1][0] > 0.5 and places[1][1] == pytest.approx(0.5)
    assert places[2][0] == pytest.approx(0.5) and places[2][1] < 0.5


@pytest.mark.parametrize("inclination", [0.0, 35.0, 90.0, 180.0])
@pytest.mark.parametrize("azimuth", [0.0, 125.0, -90.0])
def test_the_camera_s_axes_are_right_handed_everywhere(inclination: float, azimuth: float) -> None:
    axes = Axes.of(observe(Scene().with_values({"camera.inclination_deg": inclination, "camera.azimuth_deg": azimuth})))
    np.testing.assert_allclose(np.cross(axes.right, axes.up), axes.back, atol=CLOSE)


@pytest.mark.parametrize("wrong", [(Y, X, Z), (X, Y, 2.0 * Z), (X, X, Z)], ids=["left-handed", "too long", "not perpendicular"])
def test_what_are_no_axes_is_refused(wrong: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    with pytest.raises(ValueError, match="right × up = back"):
        Axes(*wrong)


@pytest.mark.parametrize("wrong", [(0.0, 1.0, 1.0, 2.0), (math.pi, 1.0, 1.0, 2.0), (1.0, 0.0, 1.0, 2.0), (1.0, 1.0, 0.0, 2.0), (1.0, 1.0, 2.0, 2.0)])
def test_what_is_no_perspective_is_refused(wrong: tuple[float, float, float, float]) -> None:
    with pytest.raises(ValueError, match="allowed is"):
        perspective(*wrong)


def test_no_points_have_no_places() -> None:
    places, in_front = project(np.zeros((0, 3)), view_matrix(5.0 * Z, PLAIN), perspective(1.0, 1.0, 1.0, 10.0))
    assert places.shape == (0, 2) and in_front.shape == (0,)
