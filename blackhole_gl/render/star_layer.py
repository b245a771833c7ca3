"""The single stars of a picture that is drawn coarse and shown enlarged: drawn as fine as it is shown, where the sky's shader found them.

Drawn with the rest, a star's light would lie on a coarse pixel or two: as much as ever, but so thin that the tone curve and the eye lose it.
"""

from __future__ import annotations

import moderngl
import numpy as np

from .programs import Draw, Samplers
from .target import Target

_ROW = 256  # pixels in a row of the list
_STARS_A_PIXEL = 2  # that are drawn: points of shaders/star_layer.vert. There are about 500 stars in the pixels of a whole picture.


class StarLayer:
    """Draws shaders/star_layer.*, and owns the list of pixels that it is drawn on."""

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self._listed: moderngl.Texture | None = None

    def draw(
        self,
        stars: Draw,
        samplers: Samplers,
        radiance: Target,
        target: moderngl.Framebuffer,
        viewport: tuple[int, int, int, int],
    ) -> None:
        """Adds the stars of a coarse picture to the picture enlarged, which `viewport` (x, y, width, height) of `target` holds. Waits for the GPU.

        Args:
            stars: the program.
            samplers: of the hit map, of the sky, and of what the coarse picture was developed with, by their names in shaders.
            radiance: of the coarse picture; alpha above 0 where there are stars (shaders/shade_sky.frag).
        """
        pixels = _with_stars(radiance)
        x, y, width, height = viewport
        radiance.texture.filter = moderngl.LINEAR, moderngl.LINEAR
        stars.sample({**samplers, "pixels": self._list(pixels, radiance.size[0])})
        stars.set(finer=(radiance.size[0] / width, radiance.size[1] / height), target_origin=(x, y), target_texel=(1.0 / width, 1.0 / height))
        outer = target.viewport
        target.use()
        target.viewport = viewport
        self._ctx.enable(moderngl.BLEND | moderngl.PROGRAM_POINT_SIZE)
        self._ctx.blend_equation = moderngl.MAX  # type: ignore[assignment]  # moderngl's stubs know of two equations only
        stars.draw_points(_STARS_A_PIXEL * len(pixels))
        self._ctx.blend_equation = moderngl.FUNC_ADD  # type: ignore[assignment]
        self._ctx.disable(moderngl.BLEND | moderngl.PROGRAM_POINT_SIZE)
        target.viewport = outer

    def release(self) -> None:
        """Gives the GL object back."""
        if self._listed is not None:
            self._listed.release()
        self._listed = None

    def _list(self, pixels: np.ndarray, width: int) -> moderngl.Texture:
        rows = -(-len(pixels) // _ROW)
        if self._listed is None or self._listed.height < rows:
            self.release()
            self._listed = self._ctx.texture((_ROW, rows + rows // 2), 2, dtype="f4")
        places = np.zeros((rows * _ROW, 2), np.float32)
        places[: len(pixels), 1], places[: len(pixels), 0] = np.divmod(pixels, width)
        self._listed.write(places.tobytes(), (0, 0, _ROW, rows))
        return self._listed


def _with_stars(radiance: Target) -> np.ndarray:
    """Indices of the pixels with stars, from the bottom left, row by row; one at least."""
    texels = np.frombuffer(radiance.frame.read(components=4, alignment=1, dtype="f2"), np.dtype("<u8"))
    found = np.flatnonzero(texels >= 1 << 48)  # half floats, alpha in the highest bits
    return found if found.size else np.zeros(1, int)  # a first star must not be what a driver compiles for
