"""Matrices for what is drawn over a picture in straight lines: the camera's view, the perspective, and where points lie in the picture.

Light does not come this way: nothing here decides what a ray hits or a picture shows. The matrices are pyrr's, and this is the only module that uses it.
pyrr calculates in the type of what it is given, so that integers are rounded, down to zeros; all that goes into it is float64 here. Its quaternions
disagree with its matrices in sign and are not used.

Points are rows: (x, y, z, 1) · view · projection. A matrix in memory, row by row, is therefore what GL reads column by column.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from pyrr import matrix44

from ..physics.observer import Observer

_ALIKE = 1e-6  # how far axes may be from orthonormal: a thousandth of a pixel in a picture a thousand pixels high


@dataclass(frozen=True)
class Axes:
    """The camera's axes as world vectors, float64 (3,): orthonormal, and right × up = back.

    Attributes:
        right, up: along the picture's width and height.
        back: against the direction that the picture's middle shows.

    Raises:
        ValueError: they are no such vectors.
    """

    right: np.ndarray
    up: np.ndarray
    back: np.ndarray

    def __post_init__(self) -> None:
        found = self.matrix
        if np.abs(found @ found.T - np.eye(3)).max() > _ALIKE or np.linalg.det(found) < 0.0:
            raise ValueError(f"a camera's axes right, up, back: got {found.tolist()}; they must be of length 1, perpendicular, and right × up = back")

    @classmethod
    def of(cls, observer: Observer) -> Axes:
        """Those of the view, wherever it looks."""
        back, down, right = observer.axes
        return cls(right, -down, back)

    @property
    def matrix(self) -> np.ndarray:
        """float64 (3, 3), an axis in each row."""
        return np.array([self.right, self.up, self.back], np.float64)


def view_matrix(place: np.ndarray, axes: Axes) -> np.ndarray:
    """float64 (4, 4): from world points to the camera's coordinates (right, up, back).

    Args:
        place: of the camera, (3,) in r_s, finite.
    """
    to_camera = matrix44.create_from_translation(-np.asarray(place, np.float64))
    return matrix44.multiply(to_camera, matrix44.create_from_matrix33(axes.matrix.T, dtype=np.float64))


def perspective(fov: float, aspect: float, near: float, far: float) -> np.ndarray:
    """float64 (4, 4): from the camera's coordinates to GL's clip coordinates.

    Args:
        fov: vertical angle of view in radians, between 0 and π.
        aspect: the picture's width over its height.
        near, far: the distances in r_s, along the direction of view, between which things are shown.

    Raises:
        ValueError: no perspective has these values.
    """
    if not (0.0 < fov < np.pi and aspect > 0.0 and 0.0 < near < far):
        raise ValueError(f"perspective: got fov {fov:g}, aspect {aspect:g}, near {near:g}, far {far:g}; allowed is 0 < fov < π, 0 < aspect, 0 < near < far")
    return matrix44.create_perspective_projection(np.degrees(float(fov)), float(aspect), float(near), float(far), dtype=np.float64)


def project(points: np.ndarray, view: np.ndarray, projection: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where world points lie in the picture.

    Args:
        points: (N, 3) in r_s.
        view, projection: of `view_matrix` and `perspective`.

    Returns:
        float64 (N, 2), counted from the picture's top left to the right and down, in its widths and heights (0 … 1 inside); and the mask (N,) of the
        points that are in front, beyond the near distance. The place of any other is NaN, as a perspective would show it mirrored.
    """
    rows = np.column_stack([np.asarray(points, np.float64), np.ones(len(points))])
    clip = matrix44.multiply(matrix44.multiply(rows, view), projection)
    in_front = clip[:, 2] >= -clip[:, 3]
    depth = np.where(in_front, clip[:, 3], np.nan)
    return np.column_stack([0.5 + 0.5 * clip[:, 0] / depth, 0.5 - 0.5 * clip[:, 1] / depth]), in_front
