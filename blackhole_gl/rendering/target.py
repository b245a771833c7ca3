"""A framebuffer together with the textures that it draws into, which are made and given back with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import moderngl


@dataclass(frozen=True, eq=False)
class Target:
    """What can be drawn into and read afterwards.

    Attributes:
        frame: the framebuffer.
        textures: its colours, in the order of the shader's outputs.
    """

    frame: moderngl.Framebuffer
    textures: tuple[moderngl.Texture, ...]

    @classmethod
    def of(cls, ctx: moderngl.Context, textures: Sequence[moderngl.Texture], depth: moderngl.Texture | None = None) -> Target:
        """Draws into `textures`; `depth`, if there is one, stays its owner's."""
        return cls(ctx.framebuffer(textures, depth), tuple(textures))

    @property
    def texture(self) -> moderngl.Texture:
        """The first texture."""
        return self.textures[0]

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        return self.frame.size

    def release(self) -> None:
        """Gives the GL objects back."""
        for texture in self.textures:
            texture.release()
        self.frame.release()


class Elsewhere:
    """A pixel apart from all pictures. llvmpipe waits with what is drawn until another target is asked for (docs/llvmpipe.md)."""

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self._target: Target | None = None

    def begin(self) -> None:
        """Has the GPU begin with what was drawn so far, while more is made ready. Whoever goes on asks for the own target anew."""
        if self._target is None:
            self._target = Target.of(self._ctx, [plain_texture(self._ctx, (1, 1), 1, "f1")])
        self._target.frame.clear()

    def release(self) -> None:
        """Gives the GL objects back."""
        if self._target is not None:
            self._target.release()
            self._target = None


def plain_texture(ctx: moderngl.Context, size: tuple[int, int], components: int, dtype: str, filtered: int = moderngl.NEAREST) -> moderngl.Texture:
    """One that does not repeat and has no levels, of `components` numbers of the `dtype` that moderngl names, in rows without gaps."""
    texture = ctx.texture(size, components, dtype=dtype, alignment=1)
    texture.filter = filtered, filtered
    texture.repeat_x = texture.repeat_y = False
    return texture
