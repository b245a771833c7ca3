"""Squares that are drawn in the place of boxes: what they hold, and that no pixel lies in two."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.rendering.squares import Patches

CELL = 4


def shown(patches: Patches, size: tuple[int, int]) -> np.ndarray:
    """How many squares and boxes hold each pixel, int (height, width)."""
    held = np.zeros(size[::-1], int)
    for x, y, side in patches.points.tolist():
        left, low = (round((0.5 + 0.5 * at) * whole - 0.5 * side) for at, whole in zip((x, y), size))
        assert left >= 0 and low >= 0 and left + side <= size[0] and low + side <= size[1]
        held[low : low + round(side), left : left + round(side)] += 1
    for x, y, width, height in patches.boxes:
        assert width > 0 and height > 0 and x + width <= size[0] and y + height <= size[1]
        held[y : y + height, x : x + width] += 1
    return held


@pytest.mark.parametrize("sides", [(4, 32), (8, 32), (4, 8, 32)])
@pytest.mark.parametrize("size", [(640, 360), (100, 70), (531, 299), (37, 45), (5, 3), (1, 1)])
def test_patches_hold_the_cells_picked_each_once_and_little_else(size, sides):
    rows, columns = -(-size[1] // CELL), -(-size[0] // CELL)
    cells = np.add.outer(np.arange(rows) - 6, np.arange(columns) - 9) > 4
    cells[min(1, rows - 1), min(2, columns - 1)] = True
    pixels = np.kron(cells, np.ones((CELL, CELL), bool))[: size[1], : size[0]]
    held = shown(Patches.picked(cells, CELL, sides, size), size)
    assert (held[pixels] == 1).all() and held.max() == 1
    if sides[0] == CELL and not size[0] % CELL and not size[1] % CELL:
        assert not held[~pixels].any()
    whole = tuple(side // sides[0] * sides[0] for side in size)
    beside = held.astype(bool) & ~pixels
    beside[whole[1] :] = beside[:, whole[0] :] = False
    assert np.count_nonzero(beside) <= 3 * CELL**2 * np.count_nonzero(cells)


@pytest.mark.parametrize("size", [(640, 360), (100, 70), (531, 299), (37, 45), (5, 3), (1, 1)])
def test_exact_patches_hold_nothing_else(size):
    rows, columns = -(-size[1] // CELL), -(-size[0] // CELL)
    cells = np.random.default_rng(1).random((rows, columns)) < 0.6
    pixels = np.kron(cells, np.ones((CELL, CELL), bool))[: size[1], : size[0]]
    np.testing.assert_array_equal(shown(Patches.picked(cells, CELL, (CELL, 32), size, exactly=True), size), pixels)


def test_full_squares_are_large():
    cells = np.ones((16, 32), bool)
    cells[:8, :8] = False
    cells[0, 0] = True
    patches = Patches.picked(cells, CELL, (8, 32), (128, 64))
    assert sorted(patches.points[:, 2].tolist()) == [8.0] + [32.0] * 7


def test_where_nothing_is_picked_there_is_none():
    patches = Patches.picked(np.zeros((10, 17), bool), CELL, (8, 32), (67, 38))
    assert len(patches.points) == 0 and not patches.boxes
