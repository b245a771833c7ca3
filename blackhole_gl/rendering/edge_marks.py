"""Marks of pixels (shaders/common/edge_marks.glsl) → those that lie at edges, beside things, and at plain outlines.

Looked at are small squares alone in which marks differ, or beside which they do: they lie one after the other in a single row with what is about them, so
that the pixels beside each other are as far apart everywhere, and each question is a few operations on the whole.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from ..glsl.declared import EdgeMark, Fate
from ..planning import REFINE_STEP
from ..shapes import Bool, Int

BESIDE = 2
"""Pixels by which what a pixel shows decides about others."""

_SIDE = 8  # of a square, in pixels
_ALONG = _SIDE + 2 * BESIDE  # of it and what is about it

_NO_RAY = np.uint16(0xFFFF)  # as targets are cleared
_VEILED, _MET = np.uint16(EdgeMark.VEILED), np.uint16(EdgeMark.MET << 8)
_SEEN = ~_VEILED  # what of a mark counts
_SEEN_THROUGH_VEIL = _SEEN & ~np.uint16(3 * EdgeMark.RING_1)
_SEEN_THROUGH_VEIL_AT_CORNERS = _MET | np.uint16(EdgeMark.IN_FIELD)
_ENDS = np.uint16(1)  # the bit of a fate that says so, alike of rays that escape and rays that end on something, which differ in the next


@dataclass(frozen=True, eq=False)
class MarkedSquares:
    """Squares of a picture with the pixels about them.

    Attributes:
        size: (width, height) of the picture.
        columns, rows: of the first pixel of each.
        marks: of their pixels and those about them, row by row; where these lie beyond the picture those at its border.
        has_ray: which of the pixels have rays of their own.
        common, any: bits that the rays of each pixel and those beside it have in common, and that any of them has.
    """

    size: tuple[int, int]
    columns: Int[np.ndarray, " squares"]
    rows: Int[np.ndarray, " squares"]
    marks: Int[np.ndarray, " pixels"]
    has_ray: Bool[np.ndarray, " pixels"]
    common: Int[np.ndarray, " pixels"]
    any: Int[np.ndarray, " pixels"]

    @classmethod
    def of(cls, marks: Int[np.ndarray, "height width"]) -> MarkedSquares:
        """Those of the picture that has these `marks`, its first number in the low byte, which may hold edges."""
        if marks.size and int((marks + np.uint16(1)).max()) <= int(marks.min()) + 1:  # all rays are alike; no ray counts for nothing
            marks = marks[:0]
        height, width = marks.shape
        rows, columns = -(-height // _SIDE), -(-width // _SIDE)
        whole = np.full((rows * _SIDE + 2 * BESIDE, columns * _SIDE + 2 * BESIDE), _NO_RAY)
        whole[BESIDE : BESIDE + height, BESIDE : BESIDE + width] = marks
        row, column = np.nonzero(_may_hold_edges(whole))
        if len(row):
            _repeat_border(whole, width, height)
        down, across = whole.strides
        windows = np.lib.stride_tricks.as_strided(whole, (rows, columns, _ALONG, _ALONG), (_SIDE * down, _SIDE * across, down, across))
        held = windows[row, column].ravel()
        has_ray = held != _NO_RAY
        common, any_ = _near(np.bitwise_and, held), _near(np.bitwise_or, held * has_ray)
        return cls((width, height), _SIDE * column, _SIDE * row, held, has_ray, common, any_)

    def edges(self, *, corners: bool = False) -> Edges:
        """The pixels that differ from one of the eight beside them.

        Left out are the direct picture's own edges, as its cover is smooth, and what it hides. Behind it a pixel at whose corner alone the hole or a ring
        begins does as well with one ray: a straight edge does not cut it, and what a thin ring has of it is hidden.

        Args:
            corners: whether it has several all the same, as from inside the horizon, where all that is outside becomes a belt thinner than a pixel.
        """
        differing = self.common ^ self.any
        found = differing & _SEEN != 0
        found &= self.has_ray
        veiled = self.marks & _VEILED != 0
        veiled &= self.has_ray
        if veiled.any():
            through = (_at_sides(np.bitwise_and, self.marks) ^ _at_sides(np.bitwise_or, self.marks * self.has_ray)) & _SEEN_THROUGH_VEIL
            through |= differing & (_SEEN_THROUGH_VEIL if corners else _SEEN_THROUGH_VEIL_AT_CORNERS)
            found &= ~veiled | (through != 0)
        within = found.reshape(-1, _ALONG, _ALONG)[:, BESIDE:-BESIDE, BESIDE:-BESIDE]
        square, place = np.divmod(np.flatnonzero(within), _SIDE**2)
        row, column = np.divmod(place, _SIDE)
        at = (square * _ALONG + row + BESIDE) * _ALONG + column + BESIDE
        x, y = self.columns[square] + column, self.rows[square] + row
        inside = (x < self.size[0]) & (y < self.size[1])
        return Edges(self, np.stack([x[inside], y[inside]], axis=-1), at[inside])

    @cached_property
    def are_wide(self) -> Bool[np.ndarray, " pixels"]:
        """Whether each pixel and all beside it lie in squares of 2×2 whose rays are alike."""
        above_none = self.marks + np.uint16(1)  # by which no ray counts for nothing
        least, most = _in_twos(np.minimum, self.marks), _in_twos(np.maximum, above_none) - np.uint16(1)
        wide = np.zeros(self.marks.shape, bool)
        wide[_ALONG + 1 : -_ALONG - 1] = _in_twos(np.logical_or, most <= least)
        return _near(np.logical_and, wide)


@dataclass(frozen=True, eq=False)
class Edges:
    """Pixels at edges: column and row of each from the bottom left, square by square, and where it lies among those of the squares."""

    squares: MarkedSquares
    pixels: Int[np.ndarray, "pixels 2"]
    at: Int[np.ndarray, " pixels"]

    def beside_things(self) -> Bool[np.ndarray, " pixels"]:
        """Within or beside which a thing or a medium is met."""
        return self.squares.any[self.at] & _MET != 0

    def at_plain_outlines(self) -> Bool[np.ndarray, " pixels"]:
        """Which lie at the outline of a thing or at the rim of a field and at nothing else: within and beside them nothing is narrower than two pixels, and
        nothing but what is met and whether the ray comes into the field changes."""
        common, any_ = self.squares.common[self.at], self.squares.any[self.at]
        on_things = (common & _ENDS) << 1  # that some rays escape where others end on things
        return self.squares.are_wide[self.at] & ((common ^ any_) & ~_SEEN_THROUGH_VEIL_AT_CORNERS & ~on_things == 0)


def shown_in_cells(marks: Int[np.ndarray, "height width"]) -> tuple[Bool[np.ndarray, "rows columns"], Bool[np.ndarray, "rows columns"]]:
    """Of each cell of the coarse grid in `marks`, which begin with one: whether a ray of any of its pixels meets a thing or a medium, and whether one escapes.
    Cells without rays meet some."""
    height, width = marks.shape
    flags = marks & (_MET | ~(marks >> 1) & np.uint16(Fate.ESCAPED))
    if height % REFINE_STEP or width % REFINE_STEP:
        flags = np.pad(flags, ((0, -height % REFINE_STEP), (0, -width % REFINE_STEP)))
    cells = _in_blocks(np.bitwise_or, flags, REFINE_STEP)
    return cells > np.uint16(Fate.ESCAPED), cells & np.uint16(Fate.ESCAPED) > 0


def _may_hold_edges(whole: Int[np.ndarray, "height width"]) -> Bool[np.ndarray, "rows columns"]:
    """Which squares of a picture of whole ones, with what is about it, have rays, and those about them and their own differ."""
    marks = whole[BESIDE:-BESIDE]
    least, most = _in_blocks(np.minimum, marks, _SIDE, BESIDE), _in_blocks(np.maximum, marks + np.uint16(1), _SIDE, BESIDE)  # of no ray that is nothing
    differ = _of_nine(np.maximum, most, np.uint16(0)) - np.uint16(1) > _of_nine(np.minimum, least, _NO_RAY)
    return differ & (least != _NO_RAY)


def _repeat_border(whole: Int[np.ndarray, "height width"], width: int, height: int) -> None:
    """Has the border of a picture of that size repeated about it in `whole`, where it begins at (`BESIDE`, `BESIDE`)."""
    right, top = BESIDE + width, BESIDE + height
    whole[BESIDE:top, :BESIDE], whole[BESIDE:top, right : right + BESIDE] = whole[BESIDE:top, BESIDE, None], whole[BESIDE:top, right - 1, None]
    whole[:BESIDE], whole[top : top + BESIDE] = whole[BESIDE], whole[top - 1]


def _in_blocks(of_two: np.ufunc, values: np.ndarray, side: int, border: int = 0) -> np.ndarray:
    """What `of_two` makes of each block of `side`², but for so many columns on the left and on the right."""
    height, width = values.shape
    rows = of_two.reduce(values.reshape(height // side, side, width), axis=1)[:, border : width - border]
    return reduce(of_two, (rows[:, k::side] for k in range(side)))


def _of_nine(of_two: np.ufunc, values: np.ndarray, beyond: np.uint16) -> np.ndarray:
    """What `of_two` makes of each value and the eight about it, which are `beyond` beyond the border."""
    whole = np.full((len(values) + 2, values.shape[1] + 2), beyond)
    whole[1:-1, 1:-1] = values
    rows = reduce(of_two, (whole[:-2], whole[1:-1], whole[2:]))
    return reduce(of_two, (rows[:, :-2], rows[:, 1:-1], rows[:, 2:]))


def _near(of_two: np.ufunc, values: np.ndarray) -> np.ndarray:
    """What `of_two` makes of each value and the eight about it, of those of squares; 0 at the ends."""
    rows = of_two(values[: -2 * _ALONG], values[2 * _ALONG :])
    of_two(rows, values[_ALONG:-_ALONG], out=rows)
    found = np.zeros_like(values)
    inner = found[_ALONG + 1 : -_ALONG - 1]
    of_two(rows[:-2], rows[2:], out=inner)
    of_two(inner, rows[1:-1], out=inner)
    return found


def _at_sides(of_two: np.ufunc, values: np.ndarray) -> np.ndarray:
    """The same of each value and the four at its sides."""
    found = np.zeros_like(values)
    inner = found[_ALONG:-_ALONG]
    of_two(values[: -2 * _ALONG], values[2 * _ALONG :], out=inner)
    for apart in (-1, 0, 1):
        of_two(inner, values[_ALONG + apart : len(values) - _ALONG + apart], out=inner)
    return found


def _in_twos(of_two: np.ufunc, values: np.ndarray) -> np.ndarray:
    """What `of_two` makes of each 2×2 that lie in squares, the first of them first."""
    rows = of_two(values[:-_ALONG], values[_ALONG:])
    return of_two(rows[:-1], rows[1:])
