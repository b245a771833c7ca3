"""The second chart: error against the distance from the critical curve, where every method gets worse."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from blackhole_gl import listed_rays
from blackhole_gl.measure.errors import angles_between
from blackhole_gl.measure.methods import Combination
from blackhole_gl.measure.scenes import ChartScene, critical_radius, true_scene
from blackhole_gl.rendering.frame import Renderer

SCENES = ("a0_near", "a0998_near")
_PER_DISTANCE = 16

# Coarse, everyday and finest steps of the exact models, a low-order scheme, and a wrong force.
_METHODS = (
    (Combination("kerr", "rk4", "mino"), (0.4, 0.2, 0.05)),
    (Combination("schwarzschild", "rk4", "radius"), (0.15, 0.02)),
    (Combination("schwarzschild", "verlet", "radius"), (0.08,)),
    (Combination("post_newtonian", "rk4", "radius"), (0.15,)),
)


@dataclass(frozen=True)
class Point:
    """Errors of escape directions at one distance ε outside the critical curve: median and largest in radians, and the share of wrong fates."""

    scene: str
    method: str
    setting: float
    epsilon: float
    direction_median: float
    direction_worst: float
    wrong_fates: float


COLUMNS = tuple(Point.__dataclass_fields__)


def near_critical(renderer: Renderer, scenes: list[ChartScene], quick: bool) -> list[Point]:
    """Errors from ε = 1e-7 to 1 in `SCENES`, for rays all round the shadow's edge."""
    points = []
    around = _PER_DISTANCE // 4 if quick else _PER_DISTANCE
    for chart_scene in (item for item in scenes if item.name in SCENES):
        epsilon = np.logspace(-7.0, 0.0, 15 if quick else 29)
        chi = 2.0 * np.pi * (np.arange(around) + 0.3) / around
        edge = critical_radius(chart_scene.scene, chi)
        psi = edge[None, :] * (1.0 + epsilon[:, None])
        rays = np.stack([psi.ravel(), np.tile(chi, len(epsilon))], axis=-1)
        truth = listed_rays.trace_by_reference(true_scene(chart_scene.scene), rays)
        for method, settings in _METHODS:
            if chart_scene.scene.hole.spin != 0.0 and method.model == "schwarzschild":
                continue
            for setting in settings:
                found = listed_rays.trace_by_shader(renderer, method.applied(chart_scene.scene, setting), rays)
                angle = angles_between(found, truth).reshape(psi.shape)
                wrong = (found.fate != truth.fate).reshape(psi.shape)
                points += [Point(chart_scene.name, method.name, setting, float(e), *_spread(a), float(np.mean(w))) for e, a, w in zip(epsilon, angle, wrong)]
    return points


def _spread(angle: np.ndarray) -> tuple[float, float]:
    known = angle[~np.isnan(angle)]
    return (float(np.median(known)), float(known.max())) if known.size else (float("nan"), float("nan"))
