"""Deflection of light in Schwarzschild, exact and in its two limits, and the elliptic integral of closed forms (float64, vectorised over arrays).

Impact parameters in Schwarzschild radii, angles in radians.

Sources: Darwin 1959 (Proc. R. Soc. A 249, 180); Keeton & Petters 2005 (PRD 72, 104006); Carlson 1995 (Numer. Algorithms 10, 13).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .relativity import CRITICAL_IMPACT

Array = np.ndarray


def weak(b: ArrayLike, order: int = 1) -> Array:
    """Deflection 2/b, plus 15 pi/(16 b^2) at `order` 2; b in r_s (Keeton & Petters 2005)."""
    b = np.asarray(b, dtype=np.float64)
    return 2.0 / b + (15.0 * np.pi / (16.0 * b * b) if order >= 2 else 0.0)


def strong(b: ArrayLike) -> Array:
    """Logarithmic limit ln[216(7-4 sqrt 3)] - pi - ln(b/b_c - 1) near the critical impact parameter (Darwin 1959)."""
    epsilon = np.asarray(b, dtype=np.float64) / CRITICAL_IMPACT - 1.0
    return np.log(216.0 * (7.0 - 4.0 * np.sqrt(3.0))) - np.pi - np.log(epsilon)


def exact(b: ArrayLike) -> Array:
    """Exact deflection of light in Schwarzschild, b > b_c in r_s; infinite at b_c, NaN below.

    Twice the integral of du/sqrt(1/b^2 - u^2 + u^3) up to the turning point, less pi, as one Carlson R_F. The roots of the
    cubic are 1/3 + 2/3 cos(...) with the angle asin(b_c/b); sums and differences of them are formed from half angles.
    """
    b = np.asarray(b, dtype=np.float64)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = CRITICAL_IMPACT / b
        angle = np.arctan2(ratio, np.sqrt((1.0 - ratio) * (1.0 + ratio))) / 3.0
        gap = np.arctan2(np.sqrt((b - CRITICAL_IMPACT) * (b + CRITICAL_IMPACT)), CRITICAL_IMPACT) * (2.0 / 3.0)
        turning = ratio / (3.0 * np.sin(np.pi / 3.0 - angle))
        negative = ratio / (3.0 * np.sin(np.pi / 3.0 + angle))
        outer = 1.0 / 3.0 + 2.0 / 3.0 * np.cos(2.0 * angle)
        gap = (2.0 / np.sqrt(3.0)) * np.sin(gap)
        pair = (turning + negative) / turning
        swept = 4.0 * carlson_rf(negative * gap / turning, pair * gap, pair * outer)
    return np.where(b > CRITICAL_IMPACT, swept - np.pi, np.where(b == CRITICAL_IMPACT, np.inf, np.nan))


_RF_SPREAD = 2e-3  # what the series leaves out begins with the 6th power, a tenth of it


def carlson_rf(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
    """Carlson's R_F = 1/2 int_0^inf dt/sqrt((t+x)(t+y)(t+z)), all >= 0, at most one of them 0 (Carlson 1995, duplication)."""
    u, v, w = np.broadcast_arrays(*(np.asarray(given, dtype=np.float64) for given in (x, y, z)))
    for _ in range(14):  # the spread falls by 4 each time
        if np.all(np.maximum(np.abs(u - w), np.abs(v - w)) < _RF_SPREAD * w):
            break
        ru, rv, rw = np.sqrt(u), np.sqrt(v), np.sqrt(w)
        shift = ru * rv + rv * rw + rw * ru
        u, v, w = 0.25 * (u + shift), 0.25 * (v + shift), 0.25 * (w + shift)
    mean = (u + v + w) / 3.0
    dx, dy = 1.0 - u / mean, 1.0 - v / mean
    dz = -dx - dy
    e2, e3 = dx * dy - dz * dz, dx * dy * dz
    return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / np.sqrt(mean)
