"""Pixels that lie scattered over a picture, and the places side by side in which their rays are drawn: all lanes of a vector then have a ray."""

from __future__ import annotations

import moderngl
import numpy as np

from ..shapes import Bool, Int

WIDE = 1000
"""Places in a row of a list; no power of two, for which llvmpipe would compile programs anew (docs/llvmpipe.md)."""
_ROWS = 24  # what its number of rows is a multiple of: rarely another size
_LANES = 4, 2  # pixels beside and above each other that software renderers shade together
_BLOCK = 8  # pixels along the sides of the blocks whose rays follow each other in a list
_NONE = -1.0


class RayList:
    """Some pixels of a picture of `size`, and where in a list of rays each has its own.

    Attributes:
        count: how many there are.
        pixels: RG32F, of the list's size: column and row of each place's pixel, from the bottom left; below 0 behind the last.
        places: R32F, of the picture's size: the number of each pixel's place, row by row; below 0 where it has none.
    """

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int]):
        self._ctx, self._size = ctx, size
        self.count = 0
        self.places = ctx.texture(size, 1, dtype="f4")
        self.places.filter = moderngl.NEAREST, moderngl.NEAREST
        self._host = np.full(size[::-1], _NONE, np.float32)
        self._held: np.ndarray = np.empty(0, np.int64)  # the pixels, as numbers
        self.pixels = self._list(_ROWS)

    @property
    def held(self) -> Int[np.ndarray, " pixels"]:
        """The pixels, as they were given."""
        return self._held

    @property
    def size(self) -> tuple[int, int]:
        """Places along each axis of the list."""
        return self.pixels.size

    @property
    def rows(self) -> int:
        """Rows of it that hold all rays."""
        return rows_of(self.count)

    def hold(self, pixels: Int[np.ndarray, " pixels"]) -> None:
        """Lists `pixels`, each told by its number, row by row from the bottom left."""
        self._host.ravel()[self._held] = _NONE
        self._held = pixels
        self.count = len(pixels)
        if self.rows > self.size[1] or 3 * self.rows < self.size[1]:
            self.pixels.release()
            self.pixels = self._list(-(-max(self.rows, 1) // _ROWS) * _ROWS)
        if self.count:
            row, column = np.divmod(pixels, self._size[0])
            numbers = numbers_of(self.rows)
            self._host.ravel()[pixels] = numbers[: self.count]
            listed = np.full((numbers.size, 2), _NONE, np.float32)
            listed[numbers[: self.count]] = np.stack([column, row], axis=-1)
            self.pixels.write(listed.tobytes(), (0, 0, WIDE, self.rows))
        self.places.write(self._host.tobytes())

    def release(self) -> None:
        """Gives the GL objects back."""
        self.pixels.release()
        self.places.release()

    def _list(self, rows: int) -> moderngl.Texture:
        made = self._ctx.texture((WIDE, rows), 2, dtype="f4")
        made.filter = moderngl.NEAREST, moderngl.NEAREST
        return made


def rows_of(count: int) -> int:
    """Rows of a list that hold `count` rays."""
    return -(-count // (WIDE * _LANES[1])) * _LANES[1]


def numbers_of(rows: int) -> Int[np.ndarray, " places"]:
    """Of the places of that many rows, those that are shaded together one after the other."""
    return np.arange(WIDE * rows).reshape(-1, _LANES[1], WIDE // _LANES[0], _LANES[0]).swapaxes(1, 2).ravel()


def in_blocks(picked: Bool[np.ndarray, "height width"]) -> Int[np.ndarray, " pixels"]:
    """The numbers of the pixels `picked`, block by block, so that rays that are drawn together are neighbours."""
    height, width = picked.shape
    whole = np.zeros((-(-height // _BLOCK) * _BLOCK, -(-width // _BLOCK) * _BLOCK), bool)
    whole[:height, :width] = picked
    found = np.flatnonzero(whole.reshape(-1, _BLOCK, whole.shape[1] // _BLOCK, _BLOCK).swapaxes(1, 2))
    block, inside = np.divmod(found, _BLOCK * _BLOCK)
    block_row, block_column = np.divmod(block, whole.shape[1] // _BLOCK)
    row, column = np.divmod(inside, _BLOCK)
    return (_BLOCK * block_row + row) * width + _BLOCK * block_column + column
