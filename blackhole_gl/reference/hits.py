"""What a traced ray hit: the record every reference model returns (float64)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

UNRESOLVED, ESCAPED, CAPTURED = 0, 1, 2


@dataclass(frozen=True)
class ReferenceHits:
    """N rays, at most `orders` crossings each. NaN stands for "none" and for nothing else.

    fate         (N,) int8: 0 unresolved, 1 escaped, 2 captured
    direction    (N, 3) asymptotic world direction, unit; zero unless escaped
    theta, phi   (N,) its angles in radians; NaN unless escaped
    steps        (N,) trial steps of the integrator; evaluations (N,) of the right-hand side, without event location
    crossing_r   (N, orders) Boyer-Lindquist r in r_s where the ray crosses z = 0 the n-th time; NaN = none, or below 1.02 r_+
    crossing_phi (N, orders) Boyer-Lindquist azimuth there in radians, in (-pi, pi]
    g            (N, orders) E_infinity/E_emitter of a circular equatorial emitter there; NaN = no crossing, or inside its ISCO
    lambda_      (N,) L_z/E of the physical photon in M
    observer     "static" or "zamo": the one used (a static observer gives way to the ZAMO in the ergosphere)
    """

    fate: np.ndarray
    direction: np.ndarray
    theta: np.ndarray
    phi: np.ndarray
    steps: np.ndarray
    evaluations: np.ndarray
    crossing_r: np.ndarray
    crossing_phi: np.ndarray
    g: np.ndarray
    lambda_: np.ndarray
    observer: str


def wrapped(angle: np.ndarray) -> np.ndarray:
    """The same angle in (-pi, pi]."""
    return np.pi - np.mod(np.pi - angle, 2.0 * np.pi)


def angles(direction: np.ndarray, fate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(theta, phi) of directions (N, 3); NaN where the ray did not escape."""
    escaped = fate == ESCAPED
    theta = np.arctan2(np.hypot(direction[:, 0], direction[:, 1]), direction[:, 2])
    phi = np.arctan2(direction[:, 1], direction[:, 0])
    return np.where(escaped, theta, np.nan), np.where(escaped, phi, np.nan)
