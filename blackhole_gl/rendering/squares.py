"""Squares of a picture that are drawn alone, as points: one draw, whatever parts of the picture they make up."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache, reduce

import moderngl
import numpy as np

from ..shapes import Bool, Float, Int
from .boxes import Box, box_of, boxes_of

TOGETHER = 4
"""Pixels along each axis that software renderers shade together, whichever of them are asked for."""

_POINT = 12  # bytes

_SHORT = 4  # sides of blocks over which slices are the quicker way


@dataclass(frozen=True, eq=False)
class Squares:
    """Squares of ``side``² pixels each.

    Attributes:
        side: in pixels.
        places: column and row of each, counted in sides from the bottom left, int (N, 2).
        points: as shaders/fullscreen.vert takes them, float32 (N, 3).
    """

    side: int
    places: Int[np.ndarray, "squares 2"]
    points: Float[np.ndarray, "squares 3"]

    @classmethod
    def of(cls, places: Int[np.ndarray, "squares 2"], side: int, size: tuple[int, int]) -> Squares:
        """The squares at `places` of a picture of `size` pixels, at least `side` each way. Those that its upper or right edge cuts are moved inside, as a point
        whose middle lies outside is not drawn at all."""
        corner = np.minimum(side * places, np.array(size) - side)
        middle = (2.0 * corner + side) / np.array(size) - 1.0
        points = np.empty((len(places), 3), np.float32)
        points[:, :2], points[:, 2] = middle, side
        return cls(side, places, points)

    @classmethod
    def holding(cls, pixels: Int[np.ndarray, "pixels 2"], side: int, size: tuple[int, int]) -> Squares:
        """Those of a picture of `size` that hold any of `pixels`, column and row each."""
        columns, rows = -(-size[0] // side), -(-size[1] // side)
        held = np.zeros(columns * rows, bool)
        held[pixels // side @ (1, columns)] = True
        row, column = np.divmod(np.flatnonzero(held), columns)
        return cls.of(np.stack([column, row], axis=-1), side, size)

    @classmethod
    def picked(cls, cells: Bool[np.ndarray, "rows columns"], side: int, size: tuple[int, int]) -> Squares:
        """Those of a picture of `size` whose cell of `side` pixels each way is picked."""
        return cls.of(np.argwhere(cells)[:, ::-1], side, size)

    def __len__(self) -> int:
        return len(self.places)

    def box(self, size: tuple[int, int]) -> tuple[int, int, int, int]:
        """x, y, width and height of the smallest part of a picture of `size` that holds them all."""
        x, y = (self.side * self.places.min(axis=0)).tolist()
        right, top = np.minimum(self.side * (self.places.max(axis=0) + 1), size).tolist()
        return x, y, right - x, top - y

    def boxes(self, size: tuple[int, int]) -> Iterator[Box]:
        """Boxes in pixels that hold them all, of a picture of `size`: of each few rows those that lie together."""
        return boxes_of(self.mask(size, self.side), self.side)

    def holds(self, pixels: Int[np.ndarray, "pixels 2"], size: tuple[int, int]) -> np.ndarray:
        """Which of `pixels`, column and row each, lie in them, bool (N,)."""
        return self.mask(size, self.side)[pixels[:, 1] // self.side, pixels[:, 0] // self.side]

    def mask(self, size: tuple[int, int], cell: int) -> np.ndarray:
        """Which of the cells of `cell` pixels each way, a part of the side, of a picture of `size` lie in them, bool (rows, columns)."""
        marked = np.zeros((-(-size[1] // self.side), -(-size[0] // self.side)), bool)
        marked[self.places[:, 1], self.places[:, 0]] = True
        parts = self.side // cell
        return np.kron(marked, np.ones((parts, parts), bool))[: -(-size[1] // cell), : -(-size[0] // cell)]


@dataclass(frozen=True, eq=False)
class Patches:
    """Squares of a few sizes, and boxes where the picture's upper and right edges would cut some. No pixel lies in two of them.

    Attributes:
        points: the squares as shaders/fullscreen.vert takes them, float32 (N, 3).
    """

    points: Float[np.ndarray, "squares 3"]
    boxes: tuple[Box, ...]

    @classmethod
    def picked(
        cls, cells: Bool[np.ndarray, "rows columns"], cell: int, sides: tuple[int, ...], size: tuple[int, int], *, exactly: bool = False
    ) -> Patches:
        """Those of a picture of `size` that hold all of its `cells`, of `cell` pixels each way, that are picked: squares of the smallest of `sides` which
        hold any, and one of a larger, each a multiple of that before it, in the place of those that it is full of. `exactly`: and no others, if the smallest
        side is that of a cell."""
        smallest, *larger = (side // cell for side in sides)
        columns, rows = (side // sides[0] * smallest for side in size)
        left = np.zeros((rows + -rows % larger[-1], columns + -columns % larger[-1]), bool)
        left[:rows, :columns] = cells[:rows, :columns]
        points = []
        for side in reversed(larger):
            full = _of_blocks(np.logical_and, left, side)
            left &= ~full.repeat(side, axis=1).repeat(side, axis=0)
            points.append(_points(full, side * cell, size))
        points.append(_points(_of_blocks(np.logical_or, left, smallest), sides[0], size))
        return cls(np.concatenate(points), tuple(_cut(cells, rows, columns, cell, size, exactly)))


def _cut(cells: Bool[np.ndarray, "rows columns"], rows: int, columns: int, cell: int, size: tuple[int, int], exactly: bool) -> Iterator[Box]:
    """What holds the cells that are picked beyond the first `rows` and `columns`."""
    for first, part in ((columns, cells[:, columns:]), (0, cells[:, :columns] & (np.arange(len(cells)) >= rows)[:, None])):
        for piece in _together(part) if exactly else [part] if part.any() else []:
            x, y, width, height = box_of(piece, (size[0] - first * cell, size[1]), cell)
            yield first * cell + x, y, width, height


def _together(cells: Bool[np.ndarray, "rows columns"]) -> Iterator[Bool[np.ndarray, "rows columns"]]:
    """Those of each row that lie together."""
    for row in np.flatnonzero(cells.any(axis=1)):
        for left, right in np.flatnonzero(np.diff(cells[row].astype(np.int8), prepend=0, append=0)).reshape(-1, 2):
            piece = np.zeros(cells.shape, bool)
            piece[row, left:right] = True
            yield piece


def _of_blocks(of_two: np.ufunc, cells: Bool[np.ndarray, "rows columns"], side: int) -> np.ndarray:
    """What `of_two` makes of each block of `side`² cells."""
    if side > _SHORT:
        rows = of_two.reduce(cells.reshape(len(cells) // side, side, cells.shape[1]), axis=1)
        return of_two.reduce(rows.reshape(len(rows), rows.shape[1] // side, side), axis=2)
    rows = reduce(of_two, (cells[k::side] for k in range(side)))
    return reduce(of_two, (rows[:, k::side] for k in range(side)))


def _points(held: np.ndarray, side: int, size: tuple[int, int]) -> Float[np.ndarray, "squares 3"]:
    """The squares of `side` pixels that are `held`, none of which an edge of the picture cuts, as shaders/fullscreen.vert takes them."""
    return _all_points(held.shape, side, size).take(np.flatnonzero(held), axis=0)


@lru_cache(maxsize=8)
def _all_points(shape: tuple[int, int], side: int, size: tuple[int, int]) -> Float[np.ndarray, "squares 3"]:
    """The same where all of so many rows and columns are held."""
    points = np.empty((*shape, 3), np.float32)
    points[..., 0] = (2 * np.arange(shape[1]) + 1) * (side / size[0]) - 1.0
    points[..., 1] = ((2 * np.arange(shape[0]) + 1) * (side / size[1]) - 1.0)[:, None]
    points[..., 2] = side
    return points.reshape(-1, 3)


class SquareBuffer:
    """The points of the squares that are drawn next, for all programs of a context."""

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self._made: moderngl.Buffer | None = None

    @property
    def _buffer(self) -> moderngl.Buffer:
        if self._made is None:
            self._made = self._ctx.buffer(reserve=_POINT, dynamic=True)
        return self._made

    def array(self, program: moderngl.Program) -> moderngl.VertexArray:
        """What `draw` draws `program` with; of a program that takes no squares, nothing that can be."""
        return self._ctx.vertex_array(program, [(self._buffer, "3f", "square")] if "square" in program else [])

    def draw(self, array: moderngl.VertexArray, points: Float[np.ndarray, "squares 3"]) -> None:
        """Draws the squares at `points` of the bound target; none where there are none."""
        if not len(points):
            return
        data = points.tobytes()
        if len(data) > self._buffer.size:
            self._buffer.orphan(2 * len(data))
        self._buffer.write(data)
        self._ctx.enable(moderngl.PROGRAM_POINT_SIZE)
        array.render(moderngl.POINTS, vertices=len(points))
        self._ctx.disable(moderngl.PROGRAM_POINT_SIZE)

    def release(self) -> None:
        """Gives the GL object back; what `array` made is of no use then. There is a new one for what is drawn after that."""
        if self._made is not None:
            self._made.release()
            self._made = None
