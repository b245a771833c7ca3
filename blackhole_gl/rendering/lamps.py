"""The lamps of a scene as shaders see them: a table with a row a lamp."""

from __future__ import annotations

import math

import numpy as np

from ..physics import motion
from ..physics.observer import outwards
from ..planning import Plan
from ..scene import Instance, met
from ..scene.schema import number_of
from ..shapes import Float

_UNIT_DISTANCE = 10.0
"""r_s at which a lamp's brightness is what its parameter says."""

_FAR = 1e6
"""r_s, for a camera at infinity."""


def rows(plan: Plan, time: float) -> Float[np.ndarray, "lamps 2 4"]:
    """Of each lamp at scene time `time`, float32: its place in r_s and how far away it has its stated brightness, 0 where that is everywhere; its light.

    A scene without any is lit from the camera.
    """
    shining = {kind.key for kind in met.kinds(plan.scene, "thing") if kind.traits.shines}
    lit = zip(met.instances(plan.scene, "thing"), motion.rows(plan.scene, "thing", plan.space_time, time)[:, 0]) if shining else ()
    found = [_row(instance, bound) for instance, bound in lit if instance.kind in shining]
    return np.array(found or [_at_camera(plan)], np.float32)


def _row(instance: Instance, bound: Float[np.ndarray, " 4"]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    values, colour = instance.values, instance.values["colour"]
    brightness = number_of(values["brightness"])
    light = tuple(brightness * number_of(part) for part in colour) if isinstance(colour, tuple) else ()
    return (*bound[:3], _UNIT_DISTANCE if values["thins_out"] else 0.0), (*light, 0.0)


def _at_camera(plan: Plan) -> tuple[tuple[float, ...], tuple[float, ...]]:
    camera = plan.scene.camera
    place = outwards(camera) * (camera.distance if math.isfinite(camera.distance) else _FAR)
    return (*place, 0.0), (1.0, 1.0, 1.0, 0.0)
