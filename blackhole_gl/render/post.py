"""Post: radiance → picture. Bloom as a chain of ever smaller levels, then exposure, tone map, gamma and dither."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import moderngl

from .inputs import FrameInputs
from .programs import Draw, Programs
from .target import Target

MOST_LEVELS = 6
"""Levels of the bloom chain at most; the smallest is then 1/128 of the picture."""

GLOW_LASTS = 0.25
"""Scene time in r_s/c for which a glow may stand still: the picture is then off by 0.01 grey levels in the mean, and nowhere by more than 4."""

TONE_TABLE = {"TONE_COLUMN_BITS": 10, "TONE_ROWS": 48}
"""Size of the tone table, as switches of the shaders that make it and read it: bits of the mantissa, and exponents."""


def bloom_sizes(size: tuple[int, int]) -> Iterator[tuple[int, int]]:
    """Sizes of the bloom levels of a picture of `size`: a quarter, then halves, rounded up, until a side is 2 or less."""
    size = -(-size[0] // 4), -(-size[1] // 4)
    yield size
    for _ in range(MOST_LEVELS - 1):
        if min(size) <= 2:
            return
        size = -(-size[0] // 2), -(-size[1] // 2)
        yield size


@dataclass(frozen=True)
class _Level:
    """One level of the bloom: its light lies in the lower left `size` pixels of the texture, which may be a little larger."""

    target: Target
    size: tuple[int, int]

    @property
    def texture(self) -> moderngl.Texture:
        return self.target.texture


class PostPass:
    """Draws shaders/post/*.frag and owns the levels of the bloom and the table of the tone curve. With bloom off it has no levels.

    Attributes:
        samplers: what the last picture was developed with, by the names in shaders.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._size: tuple[int, int] | None = None
        self._down: list[_Level] = []
        self._up: list[_Level] = []
        self._tone: Target | None = None
        self._tone_key: tuple | None = None
        self.samplers: dict[str, moderngl.Texture] = {}
        self._lasting: FrameInputs | None = None  # the frame that the glow was made of, where the next one may have it too

    def draw(
        self,
        inputs: FrameInputs,
        radiance: moderngl.Texture,
        target: moderngl.Framebuffer,
        viewport: tuple[int, int, int, int],
        *,
        glow_may_last: bool = False,
    ) -> None:
        """Makes `radiance` (RGBA16F) the picture in the `viewport` (x, y, width, height) of `target`.

        Args:
            glow_may_last: whether the glow may be that of the last frame, if this one differs from it by little time alone; never that of one before.
        """
        radiance.filter = (moderngl.LINEAR, moderngl.LINEAR)
        radiance.repeat_x = radiance.repeat_y = False
        self.samplers = {"radiance": radiance, "tone_table": self._tone_table(inputs)}
        if inputs.plan.scene.post.bloom:
            self.samplers["glow"] = self._glow(inputs, radiance, may_last=glow_may_last)
        if viewport[2:] == radiance.size and not inputs.plan.scene.post.lens:
            radiance.filter = (moderngl.NEAREST, moderngl.NEAREST)
        tone_map = self._programs.get("post/tone_map.frag", inputs, TONE_TABLE)
        tone_map.sample(self.samplers)
        tone_map.set(target_origin=viewport[:2], target_texel=_texel(viewport[2:]))
        target.use()
        outer = target.viewport
        target.viewport = viewport
        tone_map.draw()
        target.viewport = outer

    def release(self) -> None:
        """Gives the GL objects back."""
        self._release_levels()
        if self._tone is not None:
            self._tone.release()
        self._tone, self._tone_key = None, None

    def _release_levels(self) -> None:
        for level in (*self._down, *self._up):
            level.target.release()
        self._down, self._up, self._size, self._lasting = [], [], None, None

    def _tone_table(self, inputs: FrameInputs) -> moderngl.Texture:
        """The curve of one channel, made anew when a number or a choice that it depends on has changed."""
        curve, post = self._programs.get("post/tone_table.frag", inputs, TONE_TABLE), inputs.plan.scene.post
        key = (curve.serial, post.exposure, post.gamma)
        if self._tone is None:
            self._tone = Target.of(self._ctx, [_nearest(self._ctx.texture((1 << TONE_TABLE["TONE_COLUMN_BITS"], TONE_TABLE["TONE_ROWS"]), 4))])
        if key != self._tone_key:
            self._tone.frame.use()
            curve.draw()
            self._tone_key = key
        return self._tone.texture

    def _glow(self, inputs: FrameInputs, radiance: moderngl.Texture, *, may_last: bool) -> moderngl.Texture:
        if may_last and self._lasting is not None and _lasts(self._lasting, inputs):
            self._lasting = None
            return (self._up or self._down)[-1].texture
        self._lasting = inputs if may_last else None
        return self._bloom(inputs, radiance)

    def _bloom(self, inputs: FrameInputs, radiance: moderngl.Texture) -> moderngl.Texture:
        post = inputs.plan.scene.post
        self._make_levels(radiance.size)
        source, size, threshold, centre = radiance, radiance.size, post.bloom_threshold, 0.0
        down = self._programs.get("post/bloom_down.frag", inputs)
        for level in self._down:
            down.sample({"source": source})
            down.set(**_places("source", source, size, level.size), threshold=threshold, centre_weight=centre)
            _draw_into(level, down)
            source, size, threshold, centre = level.texture, level.size, 0.0, 4.0
        up = self._programs.get("post/bloom_up.frag", inputs)
        share = post.bloom_spread / (0.4 + post.bloom_spread)
        for own, level in zip(reversed(self._down[:-1]), self._up):
            up.sample({"wider": source, "level": own.texture})
            up.set(**_places("wider", source, size, level.size), spread=share)
            _draw_into(level, up)
            source, size = level.texture, level.size
        return source

    def _make_levels(self, size: tuple[int, int]) -> None:
        if size == self._size:
            return
        self._release_levels()
        first, *others = bloom_sizes(size)
        self._down = [self._level(first, first), *(self._level(other, _padded(other)) for other in others)]
        self._up = [self._level(level.size, level.texture.size) for level in reversed(self._down[:-1])]
        self._size = size

    def _level(self, size: tuple[int, int], allocated: tuple[int, int]) -> _Level:
        # Filled: what is never drawn is read all the same, by a linear filter with weight 0, which a NaN that the memory held would survive.
        texture = self._ctx.texture(allocated, 4, bytes(8 * allocated[0] * allocated[1]), dtype="f2")
        texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        texture.repeat_x = texture.repeat_y = False
        target = Target.of(self._ctx, [texture])
        target.frame.viewport = 0, 0, *size
        return _Level(target, size)


def _lasts(before: FrameInputs, now: FrameInputs) -> bool:
    """Whether the glow of the frame `before` will do for `now`."""
    return abs(now.time - before.time) <= GLOW_LASTS and (before.size, before.plan) == (now.size, now.plan)


def _padded(size: tuple[int, int]) -> tuple[int, int]:
    """`size`, one pixel more where a side is a power of two: a shader is then compiled anew (docs/llvmpipe.md),
    and a picture that changes its size meets them all. The first level, a quarter of the picture, is left to whoever chooses the picture's size."""
    width, height = ({1: 3}.get(side, side + 1) if side & (side - 1) == 0 else side for side in size)
    return width, height


def _places(name: str, source: moderngl.Texture, size: tuple[int, int], target: tuple[int, int]) -> dict[str, tuple[float, float]]:
    """Uniforms by which a pixel of a target of size `target` finds its place in the lower left `size` pixels of `source`."""
    u, v = _texel(source.size)
    return {
        f"{name}_scale": (u * size[0] / target[0], v * size[1] / target[1]),
        f"{name}_last": (u * (size[0] - 0.5), v * (size[1] - 0.5)),
        f"{name}_texel": (u, v),
    }


def _draw_into(level: _Level, prepared: Draw) -> None:
    level.target.frame.use()
    prepared.draw()


def _nearest(texture: moderngl.Texture) -> moderngl.Texture:
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture


def _texel(size: tuple[int, int]) -> tuple[float, float]:
    return 1.0 / size[0], 1.0 / size[1]

