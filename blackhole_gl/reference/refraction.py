"""Twin of the ray model `refraction`: d/ds(n dx/ds) = grad n by arc length s (float64, r_s = 1), where the shader has x'' = grad(n^2)/2 and no n at all.

With the tangent t = x', |t| = 1:  t' = (grad n - (t.grad n) t)/n  (Born & Wolf, Principles of Optics, 3.2). A = size, S = strength:

    explosion  n^2 = 1 + S/(1 + u^2)^2,  u = (r - A (1 + raggedness W(x/grain)))/width,  r^2 = |x|^2 + (A/10)^2,
               W(y) = sum_i a_i cos 2 pi (k_i.y + p_i)
    mirage     n^2 = 1 - S (1 - z/sqrt(z^2 + A^2))/2
    luneburg   n^2 = 2 - |x|^2/A^2 for |x| < A, else 1                 Luneburg 1944
    fish_eye   n = index/(1 + |x|^2/A^2)                               Maxwell 1854
    linear     n^2 = 1 + S z
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .field_form import SPHERE, Field, follow_field
from .hits import Traced
from .registry import View, twin

Array = np.ndarray
Medium = Callable[[Array], tuple[Array, Array]]
"""From x (3, ...) to n and its gradient, (...) and (3, ...)."""

_NAMES = ("medium", "size", "strength", "width", "raggedness", "grain", "index")

_WAVE = np.array([
    (0.71, 0.32, 0.51), (-0.44, 0.83, 0.35), (0.29, -0.61, 0.79), (1.43, -0.97, 0.62), (-0.81, 1.12, -1.35), (0.55, 1.78, 1.03),
])
_PHASE = np.array([0.13, 0.58, 0.91, 0.27, 0.74, 0.42])
_AMPLITUDE = np.array([2.0, 2.0, 2.0, 1.0, 1.0, 1.0]) / 9.0


def media(field_radius: float, size: float, strength: float, width: float, raggedness: float, grain: float, index: float) -> dict[str, Medium]:
    """The media by name. What Luneburg's lens is beyond a sphere that it fills is nobody's to see: there it goes on, so that steps find nothing broken off."""
    rim = 2.0 if size >= field_radius else 1.0

    def of_square(square: Array, gradient: Array) -> tuple[Array, Array]:
        n = np.sqrt(square)
        return n, gradient / (2.0 * n)

    def explosion(x: Array) -> tuple[Array, Array]:
        r = np.sqrt((x * x).sum(axis=0) + (0.1 * size) ** 2)
        angle = 2.0 * np.pi * (np.tensordot(_WAVE, x / grain, axes=1) + _PHASE.reshape(-1, *[1] * (x.ndim - 1)))
        w = np.tensordot(_AMPLITUDE, np.cos(angle), axes=1)
        w_rate = -2.0 * np.pi / grain * np.tensordot((_AMPLITUDE[:, None] * _WAVE).T, np.sin(angle), axes=1)
        u = (r - size * (1.0 + raggedness * w)) / width
        u_rate = (x / r - size * raggedness * w_rate) / width
        return of_square(1.0 + strength / (1.0 + u * u) ** 2, -4.0 * strength * u / (1.0 + u * u) ** 3 * u_rate)

    def mirage(x: Array) -> tuple[Array, Array]:
        long = np.sqrt(x[2] ** 2 + size**2)
        gradient = np.zeros_like(x)
        gradient[2] = 0.5 * strength * size**2 / long**3
        return of_square(1.0 - 0.5 * strength * (1.0 - x[2] / long), gradient)

    def luneburg(x: Array) -> tuple[Array, Array]:
        q = (x * x).sum(axis=0) / size**2
        return of_square(np.where(q < rim, 2.0 - q, 1.0), np.where(q < rim, -2.0 * x / size**2, 0.0))

    def fish_eye(x: Array) -> tuple[Array, Array]:
        below = 1.0 + (x * x).sum(axis=0) / size**2
        return index / below, -index / below**2 * 2.0 * x / size**2

    def linear(x: Array) -> tuple[Array, Array]:
        gradient = np.zeros_like(x)
        gradient[2] = strength
        return of_square(1.0 + strength * x[2], gradient)

    return {"explosion": explosion, "mirage": mirage, "luneburg": luneburg, "fish_eye": fish_eye, "linear": linear}


@twin("refraction", metric=None, spins=False, has_hole=False, parameters={**SPHERE, **{name: f"rays.refraction.{name}" for name in _NAMES}})
def refraction(view: View, field_radius: float = 10.0, field_way: float = 400.0, medium: str = "explosion", size: float = 6.0, strength: float = 0.3,
               width: float = 1.0, raggedness: float = 0.15, grain: float = 4.0, index: float = 2.0) -> Traced:
    """field_radius, field_way, size, width and grain in r_s."""
    n_at = media(field_radius, size, strength, width, raggedness, grain, index)[medium]

    def force(x: Array, tangent: Array) -> Array:
        n, gradient = n_at(x)
        return (gradient - (tangent * gradient).sum(axis=0) * tangent) / n

    return follow_field(view, Field(force, field_radius, field_way))
