"""The single stars of a picture that is drawn coarse and shown enlarged: drawn as fine as it is shown, where the sky's shader found them.

Drawn with the rest, a star's light would lie on a coarse pixel or two: as much as ever, but so thin that the tone curve and the eye lose it.
"""

from __future__ import annotations

import moderngl
import numpy as np

from .programs import Draw, Samplers
from .target import Target

_ROW = 256  # pixels in a row of the list. About 500 stars are in the pixels of a whole picture.


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
        glow_window: tuple[float, float, float, float],
    ) -> None:
        """Adds the stars of a coarse picture to the picture enlarged, which `viewport` (x, y, width, height) of `target` holds. Waits for the GPU.

        Args:
            stars: the program.
            samplers: of the hit map, of the sky, and of what the coarse picture was developed with, by their names in shaders.
            glow_window: of the coarse picture's glow, where it has one: `PostPass.glow_window`.
            radiance: of the coarse picture; alpha tells where there are stars (shaders/shade_sky.frag).
        """
        first, second = _with_stars(radiance)
        pixels = np.concatenate([first, second])
        x, y, width, height = viewport
        radiance.texture.filter = moderngl.LINEAR, moderngl.LINEAR
        stars.sample({**samplers, "pixels": self._list(pixels, radiance.size[0])})
        if "glow" in samplers:
            stars.set(glow_window=glow_window)
        stars.set(firsts=len(first), finer=(radiance.size[0] / width, radiance.size[1] / height))
        stars.set(target_origin=(x, y), target_texel=(1.0 / width, 1.0 / height))
        outer = target.viewport
        target.use()
        target.viewport = viewport
        self._ctx.enable(moderngl.BLEND | moderngl.PROGRAM_POINT_SIZE)
        self._ctx.blend_equation = moderngl.MAX  # type: ignore[assignment]  # moderngl's stubs know of two equations only
        stars.draw_points(len(pixels))
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


def _with_stars(radiance: Target) -> tuple[np.ndarray, np.ndarray]:
    """Indices of the pixels with stars, one at least, and of those that may have several; from the bottom left, row by row."""
    texels = np.frombuffer(radiance.frame.read(components=4, alignment=1, dtype="f2"), np.dtype("<u8"))
    found = np.flatnonzero(texels >= 1 << 48)
    alpha = (texels[found] >> np.uint64(48)).astype(np.uint16).view(np.float16)
    first, second = found[alpha != 0.0], found[alpha < 0.0]
    return (first if first.size else np.zeros(1, int)), second  # a first star must not be what a driver compiles for
