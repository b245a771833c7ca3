"""All light rays from one camera radius in Schwarzschild: how far round the hole each goes, as a table of cubic polynomials (float64).

The rays in any one plane through the hole and the camera are a one-parameter family, told apart by the angle ψ from the hole's centre. What
is tabulated is the angle φ swept about the hole from the camera to the ray's end: to infinity where it escapes, to r = 0 where it is
captured. All else follows from that angle in closed form (shaders/common/orbit_from_centre.glsl).

The coordinate is x = tan(ψ/2)/tan(ψ_c/2) − 1, ψ_c the shadow's half-angle: x > 0 escapes and x < 0 is captured at every camera radius, inside the
photon sphere too. φ goes as −ln |x| near 0 and is smooth elsewhere, so cells are a fixed fraction of x wide: octaves cut into `CELLS`
equal parts, which is what the leading bits of a float are.

Units r_s = 1. With u = 1/r and b_c the critical impact parameter: (du/dφ)² = f(u) = u³ − u² + (4/27) ρ², ρ = b_c/b.
"""

from __future__ import annotations

import math

import numpy as np

from ..shapes import Float
from .deflection import carlson_rf
from .relativity import CRITICAL_IMPACT

Array = np.ndarray

FIRST_OCTAVE = -24
"""|x| below 2^FIRST_OCTAVE is not told apart in float32, as x is formed as a difference from 1."""
LAST_OCTAVE = 40
"""x up to 2^LAST_OCTAVE: from 10⁴ r_s that is 1e-8 rad from straight away from the hole."""
CELLS = 16
"""Cells in an octave. For a logarithm the cubic is then good to 3e-8."""
CELL_BITS = 23 - (CELLS.bit_length() - 1)
"""Bits of a float32 that lie below those that number its cell."""
FIRST_CELL = (127 + FIRST_OCTAVE) * CELLS
WIDTH = (LAST_OCTAVE - FIRST_OCTAVE) * CELLS
CONSTANTS = {"ORBIT_CELL_BITS": CELL_BITS, "ORBIT_FIRST_CELL": FIRST_CELL}
"""What shaders that read the table know of it."""

_NODES = 0.5 * np.cos(np.pi * (2.0 * np.arange(4) + 1.0) / 8.0)  # Chebyshev's, on −½…½
_TO_CUBIC = np.linalg.inv(np.vander(_NODES, 4, increasing=True))


def edge_tangent(distance: float) -> float:
    """tan(ψ_c/2) of the static observer at `distance` > 1 (r_s, may be inf). cos ψ_c = (1 − 3u/2)√(1 + 3u) is negative inside the photon sphere."""
    u = 1.0 / distance
    return CRITICAL_IMPACT * u * math.sqrt(1.0 - u) / (1.0 + (1.0 - 1.5 * u) * math.sqrt(1.0 + 3.0 * u))


def coordinate_factors(distance: float) -> tuple[float, float]:
    """What turns L, a ray's angular momentum in M at E = 1, and cos ψ into 1 + x at `distance` (r_s, may be inf).

    1 + x = first · L/(1 + cos ψ) = second · (1 − cos ψ)/L; the second is 0 at infinity, where ψ is 0; both are where there is no such camera.
    """
    if distance <= 1.0:
        return 0.0, 0.0
    if math.isinf(distance):
        return 1.0 / CRITICAL_IMPACT, 0.0
    u = 1.0 / distance
    sine_per_momentum = 0.5 * u * math.sqrt(1.0 - u)
    tangent = edge_tangent(distance)
    return sine_per_momentum / tangent, 1.0 / (sine_per_momentum * tangent)


def table(distance: float) -> Float[Array, "2 columns 4"]:
    """The table for a camera at `distance` > 1 (r_s, may be inf): float32 (2, WIDTH, 4).

    Row 1 is of x > 0, row 0 of x < 0 (empty from |x| = 1 on). Entry i holds c of φ = c₀ + c₁ t + c₂ t² + c₃ t³ with |x| = 2^octave (1 + (k + ½ + t)/CELLS),
    i = (octave − FIRST_OCTAVE)·CELLS + k, t in −½…½.
    """
    octave = np.repeat(np.arange(FIRST_OCTAVE, LAST_OCTAVE), CELLS)
    part = np.tile(np.arange(CELLS), LAST_OCTAVE - FIRST_OCTAVE)
    size = np.exp2(octave)[:, None] * (1.0 + (part[:, None] + 0.5 + _NODES) / CELLS)
    inside = size[: -FIRST_OCTAVE * CELLS]
    cubics = np.zeros((2, WIDTH, 4), np.float32)
    cubics[0, : len(inside)] = swept_angle(-inside, distance) @ _TO_CUBIC.T
    cubics[1] = swept_angle(size, distance) @ _TO_CUBIC.T
    return cubics


