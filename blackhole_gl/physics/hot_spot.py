"""A bright patch of the disk on a circular orbit: where it is at a scene time."""

from __future__ import annotations

import math

from ..scene import catalogue
from . import relativity
from .observer import cos_sin_deg


def place(
    radius: float, phase_deg: float, orbit: str, tilt_deg: float, hole_spin: float, model: str, lensing: bool, time: float
) -> tuple[float, float, float, float]:
    """(cos φ, sin φ, r in r_s, Ω in rad per r_s/c) at scene time `time` (r_s/c), worked out in float64, so that nothing drifts after hours.

    Args:
        radius: of the orbit in r_s; inside the innermost stable one that is taken.
        phase_deg: its azimuth at time 0.
        orbit, tilt_deg, hole_spin, model, lensing: those of the scene; a ray model without spin has orbits without. A model left open has some.
    """
    rays = catalogue.plug_ins("ray_model").get(model if lensing else "flat")
    spin = hole_spin * math.cos(math.radians(tilt_deg)) if rays is None or rays.traits.spins else 0.0
    r = max(radius, float(relativity.isco_radius(spin, orbit)))
    rate = float(relativity.orbital_frequency(r, spin, orbit))
    turned = math.fmod(rate * time, 2.0 * math.pi)
    return (*cos_sin_deg(phase_deg + math.degrees(turned)), r, rate)
