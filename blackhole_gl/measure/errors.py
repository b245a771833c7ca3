"""How far traced rays are from the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..listed_rays import TracedRays

LARGEST_DISK = 20.0
"""Crossings further out (r_s) than any disk can reach do not count."""


@dataclass(frozen=True)
class Errors:
    """Errors over a set of rays; NaN where no ray has the quantity in both.

    Attributes:
        direction_median, direction_99, direction_worst: angle in radians between escape directions.
        crossing_r_99: relative, of the radius of crossings of the disk's plane.
        g_99: relative, of the frequency ratio there.
        wrong_fates: share of rays that escape instead of being captured, or the reverse, or do neither.
        lost_crossings: share of crossings that only one of the two has.
    """

    direction_median: float
    direction_99: float
    direction_worst: float
    crossing_r_99: float
    g_99: float
    wrong_fates: float
    lost_crossings: float


def compare(found: TracedRays, truth: TracedRays, chosen: np.ndarray, disk_edge: float | None = None) -> Errors:
    """The errors of `found` on the rays `chosen`, a mask (N,).

    Args:
        disk_edge: radius in r_s that errors of crossing radii are relative to; their own radius when None.
    """
    angle = angles_between(found, truth)[chosen]
    there = truth.crossing_r[chosen] <= LARGEST_DISK
    got = found.crossing_r[chosen] <= LARGEST_DISK
    both = there & ~np.isnan(found.crossing_r[chosen])
    lost = (there & np.isnan(found.crossing_r[chosen])) | (got & np.isnan(truth.crossing_r[chosen]))
    return Errors(
        *_spread(angle),
        _relative_99(found.crossing_r[chosen][both], truth.crossing_r[chosen][both], disk_edge),
        _relative_99(found.crossing_g[chosen][both], truth.crossing_g[chosen][both]),
        float(np.mean(found.fate[chosen] != truth.fate[chosen])) if chosen.any() else float("nan"),
        float(np.sum(lost) / max(1, np.sum(there | got))),
    )


def angles_between(found: TracedRays, truth: TracedRays) -> np.ndarray:
    """(N,) angle in radians between the escape directions; NaN where one of the two does not escape."""
    chord = np.linalg.norm(found.direction - truth.direction, axis=1)
    return 2.0 * np.arcsin(np.minimum(0.5 * chord, 1.0))


def _spread(values: np.ndarray) -> tuple[float, float, float]:
    values = values[~np.isnan(values)]
    if not values.size:
        return (float("nan"),) * 3
    return float(np.median(values)), float(np.quantile(values, 0.99)), float(values.max())


def _relative_99(found: np.ndarray, truth: np.ndarray, unit: float | None = None) -> float:
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.abs(found - truth) / (np.abs(truth) if unit is None else unit)
    error = error[np.isfinite(error)]
    return float(np.quantile(error, 0.99)) if error.size else float("nan")