def swept_angle(x: Float[Array, "*rays"], distance: float) -> Float[Array, "*rays"]:
    """φ from the camera at `distance` (r_s) to the end of the ray at `x` > −1, all of one sign, not 0."""
    tangent2 = edge_tangent(distance) ** 2
    u = 1.0 / distance
    above = x * (tangent2 * (1.0 + x) - 1.0) / ((1.0 + x) * (1.0 + tangent2))  # ρ − 1, no difference of near numbers
    inward = tangent2 * (1.0 + x) ** 2 < 1.0
    angle = np.empty_like(x)
    far, near = above > 0.0, above <= 0.0
    start, rest = _to_centre(0.0, above[far]), _to_centre(u, above[far])
    angle[far] = start - rest if x.flat[0] > 0.0 else rest
    angle[near] = (_escape if x.flat[0] > 0.0 else _capture)(u, above[near], inward[near])
    return angle


def _to_centre(u: float, above: Array) -> Array:
    """∫ du/√f from u to ∞ where b < b_c: f = (u + n)((u − m)² + w²).

    R_F of z² and a conjugate pair is made real by one step of Landen's transformation (Carlson 1995, eq. 2.19 f.).
    """
    third = np.arcsinh(np.sqrt(above * (2.0 + above))) / 3.0
    n = 1.0 / 3.0 + 4.0 / 3.0 * np.sinh(third) ** 2
    m = 0.5 * (1.0 + n)
    w2 = np.sinh(third) ** 2 * (n + 1.0)
    z2 = u + n
    size = np.hypot(u - m, np.sqrt(w2))
    real2 = np.where(u > m, 0.5 * (size + u - m), 0.5 * w2 / (size + np.abs(u - m)))
    both = 2.0 * np.sqrt(z2 * real2)
    plus = 0.5 * (np.sqrt(z2 + size + both) + np.sqrt(np.maximum(z2 + size - both, 0.0)))
    return 2.0 * carlson_rf(real2, z2 * real2 / plus**2, plus**2)


def _roots(above: Array) -> tuple[Array, Array, Array, Array]:
    """−u₃, u₁, u₂ and u₂ − u₁ of f where b ≥ b_c: u₃ < 0 < u₁ ≤ 2/3 ≤ u₂."""
    ratio, rest = 1.0 + above, np.sqrt(-above * (2.0 + above))
    angle = np.arctan2(ratio, rest) / 3.0
    gap = np.arctan2(rest, ratio) / 3.0
    inner = ratio / (3.0 * np.sin(np.pi / 3.0 - angle))
    return ratio / (3.0 * np.sin(np.pi / 3.0 + angle)), inner, 1.0 / 3.0 + 2.0 / 3.0 * np.cos(2.0 * angle), 2.0 / np.sqrt(3.0) * np.sin(2.0 * gap)


def _escape(u: float, above: Array, inward: Array) -> Array:
    """From u to infinity where b ≥ b_c, outside the photon sphere: outward, or inward to u₁ and out again."""
    n, inner, outer, gap = _roots(above)
    direct = u * carlson_rf(*_from_infinity(u, n, inner, outer))
    pair = 1.0 + n / inner
    to_turning = carlson_rf(n * gap / inner, pair * gap, pair * outer)
    return np.where(inward, 4.0 * to_turning - 2.0 * direct, 2.0 * direct)


def _from_infinity(u: float, n: Array, inner: Array, outer: Array) -> tuple[Array, Array, Array]:
    """u²·U² of ∫ du/√f = 2 R_F(U²) from 0 to u ≤ u₁ (Carlson 1995, eq. 1.2)."""
    x = np.sqrt(u + n), np.sqrt(np.maximum(inner - u, 0.0)), np.sqrt(np.maximum(outer - u, 0.0))
    y = np.sqrt(n), np.sqrt(inner), np.sqrt(outer)
    first, second, third = ((x[i] * x[j] * y[k] + y[i] * y[j] * x[k]) ** 2 for i, j, k in ((0, 1, 2), (0, 2, 1), (1, 2, 0)))
    return first, second, third


def _capture(u: float, above: Array, inward: Array) -> Array:
    """From u to r = 0 where b ≥ b_c, inside the photon sphere: inward, or outward to u₂ and in again."""
    n, inner, outer, gap = _roots(above)
    direct = 2.0 * carlson_rf(u + n, np.maximum(u - inner, 0.0), np.maximum(u - outer, 0.0))
    return np.where(inward, direct, 4.0 * carlson_rf(outer + n, gap, np.zeros_like(gap)) - direct)
