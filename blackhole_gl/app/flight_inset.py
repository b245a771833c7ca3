"""A flight's way as a small map: the hole, the disk's edges and the way, seen from half above. Geometry alone; `flight_overlay` draws it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..physics.flight import Flight
from ..physics.space_time import space_time
from ..scene import Scene, SceneError

_SAMPLES = 120  # of the way
_ENDLESS_S = 60.0  # that are shown of a way that nothing ends
_PIECES = 64  # of a circle
_ABOVE = math.radians(35.0)  # that the map is seen from
_ROOM = 1.1  # of the map over what it shows

_TURN = np.linspace(0.0, 2.0 * np.pi, _PIECES + 1)
_CIRCLE = np.column_stack([np.cos(_TURN), np.sin(_TURN), np.zeros_like(_TURN)])


@dataclass(frozen=True)
class Inset:
    """The map in a square, from its top left, 0 … 1 each way.

    Attributes:
        way: float64 (N, 2).
        circles: of the disk's edges, each float64 (M, 2), none without a disk.
        hole: radius of the horizon's ball, which is in the middle; 0 without a hole.
        reach: r_s from the middle to the square's sides.
    """

    way: np.ndarray
    circles: tuple[np.ndarray, ...]
    hole: float
    reach: float

    def place(self, scene: Scene) -> np.ndarray:
        """Where the camera of `scene` is, float64 (2,)."""
        return _seen(_camera(scene)[None], self.reach)[0]


def of(flight: Flight) -> Inset:
    """That of `flight`."""
    length = flight.seconds if math.isfinite(flight.seconds) else _ENDLESS_S
    places = []
    for share in np.linspace(0.0, 1.0, _SAMPLES):
        try:
            places.append(_camera(flight.at(float(share * length)).scene))
        except SceneError:  # the flight ends there, with a notice
            break
    way = np.array(places) if places else np.zeros((1, 3))
    where, disk = space_time(flight.scene), flight.scene.disk
    radii = where.disk_radii(disk) if disk.enabled else ()
    reach = _ROOM * max(float(np.abs(way).max()), where.horizon_radius, 1.0)
    circles = tuple(_seen(radius * _CIRCLE, reach) for radius in radii if radius < reach)
    return Inset(_seen(way, reach), circles, 0.5 * where.horizon_radius / reach if where.has_hole else 0.0, reach)


def _camera(scene: Scene) -> np.ndarray:
    """Its place in r_s, float64 (3,)."""
    camera = scene.camera
    down, round_ = math.radians(camera.inclination_deg), math.radians(camera.azimuth_deg)
    return camera.distance * np.array([math.sin(down) * math.cos(round_), math.sin(down) * math.sin(round_), math.cos(down)])


def _seen(points: np.ndarray, reach: float) -> np.ndarray:
    """Where points (N, 3) in r_s are on the map: +x to the right, +y away."""
    up = points[:, 2] * math.cos(_ABOVE) + points[:, 1] * math.sin(_ABOVE)
    return np.column_stack([0.5 + 0.5 * points[:, 0] / reach, 0.5 - 0.5 * up / reach])
