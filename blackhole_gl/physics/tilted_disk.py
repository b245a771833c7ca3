"""A disk whose rigid plane is tilted out of the hole's equator (float64). Its matter is told by kinematics alone, and no solution of any equation of motion.

The axis leans by the tilt towards an azimuth. Matter at r goes round it at the rate of a circular orbit about a hole whose spin is the part along the axis,
a cos(tilt): exact with no tilt, and without spin at any. Round a spinning hole a free orbit would precess, at 2 a M²/r³ far out, and the plane would warp;
this one is held.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..scene import Disk
from ..shapes import Float
from . import moving_matter, relativity
from .observer import cos_sin_deg
from .space_time import spin_along

Array = np.ndarray


def axes(disk: Disk) -> Float[Array, "3 3"]:
    """The disk's own axes in the world, as rows: two in its plane, and that which stands on it. Without a tilt, or as it goes to 0, those of the world."""
    return _axes(disk.tilt_azimuth_deg, disk.tilt_deg)


@lru_cache(maxsize=16)
def _axes(azimuth_deg: float, tilt_deg: float) -> Float[Array, "3 3"]:
    (ahead, aside), (upright, lean) = cos_sin_deg(azimuth_deg), cos_sin_deg(tilt_deg)
    turn = np.array([[ahead, -aside, 0.0], [aside, ahead, 0.0], [0.0, 0.0, 1.0]])
    tip = np.array([[upright, 0.0, lean], [0.0, 1.0, 0.0], [-lean, 0.0, upright]])
    axes = (turn @ tip @ turn.T).T
    axes.setflags(write=False)
    return axes


def placed(points: Float[Array, "*points 2"], disk: Disk) -> Float[Array, "*points 3"]:
    """Where `points` of the disk's plane are in the world."""
    return np.asarray(points, float) @ axes(disk)[:2]


def shift(
    place: Float[Array, "*points 3"], momentum: Float[Array, "*points 3"], spin: float, disk: Disk
) -> tuple[Float[Array, "*points"], Float[Array, "*points"]]:
    """E_infinity/E_emitter of light that leaves the disk, in gravity's factor 1/u^t and the motion's; NaN where nothing can turn so fast.

    Args:
        place: in r_s, in the world, in the disk's plane.
        momentum: covariant (k_r, k_θ, k_φ) there, E = 1 and M = 1.
    """
    r = np.linalg.norm(place, axis=-1)
    rate = relativity.orbital_frequency(r, spin_along(spin, disk), disk.orbit)
    velocity = np.cross(axes(disk)[2], place) * rate[..., None]
    with np.errstate(invalid="ignore"):
        clock = np.sqrt(moving_matter.own_time_squared(place, velocity, spin))
        return clock, moving_matter.emitted_shift(place, velocity, momentum, spin) / clock
