"""Twins of the ray models that take dynamical systems for forces, as Weiskopf, Schafhitzel & Ertl 2004 do (float64).

    lorenz    f = strength (sigma (y - x), rho x - y - x z, x y - beta z)      Lorenz 1963
    roessler  f = strength (-y - z, x + alpha y, beta + z (x - gamma))         Roessler 1976; the paper prints -x - z, a misprint
"""

from __future__ import annotations

import numpy as np

from .field_form import SPHERE, Field, follow_field
from .hits import Traced
from .registry import View, twin

Array = np.ndarray

_ROESSLER = {name: f"rays.roessler.{name}" for name in ("strength", "alpha", "beta", "gamma")}
_LORENZ = {name: f"rays.lorenz.{name}" for name in ("strength", "sigma", "rho", "beta")}


def lorenz_field(field_radius: float, field_way: float, strength: float, sigma: float, rho: float, beta: float) -> Field:
    """Lorenz's field and where it acts."""

    def force(place: Array, _: Array) -> Array:
        x, y, z = place
        return strength * np.stack([sigma * (y - x), x * (rho - z) - y, x * y - beta * z])

    return Field(force, field_radius, field_way)


@twin("lorenz", metric=None, spins=False, has_hole=False, parameters={**SPHERE, **_LORENZ})
def lorenz(
    view: View, field_radius: float = 10.0, field_way: float = 400.0, strength: float = 5e-4, sigma: float = 10.0, rho: float = 28.0, beta: float = 8.0 / 3.0
) -> Traced:
    """field_radius, field_way in r_s; strength in 1/r_s."""
    return follow_field(view, lorenz_field(field_radius, field_way, strength, sigma, rho, beta))


@twin("roessler", metric=None, spins=False, has_hole=False, parameters={**SPHERE, **_ROESSLER})
def roessler(
    view: View, field_radius: float = 10.0, field_way: float = 400.0, strength: float = 5e-3, alpha: float = 0.375, beta: float = 2.0, gamma: float = 4.0
) -> Traced:
    """field_radius, field_way in r_s; strength in 1/r_s."""

    def force(place: Array, _: Array) -> Array:
        x, y, z = place
        return strength * np.stack([-(y + z), x + alpha * y, beta + x * z - gamma * z])

    return follow_field(view, Field(force, field_radius, field_way))
