"""Which pixel at an edge has which block of rays: where some of the picture has changed, blocks whose pixel lies in the rest are kept."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..shapes import Bool, Float, Int
from .ray_blocks import FreshBlocks
from .squares import TOGETHER, Squares

# Blocks beside each other in the map that holds them, and what number of rows it has a multiple of: a map that keeps its size keeps its textures. Neither
# sides of blocks nor of the map are powers of two, for which llvmpipe would compile each program that reads it anew.
_IN_A_ROW, _ROWS = 120, 2

_MOST_OF_MAP = 0.75  # of its blocks, above which all are drawn, those that are nobody's too, in one draw


@dataclass(frozen=True, eq=False)
class EdgeBlocks:
    """Pixels at edges and their blocks.

    Attributes:
        pixels: column and row of each, from the bottom left, int (N, 2).
        numbers: of each pixel's block, two by two and those row by row, so that blocks with numbers side by side lie together both ways; int (N,).
        rows: of blocks that the map has room for; some are nobody's.
        seeking: whether the rays of each pixel's block look for things and media; bool (N,).
    """

    pixels: Int[np.ndarray, "pixels 2"]
    numbers: Int[np.ndarray, " pixels"]
    rows: int
    seeking: Bool[np.ndarray, " pixels"]

    @classmethod
    def of(cls, pixels: Int[np.ndarray, "pixels 2"], seeking: Bool[np.ndarray, " pixels"], *, room: int = 0) -> EdgeBlocks:
        """Blocks for `pixels`, one after the other, those `seeking` first; with `room` for so many at least."""
        numbers = np.empty(len(pixels), int)
        numbers[np.argsort(~seeking, kind="stable")] = np.arange(len(pixels))
        return cls(pixels, numbers, _rows_for(max(len(pixels), room)), seeking)

    @property
    def size(self) -> tuple[int, int]:
        """Blocks along each axis of the map."""
        return _IN_A_ROW, self.rows

    @cached_property
    def places(self) -> Int[np.ndarray, "pixels 2"]:
        """Column and row of each pixel's block."""
        return _places(self.numbers)

    @property
    def shifts(self) -> Float[np.ndarray, "rows columns 2"]:
        """Each block's pixel less its place in the map, float32; those that are nobody's have the pixel −1."""
        pixels = np.full((self.rows, _IN_A_ROW, 2), -1.0, np.float32)
        columns, rows = self.places.T
        pixels[rows, columns] = self.pixels
        pixels[..., 0] -= np.arange(_IN_A_ROW)
        pixels[..., 1] -= np.arange(self.rows)[:, None]
        return pixels

    def after(
        self, pixels: Int[np.ndarray, "pixels 2"], seeking: Bool[np.ndarray, " pixels"], changed: Squares, size: tuple[int, int]
    ) -> tuple[EdgeBlocks, Bool[np.ndarray, " pixels"]] | None:
        """The blocks once `changed` of a picture of `size` are other than before and `pixels` are at edges, and which of them have rays still to be traced, as
        have those that look for things now and did not; None where there is no room for them."""
        old, new = (2 * (picked[:, 1] * size[0] + picked[:, 0]) + sought for picked, sought in ((self.pixels, self.seeking), (pixels, seeking)))
        standing = np.flatnonzero(~changed.holds(self.pixels, size))
        _, of_old, of_new = np.intersect1d(old[standing], new, assume_unique=True, return_indices=True)
        numbers = np.full(len(pixels), -1)
        numbers[of_new] = self.numbers[standing[of_old]]
        fresh = numbers < 0
        free = np.setdiff1d(np.arange(_IN_A_ROW * self.rows), numbers[~fresh], assume_unique=True)
        if len(free) < np.count_nonzero(fresh):
            return None
        first, last = np.flatnonzero(fresh & seeking), np.flatnonzero(fresh & ~seeking)  # apart, as each kind is drawn by itself
        numbers[first], numbers[last] = free[: len(first)], free[len(free) - len(last) :]
        return EdgeBlocks(pixels, numbers, self.rows, seeking), fresh

    def fresh(self, picked: Bool[np.ndarray, " pixels"], side: int, *, all_new: bool) -> FreshBlocks:
        """The blocks `picked` of a map of blocks of `side`² rays, which is `all_new`, with all of them picked, or holds the others already."""
        if all_new and self.seeking.all() and len(self.pixels) > _MOST_OF_MAP * self.size[0] * self.size[1]:
            return FreshBlocks((), (), None)
        group = _numbers_of(self.places // _together(side))
        seek = np.bincount(group, self.seeking)
        mixed = ((seek > 0.0) & (seek < np.bincount(group)))[group]
        seeking, others = (self._squares(picked & kind, group, mixed, side) for kind in (self.seeking, ~self.seeking))
        return FreshBlocks(seeking, others, None if all_new else self._groups(group[picked], side))

    def _squares(
        self, picked: Bool[np.ndarray, " pixels"], group: Int[np.ndarray, " pixels"], mixed: Bool[np.ndarray, " pixels"], side: int
    ) -> tuple[Squares, ...]:
        """The squares of the map that hold the blocks `picked`. Blocks of a `group`, which are shaded together, lie in one square unless they are `mixed`, as
        not all look for the same: then each has a square of its own."""
        return self._groups(group[picked & ~mixed], side), Squares.of(self.places[picked & mixed], side, self._size_of_map(side))

    def _groups(self, numbers: Int[np.ndarray, " groups"], side: int) -> Squares:
        """The squares of all that is shaded together, by the numbers that `_numbers_of` gives, each once."""
        rows, columns = np.divmod(np.flatnonzero(np.bincount(numbers)), _IN_A_ROW)
        return Squares.of(np.stack([columns, rows], axis=-1), _together(side) * side, self._size_of_map(side))

    def _size_of_map(self, side: int) -> tuple[int, int]:
        return side * self.size[0], side * self.size[1]


def _rows_for(blocks: int) -> int:
    """Rows of a map with room for `blocks`: never a power of two, for which llvmpipe would finish each program that draws into the map or reads it anew."""
    rows = max(-(-blocks // (_IN_A_ROW * _ROWS)), 1) * _ROWS
    while rows & (rows - 1) == 0:
        rows += _ROWS
    return rows


def _together(side: int) -> int:
    """Blocks of `side`² rays, along each axis, that are shaded together."""
    return max(TOGETHER // side, 1)


def _numbers_of(places: Int[np.ndarray, "places 2"]) -> Int[np.ndarray, " places"]:
    """A number for each place in rows as long as the map's."""
    return places[:, 1] * _IN_A_ROW + places[:, 0]


def _places(numbers: np.ndarray) -> np.ndarray:
    fours, one = np.divmod(numbers, 4)
    rows, columns = np.divmod(fours, _IN_A_ROW // 2)
    return np.stack([2 * columns + one % 2, 2 * rows + one // 2], axis=-1)
