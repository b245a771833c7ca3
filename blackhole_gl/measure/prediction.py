"""The plan's predictions against what is measured here and now."""

from __future__ import annotations

from dataclasses import dataclass

from .. import listed_rays, planning
from ..planning import choice
from ..rendering.frame import Renderer
from ..scene import Scene
from . import refined, timing
from .errors import compare
from .scenes import NEAR_CRITICAL, ChartScene

_SIZE = (480, 270)
_ROUNDS = 7


@dataclass(frozen=True)
class Actual:
    """What a prediction is held against: error in pixels at 99 % of the pixels, and cost in flat frames."""

    error_px: float
    cost: float


def measured(renderer: Renderer, scene: Scene, rays: int = 2000) -> Actual:
    """Error and cost of the plan for `scene`, measured as the chart does.

    Raises:
        ValueError: the scene's gravity is artistic: there is no truth to compare with.
    """
    _refuse_art(scene)
    stated = planning.plan(scene).scene
    place = ChartScene("measured", scene, rays)
    found = listed_rays.trace_by_shader(renderer, stated, place.rays)
    errors = compare(found, place.truth, place.epsilon >= NEAR_CRITICAL)
    work = {"plan": planning.plan(stated), "flat": planning.plan(timing.flat_scene(stated))}
    cost = timing.interleaved(renderer, work, _SIZE, "flat", _ROUNDS)["plan"].ratio
    return Actual(choice.error_px(scene, errors.direction_99, errors.crossing_r_99), cost)


def measured_refined(renderer: Renderer, scene: Scene, pixels: int = 2000) -> choice.Refinement:
    """Error and costs of refined hit maps of `scene` by the plan's method, whether or not the plan refines it; as `measured`.

    Raises:
        ValueError: as `measured`.
    """
    _refuse_art(scene)
    stated = planning.plan(scene).scene
    errors = refined.errors(renderer, ChartScene("measured", scene, pixels), stated)
    made = refined.refined_plan(stated)
    work = {"flat": planning.plan(timing.flat_scene(stated)), "refined": made, "every pixel": made}
    cost = timing.interleaved(renderer, work, choice.REFINED_SIZE, "flat", _ROUNDS, refined=("refined",))
    error_px = choice.error_px(scene, errors.direction_99, errors.crossing_r_99, choice.REFINED_SIZE[1])
    return choice.Refinement(error_px, cost["refined"].ratio, cost["every pixel"].ratio)


def _refuse_art(scene: Scene) -> None:
    if scene.hole.gravity_strength != 1.0 or scene.hole.horizon_size != 1.0:
        raise ValueError("the scene's gravity is artistic: there is no truth to measure an error against")
