"""Listed rays through the shader that pictures use."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..planning import Plan
from ..planning import plan as make_plan
from ..scene import Scene, met
from . import hit_texels
from .hit_map import HitArrays, HitMap

# They are told by angles from the hole, not from the middle of the picture.
_AT_THE_HOLE = {"camera.yaw_deg": 0.0, "camera.pitch_deg": 0.0, "camera.roll_deg": 0.0, "camera.dome_tilt_deg": 0.0}


def trace(hit_map: HitMap, scene: Scene, directions: np.ndarray) -> tuple[HitArrays, np.ndarray, Plan]:
    """Hits of local `directions` (N, 3), the exact g of their crossings (N, 3), 0 where there is none, and the plan used; into `hit_map`.

    Where meetings leave no target for momenta, those are of the same rays in a scene with nothing to meet, which are traced first.
    """
    scene = scene.with_values(_AT_THE_HOLE)
    plan = make_plan(scene, keep_crossings=True)
    momentum = None
    if not hit_texels.momenta_textures(plan.meetings):
        momentum = hit_map.trace_listed(make_plan(met.without_any(scene), keep_crossings=True), directions).momentum
    if plan.model.traits.tells_time and not plan.is_inside:
        plan = replace(plan, scene=plan.scene.with_values({"rays.light_travel": True}))  # as listed rays tell all that there is to tell
    hits = hit_map.trace_listed(plan, directions)
    if momentum is not None:
        hits = replace(hits, momentum=np.where(np.any(hits.crossing != 0.0, axis=-1, keepdims=True), momentum, np.float32(np.nan)))
    return hits, hit_map.emission_shifts(directions), plan
