"""Matter that falls in from the innermost stable circular orbit (ISCO): closed forms in Kerr (float64).

It keeps the energy and the angular momentum of that orbit, so that with M = 1, u = r_I/r and r_I the ISCO's radius

    u^r = −√(2/(3 r_I)) (u − 1)^(3/2),   E = √(1 − 2/(3 r_I)),   L = 2/(3√3) (1 + 2 √(3 r_I − 2)) along the orbit

(Mummery & Balbus 2022, Phys. Rev. Lett. 129, 161101; E and L are those of Bardeen, Press & Teukolsky 1972 there).
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..shapes import Float
from . import relativity

Array = np.ndarray

_DRIFT = 0.01
"""Speed with which matter crosses the ISCO, in units of √(2/(3 r_I)): about that of sound in a disk a hundred times as wide as thick."""


class Constants(NamedTuple):
    """Of matter on the ISCO, and of what falls in from there: radius in M, energy, angular momentum in M along the orbit."""

    radius: float
    energy: float
    momentum: float


class FourVelocity(NamedTuple):
    """Contravariant components u^t, u^r, u^φ in Boyer–Lindquist's coordinates, M = 1."""

    time: Array
    radial: Array
    around: Array


@lru_cache(maxsize=64)
def constants(spin: float, orbit: str = "prograde") -> Constants:
    """Those of the ISCO."""
    radius = 2.0 * float(relativity.isco_radius(spin, orbit))
    return Constants(radius, float(np.sqrt(1.0 - 2.0 / (3.0 * radius))), float(2.0 / np.sqrt(27.0) * (1.0 + 2.0 * np.sqrt(3.0 * radius - 2.0))))


def four_velocity(r: ArrayLike, spin: float, orbit: str = "prograde") -> FourVelocity:
    """Of the matter at r (r_s) between the horizon and the ISCO, where it is that of the circular orbit; NaN outside of both."""
    fixed, a, sense = constants(spin, orbit), relativity.relative_spin(spin, orbit), relativity.orbit_sense(spin, orbit)
    r = 2.0 * np.asarray(r, dtype=np.float64)
    root = np.sqrt((1.0 - a) * (1.0 + a))
    delta = (r - 1.0 - root) * (r - 1.0 + root)
    inside = (r <= fixed.radius) & (r > 1.0 + root)
    r, delta = np.where(inside, r, np.nan), np.where(inside, delta, np.nan)
    time = (r * r + a * a * (1.0 + 2.0 / r)) * fixed.energy - 2.0 * a / r * fixed.momentum
    around = (1.0 - 2.0 / r) * fixed.momentum + 2.0 * a / r * fixed.energy
    return FourVelocity(time / delta, -np.sqrt(2.0 / (3.0 * fixed.radius)) * (fixed.radius / r - 1.0) ** 1.5, sense * around / delta)


def emission_shift(r: ArrayLike, lam: ArrayLike, k_r: ArrayLike, spin: float, orbit: str = "prograde", energy_sign: ArrayLike = 1.0) -> Array:
    """|E_infinity|/E_emitter of light that leaves the matter at r (r_s); NaN outside the ISCO.

    Args:
        lam: L_z/E of the light in M.
        k_r: its covariant radial momentum in units of |E|, M = 1.
        energy_sign: that of its energy at infinity.
    """
    matter, energy = four_velocity(r, spin, orbit), np.asarray(energy_sign, dtype=np.float64)
    return energy / (energy * (matter.time - np.asarray(lam, dtype=np.float64) * matter.around) - np.asarray(k_r, dtype=np.float64) * matter.radial)


def heating(r: Float[Array, "*radii"], spin: float, orbit: str = "prograde") -> Float[Array, "*radii"]:
    """T of the matter at r (r_s) inside the ISCO over its T there.

    Matter that keeps its entropy, is held up by the pressure of its light and is opaque by scattering. With ρ ∝ (r³ |u^r|)^(−6/7), as a disk in
    vertical balance is r² √(p/ρ) thick and as much matter passes every radius, T⁴ ∝ ρ^(4/3)/Σ gives (r_I/r)^(17/28) (u^r/u^r_I)^(−1/28)
    (Mummery, Ingram, Davis & Fabian 2024, MNRAS 531, 366).
    """
    ratio = np.maximum(relativity.isco_radius(spin, orbit) / r, 1.0)
    return ratio ** (17.0 / 28.0) * (1.0 + (ratio - 1.0) ** 1.5 / _DRIFT) ** (-1.0 / 28.0)
