"""What media at a resolution of their own are marched into and joined in, and what is known of their rays."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import moderngl
import numpy as np

from .boxes import Box, bands_of
from .classes import Where
from .kept_samples import MOST_KEPT, KeptSamples
from .ray_lists import RayList, in_blocks
from .target import Target

OWN, BETWEEN = Where(">", 0.375), Where("<", 0.625)
"""By shaders/transfer_marks.frag: pixels that are marched by themselves, and those between rays that meet media."""

_SQUARE, _BAND = 16, 2  # pixels along the sides of squares, and rows of these, that what media are drawn in is kept to


class CoarseTargets:
    """Textures, a pair for each stretch, of a picture's size, of the grid's, and of a list's.

    Attributes:
        made_for: the picture's size, the stretches, the pixels from ray to ray, and whether its rays lie apart.
        grid: `whole` itself where each pixel has a ray.
        marks: draws into `depth`.
        depth: of `whole`: which pixels are marched by themselves.
        cells: of the grid, as shaders/transfer_cells.frag tells them.
        bands: parts of the picture, none over another, that hold all pixels between rays that meet media, and all marched by themselves; empty where rays lie
            apart.
        shown: the same of both, None where rays lie apart.
        own: those pixels.
        samples, own_samples: those of the grid's rays and of `own`.
    """

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int], count: int, step: int, *, apart: bool):
        self.made_for = size, count, step, apart
        self.depth = ctx.depth_texture(size)
        coarse = -(-(size[0] - 1) // step) + 1, -(-(size[1] - 1) // step) + 1
        self.whole = Target.of(ctx, [_texture(ctx, size) for _ in range(2 * count)], self.depth)
        self.grid = self.whole
        if step > 1:
            grid = [_texture(ctx, coarse, "f4" if place == 1 else "f2") for place in range(2 * count)]  # a ray's history is the second's alpha
            for texture in [] if apart else grid:
                texture.filter = moderngl.LINEAR, moderngl.LINEAR
            self.grid = Target.of(ctx, grid)
        self.marks = ctx.framebuffer([], self.depth)
        self.own = RayList(ctx, (1, 1) if apart else size)
        self.samples, self.own_samples = KeptSamples(ctx, coarse), KeptSamples(ctx, (1, 1) if apart else size)
        self.cells = Target.of(ctx, [ctx.texture(self.grid.size, 1, dtype="f4")])
        self.cells.texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self.bands: dict[Where, Sequence[Box]] = {}
        self.shown: Sequence[Box] | None = None
        self._dear = False  # too many samples to be kept
        self._listed: Target | None = None

    def clear(self) -> None:
        """Empties the picture of what it was filled with by the last bands."""
        self.whole.frame.depth_mask = False
        if self.shown is None:
            self.whole.frame.clear()
        for box in self.shown or ():
            self.whole.frame.clear(viewport=box)

    def note(self, depth: np.ndarray) -> None:
        """Takes in what shaders/transfer_marks.frag has found, float32 (height, width)."""
        self.own.hold(in_blocks(OWN.holds(depth)))
        own, between = _squares(OWN.holds(depth)), _squares(BETWEEN.holds(depth))
        self.bands = {where: list(bands_of(held, self.whole.size, _SQUARE, _BAND)) for where, held in ((OWN, own), (BETWEEN, between))}
        self.shown = list(bands_of(own | between, self.whole.size, _SQUARE, _BAND))

    @property
    def is_told(self) -> bool:
        """Whether nothing is left to be told of samples."""
        return self._dear or self.samples.is_whole and (self.own_samples.is_whole or not self.own.count)

    def forget(self) -> None:
        """Rays are others from now on."""
        self.samples.forget()
        self.own_samples.forget()
        self._dear = False

    def untold(self) -> tuple[KeptSamples, Callable[[], np.ndarray], int]:
        """The samples that are told next, what tells their pixels, and the pixels from ray to ray."""
        if self.samples.is_whole:
            return self.own_samples, lambda: self.own.held, 1
        return self.samples, self._meeting, self.made_for[2]

    def _meeting(self) -> np.ndarray:
        """The rays of the grid that have met media, as it was marched; where they have too many pieces to be kept, that is known from then on."""
        texture = self.grid.textures[0]
        pieces = np.frombuffer(texture.read(), np.float16).reshape(texture.height, texture.width, 4)[..., 3]
        self._dear = float(pieces.sum(dtype=np.float64)) > MOST_KEPT
        return in_blocks(pieces > 0.0)

    def listed(self, ctx: moderngl.Context, rays: RayList) -> Target:
        """Of the size of the list."""
        if self._listed is None or self._listed.size != rays.size:
            if self._listed is not None:
                self._listed.release()
            self._listed = Target.of(ctx, [_texture(ctx, rays.size) for _ in self.whole.textures])
        return self._listed

    def release(self) -> None:
        for item in (self.whole, self.cells, self.marks, self.depth, self.own, self._listed, self.samples, self.own_samples):
            if item is not None:
                item.release()
        if self.grid is not self.whole:
            self.grid.release()


def _squares(held: np.ndarray) -> np.ndarray:
    """Which squares hold any of the pixels `held`, bool (rows, columns)."""
    rows, columns = (np.arange(0, side, _SQUARE) for side in held.shape)
    return np.logical_or.reduceat(np.logical_or.reduceat(held, rows, axis=0), columns, axis=1)


def _texture(ctx: moderngl.Context, size: tuple[int, ...], dtype: str = "f2") -> moderngl.Texture:
    texture = ctx.texture((size[0], size[1]), 4, dtype=dtype)
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    texture.repeat_x = texture.repeat_y = False
    return texture


def named(target: Target) -> dict[str, moderngl.Texture]:
    """The textures of `target` as shaders/common/stretches.glsl names them."""
    return {f"{('gathered', 'dimmed')[place % 2]}{place // 2}": texture for place, texture in enumerate(target.textures)}
