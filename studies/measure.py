"""Error and cost of one method in one scene, at each of its step settings."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from dataclasses import fields as record_fields

import numpy as np

from blackhole_gl import listed_rays, planning
from blackhole_gl.measure import refined, timing
from blackhole_gl.measure.errors import compare
from blackhole_gl.measure.methods import Combination
from blackhole_gl.measure.scenes import NEAR_CRITICAL, ChartScene
from blackhole_gl.planning.measured import Measured
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene

# Of refined maps: frames so large are steady sooner than small ones.
_REFINED_ROUNDS = 2

# A frame that takes longer than this (seconds) is timed in one round only: its ratio is steady enough, and the chart has an end.
_LONG_FRAME = 0.15

# One that takes less than this is timed several times a round: a few milliseconds are lengthened by half as easily as not.
_SHORT_FRAME = 0.02


@dataclass(frozen=True)
class Timings:
    """How cost is measured: size of the frames in pixels, rounds, and how often a short frame is timed in each."""

    size: tuple[int, int]
    rounds: int
    tries: int


FULL = Timings((320, 180), 3, 4)
QUICK = Timings((320, 180), 2, 2)


@dataclass(frozen=True)
class Row(Measured):
    """A row of the table for readers: what the plan reads, and more.

    Attributes:
        variant: the model's switches that are not as they come.
        lost_crossings: as `errors.Errors`, for rays off the critical curve.
        near_…: the same for rays within 1e-3 of it.
        own_…: error against the method's own float64 twin: what is left when the model's wrongness is taken away.
        unresolved: rays without a fate, of all.
        cost_low, cost_high: extremes of the cost in the single rounds.
        milliseconds: of the frame, on the machine named in the table's head.
    """

    variant: str
    lost_crossings: float
    near_direction_median: float
    near_direction_worst: float
    near_wrong_fates: float
    own_direction_median: float
    own_direction_99: float
    unresolved: int
    cost_low: float
    cost_high: float
    milliseconds: float

    @property
    def setting(self) -> float:
        """The step setting that varies along the method's curve; NaN for closed models."""
        for value in (self.step_tolerance, self.step_angle, self.step_length):
            if not math.isnan(value):
                return value
        return math.nan

    @property
    def method(self) -> str:
        """The combination's name, without the setting."""
        return ", ".join(part for part in (self.model, self.integrator, self.step_control, self.variant, "refined" if self.refined else "") if part)


COLUMNS = tuple(item.name for item in record_fields(Row))


def measure(
    renderer: Renderer, chart_scene: ChartScene, method: Combination, settings: tuple[float, ...], timings: Timings, twin: listed_rays.TracedRays | None
) -> list[Row]:
    """A row for each of `settings`.

    Args:
        twin: the rays traced by the method's own float64 twin, where that is not the truth itself; None where there is none.
    """
    scenes = [method.applied(chart_scene.scene, setting) for setting in settings]
    if method.refined:
        rounds = min(timings.rounds, _REFINED_ROUNDS)
        return [_refined_row(renderer, chart_scene, method, setting, scene, rounds) for setting, scene in zip(settings, scenes)]
    costs = _costs(renderer, chart_scene.scene, scenes, timings)
    rows = []
    for setting, scene, cost in zip(settings, scenes, costs):
        found = listed_rays.trace_by_shader(renderer, scene, chart_scene.rays)
        rows.append(_row(chart_scene, method, setting, found, chart_scene.truth, twin, cost))
    return rows


def _refined_row(renderer: Renderer, chart_scene: ChartScene, method: Combination, setting: float, scene: Scene, rounds: int) -> Row:
    found = refined.trace(renderer, chart_scene, scene)
    cost, cost_unrefined = refined.costs(renderer, scene, rounds)
    return replace(_row(chart_scene, method, setting, found, refined.truth(chart_scene), None, cost), cost_unrefined=cost_unrefined)


def _row(
    chart_scene: ChartScene,
    method: Combination,
    setting: float,
    found: listed_rays.TracedRays,
    truth: listed_rays.TracedRays,
    twin: listed_rays.TracedRays | None,
    cost: timing.Timing,
) -> Row:
    """The row of the rays `found`: all those of `chart_scene`, or the first of them."""
    scene, near = chart_scene.scene, chart_scene.epsilon[: len(found.fate)] < NEAR_CRITICAL
    edge = refined.disk_edge(scene) if method.refined else None
    errors, close = compare(found, truth, ~near, edge), compare(found, truth, near, edge)
    own = errors if twin is None else compare(found, twin, ~near)
    camera = scene.camera
    step = {knob: setting if method.knob == knob else math.nan for knob in ("length", "angle", "tolerance")}
    return Row(
        scene=chart_scene.name,
        spin=scene.hole.spin,
        distance=camera.distance,
        inclination_deg=camera.inclination_deg,
        fov_deg=camera.fov_deg,
        model=method.model,
        integrator=method.integrator,
        step_control=method.step_control,
        step_length=step["length"],
        step_angle=step["angle"],
        **asdict(errors),
        evaluations=float(np.mean(found.evaluations)),
        cost_flat_ratio=cost.ratio,
        step_tolerance=step["tolerance"],
        refined=int(method.refined),
        cost_unrefined=math.nan,
        variant=method.variant,
        near_direction_median=close.direction_median,
        near_direction_worst=close.direction_worst,
        near_wrong_fates=close.wrong_fates,
        own_direction_median=own.direction_median,
        own_direction_99=own.direction_99,
        unresolved=int(np.sum(found.fate == 0)),
        cost_low=cost.spread[0],
        cost_high=cost.spread[1],
        milliseconds=cost.milliseconds,
    )


def _costs(renderer: Renderer, base: Scene, scenes: list[Scene], timings: Timings) -> list[timing.Timing]:
    """Times of `scenes`, each taken right after the flat frame of `base`; long ones in one round only.

    The shortest time of each counts: what else a machine does can only lengthen a frame.
    """
    flat = timing.flat_scene(base)
    plans, flat_plan = [planning.plan(scene) for scene in scenes], planning.plan(flat)
    for made in (flat_plan, plans[0]):
        renderer.time_trace(made, timings.size)  # drivers compile at the first draw
    taken: list[list[float]] = [[] for _ in plans]
    yard: list[list[float]] = [[] for _ in plans]
    for round_ in range(timings.rounds):
        for index, made in enumerate(plans):
            if round_ and min(taken[index]) > _LONG_FRAME:
                continue
            yard[index].append(min(renderer.time_trace(flat_plan, timings.size) for _ in range(2)))
            seconds = renderer.time_trace(made, timings.size)
            if seconds < _SHORT_FRAME:
                seconds = min([seconds, *(renderer.time_trace(made, timings.size) for _ in range(1, timings.tries))])
            taken[index].append(seconds)
    shortest_flat = min(min(times) for times in yard)
    return [_timing(a, b, shortest_flat) for a, b in zip(taken, yard)]



def _timing(seconds: list[float], flat: list[float], shortest_flat: float) -> timing.Timing:
    ratios = [a / b for a, b in zip(seconds, flat)]
    return timing.Timing(1e3 * min(seconds), min(seconds) / shortest_flat, (min(ratios), max(ratios)))
