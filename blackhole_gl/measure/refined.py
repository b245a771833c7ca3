"""Refined hit maps, as a moving camera's: their pixels against the truth, and what they cost.

Size matters here: the fewer the pixels, the more of them cannot be interpolated. All of this is of one size, `choice.REFINED_SIZE`.
"""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np

from .. import planning
from ..listed_rays import TracedRays, unknown
from ..physics import relativity
from ..planning import REFINE_STEP, Plan
from ..planning.choice import REFINED_SIZE
from ..rendering.frame import Renderer
from ..scene import Scene
from . import timing
from .errors import Errors, compare
from .scenes import NEAR_CRITICAL, ChartScene

_BESIDE_EDGE = 0.02
"""Relative error of a radius, far above any that is measured, up to which a crossing beside an edge is taken for the one on the other side."""

_UNSEEN = 1e5
"""r_s; beyond any crossing: what stands for one that is off the disk (shaders/common/hit_map_read.glsl)."""


def refined_plan(scene: Scene, keep_crossings: bool = False) -> Plan:
    """The plan for `scene`, refined whether or not it would be."""
    return replace(planning.plan(scene, keep_crossings=keep_crossings), refine_px=planning.refine_px(scene))


def trace(renderer: Renderer, chart_scene: ChartScene, scene: Scene) -> TracedRays:
    """What a refined map of `scene`, which is `chart_scene` with some method, holds at the pixels of `chart_scene`.

    Crossings off the disk are left out: interpolation does not look at them. Steps and evaluations are those of the whole picture, the
    grid's own rays too, shared out among its pixels.
    """
    made = refined_plan(scene, keep_crossings=True)
    renderer.time_trace(made, REFINED_SIZE, progressive=True)
    hits = renderer.hits()
    x, y = chart_scene.pixels.T
    steps = np.full(len(x), _steps_a_pixel(renderer, hits.steps))
    crossing = hits.crossing[y, x].astype(float)
    r = _counted(np.hypot(crossing[..., 0], crossing[..., 1]), _true(chart_scene).crossing_r, scene)
    where, orbit = made.space_time, scene.disk.orbit
    emitter_r = np.where(r >= where.matter_isco_radius(scene.disk), r, np.nan)
    g = relativity.circular_orbit_g(emitter_r, hits.lambda_[y, x][:, None], where.spin, orbit)
    fate = hits.fate[y, x]
    direction = np.where((fate == 1)[:, None], hits.direction[y, x].astype(float), np.nan)
    phi = np.where(np.isnan(r), np.nan, np.arctan2(crossing[..., 1], crossing[..., 0]))
    evaluations = steps * made.evaluations_per_step
    return replace(unknown(len(x)), fate=fate, direction=direction, steps=steps, evaluations=evaluations, crossing_r=r, crossing_phi=phi, crossing_g=g)


def truth(chart_scene: ChartScene) -> TracedRays:
    """What is true at the pixels of `chart_scene`, with the crossings that `trace` counts."""
    part = _true(chart_scene)
    return replace(part, crossing_r=_within(part.crossing_r, chart_scene.scene))


def _true(chart_scene: ChartScene) -> TracedRays:
    whole = chart_scene.truth
    return TracedRays(*(getattr(whole, item.name)[: chart_scene.count] for item in fields(whole)))


def errors(renderer: Renderer, chart_scene: ChartScene, scene: Scene) -> Errors:
    """Errors of a refined map of `scene`, which is that of `chart_scene` with some method, at pixels off the critical curve."""
    chosen = chart_scene.epsilon[: chart_scene.count] >= NEAR_CRITICAL
    return compare(trace(renderer, chart_scene, scene), truth(chart_scene), chosen, disk_edge(chart_scene.scene))


def costs(renderer: Renderer, scene: Scene, rounds: int) -> tuple[timing.Timing, float]:
    """The time of a refined trace of `scene`, and the ratio to the flat frame of one with a ray for every pixel.

    As everywhere in the chart the shortest times count.
    """
    flat, made = planning.plan(timing.flat_scene(scene)), refined_plan(scene)
    taken, yard = [], []
    for _ in range(rounds):
        yard.append(min(renderer.time_trace(flat, REFINED_SIZE) for _ in range(2)))
        taken.append(renderer.time_trace(made, REFINED_SIZE, progressive=True))
    every_pixel = min(renderer.time_trace(made, REFINED_SIZE) for _ in range(2))
    ratios = [a / b for a, b in zip(taken, yard)]
    return timing.Timing(1e3 * min(taken), min(taken) / min(yard), (min(ratios), max(ratios))), every_pixel / min(yard)


def disk_edge(scene: Scene) -> float:
    """What errors of crossing radii are relative to, in r_s: interpolation errs by a length on the disk, as a pixel sees it, and not by a share of r."""
    return planning.plan(scene).disk_outer


def _within(r: np.ndarray, scene: Scene) -> np.ndarray:
    """Crossing radii (…) in r_s, NaN where there is none on the disk."""
    made = planning.plan(scene)
    return np.where((r >= made.disk_inner) & (r <= made.disk_outer), r, np.nan)


def _counted(found: np.ndarray, true: np.ndarray, scene: Scene) -> np.ndarray:
    """Those of the crossing radii `found` (…) that count: on the disk, or where truth is.

    One that lies just on the other side of an edge than truth has an error in its radius, and is not lost.
    """
    on_disk = ~np.isnan(_within(true, scene))
    beside = np.abs(found / true - 1.0) < _BESIDE_EDGE
    return np.where(on_disk, np.where((found > 0.0) & (found < _UNSEEN), found, np.nan), np.where(beside, np.nan, _within(found, scene)))


def _steps_a_pixel(renderer: Renderer, steps: np.ndarray) -> float:
    """Mean over the pixels of the steps taken for them; `steps` (height, width) are interpolated where a pixel has no ray of its own."""
    return float(np.mean(steps * renderer.hit_map.own_rays()) + np.mean(steps) / REFINE_STEP**2)
