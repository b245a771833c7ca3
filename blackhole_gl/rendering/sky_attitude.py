"""How a sky that can be turned stands in the world."""

from __future__ import annotations

import numpy as np

from ..physics.observer import cos_sin_deg


def attitude(yaw_deg: float, pitch_deg: float, roll_deg: float) -> np.ndarray:
    """Unit quaternion (x, y, z, w), float64 (4,), that turns a sky's own axes to the world's: by `roll_deg` about x, then x up by `pitch_deg`, then by
    `yaw_deg` about z."""
    (cz, sz), (cy, sy), (cx, sx) = (cos_sin_deg(0.5 * angle) for angle in (yaw_deg, -pitch_deg, roll_deg))
    return np.array([sx * cy * cz - cx * sy * sz, cx * sy * cz + sx * cy * sz, cx * cy * sz - sx * sy * cz, cx * cy * cz + sx * sy * sz])
