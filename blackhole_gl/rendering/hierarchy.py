"""Bounding volume hierarchies, laid out for shaders that walk them without a stack (shaders/common/hierarchy.glsl).

Nodes lie in depth-first order: the first child of a node is the next one, and each tells where the walk goes on beyond it. Boxes are parted where
the two halves have the least surface to be met, along any axis between any eighths of them; a whole level at a time, so that 10,000 boxes take a
tenth of a second.

A node is one texel, as texels are what a walk takes its time for: its box is widened to whole cells of a cubic lattice, 16 bits a side.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..shapes import Bool, Float, Int

ROW = 256
"""Nodes in a row of the texture."""

FIRST = 1
"""Number of the first node; in the place of number 0 lies the lattice."""

_CELLS = 65535

_CUTS = 8  # parts of as many boxes, between which a node may be cut


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

    def texels(self, leaves: Int[np.ndarray, " M"]) -> Int[np.ndarray, "rows columns 4"]:
        """The texture, int32, as shaders/common/hierarchy.glsl describes it; `leaves` is what leaves hold, less than 2³⁰."""
        corner, cell = self._lattice()
        rows = max(-(-(len(self.beyond) + FIRST) // ROW), 3) | 1  # an odd number is no power of two (docs/llvmpipe.md)
        found = np.zeros((rows * ROW, 4), np.int32)
        found[:, :3] = _CELLS  # boxes that hold nothing
        found[0] = np.append(corner, cell).view(np.int32)
        # Shaders round, too: places are no finer than a small part of a cell.
        low, high = np.floor((self.low - corner) / cell - 0.01), np.ceil((self.high - corner) / cell + 0.01)
        used = found[FIRST:][: len(self.beyond)]
        used[:, :3] = (low.astype(np.int64) | high.astype(np.int64) << 16).astype(np.uint32).view(np.int32)
        after = np.where(self.beyond < 0, 0, self.beyond + FIRST)
        used[:, 3] = np.where(self.count > 0, -1 - 2 * leaves - (self.beyond < 0), after)
        return found.reshape(rows, ROW, 4)

    def _lattice(self) -> tuple[Float[np.ndarray, " 3"], np.float32]:
        """Corner and width of a cell, float32: two cells of room on either side of all boxes, and no cell finer than the corner is rounded by."""
        if not len(self.low):
            return np.zeros(3, np.float32), np.float32(1.0)
        low, high = self.low.min(axis=0), self.high.max(axis=0)
        cell = np.float32(max(np.max(high - low) / (_CELLS - 4), 1e-7 * np.max(np.abs([low, high])), 1e-20))
        return (low - 2.0 * cell).astype(np.float32), cell


def build(low: Float[np.ndarray, "N 3"], high: Float[np.ndarray, "N 3"]) -> Hierarchy:
    """The hierarchy of the boxes from `low` to `high`, one in each leaf."""
    sorted_by = (low + high).argsort(axis=0, kind="stable").T  # boxes along each axis; those of a node lie together in all three
    start, length = (np.array([value] if len(low) else [], int) for value in (0, len(low)))
    levels: list[_Level] = []
    while start.size:
        cut = length.cumsum() - length
        taken = (start - cut).repeat(length) + np.arange(length.sum())
        items = sorted_by[0, taken]
        bounds = np.minimum.reduceat(low[items], cut), np.maximum.reduceat(high[items], cut)
        inner = length > 1
        levels.append(_Level(*bounds, start, length, inner))
        taken, start, length = taken[inner.repeat(length)], start[inner], length[inner]
        if start.size:
            halves, _ = halved(low, high, sorted_by, taken, length, len(low))
            start, length = _in_turn(start, start + halves), _in_turn(halves, length - halves)
    return _laid_out(levels, sorted_by[0])


def both(one: Hierarchy, other: Hierarchy) -> Hierarchy:
    """The hierarchy of the boxes of `one` and then those of the `other`, each of which encloses some."""
    second, boxes = 1 + len(one.beyond), len(one.order)
    return Hierarchy(
        np.concatenate([np.minimum(one.low[:1], other.low[:1]), one.low, other.low]),
        np.concatenate([np.maximum(one.high[:1], other.high[:1]), one.high, other.high]),
        np.concatenate([[-1], np.where(one.beyond < 0, second, one.beyond + 1), np.where(other.beyond < 0, -1, other.beyond + second)]),
        np.concatenate([[-1], one.first, np.where(other.first < 0, -1, other.first + boxes)]),
        np.concatenate([[0], one.count, other.count]),
        np.concatenate([one.order, other.order + boxes]),
    )


def _in_turn(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.array((first, second)).T.reshape(-1)


@dataclass(frozen=True, eq=False)
class _Level:
    """Nodes as far below the root, those of the same parent beside each other: boxes, place of the first item and number of items, and which have children."""

    low: Float[np.ndarray, "nodes 3"]
    high: Float[np.ndarray, "nodes 3"]
    start: Int[np.ndarray, " nodes"]
    length: Int[np.ndarray, " nodes"]
    inner: Bool[np.ndarray, " nodes"]


def halved(
    low: np.ndarray, high: np.ndarray, sorted_by: np.ndarray, taken: np.ndarray, length: np.ndarray, most: int
) -> tuple[Int[np.ndarray, " nodes"], Int[np.ndarray, " nodes"]]:
    """Parts nodes of `length` items, which lie at `taken` one node behind the other, in halves of `most` at most, and puts the items of the first half first.

    Returns:
        How many those are, and along which axis the others lie behind them.
    """
    cut, nodes = length.cumsum() - length, np.arange(len(length))
    items = sorted_by[:, taken]
    firsts = (length[:, None] * np.arange(1, _CUTS)) // _CUTS  # how many are before each cut
    costs = np.where((firsts <= most) & (length[:, None] - firsts <= most), _costs(low[items], high[items], cut, length, firsts), np.inf)
    axis, place = np.divmod(costs.transpose(1, 0, 2).reshape(len(length), -1).argmin(axis=1), _CUTS - 1)
    halves = firsts[nodes, place]
    middles = (cut + halves).repeat(length)
    here = np.arange(len(taken))
    is_second = np.empty(len(low), bool)
    is_second[items[axis.repeat(length), here]] = here >= middles
    second = is_second[items]
    before = second.cumsum(axis=1) - second
    before -= before[:, cut].repeat(length, axis=1)  # of the second half, in the same node
    places = taken[np.where(second, middles + before, here - before)]
    sorted_by[np.arange(3)[:, None], places] = items
    return halves, axis


def _costs(low: np.ndarray, high: np.ndarray, cut: np.ndarray, length: np.ndarray, firsts: np.ndarray) -> Float[np.ndarray, "3 nodes cuts"]:
    """What a walk takes at the halves of each node by each cut: their surfaces, as rays meet a box by its surface, times their boxes.

    Args:
        low, high: of the items in order along each axis, (3, items, 3).
        cut, length: of each node's items. firsts: how many of them come before each cut.
    """
    ends = np.concatenate([np.zeros((len(cut), 1), int), firsts, length[:, None]], axis=1)
    empty = (ends[:, 1:] == ends[:, :-1])[..., None]
    begins, shape = (cut[:, None] + ends[:, :-1]).reshape(-1), (3, len(cut), _CUTS, 3)  # the last part of a node is never empty
    lows = np.where(empty, np.inf, np.minimum.reduceat(low, begins, axis=1).reshape(shape))
    highs = np.where(empty, -np.inf, np.maximum.reduceat(high, begins, axis=1).reshape(shape))
    before = _surface(np.minimum.accumulate(lows, axis=2), np.maximum.accumulate(highs, axis=2))[..., :-1]
    after = _surface(np.minimum.accumulate(lows[:, :, ::-1], axis=2), np.maximum.accumulate(highs[:, :, ::-1], axis=2))[..., -2::-1]
    return np.where(firsts > 0, before * firsts + after * (length[:, None] - firsts), np.inf)


def _surface(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Half of the surface of boxes (…, 3), 0 of those that hold nothing."""
    sides = np.maximum(high - low, 0.0)
    x, y, z = sides[..., 0], sides[..., 1], sides[..., 2]
    return x * (y + z) + y * z


def _laid_out(levels: list[_Level], order: np.ndarray) -> Hierarchy:
    """The nodes of all levels in depth-first order."""
    sizes: list[np.ndarray] = []  # nodes from each on down
    for level in reversed(levels):
        size = np.ones(len(level.start), int)
        if sizes:
            size[level.inner] += sizes[-1][::2] + sizes[-1][1::2]
        sizes.append(size)
    sizes.reverse()
    number, after = np.zeros(min(len(levels), 1), int), np.full(min(len(levels), 1), -1)
    count = int(sizes[0][0]) if levels else 0
    box, none = np.zeros((2, count, 3)), np.full((2, count), -1)
    made = Hierarchy(box[0], box[1], none[0], none[1], np.zeros(count, int), order)
    for level, below in zip(levels, [*sizes[1:], np.zeros(0, int)]):
        made.low[number], made.high[number], made.beyond[number] = level.low, level.high, after
        leaves = ~level.inner
        made.first[number[leaves]], made.count[number[leaves]] = level.start[leaves], level.length[leaves]
        first = number[level.inner] + 1
        second = first + below[::2]
        number, after = _in_turn(first, second), _in_turn(second, after[level.inner])
    return made
