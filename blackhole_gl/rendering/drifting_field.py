"""How far the sky `drifting_field` has turned and drifted: in float64, and split so that hours later its shader still counts in small numbers."""

from __future__ import annotations

import math

import numpy as np

VELOCITY = np.array([0.005, 0.003, 0.0])
"""Of the drift, for a field of directions, a time of r_s/c."""


def turn(time: float, rate: float) -> np.ndarray:
    """(cos, sin) of the angle that the field has turned by, float64 (2,)."""
    angle = math.fmod(rate * time, 2.0 * math.pi)
    return np.array([math.cos(angle), math.sin(angle)])


def cell(time: float, drift: float, scale: float) -> np.ndarray:
    """How many whole cells of the noise's lattice the field has drifted, along its three edges; float64 (4,), the last 0."""
    moved = _moved(time, drift, scale)
    return np.append(np.floor(moved + moved.sum() / 3.0), 0.0)


def shift(time: float, drift: float, scale: float) -> np.ndarray:
    """What it has drifted beyond that, in the noise's own places; float64 (4,), the last 0."""
    whole = cell(time, drift, scale)[:3]
    return np.append(_moved(time, drift, scale) - (whole - whole.sum() / 6.0), 0.0)


def _moved(time: float, drift: float, scale: float) -> np.ndarray:
    return scale * drift * time * VELOCITY
