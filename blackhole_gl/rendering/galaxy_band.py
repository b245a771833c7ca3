"""The galaxy band of the procedural sky, as the assets hold it."""

from __future__ import annotations

import numpy as np

from ..resources import assets_dir


def table() -> np.ndarray:
    """Square root of its radiance over longitude × sin(latitude) in −0.5…0.5, uint8 (rows, columns, 3).

    Raises:
        FileNotFoundError: it is missing from assets/.
    """
    return np.load(assets_dir() / "galaxy_band.npy")
