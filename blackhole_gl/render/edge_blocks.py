"""Which pixel at an edge has which block of rays: where some of the picture has changed, blocks whose pixel lies in the rest are kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..shapes import Int
from .squares import Squares

# Blocks beside each other in the map that holds them, and what number of rows it has a multiple of: a map that keeps its size keeps its textures.
_IN_A_ROW, _ROWS = 128, 4

# Pixels along each axis that software renderers shade together, whichever of them are asked for.
_TOGETHER = 4


@dataclass(frozen=True, eq=False)
class EdgeBlocks:
    """Pixels at edges and their blocks.

    Attributes:
        pixels: column and row of each, from the bottom left, int (N, 2).
        numbers: of each pixel's block, two by two and those row by row, so that blocks with numbers side by side lie together both ways; int (N,).
        rows: of blocks that the map has room for; some are nobody's.
    """

    pixels: Int[np.ndarray, "pixels 2"]
    numbers: Int[np.ndarray, " pixels"]
    rows: int

    @classmethod
    def of(cls, pixels: Int[np.ndarray, "pixels 2"]) -> EdgeBlocks:
        """Blocks for `pixels`, one after the other."""
        return cls(pixels, np.arange(len(pixels)), _rows_for(len(pixels)))

    @property
    def size(self) -> tuple[int, int]:
        """Blocks along each axis of the map."""
        return _IN_A_ROW, self.rows

    @property
    def places(self) -> Int[np.ndarray, "pixels 2"]:
        """Column and row of each pixel's block."""
        return _places(self.numbers)

    @property
    def pixel_of_block(self) -> np.ndarray:
        """Each block's pixel, row by row, float32 (blocks, 2); 0 for those that are nobody's."""
        found = np.zeros((self.rows, _IN_A_ROW, 2), np.float32)
        columns, rows = self.places.T
        found[rows, columns] = self.pixels
        return found.reshape(-1, 2)

    def after(self, pixels: Int[np.ndarray, "pixels 2"], changed: Squares, size: tuple[int, int]) -> tuple[EdgeBlocks, Int[np.ndarray, "fresh 2"]] | None:
        """The blocks once `changed` of a picture of `size` are other than before and `pixels` are at edges, and the places of those whose rays are still to be
        traced; None where there is no room for them."""
        old, new = (picked[:, 1] * size[0] + picked[:, 0] for picked in (self.pixels, pixels))
        standing = np.flatnonzero(~changed.holds(self.pixels, size))
        _, of_old, of_new = np.intersect1d(old[standing], new, assume_unique=True, return_indices=True)
        numbers = np.full(len(pixels), -1)
        numbers[of_new] = self.numbers[standing[of_old]]
        fresh = numbers < 0
        free = np.setdiff1d(np.arange(_IN_A_ROW * self.rows), numbers[~fresh], assume_unique=True)
        if len(free) < np.count_nonzero(fresh):
            return None
        numbers[fresh] = free[: np.count_nonzero(fresh)]
        return EdgeBlocks(pixels, numbers, self.rows), _places(numbers[fresh])


def _rows_for(blocks: int) -> int:
    """Rows of a map with room for `blocks`: never a power of two, for which llvmpipe would finish each program that draws into the map or reads it anew."""
    rows = max(-(-blocks // (_IN_A_ROW * _ROWS)), 1) * _ROWS
    while rows & (rows - 1) == 0:
        rows += _ROWS
    return rows


def squares_of(places: Int[np.ndarray, "blocks 2"], side: int, size: tuple[int, int]) -> Squares:
    """The squares of a map of `size` that hold the blocks of `side`² rays at `places`: of as many as are shaded together, others' too."""
    blocks = max(_TOGETHER // side, 1)
    return Squares.of(np.unique(places // blocks, axis=0), blocks * side, size)


def _places(numbers: np.ndarray) -> np.ndarray:
    fours, one = np.divmod(numbers, 4)
    rows, columns = np.divmod(fours, _IN_A_ROW // 2)
    return np.stack([2 * columns + one % 2, 2 * rows + one // 2], axis=-1)
