"""The stars of the sky `catalogue`: those of Hipparcos (assets/hipparcos.npz), and beyond what it holds whole the law N(>F) ∝ F^(−4/3), joined without a step.

Directions are of J2000: x to the vernal equinox, z to the celestial north pole.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..resources import assets_dir
from .star_cells import hash_bits

Array = np.ndarray

WHOLE_TO = 7.5
"""Hp up to which the catalogue is held to have every star."""

CONTINUED_TO = 9.0
"""Hp up to which the law adds what it lacks; beyond that starlight is the Milky Way's."""

LAW = 4.0 / 3.0
"""−dlog N(>F)/dlog F."""

GALAXY_POLE = np.array([-0.867666, -0.198077, 0.455985])
"""α = 192.8595°, δ = 27.1283°."""

GALAXY_CENTRE = np.array([-0.054876, -0.873439, -0.483832])
"""α = 266.405°, δ = −28.936°."""

_STEP = 2.0 * np.pi / 2**24  # rad, of the asset's places
_UNKNOWN_COLOUR = 0.6  # B−V where there is none
_COLOURS = -0.4, 2.5  # B−V; what lies beyond is no star's


@dataclass(frozen=True)
class Stars:
    """Stars, the brightest first.

    Attributes:
        direction: unit vectors (n, 3).
        flux: (n,), that of Hp = 0 is 1.
        kelvin: temperatures (n,).
    """

    direction: Array
    flux: Array
    kelvin: Array

    def sorted(self) -> Stars:
        """The same, the brightest first."""
        order = np.argsort(-self.flux, kind="stable")
        return Stars(self.direction[order], self.flux[order], self.kelvin[order])


def hipparcos() -> Stars:
    """The catalogue's own stars.

    Raises:
        FileNotFoundError: it is missing from assets/.
    """
    with np.load(assets_dir() / "hipparcos.npz") as stored:
        direction = _towards(stored["ra"], stored["dec"])
        magnitude, colour = stored["millimag"] * 1e-3, stored["colour"] * 1e-3
    colour = np.where(colour < -9.0, _UNKNOWN_COLOUR, np.clip(colour, *_COLOURS))
    return Stars(direction, 10.0 ** (-0.4 * magnitude), kelvin_of(colour)).sorted()


def numbered() -> tuple[Array, Array]:
    """The stars' numbers in Hipparcos (n,), and unit vectors (n, 3).

    Raises:
        FileNotFoundError: it is missing from assets/.
    """
    with np.load(assets_dir() / "hipparcos.npz") as stored:
        return stored["hip"], _towards(stored["ra"], stored["dec"])


def _towards(ra: Array, dec: Array) -> Array:
    """Unit vectors of places as the asset has them."""
    level = np.cos(dec * _STEP)
    return np.stack([level * np.cos(ra * _STEP), level * np.sin(ra * _STEP), np.sin(dec * _STEP)], axis=-1)


def kelvin_of(colour: Array) -> Array:
    """Temperature of a star of B−V (Ballesteros 2012), K."""
    return 4600.0 * (1.0 / (0.92 * colour + 1.7) + 1.0 / (0.92 * colour + 0.62))


def continued(known: Stars) -> Stars:
    """`known` with stars of the law where it lacks them between `WHOLE_TO` and `CONTINUED_TO`: crowded to the galaxy's plane, in its faint ones' colours."""
    edges = np.linspace(WHOLE_TO, CONTINUED_TO, 16)
    magnitude = -2.5 * np.log10(known.flux)
    there = np.searchsorted(np.sort(magnitude), edges)
    wanted = np.rint(there[0] * 10.0 ** (0.4 * LAW * (edges - WHOLE_TO))).astype(int)
    lacking = np.maximum.accumulate(np.maximum(wanted - there, 0))
    added = np.repeat(np.arange(len(edges) - 1), np.diff(lacking))
    count = len(added)
    flux = 10.0 ** (-0.4 * (edges[added] + (edges[1] - edges[0]) * _uniform(count, 0)))
    kelvin = known.kelvin[-1 - (_uniform(count, 1) * 0.8 * len(known.kelvin)).astype(int)]
    parts = (known.direction, _scattered(count)), (known.flux, flux), (known.kelvin, kelvin)
    return Stars(*(np.concatenate(part) for part in parts)).sorted()


def _scattered(count: int) -> Array:
    """Unit vectors (count, 3), the denser the nearer to the galaxy's plane: the richness of the procedural sky."""
    tried = 4 * count + 64  # more than a quarter is kept
    z, turn = 2.0 * _uniform(tried, 2) - 1.0, 2.0 * np.pi * _uniform(tried, 3)
    level = np.sqrt(1.0 - z * z)
    direction = np.stack([level * np.cos(turn), level * np.sin(turn), z], axis=-1)
    height = direction @ GALAXY_POLE
    return direction[_uniform(tried, 4) < 0.25 + 0.75 / (1.0 + 20.0 * height * height)][:count]


def _uniform(count: int, draw: int) -> Array:
    """0…1 (count,), the same on every machine."""
    return (hash_bits(np.arange(count, dtype=np.uint32) * np.uint32(8) + np.uint32(draw)) + 0.5) / 2.0**32
