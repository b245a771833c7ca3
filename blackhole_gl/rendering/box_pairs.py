"""Boxes of a mesh's triangles, two by two, in a binary tree without links: shaders/common/box_pairs.glsl walks it.

Below the node i lie the nodes 2 i and 2 i + 1, whose boxes are one texel, as texels are what a walk takes its time for. All branches are as long, and have
room for as many triangles: boxes are parted where the two halves have the least surface to be met, as in hierarchy.py, but no half is larger than that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..shapes import Float, Int
from . import hierarchy

IN_LEAF = 2
"""Triangles in a leaf at most; a node of the lowest level has two leaves."""

_CELLS = 510  # of the lattice in a unit of length, from −1 to 1 and one more on both sides
_NOWHERE = 1023 * (1 + (1 << 10) + (1 << 20))  # a box that holds nothing, in a corner of the lattice, where no mesh is


@dataclass(frozen=True)
class BoxPairs:
    """The tree of a mesh of N triangles within the unit ball.

    Attributes:
        levels: of its nodes, of which there are 2^levels − 1.
        texels: int32 (2^levels, 4), as shaders/common/box_pairs.glsl describes them; the nodes from number 1 on.
        places: (N,) where each triangle lies, of 2·`IN_LEAF`·2^(levels − 1) places.
    """

    levels: int
    texels: Int[np.ndarray, "nodes 4"]
    places: Int[np.ndarray, " N"]


def build(corners: Float[np.ndarray, "N 3 3"]) -> BoxPairs:
    """The tree of triangles with those corners, within the unit ball."""
    low, high, count = corners.min(axis=1).astype(float), corners.max(axis=1).astype(float), len(corners)
    levels = max((-(-count // IN_LEAF) - 1).bit_length(), 1)
    sorted_by = (low + high).argsort(axis=0, kind="stable").T
    start, length = np.zeros(1, int), np.full(1, count)
    texels = np.zeros((1 << levels, 4), np.int64)
    texels[0, 0] = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max().astype(np.float32).view(np.uint32)
    nodes = texels[:0]
    for level in range(levels):
        halves, axis = np.zeros(len(length), int), np.zeros(len(length), int)
        full = length > 0
        halves[full], axis[full] = hierarchy.halved(low, high, sorted_by, np.arange(count), length[full], IN_LEAF << (levels - level - 1))
        start, length = _in_turn(start, start + halves), _in_turn(halves, length - halves)
        corners = np.full((2, len(length)), _NOWHERE)
        full = length > 0
        lows, highs = np.minimum.reduceat(low[sorted_by[0]], start[full]), np.maximum.reduceat(high[sorted_by[0]], start[full])
        # Shaders round, too: places are no finer than a small part of a cell.
        corners[0, full] = _packed(np.floor(lows * _CELLS + (_CELLS + 0.99)))
        corners[1, full] = _packed(np.ceil(highs * _CELLS + (_CELLS + 1.01)))
        nodes = texels[1 << level : 2 << level]
        nodes[:] = corners.reshape(2, -1, 2).swapaxes(0, 1).reshape(-1, 4)
        nodes[:, 2] |= axis << 30
    nodes[:, :2] |= length.reshape(-1, 2) << 30
    places = np.empty(count, int)
    lowest = np.arange(len(nodes))
    places[sorted_by[0]] = np.arange(count) + (2 * IN_LEAF * lowest - start[::2]).repeat(length.reshape(-1, 2).sum(axis=1))
    return BoxPairs(levels, texels.astype(np.uint32).view(np.int32), places)


def _in_turn(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.array((first, second)).T.reshape(-1)


def _packed(cells: Float[np.ndarray, "boxes 3"]) -> Int[np.ndarray, " boxes"]:
    """The three as ten bits each."""
    x, y, z = np.clip(cells, 0, 1022).astype(np.int64).T
    return x | y << 10 | z << 20
