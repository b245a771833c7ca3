"""Squares of a picture that are drawn alone, as points: one draw, whatever parts of the picture they make up."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import moderngl
import numpy as np

from ..shapes import Bool, Float, Int
from .boxes import Box, boxes_of

TOGETHER = 4
"""Pixels along each axis that software renderers shade together, whichever of them are asked for."""

_POINT = 12  # bytes


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
    """Squares of two sizes.

    Attributes:
        points: as shaders/fullscreen.vert takes them, float32 (N, 3).
    """

    points: Float[np.ndarray, "squares 3"]

    @classmethod
    def picked(cls, cells: Bool[np.ndarray, "rows columns"], cell: int, sides: tuple[int, int], size: tuple[int, int]) -> Patches:
        """Those of a picture of `size` that hold all of its `cells`, of `cell` pixels each way, that are picked: squares of the smaller of two `sides` which
        hold any, and one of the larger, which is a multiple of it, in the place of those that it is full of."""
        small, large = (side // cell for side in sides)
        rows, columns = cells.shape
        left = np.pad(cells, ((0, -rows % large), (0, -columns % large)))
        full = np.logical_and.reduce(_blocks(left, large), axis=(1, 3))
        left &= ~full.repeat(large, axis=0).repeat(large, axis=1)
        some = np.logical_or.reduce(_blocks(left, small), axis=(1, 3))
        return cls(np.concatenate([Squares.picked(some, sides[0], size).points, Squares.picked(full, sides[1], size).points]))

    def __len__(self) -> int:
        return len(self.points)


def _blocks(cells: np.ndarray, side: int) -> np.ndarray:
    """The view (rows, side, columns, side) of `cells`, whose sides are multiples of `side`."""
    rows, columns = cells.shape
    return cells.reshape(rows // side, side, columns // side, side)


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

    def draw(self, array: moderngl.VertexArray, squares: Squares | Patches) -> None:
        """Draws `squares` of the bound target; none where there are none."""
        if not len(squares):
            return
        data = squares.points.tobytes()
        if len(data) > self._buffer.size:
            self._buffer.orphan(2 * len(data))
        self._buffer.write(data)
        self._ctx.enable(moderngl.PROGRAM_POINT_SIZE)
        array.render(moderngl.POINTS, vertices=len(squares))
        self._ctx.disable(moderngl.PROGRAM_POINT_SIZE)

    def release(self) -> None:
        """Gives the GL object back; what `array` made is of no use then. There is a new one for what is drawn after that."""
        if self._made is not None:
            self._made.release()
            self._made = None
