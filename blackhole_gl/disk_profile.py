"""Temperature laws of the thin disk, normalised to their peak, and the table the shaders read.

A law is one function `(r, spin, orbit, r_in) -> T`, T up to a constant factor, registered in `LAWS` by its decorator.
`r` (float64 array) and `r_in` are in r_s with r >= r_in; `orbit` is "prograde" or "retrograde".
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from . import relativity

Array = np.ndarray
Law = Callable[[Array, float, str, float], Array]

LAWS: dict[str, Law] = {}

_PEAK_SAMPLES = 4096


def _law(function: Law) -> Law:
    LAWS[function.__name__] = function
    return function


@_law
def page_thorne(r: Array, spin: float, orbit: str, r_in: float) -> Array:
    """F^(1/4) of the relativistic thin disk. The stress vanishes at the ISCO wherever the disk is cut off (Page & Thorne 1974)."""
    return relativity.page_thorne_flux(r, spin, orbit) ** 0.25


@_law
def shakura_sunyaev(r: Array, spin: float, orbit: str, r_in: float) -> Array:
    """(r/r_in)^(-3/4), hottest at the inner edge (S1; the outer part of Shakura & Sunyaev 1973)."""
    return (r / r_in) ** -0.75


@_law
def tapered(r: Array, spin: float, orbit: str, r_in: float) -> Array:
    """r^(-0.8) (1 - sqrt(r_in/r))^0.35, cold at the inner edge (S0)."""
    return r**-0.8 * np.maximum(1.0 - np.sqrt(r_in / r), 0.0) ** 0.35


def temperature(law: str, r: Array, *, spin: float, orbit: str, r_in: float, r_out: float) -> Array:
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


def table(law: str, spin: float, orbit: str, r_in: float, r_out: float, samples: int = 512) -> Array:
    """T/T_peak as float32 (samples,), for r = r_in + (r_out - r_in) t^2.

    Texel i holds the value at its centre, t = (i + 1/2)/samples: a linear filter read at coordinate t interpolates in t.
    """
    t = (np.arange(samples) + 0.5) / samples
    return temperature(law, r_in + (r_out - r_in) * t * t, spin=spin, orbit=orbit, r_in=r_in, r_out=r_out).astype(np.float32)
