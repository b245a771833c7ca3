"""Parts of a picture that draws are kept to.

Software renderers look at the depth of every pixel that a draw covers, be its shader kept from it or not: 2 ms of a picture of 1280×720.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ..shapes import Bool, Int

Box = tuple[int, int, int, int]
"""x, y, width and height of a part of the picture, in pixels from the bottom left."""

NOWHERE: Box = (0, 0, 0, 0)

WORTH_A_DRAW = 1 << 14
"""Pixels that a draw of its own has to spare: that many are left out by the depth test in the time in which one is prepared."""


def box_of(picked: Bool[np.ndarray, "rows columns"], size: tuple[int, int], side: int = 1) -> Box:
    """The smallest that holds all that is `picked` of a picture of `size`, in cells of `side` pixels each way; `NOWHERE` where nothing is."""
    rows, columns = np.flatnonzero(picked.any(axis=1)), np.flatnonzero(picked.any(axis=0))
    if not rows.size:
        return NOWHERE
    x, y = side * int(columns[0]), side * int(rows[0])
    return x, y, min(side * int(columns[-1] + 1), size[0]) - x, min(side * int(rows[-1] + 1), size[1]) - y


def bands_of(picked: Bool[np.ndarray, "rows columns"], size: tuple[int, int], side: int, height: int) -> Iterator[Box]:
    """The same for each `height` rows of cells that hold any: for what lies about a hole, or far apart."""
    filled = np.logical_or.reduce(picked, axis=1).tobytes()  # of which the first and the last are found soon
    for first in range(0, len(picked), height):
        low, high = filled.find(1, first, first + height), filled.rfind(1, first, first + height) + 1
        if low >= 0:
            columns = np.logical_or.reduce(picked[low:high]).tobytes()
            left, right = columns.find(1), columns.rfind(1) + 1
            x, y = side * left, side * low
            yield x, y, min(side * right, size[0]) - x, min(side * high, size[1]) - y


def few_of(bands: Iterable[Box]) -> list[Box]:
    """Those `bands` that follow each other as one where apart they spare fewer pixels than a draw is worth, if a depth test leaves them out."""
    found: list[Box] = []
    for box in bands:
        both = joined(found[-1], box) if found else NOWHERE
        if found and _area(both) - _area(found[-1]) - _area(box) <= WORTH_A_DRAW:
            found[-1] = both
        else:
            found.append(box)
    return found


def _area(box: Box) -> int:
    return box[2] * box[3]


def boxes_of(picked: Bool[np.ndarray, "rows columns"], side: int) -> Iterator[Box]:
    """Boxes that hold all that is `picked`, in cells of `side` pixels each way, and no more than half as much beside: in each row what lies together, put
    to what is like it in the row below."""
    growing: list[tuple[int, int, int, int, int]] = []  # left, right, first row, row after the last, cells
    for row in np.flatnonzero(picked.any(axis=1)).tolist():
        ends = np.flatnonzero(np.diff(picked[row].astype(np.int8), prepend=0, append=0))
        for left, right in ends.reshape(-1, 2).tolist():
            for k, (first, last, bottom, top, cells) in enumerate(growing):
                low, high = min(left, first), max(right, last)
                if top >= row and 2 * (high - low) * (row + 1 - bottom) <= 3 * (cells + right - left):
                    growing[k] = low, high, bottom, row + 1, cells + right - left
                    break
            else:
                growing.append((left, right, row, row + 1, right - left))
    for first, last, bottom, top, _ in growing:
        yield side * first, side * bottom, side * (last - first), side * (top - bottom)


def joined(box: Box, other: Box) -> Box:
    """The smallest that holds both."""
    if not (box[2] and box[3]):
        return other
    if not (other[2] and other[3]):
        return box
    low = min(box[0], other[0]), min(box[1], other[1])
    high = max(box[0] + box[2], other[0] + other[2]), max(box[1] + box[3], other[1] + other[3])
    return *low, high[0] - low[0], high[1] - low[1]


def grown(box: Box, by: int, size: tuple[int, int]) -> Box:
    """With so many pixels more on each side, as far as a picture of `size` has them."""
    x, y, width, height = box
    left, low = max(x - by, 0), max(y - by, 0)
    return left, low, min(x + width + by, size[0]) - left, min(y + height + by, size[1]) - low


def inside(pixels: Int[np.ndarray, "pixels 2"], box: Box) -> Bool[np.ndarray, " pixels"]:
    """Which of `pixels`, column and row each, lie in it."""
    x, y, width, height = box
    return (pixels[:, 0] >= x) & (pixels[:, 0] < x + width) & (pixels[:, 1] >= y) & (pixels[:, 1] < y + height)
