"""Smooth orbit and zoom of the camera, free of any window.

The hand moves a *target*; the camera follows it as a first-order lag, ``x' = (target − x)/τ``. Within a frame the target is taken to move
at a constant rate, for which the lag has a closed solution, so the path does not depend on how time is cut into frames.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from ..physics import relativity
from ..physics.observer import least_distance
from ..scene import Scene, fields
from ..scene.schema import Field

SMOOTHING_TIME = 0.09  # τ in seconds: fast enough to feel attached to the hand, slow enough to hide the wheel's notches
_INSTANT_S = 1e-6  # no time at all: a rate over less would overflow
_REST_DEG = 2e-3  # nearer than this to the target the camera is at rest, and the window may idle
_REST_REACH = 2e-5
_NEAREST = 1e-4  # r_s above the horizon
_SHADOW_M = 2.0 * math.sqrt(27.0)  # width of a hole's shadow from afar, in M: of every spin to within a tenth
_SMALLEST = 0.01  # of the picture's height: a shadow narrower than this is a dot
_LARGEST = 2.0  # a far camera's shadow over the picture's height
_WIDEST = 4.0 / 3.0  # of a near camera's shadow, over the picture's height


@dataclass(frozen=True)
class Pose:
    """Where the camera is.

    Attributes:
        azimuth, inclination: degrees; the azimuth is not wrapped, the inclination is 0…180.
        reach: natural logarithm of (distance − horizon) in r_s, or of the picture's height in M for a camera at infinity.
    """

    azimuth: float
    inclination: float
    reach: float

    def moved(self, azimuth: float = 0.0, inclination: float = 0.0, reach: float = 0.0) -> Pose:
        """This pose with the given amounts added, kept from tipping over the poles."""
        tilted = min(max(self.inclination + inclination, 0.0), 180.0)
        return Pose(self.azimuth + azimuth, tilted, self.reach + reach)


@dataclass(frozen=True)
class Motion:
    """The camera on its way: where it is and where the hand wants it."""

    current: Pose
    target: Pose

    @classmethod
    def at(cls, scene: Scene) -> Motion:
        """At rest where `scene` has its camera."""
        pose = pose_of(scene)
        return cls(pose, pose)

    @property
    def at_rest(self) -> bool:
        """Whether the camera is where the hand wants it."""
        return self.current == self.target

    def advanced(self, wanted: Pose, dt: float) -> Motion:
        """After `dt` seconds in which the target moved evenly to `wanted`."""
        if dt < _INSTANT_S:
            return replace(self, target=wanted)
        old, here = self.target, self.current
        current = Pose(
            _follow(here.azimuth, old.azimuth, wanted.azimuth, dt),
            _follow(here.inclination, old.inclination, wanted.inclination, dt),
            _follow(here.reach, old.reach, wanted.reach, dt),
        )
        return Motion(wanted if _is_near(current, wanted) else current, wanted)


def _follow(x: float, before: float, after: float, dt: float) -> float:
    """Exact solution of ``x' = (target − x)/τ`` for a target that goes evenly from `before` to `after` in `dt`."""
    lag = (after - before) / dt * SMOOTHING_TIME
    return after - lag + (x - before + lag) * math.exp(-dt / SMOOTHING_TIME)


def _is_near(a: Pose, b: Pose) -> bool:
    return max(abs(a.azimuth - b.azimuth), abs(a.inclination - b.inclination)) < _REST_DEG and abs(a.reach - b.reach) < _REST_REACH


def floor_radius(scene: Scene) -> float:
    """What zooming approaches and never passes, in r_s: the outer horizon r_+ of what the ray model shows; for a camera that falls, the end of its fall."""
    return least_distance(scene)


def pose_of(scene: Scene) -> Pose:
    """The pose of `scene`'s camera."""
    camera = scene.camera
    # A camera that a smaller spin has left inside the horizon counts as just outside.
    return Pose(camera.azimuth_deg, camera.inclination_deg, math.log(max(_extent(scene) - _floor(scene), _NEAREST)))


