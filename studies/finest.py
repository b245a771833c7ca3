"""What the finest steps reach: their bounds for rays off the critical curve, and fates close to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from blackhole_gl import listed_rays
from blackhole_gl.measure.errors import LARGEST_DISK, angles_between
from blackhole_gl.measure.methods import Combination
from blackhole_gl.measure.scenes import SHOWN, ChartScene
from blackhole_gl.rendering.frame import Renderer

AWAY, CLOSE = 1e-2, 1e-6
"""ε from which errors, and from which fates count."""

BOUNDS = {"direction_median": 2e-6, "direction_99": 1e-5, "crossing_r_median": 3e-7, "crossing_r_99": 1e-5, "g_99": 1e-5, "wrong_fates": 0.0}

_METHODS = ((Combination("kerr", "rk4", "mino"), 0.05), (Combination("schwarzschild_binet", "rk4", "mino"), 0.05))


@dataclass(frozen=True)
class Finest:
    """Errors of one method at its best step in one scene; names as in `BOUNDS`, directions in radians, the others relative."""

    scene: str
    method: str
    setting: float
    direction_median: float
    direction_99: float
    crossing_r_median: float
    crossing_r_99: float
    g_99: float
    wrong_fates: float


def finest(renderer: Renderer, scenes: list[ChartScene]) -> list[Finest]:
    """`kerr` in each of the four scenes, `schwarzschild_binet` where there is no spin."""
    found = []
    for chart_scene in (item for item in scenes if item.name in SHOWN):
        for method, setting in _METHODS:
            if method.model == "kerr" or chart_scene.scene.hole.spin == 0.0:
                found.append(_measure(renderer, chart_scene, method, setting))
    return found


def _measure(renderer: Renderer, chart_scene: ChartScene, method: Combination, setting: float) -> Finest:
    traced, truth = listed_rays.trace_by_shader(renderer, method.applied(chart_scene.scene, setting), chart_scene.rays), chart_scene.truth
    away = chart_scene.epsilon >= AWAY
    inside = (truth.crossing_r <= LARGEST_DISK) & away[:, None]
    errors = {
        "direction": angles_between(traced, truth)[away],
        "crossing_r": np.abs(traced.crossing_r / truth.crossing_r - 1.0)[inside],
        "g": np.abs(traced.crossing_g / truth.crossing_g - 1.0)[inside],
    }
    counted = chart_scene.epsilon >= CLOSE
    return Finest(
        chart_scene.name,
        method.name,
        setting,
        _quantile(errors["direction"], 0.5),
        _quantile(errors["direction"], 0.99),
        _quantile(errors["crossing_r"], 0.5),
        _quantile(errors["crossing_r"], 0.99),
        _quantile(errors["g"], 0.99),
        float(np.mean(traced.fate[counted] != truth.fate[counted])),
    )


def _quantile(values: np.ndarray, share: float) -> float:
    values = values[np.isfinite(values)]
    return float(np.quantile(values, share)) if values.size else float("nan")
