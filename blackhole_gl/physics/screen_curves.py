"""Curves that an observer sees: the critical curve, and circles of the equatorial plane by each order of image. Closed forms in float64, no pixels.

On the screen, *right* and *up* of the direction to the hole, they are told in M: screen coordinates α, β of a far observer; of a near one in the plane through
the hole that the middle of a picture of it shows undistorted, 2 D tan ψ with D in r_s, as `picture_height_m`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..scene import Scene, SceneError, refuse_other
from ..shapes import Float
from . import angular_size, lensed_circles, projection
from .observer import observe
from .space_time import ray_model, space_time

Array = np.ndarray

_MOST_AWAY = 0.5 * math.pi - 1e-3  # radians: what lies beside or behind the camera is on no screen


@dataclass(frozen=True)
class ScreenCurve:
    """One closed curve of N points.

    Attributes:
        kind: ``critical`` or ``isoradial``.
        radius: of the circle that is seen, in r_s; NaN of the critical curve.
        order: of its image, 0 the direct one; −1 of the critical curve, which all orders tend to.
        angle: on the screen from right towards up, radians (N,).
        alpha, beta: right and up of the hole's centre in M (N,); NaN where no screen before the camera shows it.
    """

    kind: str
    radius: float
    order: int
    angle: Float[Array, " N"]
    alpha: Float[Array, " N"]
    beta: Float[Array, " N"]

    def in_uas(self, scene: Scene) -> tuple[Float[Array, " N"], Float[Array, " N"]]:
        """`alpha` and `beta` in µas, at the mass and distance that `scene` states (``source.mass_suns``, ``source.distance_pc``)."""
        m_uas = angular_size.m_uas(scene.source)
        return m_uas * self.alpha, m_uas * self.beta

    def in_pixels(self, scene: Scene, size: tuple[int, int]) -> tuple[Float[Array, " N"], Float[Array, " N"]]:
        """(x, y) on a picture of `size` by the camera of `scene`, wherever it looks, from the outer corner of its top left pixel.

        Raises:
            SceneError: the picture is no perspective.
        """
        if not projection.is_perspective(scene.camera):
            raise SceneError("camera.projection", f"got {scene.camera.projection}; pixels of curves are told for {projection.PERSPECTIVE} alone")
        seen = _directions(scene, self) @ observe(scene).look
        width, height = size
        half_height = projection.half_height(scene.camera)
        ahead = -seen[..., 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            right, up = (np.where(ahead > 0.0, part / ahead, np.nan) for part in (seen[..., 2], -seen[..., 1]))
        scale = 0.5 * height / half_height
        return 0.5 * width + scale * right, 0.5 * height - scale * up


def critical_curve(scene: Scene, samples: int = 512) -> ScreenCurve:
    """The edge of the shadow, light on spherical orbits (Bardeen 1973): exact at each of `samples` points, in M, µas and pixels.

    Raises:
        SceneError: the scene's space-time has no photon orbits. ValueError: there are no samples.
    """
    _refuse_without_points(scene, samples)
    away, angle = lensed_circles.critical_points(observe(scene), samples)
    return _curve(scene, "critical", math.nan, -1, angle, away)


def isoradials(scene: Scene, radii: ArrayLike, orders: ArrayLike = (0,), samples: int = 512) -> list[ScreenCurve]:
    """The images of circles of the equatorial plane (Luminet 1979), each of `radii` (r_s) by each of `orders`, at `samples` angles on the screen: 0 the
    direct image, 1 the first ring, ….

    Raises:
        SceneError: the scene's space-time has no closed form; or a radius not between the horizon and the camera, or an order not 0, 1, 2, ….
        ValueError: there are no samples.
    """
    _refuse_without_points(scene, samples)
    radius, order = np.atleast_1d(np.asarray(radii, float)), np.atleast_1d(np.asarray(orders))
    horizon = space_time(scene).horizon_radius
    if not np.all((radius > horizon) & (radius < scene.camera.distance) & np.isfinite(radius)):
        raise SceneError("radii", f"got {radius}; allowed is between the horizon at {horizon:.4g} r_s and the camera at {scene.camera.distance:g} r_s")
    if not (np.issubdtype(order.dtype, np.integer) and np.all(order >= 0)):
        raise SceneError("orders", f"got {order}; allowed is 0 for the direct image, 1 for the first ring, and so on")
    seen = observe(scene)
    angle = 2.0 * math.pi * np.arange(samples) / samples
    each_radius, each_order = (values.ravel() for values in np.meshgrid(radius, order, indexing="ij"))
    about = lensed_circles.circles(seen, each_radius, each_order, angle)
    away = lensed_circles.circles(seen, each_radius, each_order, angle, about)
    return [_curve(scene, "isoradial", float(r), int(n), angle, part) for r, n, part in zip(each_radius, each_order, away)]


def _is_far(scene: Scene) -> bool:
    return math.isinf(scene.camera.distance)


def _refuse_without_points(scene: Scene, samples: int) -> None:
    refuse_other(scene)
    if samples < 1:
        raise ValueError(f"samples: got {samples!r}; allowed is 1 point or more")
    if ray_model(scene).traits.space_time not in ("schwarzschild", "kerr"):
        raise SceneError("rays.model", f"got {ray_model(scene).key}, without closed forms; allowed are models of Schwarzschild's and Kerr's space-times")


def _curve(scene: Scene, kind: str, radius: float, order: int, angle: Array, away: Array) -> ScreenCurve:
    distance = away if _is_far(scene) else 2.0 * scene.camera.distance * np.tan(np.where(away < _MOST_AWAY, away, np.nan))
    return ScreenCurve(kind, radius, order, angle, distance * np.cos(angle), distance * np.sin(angle))


def _directions(scene: Scene, curve: ScreenCurve) -> Float[Array, "N 3"]:
    """Local directions (N, 3) of the points of `curve`."""
    away = np.hypot(curve.alpha, curve.beta)
    return lensed_circles.directions(observe(scene), away if _is_far(scene) else np.arctan(away / (2.0 * scene.camera.distance)), curve.angle)
