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

    Where meetings leave no target for momenta and none for the times of all crossings, those are of the same rays in a scene with nothing to meet, which are
    traced first.
    """
    scene = scene.with_values(_AT_THE_HOLE)
    plan = make_plan(scene, keep_crossings=True)
    if hit_texels.momenta_textures(plan.meetings):
        hits = hit_map.trace_listed(_with_times(plan), directions)
    else:
        alone = hit_map.trace_listed(_with_times(make_plan(met.without_any(scene), keep_crossings=True)), directions)
        hits = hit_map.trace_listed(plan, directions)
        there = np.any(hits.crossing != 0.0, axis=-1)
        hits = replace(hits, momentum=np.where(there[..., None], alone.momenta, np.float32(np.nan)))
        hits = replace(hits, delay=None if alone.delay is None else np.where(there, alone.delay, np.float32(np.nan)))
    return hits, hit_map.emission_shifts(directions), plan


def _with_times(plan: Plan) -> Plan:
    """`plan`, but that times are kept where they can be told, as listed rays tell all that there is to tell."""
    if not plan.model.traits.tells_time or plan.is_inside:
        return plan
    return replace(plan, scene=plan.scene.with_values({"rays.light_travel": True}))