def values_of(pose: Pose, scene: Scene) -> Mapping[str, float]:
    """The scene values, by key, that put `scene`'s camera at `pose`; only those that it does not have yet.

    They are rounded far below what can be seen, so that a camera sent back to 20 r_s is saved as 20 and not as 20.000000000000004.
    """
    here, values = pose_of(scene), {}
    if pose.azimuth != here.azimuth:
        turn = pose.azimuth if abs(pose.azimuth) <= 180.0 else math.remainder(pose.azimuth, 360.0)
        values["camera.azimuth_deg"] = round(turn, 7)
    if pose.inclination != here.inclination:
        values["camera.inclination_deg"] = round(pose.inclination, 7)
    if pose.reach != here.reach:
        field = _extent_field(scene)
        extent = float(f"{_floor(scene) + math.exp(pose.reach):.10g}")
        values[field.key] = min(max(extent, field.low), field.high)
    return values


def limited(pose: Pose, scene: Scene) -> Pose:
    """`pose` with its reach inside the range of the scene's field."""
    field, floor = _extent_field(scene), _floor(scene)
    nearest = max(field.low - floor, _NEAREST)
    return replace(pose, reach=min(max(pose.reach, math.log(nearest)), math.log(field.high - floor)))


def within_reach(pose: Pose, scene: Scene, start: Pose) -> Pose:
    """`pose` with its reach inside what the hand may bring about: the hole stays in sight, but for a camera that is beyond that at `start`, which may stay."""
    near, far = (math.log(max(extent - _floor(scene), _NEAREST)) for extent in range_by_hand(scene))
    return limited(replace(pose, reach=min(max(pose.reach, min(near, start.reach)), max(far, start.reach))), scene)


def range_by_hand(scene: Scene) -> tuple[float, float]:
    """The least and the greatest distance in r_s, or height of a far camera's picture in M, at which the hole is neither all that is seen nor a dot.

    At the nearest its shadow is as wide as a picture of 4:3 that looks at it: some of the world is left at the sides, or in the corners.
    """
    if math.isinf(scene.camera.distance):
        return _SHADOW_M / _LARGEST, _SHADOW_M / _SMALLEST
    half = math.radians(0.5 * scene.camera.fov_deg)
    side = math.atan(math.tan(half) * _WIDEST)
    near = float(relativity.schwarzschild_shadow_distance(side))
    far = 0.5 * _SHADOW_M / (_SMALLEST * 2.0 * half)
    return near * scene.hole.gravity_strength, far * scene.hole.gravity_strength  # which makes a larger hole of it


def shadow_angle(scene: Scene) -> float:
    """The angle in radians between the hole's centre and its shadow's edge, seen by the camera at rest: exact without spin, and near it with."""
    return float(relativity.schwarzschild_shadow_angle(max(scene.camera.distance / scene.hole.gravity_strength, 1.0)))


def clear_of_horizon(scene: Scene) -> Scene:
    """`scene`, with a camera that is not above the horizon moved out to the least distance that the hand could bring it to."""
    if scene.camera.distance >= floor_radius(scene) + 0.5 * _NEAREST:
        return scene
    return scene.with_values({"camera.distance": float(f"{range_by_hand(scene)[0]:.6g}")})


def range_in(scene: Scene, item: Field) -> Field:
    """`item` with the range that it has in `scene`: the camera's distance begins just above the horizon."""
    return replace(item, low=max(item.low, floor_radius(scene) + _NEAREST)) if item.key == "camera.distance" else item


def _extent_field(scene: Scene) -> Field:
    return fields()["camera.field_m" if math.isinf(scene.camera.distance) else "camera.distance"]


def _extent(scene: Scene) -> float:
    camera = scene.camera
    return camera.field_m if math.isinf(camera.distance) else camera.distance


def _floor(scene: Scene) -> float:
    return 0.0 if math.isinf(scene.camera.distance) else floor_radius(scene)
