"""Temperature laws of the thin disk, normalised to their peak, and the table the shaders read.

A law is one function `(r, spin, orbit, r_in) -> T`, T up to a constant factor, registered in `LAWS` by its decorator.
`r` (float64 array) and `r_in` are in r_s with r >= r_in; `orbit` is "prograde" or "retrograde".
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from ..shapes import Float
from . import relativity

Array = np.ndarray
Law = Callable[[Array, float, str, float], Array]

LAWS: dict[str, Law] = {}

_PEAK_SAMPLES = 4096


def _law(function: Law) -> Law:
    LAWS[function.__name__] = function
    return function


@_law
def page_thorne(r: Float[Array, "*radii"], spin: float, orbit: str, r_in: float) -> Float[Array, "*radii"]:
    """F^(1/4) of the relativistic thin disk. The stress vanishes at the ISCO wherever the disk is cut off (Page & Thorne 1974)."""
    return page_thorne_flux(r, spin, orbit) ** 0.25


@_law
def shakura_sunyaev(r: Float[Array, "*radii"], spin: float, orbit: str, r_in: float) -> Float[Array, "*radii"]:
    """(r/r_in)^(-3/4), hottest at the inner edge (BlackHoleGPU, docs/sources.md; the outer part of Shakura & Sunyaev 1973)."""
    return (r / r_in) ** -0.75


@_law
def tapered(r: Float[Array, "*radii"], spin: float, orbit: str, r_in: float) -> Float[Array, "*radii"]:
    """r^(-0.8) (1 - sqrt(r_in/r))^0.35, cold at the inner edge (the orbital-plane renderer of docs/sources.md)."""
    return r**-0.8 * np.maximum(1.0 - np.sqrt(r_in / r), 0.0) ** 0.35


def temperature(
    law: str, r: Float[Array, "*radii"], *, spin: float, orbit: str, r_in: float, r_out: float
) -> Float[Array, "*radii"]:
    """T/T_peak at radii `r` (r_s), T_peak the highest temperature in [r_in, r_out]; 0 inside r_in.

    Raises ValueError for an unknown law, or an annulus that is empty.
    """
    if law not in LAWS:
        raise ValueError(f"unknown temperature law {law!r}: one of {', '.join(LAWS)}")
    if not 0.0 < r_in < r_out:
        raise ValueError(f"the disk needs 0 < r_in < r_out, not r_in = {r_in}, r_out = {r_out}")
    r = np.asarray(r, dtype=np.float64)
    values = LAWS[law](np.maximum(r, r_in), spin, orbit, r_in)
    return np.where(r >= r_in, values / _peak(LAWS[law], spin, orbit, r_in, r_out), 0.0)


def _peak(law: Law, spin: float, orbit: str, r_in: float, r_out: float) -> float:
    """Highest temperature in [r_in, r_out]: a scan, refined twice about its best sample (the laws have one maximum)."""
    low, high = r_in, r_out
    for _ in range(3):
        radii = low + (high - low) * np.linspace(0.0, 1.0, _PEAK_SAMPLES) ** 2
        values = law(radii, spin, orbit, r_in)
        best = int(np.argmax(values))
        low, high = radii[max(best - 1, 0)], radii[min(best + 1, _PEAK_SAMPLES - 1)]
    peak = float(values[best])
    # Where page_thorne's disk lies wholly inside the ISCO nothing shines; the table is then 0, not 0/0.
    return peak if peak > 0.0 else 1.0


def table(law: str, spin: float, orbit: str, r_in: float, r_out: float, samples: int = 512) -> Float[Array, " samples"]:
    """T/T_peak as float32 (samples,), for r = r_in + (r_out - r_in) t^2.

    Texel i holds the value at its centre, t = (i + 1/2)/samples: a linear filter read at coordinate t interpolates in t.
    """
    t = (np.arange(samples) + 0.5) / samples
    return temperature(law, r_in + (r_out - r_in) * t * t, spin=spin, orbit=orbit, r_in=r_in, r_out=r_out).astype(np.float32)


def page_thorne_flux(r: ArrayLike, spin: ArrayLike, orbit: str = "prograde") -> Array:
    """Flux of a thin disk with no torque at the ISCO, up to a constant factor; 0 inside the ISCO. r in r_s (Page & Thorne 1974, eq. 15n).

    F = B/(x^4 (x^3 - 3x + 2a)), x = sqrt(r/M), and B the integral from the ISCO of (x^4-6x^2+8ax-3a^2)/(x (x^3-3x+2a)):
    its closed form in logarithms, or near the ISCO, where that cancels, a Gauss-Legendre sum.
    """
    a = relativity.relative_spin(spin, orbit)
    x0 = np.sqrt(2.0 * relativity.isco_radius(spin, orbit))
    x = np.sqrt(2.0 * np.asarray(r, dtype=np.float64))
    outside = x > x0
    x = np.where(outside, x, 2.0 * x0)
    roots = _page_thorne_roots(a)
    near = x - x0 < 0.25 * (x0 - np.maximum(roots[0], roots[1]))
    bracket = np.where(near, _page_thorne_sum(x, x0, a), _page_thorne_closed(x, x0, a, roots))
    norm = (x - 1.0) ** 2 * (x + 2.0) - 2.0 * (1.0 - a)
    return np.where(outside, np.maximum(bracket, 0.0) / (x**4 * norm), 0.0)


def _page_thorne_roots(a: Array) -> tuple[Array, Array, Array]:
    """Roots of x^3 - 3x + 2a; the one that vanishes with a comes from arcsin, to full relative precision."""
    third = np.arcsin(a) / 3.0
    return 2.0 * np.cos(np.pi / 6.0 + third), 2.0 * np.sin(third), -2.0 * np.cos(np.pi / 6.0 - third)


def _page_thorne_closed(x: Array, x0: Array, a: Array, roots: tuple[Array, Array, Array]) -> Array:
    total = x - x0 - 1.5 * a * np.log(x / x0)
    for i, root in enumerate(roots):
        others = root * (root - roots[i - 1]) * (root - roots[i - 2])
        # At a = 0 and |a| = 1 a factor vanishes, and the square above it faster: the term is then 0.
        weight = np.where(others != 0.0, 3.0 * (root - a) ** 2 / np.where(others != 0.0, others, 1.0), 0.0)
        inner = x0 - root
        total = total - weight * np.log(np.where(inner > 0.0, (x - root) / np.where(inner > 0.0, inner, 1.0), 1.0))
    return total


def _page_thorne_sum(x: Array, x0: Array, a: Array) -> Array:
    nodes, weights = np.polynomial.legendre.leggauss(16)
    half = 0.5 * (x - x0)
    total = np.zeros_like(x)
    for node, weight in zip(nodes, weights, strict=True):
        # The numerator has its zero at the ISCO: Taylor's series about it, exact for a polynomial.
        d = half * (1.0 + node)
        y = x0 + d
        numerator = d * (4.0 * x0**3 - 12.0 * x0 + 8.0 * a + d * (6.0 * x0**2 - 6.0 + d * (4.0 * x0 + d)))
        total = total + weight * numerator / (y * (y**3 - 3.0 * y + 2.0 * a))
    return half * total
