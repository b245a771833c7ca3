"""Where the two eyes of a panorama stand (omnidirectional stereo): in every direction that is looked in, to both sides of it.

An eye's place is that of the camera and half of their distance along the right of that direction, straight in Boyer–Lindquist coordinates taken for spherical
ones, and its axes are turned as in flat space. That is no parallel transport: near a hole neither has a meaning of
its own, and each eye is an observer for itself.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..physics import observer
from ..planning import Plan
from ..planning import plan as make_plan
from ..scene import Camera, Scene
from ..shapes import Float

STRIP = 32
"""Columns of a picture that an eye stands still for: between two it takes a step, which moves what is d away by `STRIP` · separation/(2 d) pixels at most."""


@dataclass(frozen=True)
class Eyes:
    """One eye of a picture `width` pixels wide that goes all round.

    Attributes:
        side: −1 left, 1 right.
    """

    side: float
    width: int
    _plans: dict[tuple[int, int], Plan] = field(default_factory=dict)

    def plan(self, plan: Plan, column: int) -> Plan:
        """`plan` seen from where the eye stands for the columns from `column` on."""
        key = id(plan), column
        if key not in self._plans:
            longitude = 2.0 * math.pi * ((column + 0.5 * STRIP) / self.width - 0.5)
            self._plans[key] = make_plan(eye(plan.scene, longitude, self.side))
        return self._plans[key]


def eye(scene: Scene, longitude: float, side: float) -> Scene:
    """`scene` seen by the eye on one `side` (−1 left, 1 right) of who looks `longitude` radians to the right of the picture's middle.

    Raises:
        SceneError: there is no place for it there.
    """
    camera = scene.camera
    seen = observer.observe(scene)
    back, _, right = seen.axes
    aside = math.cos(longitude) * right + math.sin(longitude) * back
    place = camera.distance * seen.n + 0.5 * side * camera.eye_separation * aside
    return scene.with_values(placed(camera, place, seen.axes))


def placed(camera: Camera, place: Float[np.ndarray, " 3"], axes: Float[np.ndarray, "3 3"]) -> dict[str, float]:
    """The values of a `camera` at `place` in r_s whose view has the world `axes` (back, down, right)."""
    distance = float(np.linalg.norm(place))
    n = place / distance
    inclination, azimuth = math.degrees(math.atan2(math.hypot(n[0], n[1]), n[2])), math.degrees(math.atan2(n[1], n[0]))
    (cos_theta, sin_theta), (cos_phi, sin_phi) = observer.cos_sin_deg(inclination), observer.cos_sin_deg(azimuth)
    frame = np.array([n, [cos_theta * cos_phi, cos_theta * sin_phi, -sin_theta], [-sin_phi, cos_phi, 0.0]])
    look = frame @ axes.T
    ahead = -look[:, 0]
    yaw, pitch = math.atan2(ahead[2], -ahead[0]), math.asin(min(max(-ahead[1], -1.0), 1.0))
    level = observer.look_rotation(Camera(yaw_deg=math.degrees(yaw), pitch_deg=math.degrees(pitch)))
    rolled = level.T @ look
    return {
        "camera.distance": distance,
        "camera.inclination_deg": inclination,
        "camera.azimuth_deg": azimuth,
        "camera.yaw_deg": math.degrees(yaw),
        "camera.pitch_deg": math.degrees(pitch),
        "camera.roll_deg": math.degrees(math.atan2(rolled[1, 2], rolled[1, 1])),
    }
