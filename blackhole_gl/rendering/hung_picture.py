"""Where the picture of the sky `picture` hangs: what shaders/skies/picture.glsl has worked out for a frame."""

from __future__ import annotations

import math

import numpy as np

from ..physics.observer import cos_sin_deg


def axes(hung: str, azimuth_deg: float, latitude_deg: float, camera_azimuth_deg: float, camera_inclination_deg: float) -> np.ndarray:
    """Rows: unit vectors to the right and up on the picture and from the hole to its middle, in the world; float64 (4, 4), the fourth row and column empty."""
    if hung == "behind":
        azimuth_deg, latitude_deg = camera_azimuth_deg + 180.0, camera_inclination_deg - 90.0
    (c, s), (level, rise) = cos_sin_deg(azimuth_deg), cos_sin_deg(latitude_deg)
    found = np.zeros((4, 4))
    found[0, :3] = s, -c, 0.0
    found[1, :3] = -rise * c, -rise * s, level
    found[2, :3] = level * c, level * s, rise
    return found


def half_width(width_deg: float) -> float:
    """Half the width of the picture in the plane at distance 1."""
    return math.tan(math.radians(0.5 * width_deg))
