"""Squares that are drawn in the place of boxes: what they hold, and that none is outside the picture."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.rendering.squares import Patches

CELL, SIDES = 4, (8, 32)


def shown(patches: Patches, size: tuple[int, int]) -> np.ndarray:
    """How many of them hold each pixel, int (height, width)."""
    held = np.zeros(size[::-1], int)
    for x, y, side in patches.points.tolist():
        left, low = (round((0.5 + 0.5 * at) * whole - 0.5 * side) for at, whole in zip((x, y), size))
        assert left >= 0 and low >= 0 and left + side <= size[0] and low + side <= size[1]
        held[low : low + round(side), left : left + round(side)] += 1
    return held


@pytest.mark.parametrize("size", [(640, 360), (100, 70), (37, 45)])
def test_patches_hold_the_cells_picked_and_little_else(size):
    cells = np.add.outer(np.arange(-(-size[1] // CELL)) - 6, np.arange(-(-size[0] // CELL)) - 9) > 4
    cells[1, 2] = True
    pixels = np.kron(cells, np.ones((CELL, CELL), bool))[: size[1], : size[0]]
    held = shown(Patches.picked(cells, CELL, SIDES, size), size)
    assert (held[pixels] > 0).all()
    near = np.zeros_like(pixels)
    for row, column in np.argwhere(pixels[::CELL, ::CELL]) * CELL:
        near[max(row - 2 * SIDES[0], 0) : row + 2 * SIDES[0], max(column - 2 * SIDES[0], 0) : column + 2 * SIDES[0]] = True
    assert not held[~near].any()


def test_full_squares_are_large_and_none_lies_on_another():
    cells = np.ones((16, 32), bool)
    cells[:8, :8] = False
    cells[0, 0] = True
    patches = Patches.picked(cells, CELL, SIDES, (128, 64))
    assert sorted(patches.points[:, 2].tolist()) == [8.0] + [32.0] * 7
    assert shown(patches, (128, 64)).max() == 1


def test_where_nothing_is_picked_there_is_none():
    assert len(Patches.picked(np.zeros((9, 16), bool), CELL, SIDES, (64, 36))) == 0
