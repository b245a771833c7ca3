"""Blocks of rays: several to a pixel, at edges, or one to each, side by side."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np

from ..shapes import Float
from .draw import Draw
from .squares import Squares

_SIDE_BY_SIDE = 3, 3  # any; no power of two, as maps at edges have none: llvmpipe compiles a program for each kind of texture that it reads


@dataclass(frozen=True, eq=False)
class RayBlocks:
    """Blocks of rays, each of one pixel, as a map holds them.

    Attributes:
        side: rays along each axis of a pixel.
        shifts: RG32F, the pixel of each block, column and row from the bottom left, less those of the block; of blocks beyond it the nearest texel counts.
    """

    side: int
    shifts: moderngl.Texture

    @classmethod
    def side_by_side(cls, ctx: moderngl.Context) -> RayBlocks:
        """Blocks of one ray each, for a map of any size in which they lie as the pixels do in the picture."""
        return cls(1, shifts_texture(ctx, _SIDE_BY_SIDE, np.zeros((*_SIDE_BY_SIDE, 2), np.float32)))

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) of a map of all blocks that have a texel."""
        return self.side * self.shifts.width, self.side * self.shifts.height

    @property
    def samplers(self) -> dict[str, moderngl.Texture]:
        """What shaders/common/observer.glsl reads, by name."""
        return {"block_shifts": self.shifts}

    def tell(self, draw: Draw) -> None:
        """Sets the loose uniforms of shaders/common/observer.glsl that the program has."""
        draw.tell(block_side=float(self.side), block_step=(1.0 / self.shifts.width, 1.0 / self.shifts.height))


def shifts_texture(ctx: moderngl.Context, size: tuple[int, int], shifts: Float[np.ndarray, "rows columns 2"] | None = None) -> moderngl.Texture:
    """A texture for the shifts of so many blocks along each axis, which holds `shifts`, if there are any yet."""
    made = ctx.texture(size, 2, None if shifts is None else shifts.tobytes(), dtype="f4")
    made.filter = moderngl.NEAREST, moderngl.NEAREST
    made.repeat_x = made.repeat_y = False
    return made


@dataclass(frozen=True, eq=False)
class FreshBlocks:
    """Which blocks of a map are to be traced, as squares of it; all of it, looking for things and media, where there are no squares and none stand.

    Attributes:
        seeking: of rays that look for things and media.
        others: of rays that end on nothing but the hole.
        changed: holds all of them; None where the map holds no others that stand.
    """

    seeking: tuple[Squares, ...]
    others: tuple[Squares, ...]
    changed: Squares | None

    @property
    def whole(self) -> bool:
        """Whether that is all of the map."""
        return self.changed is None and not (self.seeking or self.others)
