"""The single stars of a picture that is drawn coarse and shown enlarged: drawn as fine as it is shown, where the sky's shader found them.

Drawn with the rest, a star's light would lie on a coarse pixel or two: as much as ever, but so thin that the tone curve and the eye lose it.
"""

from __future__ import annotations

import moderngl
import numpy as np

from .draw import Draw, Samplers
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
        stars.set(finer=(radiance.size[0] / viewport[2], radiance.size[1] / viewport[3]))
        found = with_stars(np.frombuffer(radiance.frame.read(components=4, alignment=1, dtype="f2"), np.dtype("<u8")))
        first, second = (np.stack([pixels % radiance.size[0], pixels // radiance.size[0]], axis=-1) for pixels in found)
        self.draw_listed(stars, samplers, radiance.texture, (first, second), target, viewport, glow_window)

    def draw_listed(
        self,
        stars: Draw,
        samplers: Samplers,
        radiance: moderngl.Texture,
        holding: tuple[np.ndarray, np.ndarray],
        target: moderngl.Framebuffer,
        viewport: tuple[int, int, int, int],
        glow_window: tuple[float, float, float, float],
    ) -> None:
        """The same where it is known which pixels hold stars: column and row of those with one at least, int (N, 2), and of those that may have several."""
        first, second = holding
        first = first if len(first) else np.zeros((1, 2), int)  # a first star must not be what a driver compiles for
        pixels = np.concatenate([first, second])
        x, y, width, height = viewport
        radiance.filter = moderngl.LINEAR, moderngl.LINEAR
        stars.sample({**samplers, "pixels": self._list(pixels)})
        if "glow" in samplers:
            stars.set(glow_window=glow_window)
        texel = 1.0 / width, 1.0 / height
        stars.set(firsts=len(first), target_origin=(x, y), shown_texel=texel)
        if stars.takes("target_texel"):
            stars.set(target_texel=texel)
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

    def _list(self, pixels: np.ndarray) -> moderngl.Texture:
        rows = -(-len(pixels) // _ROW)
        if self._listed is None or self._listed.height < rows:
            self.release()
            self._listed = self._ctx.texture((_ROW, rows + rows // 2), 2, dtype="f4")
        places = np.zeros((rows * _ROW, 2), np.float32)
        places[: len(pixels)] = pixels
        self._listed.write(places.tobytes(), (0, 0, _ROW, rows))
        return self._listed


def with_stars(texels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which of a picture's `texels` (RGBA16F, each as one integer of 64 bits) have stars, one at least, and which may have several."""
    found = np.flatnonzero(texels >= 1 << 48)
    alpha = (texels[found] >> np.uint64(48)).astype(np.uint16).view(np.float16)
    return found[alpha != 0.0], found[alpha < 0.0]
