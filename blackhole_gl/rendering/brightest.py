"""The luminance of a picture's brightest pixel, found and left on the GPU."""

from __future__ import annotations

import moderngl

from .inputs import FrameInputs
from .programs import Programs
from .target import Target

_SIDE = 8  # of the squares that shaders/post/brightest.frag makes a pixel each


class BrightestPass:
    """Draws shaders/post/brightest.frag until one pixel is left, and owns the textures in between."""

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._size: tuple[int, int] | None = None
        self._targets: list[Target] = []

    def of(self, inputs: FrameInputs, radiance: moderngl.Texture) -> moderngl.Texture:
        """One texel (RGBA32F), each of its colours the largest luminance in `radiance`."""
        self._make_targets(radiance.size)
        draw, source = self._programs.get("post/brightest.frag", inputs), radiance
        for target in self._targets:
            draw.sample({"source": source})
            draw.set(source_last=(source.width - 1, source.height - 1))
            target.frame.use()
            draw.draw()
            source = target.texture
        return source

    def release(self) -> None:
        """Gives the GL objects back."""
        for target in self._targets:
            target.release()
        self._targets, self._size = [], None

    def _make_targets(self, size: tuple[int, int]) -> None:
        if size == self._size:
            return
        self.release()
        self._size = size
        while not self._targets or size != (1, 1):
            size = -(-size[0] // _SIDE), -(-size[1] // _SIDE)
            self._targets.append(Target.of(self._ctx, [self._ctx.texture(size, 4, dtype="f4")]))
