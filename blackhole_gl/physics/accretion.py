"""How hot the disk of a real object is: Page and Thorne's flux in watts, for a mass and a rate of accretion.

The constants are SI's (CODATA 2018, exact but for the Thomson cross-section and the proton's mass).
"""

from __future__ import annotations

import math
from functools import lru_cache

from ..scene import Scene
from . import disk_profile, plunging
from .angular_size import LIGHT_SPEED, SUN_GM
from .space_time import space_time

STEFAN_BOLTZMANN = 5.670374419e-8
"""W/(m² K⁴)."""

_PROTON_MASS, _THOMSON = 1.67262192369e-27, 6.6524587321e-29  # kg, m²


@lru_cache(maxsize=64)  # asked for in every frame
def hottest(scene: Scene) -> float:
    """The highest temperature of the disk of `scene` in K, as matter there sees it: the one chosen, or the one that follows from mass and rate."""
    disk, where = scene.disk, space_time(scene)
    if disk.temperature_of == "chosen":
        return disk.temperature_k
    inner, outer = where.disk_radii(disk)
    flux = disk_profile.peak("page_thorne", where.matter_spin(disk), disk.orbit, inner, outer, disk.inner_torque) ** 4
    radius = SUN_GM * scene.source.mass_suns / LIGHT_SPEED**2
    rate = disk.accretion_rate * eddington_power(scene.source.mass_suns) / efficiency(where.matter_spin(disk), disk.orbit, disk.inner_torque)
    return disk.colour_hardening * (3.0 / (8.0 * math.pi) * rate * flux / radius**2 / STEFAN_BOLTZMANN) ** 0.25


def eddington_power(mass_suns: float) -> float:
    """Luminosity in W at which light pushes ionized hydrogen off as hard as the mass pulls."""
    return 4.0 * math.pi * SUN_GM * mass_suns * _PROTON_MASS * LIGHT_SPEED / _THOMSON


def efficiency(spin: float, orbit: str, torque: float) -> float:
    """Share of infalling mass that the disk turns into light: what it has lost on the ISCO, and the work of a torque there."""
    return 1.0 - plunging.constants(spin, orbit).energy + torque
