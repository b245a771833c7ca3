"""Twin of the ray model `flat`: straight lines, in closed form (float64, r_s = 1)."""

from __future__ import annotations

import numpy as np

from .hits import CAPTURED, ESCAPED
from .observers import Place

Array = np.ndarray


def trace_lines(position: Array, direction: Array, radius: float) -> tuple[Array, Array]:
    """Follows x = position + s direction, both (N, 3), for s > 0 (position at infinity: s > -inf, see `start_at_infinity`).

    Returns (fate (N,), crossing points (N, 3) of the plane z = 0, NaN where there is none before capture).
    """
    along = np.einsum("ij,ij->i", position, direction)
    distance2 = np.einsum("ij,ij->i", position, position)
    closest2 = np.maximum(distance2 - along**2, 0.0)
    hit = (along < 0.0) & (closest2 < radius**2)
    entry = -along - np.sqrt(np.maximum(radius**2 - closest2, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        s = -position[:, 2] / direction[:, 2]
        crosses = np.isfinite(s) & (s > 0.0) & ~(hit & (s > entry))
        point = np.where(crosses[:, None], position + s[:, None] * direction, np.nan)
    return np.where(hit, CAPTURED, ESCAPED).astype(np.int8), point


def start(place: Place, directions: Array) -> tuple[Array, Array]:
    """World positions and directions (N, 3) of local directions (N, 3) seen from `place` (r in r_s)."""
    e_r, e_theta, e_phi = place.frame()
    world = directions @ np.stack([e_r, e_theta, e_phi])
    return np.repeat((place.r * e_r)[None], len(world), axis=0), world


def start_at_infinity(place: Place, screen: Array) -> tuple[Array, Array]:
    """As `start`, for parallel rays at (alpha, beta) = `screen` (N, 2) in r_s, from a place far beyond all crossings asked for."""
    e_r, e_theta, e_phi = place.frame()
    direction = np.repeat(-e_r[None], len(screen), axis=0)
    offset = np.outer(screen[:, 0], e_phi) - np.outer(screen[:, 1], e_theta)
    # z = 0 is met at s = -offset_z/direction_z; a start before that point misses nothing, wherever it lies.
    with np.errstate(divide="ignore", invalid="ignore"):
        s = -offset[:, 2] / direction[:, 2]
    reach = 2.0 * np.where(np.isfinite(s), np.abs(s), 0.0) + 10.0
    return offset - reach[:, None] * direction, direction
