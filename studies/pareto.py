"""Which points are not beaten in both cost and error."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def front(cost: Sequence[float], error: Sequence[float]) -> list[int]:
    """Indices of the points that no other point equals or beats in both, cheapest first; points with NaN are left out."""
    costs, errors = np.asarray(cost, float), np.asarray(error, float)
    order = np.lexsort((errors, costs))
    found: list[int] = []
    lowest = np.inf
    for index in order:
        if np.isfinite(costs[index]) and errors[index] < lowest:
            found.append(int(index))
            lowest = errors[index]
    return found
