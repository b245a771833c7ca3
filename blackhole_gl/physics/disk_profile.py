"""Temperature laws of the thin disk, normalised to their peak, and the table the shaders read.

A law is one function `(r, spin, orbit, r_in, torque) -> T`, T up to a constant factor, registered in `LAWS` by its decorator.
`r` (float64 array) and `r_in` are in r_s with r >= r_in; `orbit` is "prograde" or "retrograde"; `torque` is what a torque at the ISCO adds to the
disk's efficiency. What falls in from r_in has the law of `plunging.heating`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from ..shapes import Float
from . import plunging, relativity

Array = np.ndarray
Law = Callable[[Array, float, str, float, float], Array]

LAWS: dict[str, Law] = {}

_PEAK_SAMPLES = 4096
_SAMPLES, _SAMPLES_OF_WIDE = 512, 2048
_WIDE = 20.0  # r_s: up to here the fewer keep T⁴ of every law within 2e-3 of itself but where it falls to 0; the more up to five times as far


def _law(function: Law) -> Law:
    LAWS[function.__name__] = function
    return function


@_law
def page_thorne(r: Float[Array, "*radii"], spin: float, orbit: str, r_in: float, torque: float) -> Float[Array, "*radii"]:
    """F^(1/4) of the relativistic thin disk. The stress at the ISCO is the torque's, wherever the disk is cut off (Page & Thorne 1974; Agol & Krolik 2000)."""
    return page_thorne_flux(r, spin, orbit, torque) ** 0.25


@_law
def shakura_sunyaev(r: Float[Array, "*radii"], spin: float, orbit: str, r_in: float, torque: float) -> Float[Array, "*radii"]:
    """(r/r_in)^(-3/4), hottest at the inner edge (BlackHoleGPU, docs/sources.md; the outer part of Shakura & Sunyaev 1973)."""
    return (r / r_in) ** -0.75


@_law
def tapered(r: Float[Array, "*radii"], spin: float, orbit: str, r_in: float, torque: float) -> Float[Array, "*radii"]:
    """r^(-0.8) (1 - sqrt(r_in/r))^0.35, cold at the inner edge (the orbital-plane renderer of docs/sources.md)."""
    return r**-0.8 * np.maximum(1.0 - np.sqrt(r_in / r), 0.0) ** 0.35


def temperature(
    law: str, r: Float[Array, "*radii"], *, spin: float, orbit: str, r_in: float, r_out: float, torque: float = 0.0, edge: float | None = None
) -> Float[Array, "*radii"]:
    """T/T_peak at radii `r` (r_s), T_peak the highest temperature in [r_in, r_out].

    Between `edge` and r_in matter falls in, and its temperature goes on from that at r_in; 0 inside of both.

    Raises ValueError for an unknown law, or an annulus that is empty.
    """
    if law not in LAWS:
        raise ValueError(f"unknown temperature law {law!r}: one of {', '.join(LAWS)}")
    if not 0.0 < r_in < r_out:
        raise ValueError(f"the disk needs 0 < r_in < r_out, not r_in = {r_in}, r_out = {r_out}")
    r = np.asarray(r, dtype=np.float64)
    values = LAWS[law](np.maximum(r, r_in), spin, orbit, r_in, torque)
    values = np.where(r >= r_in, values, values * plunging.heating(np.minimum(r, r_in), spin, orbit))
    return np.where(r >= (r_in if edge is None else edge), values / peak(law, spin, orbit, r_in, r_out, torque), 0.0)


def peak(law: str, spin: float, orbit: str, r_in: float, r_out: float, torque: float) -> float:
    """Highest temperature in [r_in, r_out], in the law's own units: a scan, refined twice about its best sample (the laws have one maximum)."""
    low, high = r_in, r_out
    for _ in range(3):
        radii = low + (high - low) * np.linspace(0.0, 1.0, _PEAK_SAMPLES) ** 2
        values = LAWS[law](radii, spin, orbit, r_in, torque)
        best = int(np.argmax(values))
        low, high = radii[max(best - 1, 0)], radii[min(best + 1, _PEAK_SAMPLES - 1)]
    highest = float(values[best])
    # Where page_thorne's disk lies wholly inside the ISCO nothing shines; the table is then 0, not 0/0.
    return highest if highest > 0.0 else 1.0


