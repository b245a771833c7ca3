"""Twin of the ray model `potential`: a body of speed 1 in the potential of a centre (float64, r_s = 1).

    x'' = -grad V(s),  s^2 = |x - centre|^2 + core^2

    newton   V = -strength/s
    yukawa   V = -strength e^(-screening s)/s                     Yukawa 1935
    compact  dV/ds = strength (2 q^3 - 3 q^2 + 1), q = s/extent   up to s = extent, and 0 beyond (Weiskopf, Schafhitzel & Ertl 2004)
"""

from __future__ import annotations

import numpy as np

from .field_form import SPHERE, Field, follow_field
from .hits import Traced
from .registry import View, twin

Array = np.ndarray

_NAMES = ("law", "strength", "screening", "extent", "core", "x", "y", "z")


def slope(law: str, s: Array, strength: float, screening: float, extent: float) -> Array:
    """dV/ds (N,) at s (N,).

    Raises:
        ValueError: there is no such law.
    """
    if law == "newton":
        return strength / s**2
    if law == "yukawa":
        return strength * np.exp(-screening * s) * (1.0 / s + screening) / s
    if law == "compact":
        q = s / extent
        return np.where(q < 1.0, strength * (1.0 - q) ** 2 * (1.0 + 2.0 * q), 0.0)
    raise ValueError(f"law: got {law!r}; allowed are newton, yukawa and compact")


@twin("potential", metric=None, spins=False, has_hole=False, parameters={**SPHERE, **{name: f"rays.potential.{name}" for name in _NAMES}})
def potential(view: View, field_radius: float = 10.0, field_way: float = 400.0, law: str = "newton", strength: float = 0.5, screening: float = 0.3,
              extent: float = 8.0, core: float = 0.2, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Traced:
    """field_radius, field_way, extent, core and the centre x, y, z in r_s; screening in 1/r_s."""
    centre = np.array([x, y, z])

    def force(place: Array, _: Array) -> Array:
        from_centre = place - centre.reshape(3, *[1] * (place.ndim - 1))
        s = np.sqrt((from_centre**2).sum(axis=0) + core**2)
        return -slope(law, s, strength, screening, extent) * from_centre / s

    return follow_field(view, Field(force, field_radius, field_way))
