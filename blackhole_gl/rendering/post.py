"""Post: radiance → picture. A telescope's beam, bloom as a chain of ever smaller levels, then exposure, tone map, gamma and dither; or the colours of a map."""

from __future__ import annotations

from collections.abc import Iterator

import moderngl

from ..scene import Scene
from .beam import BeamPass
from .brightest import BrightestPass
from .inputs import FrameInputs
from .levels import Level, draw_into, padded
from .programs import Programs
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


def keeps_stars(scene: Scene) -> bool:
    """Whether a star drawn over the finished picture of `scene` looks as if it had been in its radiance."""
    return not (scene.post.lens or scene.post.beam) and scene.post.colours == "light"


class PostPass:
    """Draws shaders/post/*.frag and owns the levels of the bloom and the table of the tone curve. With bloom off it has no levels.

    Attributes:
        samplers: what the last picture was developed with, by the names in shaders.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._size: tuple[int, int] | None = None
        self._down: list[Level] = []
        self._up: list[Level] = []
        self._tone: Target | None = None
        self._tone_key: tuple | None = None
        self._beam, self._brightest = BeamPass(ctx, programs), BrightestPass(ctx, programs)
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
        post = inputs.plan.scene.post
        if post.beam:
            radiance = self._beam.blurred(inputs, radiance)
        radiance.filter = (moderngl.LINEAR, moderngl.LINEAR)
        radiance.repeat_x = radiance.repeat_y = False
        self.samplers = {"radiance": radiance, "tone_table": self._tone_table(inputs)}
        if post.colours == "afmhot":
            self.samplers["brightest"] = self._brightest.of(inputs, radiance)
        elif post.bloom:
            self.samplers["glow"] = self._glow(inputs, radiance, may_last=glow_may_last)
        if viewport[2:] == radiance.size and not post.lens:
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
        self._beam.release()
        self._brightest.release()
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
            draw_into(level, down)
            source, size, threshold, centre = level.texture, level.size, 0.0, 4.0
        up = self._programs.get("post/bloom_up.frag", inputs)
        share = post.bloom_spread / (0.4 + post.bloom_spread)
        for own, level in zip(reversed(self._down[:-1]), self._up):
            up.sample({"wider": source, "level": own.texture})
            up.set(**_places("wider", source, size, level.size), spread=share)
            draw_into(level, up)
            source, size = level.texture, level.size
        return source

    def _make_levels(self, size: tuple[int, int]) -> None:
        if size == self._size:
            return
        self._release_levels()
        first, *others = bloom_sizes(size)
        self._down = [Level.of(self._ctx, first, first), *(Level.of(self._ctx, other, padded(other)) for other in others)]
        self._up = [Level.of(self._ctx, level.size, level.texture.size) for level in reversed(self._down[:-1])]
        self._size = size


def _lasts(before: FrameInputs, now: FrameInputs) -> bool:
    """Whether the glow of the frame `before` will do for `now`."""
    return abs(now.time - before.time) <= GLOW_LASTS and (before.size, before.plan) == (now.size, now.plan)


def _places(name: str, source: moderngl.Texture, size: tuple[int, int], target: tuple[int, int]) -> dict[str, tuple[float, float]]:
    """Uniforms by which a pixel of a target of size `target` finds its place in the lower left `size` pixels of `source`."""
    u, v = _texel(source.size)
    return {
        f"{name}_scale": (u * size[0] / target[0], v * size[1] / target[1]),
        f"{name}_last": (u * (size[0] - 0.5), v * (size[1] - 0.5)),
        f"{name}_texel": (u, v),
    }


def _nearest(texture: moderngl.Texture) -> moderngl.Texture:
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture


def _texel(size: tuple[int, int]) -> tuple[float, float]:
    return 1.0 / size[0], 1.0 / size[1]

