"""Levels of post: pictures that are drawn into a corner of a texture, of sizes that a driver compiles nothing anew for."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

from .draw import Draw
from .target import Target


@dataclass(frozen=True)
class Level:
    """A picture whose light lies in the lower left `size` pixels of its texture, which may be a little larger."""

    target: Target
    size: tuple[int, int]

    @classmethod
    def of(cls, ctx: moderngl.Context, size: tuple[int, int], allocated: tuple[int, int], dtype: str = "f2") -> Level:
        """A new one, in a texture of `allocated` pixels of half floats or, ``f4``, floats."""
        # Filled: what is never drawn is read all the same, by a linear filter with weight 0, which a NaN that the memory held would survive.
        texture = ctx.texture(allocated, 4, bytes(4 * int(dtype[1]) * allocated[0] * allocated[1]), dtype=dtype)
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        texture.repeat_x = texture.repeat_y = False
        target = Target.of(ctx, [texture])
        target.frame.viewport = 0, 0, *size
        return cls(target, size)

    @property
    def texture(self) -> moderngl.Texture:
        """That of its target."""
        return self.target.texture


def padded(size: tuple[int, int]) -> tuple[int, int]:
    """`size`, one pixel more where a side is a power of two: a shader is then compiled anew (docs/llvmpipe.md),
    and a picture that changes its size meets them all. The first level, a quarter of the picture, is left to whoever chooses the picture's size."""
    width, height = ({1: 3}.get(side, side + 1) if side & (side - 1) == 0 else side for side in size)
    return width, height


def draw_into(level: Level, prepared: Draw) -> None:
    """Draws the triangle of a program into `level`."""
    level.target.frame.use()
    prepared.draw()
