"""The table of black-body colours, as fine as shaders look it up."""

from __future__ import annotations

import numpy as np

from .resources import assets_dir

ENTRIES = 2048
"""Of the table that shaders get, so that the nearest will do; shaders/common/colour.glsl names the last one's number."""


def table() -> np.ndarray:
    """Linear Rec. 709 colours of luminance 1 from 1,000 to 40,000 K evenly in log T, float32 (ENTRIES, 4), the last component 1.

    Raises:
        FileNotFoundError: assets/blackbody.npy is missing.
    """
    stored = np.load(assets_dir() / "blackbody.npy")
    place = np.linspace(0.0, len(stored) - 1.0, ENTRIES)
    colours = [np.interp(place, np.arange(len(stored)), channel) for channel in stored.T]
    return np.stack([*colours, np.ones(ENTRIES)], axis=-1).astype(np.float32)
