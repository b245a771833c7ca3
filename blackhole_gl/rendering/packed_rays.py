"""Rays of pixels that lie apart, such as along outlines: traced side by side in a map of their own, then put where they belong.

Software renderers shade eight pixels together, whichever of them are asked for (docs/llvmpipe.md): along outlines a third of the rays were nobody's.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import moderngl
import numpy as np

from ..planning import HALF_STEP
from ..shapes import Bool, Float, Int
from .boxes import Box
from .draw import Draw
from .ray_blocks import RayBlocks, shifts_texture
from .squares import TOGETHER
from .target import Target, plain_texture

_WIDTH = 63 * TOGETHER  # of the map, in pixels: no power of two (docs/llvmpipe.md)
_FIRST_ROWS = 9 * TOGETHER
_IN_BLOCK = TOGETHER**2


class PackedRays:
    """The rays of cells of `HALF_STEP`² pixels, but for those pixels that have been traced with others.

    Attributes:
        numbers: R32F, of each cell: the number in the map of the ray of its first pixel, the others behind it in rows; where that has been traced,
            −1 − the number of the next one's.
    """

    def __init__(self, ctx: moderngl.Context, cells: tuple[int, int], count: int):
        self._ctx, self._count = ctx, count
        self.numbers = plain_texture(ctx, cells, 1, "f4")
        self._rays: Target | None = None
        self._shifts: moderngl.Texture | None = None
        self._boxes: list[Box] = []  # in use
        self._order = _in_squares(cells)
        self._pixels = _pixels_of(cells)

    def choose(self, cells: Bool[np.ndarray, "rows columns"], first_is_known: Bool[np.ndarray, "rows columns"]) -> int:
        """Packs the rays of `cells`; of those whose `first_is_known` all but that of their first pixel. Returns how many rays there are."""
        places = self._order[cells.ravel()[self._order]]
        if not len(places):
            return 0
        known = first_is_known.ravel()[places]
        rays = HALF_STEP**2 - known
        ends = np.cumsum(rays)
        first = ends - rays
        numbers = np.zeros(cells.size, np.float32)
        numbers[places] = np.where(known, -1 - first, first)
        self.numbers.write(numbers.tobytes(), alignment=1)
        left = np.ones((len(places), HALF_STEP**2), bool)
        left[:, 0] = ~known
        self._write(self._pixels[places][left])
        return int(ends[-1])

    def trace(self, rays: Draw) -> None:
        """Traces them; `rays` are of `blocks`."""
        rays.set(ray_grid=(1.0, 0.0, 0.0))
        self._there.frame.use()
        rays.draw_boxes(box for box in self._boxes if box[2] and box[3])

    @property
    def blocks(self) -> RayBlocks:
        """The map's blocks, of a ray each."""
        if self._shifts is None:
            raise RuntimeError("no rays have been chosen yet: `choose` comes first")
        return RayBlocks(1, self._shifts)

    @property
    def textures(self) -> Sequence[moderngl.Texture]:
        """What they hit: those of a hit map."""
        return self._there.textures

    def release(self) -> None:
        """Gives the GL objects back."""
        for item in (self.numbers, self._rays, self._shifts):
            if item is not None:
                item.release()
        self._rays = self._shifts = None

    @property
    def _there(self) -> Target:
        if self._rays is None:
            raise RuntimeError("no rays have been chosen yet: `choose` comes first")
        return self._rays

    def _write(self, pixels: Int[np.ndarray, " rays"]) -> None:
        """Tells where the rays are from, `pixels` as `_pixels_of` has them, whose blocks of `TOGETHER`² lie side by side (shaders/refine_half_put.frag); what
        is left of the last blocks are those of the last pixel."""
        across = _WIDTH // TOGETHER
        full, more = divmod(-(-len(pixels) // _IN_BLOCK), across)
        self._boxes = [(0, 0, _WIDTH, TOGETHER * full), (0, TOGETHER * full, TOGETHER * more, TOGETHER)]
        rows = TOGETHER * (full + (more > 0))
        whole = np.empty(rows * _WIDTH, pixels.dtype)
        whole[: len(pixels)], whole[len(pixels) :] = pixels, pixels[-1]
        in_blocks = whole.reshape(rows // TOGETHER, across, TOGETHER, TOGETHER)
        shifts = in_blocks.swapaxes(1, 2).reshape(rows, _WIDTH).view(np.float32).reshape(rows, _WIDTH, 2) - _texels(rows)
        if self._shifts is None or self._rays is None or self._shifts.height < rows:
            for item in (self._rays, self._shifts):
                if item is not None:
                    item.release()
            most = max(_FIRST_ROWS, TOGETHER * (rows // TOGETHER + rows // (2 * TOGETHER) | 1))
            self._shifts = shifts_texture(self._ctx, (_WIDTH, most))
            self._rays = Target.of(self._ctx, [plain_texture(self._ctx, (_WIDTH, most), 4, "f4") for _ in range(self._count)])
        self._shifts.write(shifts.tobytes(), (0, 0, _WIDTH, rows))


@lru_cache(maxsize=8)
def _texels(rows: int) -> Float[np.ndarray, "rows columns 2"]:
    """Column and row of each texel of so many rows of the map, float32."""
    return np.stack(np.meshgrid(np.arange(_WIDTH), np.arange(rows)), axis=-1).astype(np.float32)


def _pixels_of(size: tuple[int, int]) -> Int[np.ndarray, "cells pixels"]:
    """Column and row, both float32 in one number of 64 bits, as they are moved in a third of the time, of each pixel of so many cells, row by row."""
    parts = np.array([(part % HALF_STEP, part // HALF_STEP) for part in range(HALF_STEP**2)], np.float32)
    columns, rows = np.meshgrid(np.arange(size[0]), np.arange(size[1]))
    corners = HALF_STEP * np.stack([columns, rows], axis=-1).astype(np.float32)
    return (corners.reshape(-1, 1, 2) + parts).view(np.uint64)[..., 0]


def _in_squares(size: tuple[int, int]) -> Int[np.ndarray, " cells"]:
    """The places of so many cells, row by row, in an order in which near ones follow each other: quarter by quarter of each square of them."""
    columns, rows = np.meshgrid(np.arange(size[0]), np.arange(size[1]))
    key = np.zeros(columns.shape, int)
    for bit in range(max(size).bit_length()):
        key |= (columns >> bit & 1) << 2 * bit | (rows >> bit & 1) << 2 * bit + 1
    return np.argsort(key, axis=None)
