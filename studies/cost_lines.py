"""What a method costs by the work it does: the plan's costs, freed from the chance of single measurements.

On a machine that other programs share, single costs scatter by a tenth and more, and the cheapest of many is mostly a lucky one. But a method's
cost is a straight line in the evaluations a ray that it takes, which are counted exactly: all scenes and steps together say where it lies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from studies.measure import Row

_FEWEST = 8
"""Rows that a line needs."""

_STRAIGHT = 0.15
"""Median departure from the line, as a share of the cost, beyond which a method's costs are left as they were measured: rays that want many steps
beside rays that want few are waited for, and then the mean does not say it all."""

_ROUNDS = 12


def by_work(rows: Sequence[Row]) -> list[Row]:
    """`rows` with costs that lie on their method's line, where its costs lie near one; refined rows are left as they are."""
    kinds: dict[str, list[int]] = {}
    for index, row in enumerate(rows):
        if not row.refined and row.cost_flat_ratio > 0.0:
            kinds.setdefault(row.method, []).append(index)
    found = list(rows)
    for members in kinds.values():
        evaluations, costs = (np.array([getattr(rows[index], name) for index in members]) for name in ("evaluations", "cost_flat_ratio"))
        line = _line(evaluations, costs)
        if len(members) >= _FEWEST and np.median(np.abs(line / costs - 1.0)) <= _STRAIGHT:
            for index, cost in zip(members, line):
                found[index] = replace(rows[index], cost_flat_ratio=float(cost))
    return found


def _line(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Values at `x` of the straight line nearest to `y`, by the sum of relative departures (weighted least squares, repeated): outliers pull little."""
    if np.ptp(x) == 0.0:
        return np.full_like(y, np.median(y))
    terms = np.stack([np.ones_like(x), x], axis=1)
    weight, fit = 1.0 / y, y
    for _ in range(_ROUNDS):
        fit = terms @ np.linalg.lstsq(terms * weight[:, None], y * weight, rcond=None)[0]
        weight = 1.0 / (y * np.sqrt(np.maximum(np.abs(fit / y - 1.0), 0.01)))
    return fit
