"""Blocks of rays, several to a pixel, in the place of pixels side by side."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

from .squares import Squares

IN_BLOCKS = {"RAYS_IN_BLOCKS": 1}
"""What shaders that draw rays of blocks are composed with."""


@dataclass(frozen=True, eq=False)
class RayBlocks:
    """Blocks of rays, each of one pixel, that a map may hold instead of a ray for each pixel of a picture.

    Attributes:
        side: rays along each axis of a pixel.
        pixels: RG32F, each block's pixel, from the bottom left.
    """

    side: int
    pixels: moderngl.Texture

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) of the map."""
        return self.side * self.pixels.width, self.side * self.pixels.height

    @property
    def samplers(self) -> dict[str, moderngl.Texture]:
        """What shaders/common/observer.glsl reads, by name."""
        return {"block_pixels": self.pixels}


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
