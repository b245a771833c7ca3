"""Bounding volume hierarchies, laid out for shaders that walk them without a stack (shaders/common/hierarchy.glsl).

Nodes lie in depth-first order: the first child of a node is the next one, and each tells where the walk goes on beyond it. Halves are cut at the median along
the longest side, a whole level at a time, so that 10,000 boxes take some tens of milliseconds.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..shapes import Float, Int

ROW = 256
"""Nodes in a row of the texture, two texels each."""

MOST_IN_LEAF = 4


@dataclass(frozen=True)
class Hierarchy:
    """What encloses N boxes.

    Attributes:
        low, high: float64 (M, 3), the nodes' boxes.
        beyond: (M,) node with which the walk goes on past this one and all below it; −1 at the end.
        first: (M,) place in `order` of a leaf's first box, −1 for inner nodes.
        count: (M,) boxes of a leaf, 0 for inner nodes.
        order: (N,) the boxes as leaves have them.
    """

    low: Float[np.ndarray, "M 3"]
    high: Float[np.ndarray, "M 3"]
    beyond: Int[np.ndarray, " M"]
    first: Int[np.ndarray, " M"]
    count: Int[np.ndarray, " M"]
    order: Int[np.ndarray, " N"]

    def texels(self, leaves: Int[np.ndarray, " M"]) -> Float[np.ndarray, "rows columns 4"]:
        """The texture: low and `beyond`, high and the number in `leaves` of a leaf, −1 for inner nodes; float32, boxes rounded outwards."""
        rows = max(-(-len(self.beyond) // ROW), 3) | 1  # an odd number is no power of two (docs/llvmpipe.md)
        found = np.zeros((rows * ROW, 2, 4), np.float32)
        found[:, 0, :3], found[:, 1, :3], found[:, :, 3] = 1e30, -1e30, -1.0  # boxes that hold nothing
        used = found[: len(self.beyond)]
        used[:, 0, :3] = np.nextafter(self.low.astype(np.float32), np.float32(-np.inf))
        used[:, 1, :3] = np.nextafter(self.high.astype(np.float32), np.float32(np.inf))
        used[:, 0, 3], used[:, 1, 3] = self.beyond, np.where(self.count > 0, leaves, -1)
        return found.reshape(rows, 2 * ROW, 4)


def build(low: Float[np.ndarray, "N 3"], high: Float[np.ndarray, "N 3"], in_leaf: int = 1) -> Hierarchy:
    """The hierarchy of the boxes from `low` to `high`, at most `in_leaf` (1 to `MOST_IN_LEAF`) of them in a leaf."""
    order, size = np.arange(len(low)), _nodes(len(low), in_leaf)
    bounds = np.zeros((2, size, 3))
    beyond, first, count = (np.full(size, fill) for fill in (-1, -1, 0))
    start, length, node, after = (np.array([value] if size else [], int) for value in (0, len(low), 0, -1))
    while node.size:
        taken = np.concatenate([np.arange(a, a + n) for a, n in zip(start, length)])
        cut = np.cumsum(length) - length
        items = order[taken]
        bounds[0, node], bounds[1, node] = np.minimum.reduceat(low[items], cut), np.maximum.reduceat(high[items], cut)
        beyond[node] = after
        is_leaf = length <= in_leaf
        first[node[is_leaf]], count[node[is_leaf]] = start[is_leaf], length[is_leaf]
        centre = low[items] + high[items]
        longest = np.argmax(np.maximum.reduceat(centre, cut) - np.minimum.reduceat(centre, cut), axis=1)
        part = np.repeat(np.arange(node.size), length)
        order[taken] = items[np.lexsort((centre[np.arange(len(items)), longest[part]], part))]
        start, length, node, after = _children(start[~is_leaf], length[~is_leaf], node[~is_leaf], after[~is_leaf], in_leaf)
    return Hierarchy(bounds[0], bounds[1], beyond, first, count, order)


def _children(start: np.ndarray, length: np.ndarray, node: np.ndarray, after: np.ndarray, in_leaf: int) -> tuple[np.ndarray, ...]:
    """The halves of what is no leaf: place of the first box, boxes, node, node beyond."""
    left = (length + 1) // 2
    second = node + 1 + np.array([_nodes(int(n), in_leaf) for n in left], int)
    both = (start, start + left), (left, length - left), (node + 1, second), (second, after)
    return tuple(np.stack(pair, axis=1).reshape(-1) for pair in both)


@lru_cache(maxsize=4096)
def _nodes(boxes: int, in_leaf: int) -> int:
    """Nodes of the hierarchy of so many boxes."""
    if boxes <= in_leaf:
        return int(boxes > 0)
    left = (boxes + 1) // 2
    return 1 + _nodes(left, in_leaf) + _nodes(boxes - left, in_leaf)
