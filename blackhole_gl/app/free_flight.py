"""Free flight: the camera goes where it looks, and goes on looking there. No imgui here.

Speeds are shares of the height above the horizon, a second, so that there is always as much to see of the way; and what is above it stays above.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from ..physics.observer import cos_sin_deg, look_rotation
from ..scene import Scene, fields
from ..shapes import Float
from .camera_control import floor_radius, range_in

RATE = 0.8  # of the height above the horizon, a second
_EASE_S = 0.15  # in which it picks up speed, and loses it
_REST = 2e-3  # slower than this, in shares of the full speed, it stands
_STILL = (0.0, 0.0, 0.0)

KEYS: Mapping[str, tuple[float, float, float]] = {
    # action: right, up, forward, in shares of the full speed
    "fly_left": (-1.0, 0.0, 0.0),
    "fly_right": (1.0, 0.0, 0.0),
    "fly_down": (0.0, -1.0, 0.0),
    "fly_up": (0.0, 1.0, 0.0),
    "fly_back": (0.0, 0.0, -1.0),
    "fly_forward": (0.0, 0.0, 1.0),
}


@dataclass(frozen=True)
class FreeFlight:
    """How fast the camera flies right, up and forward, in shares of the full speed."""

    speed: tuple[float, float, float] = _STILL

    @property
    def at_rest(self) -> bool:
        """Whether it does not."""
        return self.speed == _STILL

    def advanced(self, wanted: tuple[float, float, float], dt: float) -> tuple[FreeFlight, tuple[float, float, float]]:
        """After `dt` seconds in which the hand wants `wanted`, and the way gone meanwhile, in full speeds times seconds: the closed solution of a lag."""
        left = math.exp(-dt / _EASE_S)
        way = [aim * dt + (had - aim) * _EASE_S * (1.0 - left) for aim, had in zip(wanted, self.speed)]
        speed = [aim + (had - aim) * left for aim, had in zip(wanted, self.speed)]
        stands = wanted == _STILL and max(map(abs, speed)) < _REST
        return FreeFlight(_STILL if stands else (speed[0], speed[1], speed[2])), (way[0], way[1], way[2])


def wanted(held: Collection[str], stick: tuple[float, float, float] = _STILL) -> tuple[float, float, float]:
    """The speed that held actions and a `stick` ask for: right, up, forward, no faster than the full speed."""
    asked = np.sum([stick, *(KEYS[name] for name in held if name in KEYS)], axis=0)
    right, up, forward = asked / max(float(np.linalg.norm(asked)), 1.0)
    return float(right), float(up), float(forward)


def flown(scene: Scene, way: tuple[float, float, float]) -> Mapping[str, float]:
    """The values, by key, of `scene`'s camera after `way` right, up and forward, in heights above the horizon. Its view is moved, not turned, in space."""
    camera = scene.camera
    frame = _frame(camera.inclination_deg, camera.azimuth_deg)
    axes = look_rotation(camera).T @ frame  # back, down, right
    step = (camera.distance - floor_radius(scene)) * np.array([-way[2], -way[1], way[0]])
    place = camera.distance * frame[0] + step @ axes
    nearest, farthest = range_in(scene, fields()["camera.distance"]).low, fields()["camera.distance"].high
    distance = min(max(float(np.linalg.norm(place)), nearest), farthest)
    inclination = math.degrees(math.atan2(math.hypot(place[0], place[1]), place[2]))
    azimuth = math.degrees(math.atan2(place[1], place[0])) if place[0] or place[1] else camera.azimuth_deg
    placed = {"camera.distance": float(f"{distance:.10g}"), "camera.inclination_deg": round(inclination, 7), "camera.azimuth_deg": round(azimuth, 7)}
    turned = _frame(placed["camera.inclination_deg"], placed["camera.azimuth_deg"]) @ axes.T
    return {**placed, **{f"camera.{name}": round(angle, 7) for name, angle in zip(("yaw_deg", "pitch_deg", "roll_deg"), look_angles(turned))}}


def look_angles(look: Float[np.ndarray, "3 3"]) -> tuple[float, float, float]:
    """Yaw, pitch and roll in degrees of a look: the inverse of `look_rotation`."""
    pitch = math.asin(min(max(float(look[1, 0]), -1.0), 1.0))
    if math.hypot(look[1, 1], look[1, 2]) < 1e-9:  # straight up or down yaw and roll are one turn
        up = math.copysign(1.0, look[1, 0])
        return 0.0, math.degrees(pitch), math.degrees(math.atan2(-up * look[0, 2], -up * look[0, 1]))
    yaw, roll = math.atan2(-look[2, 0], look[0, 0]), math.atan2(look[1, 2], look[1, 1])
    return math.degrees(yaw), math.degrees(pitch), math.degrees(roll)


def _frame(inclination_deg: float, azimuth_deg: float) -> Float[np.ndarray, "3 3"]:
    """World unit vectors n, e_θ, e_φ as rows."""
    (c, s), (cp, sp) = cos_sin_deg(inclination_deg), cos_sin_deg(azimuth_deg)
    return np.array([[s * cp, s * sp, c], [c * cp, c * sp, -s], [-sp, cp, 0.0]])
