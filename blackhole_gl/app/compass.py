"""Which way the camera looks: the spin axis, the plane of the disk and the direction to the hole, as it sees them. Geometry alone; `overlay` draws it.

It is a small model of the world's directions right before the camera, wherever that is, so nothing is bent here.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..physics.observer import observe
from ..physics.space_time import space_time
from ..rendering.drawing_matrices import Axes, perspective, project, view_matrix
from ..scene import Scene

_PIECES = 48  # of the circle
_AWAY = 5.0  # of the camera, in radii of the circle: near enough to tell front from back, far enough to look straight
_MARGIN = 1.15  # of the model, which nothing of it reaches
_PROJECTION = perspective(2.0 * np.arcsin(_MARGIN / _AWAY), 1.0, 1.0, 2.0 * _AWAY)

_TURN = np.linspace(0.0, 2.0 * np.pi, _PIECES + 1)
_CIRCLE = np.column_stack([np.cos(_TURN), np.sin(_TURN), np.zeros_like(_TURN)])


@dataclass(frozen=True)
class Compass:
    """The model in a square, from the top left, 0 … 1 each way.

    Attributes:
        circle: the plane of the disk, float64 (N, 2), closed.
        circle_is_near: (N,), where it comes towards the camera.
        axis: the ends of the axis, float64 (2, 2), the one that the spin points to last.
        spins: whether there is a spin, which makes an arrow of the axis.
        hole: float64 (2,), at the end of the direction to the hole.
        hole_is_ahead: whether that direction leads away from the camera, as where the hole is before it.
    """

    circle: np.ndarray
    circle_is_near: np.ndarray
    axis: np.ndarray
    spins: bool
    hole: np.ndarray
    hole_is_ahead: bool


def seen(axes: Axes, to_hole: np.ndarray, spin: float) -> Compass:
    """The model as a camera with `axes` sees it.

    Args:
        to_hole: world unit vector (3,).
        spin: a*, whose sign says where the axis points; 0 for none.
    """
    end = np.array([0.0, 0.0, -1.0 if spin < 0.0 else 1.0])
    points = np.concatenate([_CIRCLE, [-end, end, to_hole]])
    places, _ = project(points, view_matrix(_AWAY * axes.back, axes), _PROJECTION)
    near = points @ axes.back >= 0.0  # from above a pole the whole circle is: the camera sees all of it
    return Compass(places[:-3], near[:-3], places[-3:-1], spin != 0.0, places[-1], not near[-1])


@lru_cache(maxsize=1)  # a camera at rest is asked for in every frame
def of(scene: Scene) -> Compass:
    """That of the scene's camera.

    Raises:
        ValueError: the camera is not outside the horizon.
    """
    observer = observe(scene)
    return seen(Axes.of(observer), observer.hole @ np.stack([observer.n, observer.e_theta, observer.e_phi]), space_time(scene).spin)
