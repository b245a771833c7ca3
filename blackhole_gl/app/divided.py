"""A saved picture with a divider, as the window shows one side by side. No imgui here."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..scene import Scene

_LINE = 199, 201, 209
_LINE_WIDTH = 2  # pixels


@dataclass(frozen=True)
class RightSide:
    """What stands right of the divider.

    Attributes:
        share: of the picture's width that is left of it, 0…1.
    """

    scene: Scene
    share: float


def joined(left: np.ndarray, right: np.ndarray, share: float) -> np.ndarray:
    """The left `share` of one picture and the rest of another of the same size, (height, width, 3) uint8, with a line between them."""
    width = left.shape[1]
    middle = round(share * width)
    whole = np.concatenate([left[:, :middle], right[:, middle:]], axis=1)
    if 0 < middle < width:
        whole[:, max(middle - _LINE_WIDTH // 2, 0) : middle + _LINE_WIDTH // 2] = _LINE
    return whole
