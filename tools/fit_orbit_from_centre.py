"""The polynomial in shaders/common/orbit_from_centre.glsl: prints its coefficients and its error.

r(φ) is the null orbit of Schwarzschild that leaves r = 0 at φ = 0 (r_s = 1, κ = 1/b²): r'' = ½ − r + 2κr³. With p = sin²(φ/2) and e = κp³,
r = p + p e g(p, e); g is fitted where the shader asks for it: at half of every φ ≤ π that lies on the way between infinity and the horizon.

    python tools/fit_orbit_from_centre.py
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import quad, solve_ivp

POWERS = ((0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (0, 1), (1, 1))
"""Of p and of e."""

CRITICAL = 4.0 / 27.0
KAPPAS = np.concatenate([CRITICAL * np.linspace(0.0, 1.0, 25)[1:], np.linspace(0.15, 0.21, 12), np.geomspace(0.22, 20.0, 25)])


def longest_half_angle(kappa: float) -> float:
    """Half of the angle between infinity and the horizon, π/2 at most."""
    if kappa <= CRITICAL * 1.001:
        return 0.5 * np.pi
    return 0.5 * min(np.pi, quad(lambda u: 1.0 / np.sqrt(u**3 - u * u + kappa), 0.0, 1.0, limit=200)[0])


def _orbit(_: float, y: np.ndarray, kappa: float) -> list[float]:
    return [y[1], 0.5 - y[0] + 2.0 * kappa * y[0] ** 3]


def samples() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """p, e and r/p − 1 over all that is asked for."""
    rows = []
    for kappa in KAPPAS:
        phi = longest_half_angle(kappa) * (0.5 - 0.5 * np.cos(np.pi * (np.arange(40) + 0.5) / 40))
        phi = phi[phi > 0.05]
        found = solve_ivp(_orbit, (0.0, phi[-1]), [0.0, 0.0], "DOP853", phi, args=(kappa,), rtol=1e-13, atol=1e-15)
        p = np.sin(0.5 * phi) ** 2
        rows.append(np.stack([p, kappa * p**3, found.y[0] / p - 1.0]))
    p, e, excess = np.concatenate(rows, axis=1)
    kept = e * p > 1e-9
    return p[kept], e[kept], excess[kept]


def fit(p: np.ndarray, e: np.ndarray, excess: np.ndarray) -> tuple[np.ndarray, float]:
    """Coefficients of g and the largest error of r/p: least squares, weighted anew towards the smallest largest error."""
    terms = np.stack([p**i * e**j for i, j in POWERS], axis=1) * e[:, None]
    weights, best = np.ones_like(p), (np.zeros(len(POWERS)), np.inf)
    for _ in range(80):
        found = np.linalg.lstsq(terms * weights[:, None], excess * weights, rcond=None)[0]
        error = np.abs(terms @ found - excess)
        if error.max() < best[1]:
            best = found, float(error.max())
        weights *= np.sqrt(0.3 + error / error.max())
        weights /= weights.max()
    return best


if __name__ == "__main__":
    coefficients, worst = fit(*samples())
    for (i, j), value in zip(POWERS, coefficients):
        print(f"p^{i} e^{j}  {value:.8f}")
    print(f"largest error of r/p: {worst:.1e}")