def table(
    law: str, spin: float, orbit: str, r_in: float, r_out: float, samples: int | None = None, *, torque: float = 0.0, edge: float | None = None
) -> Float[Array, " samples"]:
    """T/T_peak as float32 (samples,), 512 unless said, or 2048 of a wide disk, for r = edge + (r_out - edge) t^2, `edge` being r_in where no matter falls in.

    Texel i holds the value at its centre, t = (i + 1/2)/samples: a linear filter read at coordinate t interpolates in t.
    """
    count = (_SAMPLES if r_out <= _WIDE else _SAMPLES_OF_WIDE) if samples is None else samples
    t = (np.arange(count) + 0.5) / count
    innermost = r_in if edge is None else edge
    r = innermost + (r_out - innermost) * t * t
    return temperature(law, r, spin=spin, orbit=orbit, r_in=r_in, r_out=r_out, torque=torque, edge=edge).astype(np.float32)


def page_thorne_flux(r: ArrayLike, spin: ArrayLike, orbit: str = "prograde", torque: float = 0.0) -> Array:
    """Flux of a thin disk, in units of 3/(8 pi) of the mass that falls in per time (M = 1); 0 inside the ISCO. r in r_s (Page & Thorne 1974, eq. 15n).

    F = B/(x^4 (x^3 - 3x + 2a)), x = sqrt(r/M), and B the integral from the ISCO of (x^4-6x^2+8ax-3a^2)/(x (x^3-3x+2a)):
    its closed form in logarithms, or near the ISCO, where that cancels, a Gauss-Legendre sum. A torque at the ISCO that does work of `torque` times
    the energy of the mass that falls in adds the constant torque/(Omega u^t) of the ISCO to B (Agol & Krolik 2000, ApJ 528, 161).
    """
    a = relativity.relative_spin(spin, orbit)
    x0 = np.sqrt(2.0 * relativity.isco_radius(spin, orbit))
    x = np.sqrt(2.0 * np.asarray(r, dtype=np.float64))
    outside = x > x0 if torque == 0.0 else x >= x0
    x = np.where(outside, x, 2.0 * x0)
    roots = _page_thorne_roots(a)
    near = x - x0 < 0.25 * (x0 - np.maximum(roots[0], roots[1]))
    bracket = np.where(near, _page_thorne_sum(x, x0, a), _page_thorne_closed(x, x0, a, roots))
    norm = (x - 1.0) ** 2 * (x + 2.0) - 2.0 * (1.0 - a)
    if torque > 0.0:
        bracket = bracket + torque * np.sqrt(x0**3 * ((x0 - 1.0) ** 2 * (x0 + 2.0) - 2.0 * (1.0 - a)))
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


@lru_cache
def _gauss_legendre(count: int) -> tuple[Array, Array]:
    """Nodes in −1…1 and weights of Gauss' rule, from the eigenvectors of Legendre's recurrence (Golub & Welsch 1969). NumPy's own begins with an import
    that takes as long as all the rest of this file."""
    k = np.arange(1.0, count)
    beside = np.diag(k / np.sqrt(4.0 * k * k - 1.0), 1)
    nodes, vectors = np.linalg.eigh(beside + beside.T)
    return nodes, 2.0 * vectors[0] ** 2


def _page_thorne_sum(x: Array, x0: Array, a: Array) -> Array:
    nodes, weights = _gauss_legendre(16)
    half = 0.5 * (x - x0)
    total = np.zeros_like(x)
    for node, weight in zip(nodes, weights, strict=True):
        # The numerator has its zero at the ISCO: Taylor's series about it, exact for a polynomial.
        d = half * (1.0 + node)
        y = x0 + d
        numerator = d * (4.0 * x0**3 - 12.0 * x0 + 8.0 * a + d * (6.0 * x0**2 - 6.0 + d * (4.0 * x0 + d)))
        total = total + weight * numerator / (y * (y**3 - 3.0 * y + 2.0 * a))
    return half * total
