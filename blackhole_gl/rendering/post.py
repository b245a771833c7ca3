"""Post: radiance → picture. A telescope's beam, bloom as a chain of ever smaller levels, then exposure, tone map, gamma and dither; or the colours of a map."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import moderngl
import numpy as np

from ..physics import projection
from ..scene import Scene
from .beam import BeamPass
from .brightest import BrightestPass
from .inputs import FrameInputs
from .levels import Level, draw_into, padded
from .programs import Programs
from .target import Target

GLOW_SHRINKS = 4
"""From the picture to the first level of the bloom; from level to level it is 2."""

MOST_LEVELS = 6
"""Levels of the bloom chain at most; the smallest is then 1/128 of the picture."""

GLOW_GRID = GLOW_SHRINKS << (MOST_LEVELS - 1)
"""Pixels that the coarsest level of the bloom has in one: parts of a picture that begin on it glow as the whole does."""

GLOW_REACH = 5 * GLOW_GRID
"""Pixels, beyond which no light glows: two and a half of those from below, and as many on the way up again, less what both share."""

GLOW_LASTS = 0.25
"""Scene time in r_s/c for which a glow may stand still: the picture is then off by 0.01 grey levels in the mean, and nowhere by more than 4."""

GLOW_SERVES = 3
"""Pictures one after the other that may have the same glow."""

_ANYWHERE = 4.0  # beyond all places in a texture that goes round

TONE_TABLE = {"TONE_COLUMN_BITS": 10, "TONE_ROWS": 48}
"""Size of the tone table, as switches of the shaders that make it and read it: bits of the mantissa, and exponents."""


def bloom_sizes(size: tuple[int, int]) -> Iterator[tuple[int, int]]:
    """Sizes of the bloom levels of a picture of `size`: a quarter, then halves, rounded up, until a side is 2 or less."""
    size = -(-size[0] // GLOW_SHRINKS), -(-size[1] // GLOW_SHRINKS)
    yield size
    for _ in range(MOST_LEVELS - 1):
        if min(size) <= 2:
            return
        size = -(-size[0] // 2), -(-size[1] // 2)
        yield size


def keeps_stars(scene: Scene) -> bool:
    """Whether a star drawn over the finished picture of `scene` looks as if it had been in its radiance."""
    return not (scene.post.lens or scene.post.beam) and scene.post.colours == "light"


@dataclass(frozen=True)
class _Window:
    """What a texture holds of a picture: `size` pixels of it from `corner` on."""

    size: tuple[int, int]
    corner: tuple[int, int]

    def of(self, picture: tuple[int, int]) -> tuple[float, float, float, float]:
        """Scale and shift from a place in the `picture`, 0…1, to that in the texture."""
        (width, height), (x, y) = self.size, self.corner
        return picture[0] / width, picture[1] / height, -x / width, -y / height


class PostPass:
    """Draws shaders/post/*.frag and owns the levels of the bloom and the table of the tone curve. With bloom off it has no levels.

    Attributes:
        samplers: what the last picture was developed with, by the names in shaders.
        glow_window: scale and shift from a place in it to that in its ``glow``, where it has one.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._size: tuple[int, int] | None = None
        self._down: list[Level] = []
        self._up: list[Level] = []
        self._quarter: Level | None = None  # what glows of a part of a picture
        self._tone: Target | None = None
        self._tone_key: tuple | None = None
        self._beam, self._brightest = BeamPass(ctx, programs), BrightestPass(ctx, programs)
        self.samplers: dict[str, moderngl.Texture] = {}
        self.glow_window = 1.0, 1.0, 0.0, 0.0
        self._lasting: FrameInputs | None = None  # the frame that the glow was made of, where the next one may have it too
        self._served = 0  # pictures that have had it

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
            glow_may_last: whether the glow may be that of the last frame, or of the one before it, if this one differs from that by little time alone.
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
        glow = None
        if "glow" in self.samplers:
            texture = self.samplers["glow"]
            glow = _Window((GLOW_SHRINKS * texture.width, GLOW_SHRINKS * texture.height), (-_glow_beyond(inputs), 0))
        if viewport[2:] == radiance.size and not post.lens:
            radiance.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._tone_map(inputs, target, viewport, viewport[:2], viewport[2:], _Window(radiance.size, (0, 0)), glow)

    def draw_part(self, inputs: FrameInputs, radiance: moderngl.Texture, corner: tuple[int, int], target: moderngl.Framebuffer) -> None:
        """Makes the part of `radiance` (RGBA16F) that begins at the pixel `corner` and is as large as `target` and `inputs` the picture in there, as if it
        were all of one. Beyond its end `radiance` begins anew."""
        radiance.filter = (moderngl.LINEAR, moderngl.LINEAR)
        radiance.repeat_x = radiance.repeat_y = True
        self.samplers = {"radiance": radiance, "tone_table": self._tone_table(inputs)}
        if inputs.plan.scene.post.bloom:
            self._make_levels(next(bloom_sizes(inputs.size)))
            start = corner[0] / radiance.width, corner[1] / radiance.height
            self._draw_quarter(inputs, radiance, self._down[0], start=start, last=(_ANYWHERE, _ANYWHERE))
            self.samplers["glow"] = self._spread(inputs)
        glow = self.samplers.get("glow")
        covered = None if glow is None else (GLOW_SHRINKS * glow.width, GLOW_SHRINKS * glow.height)
        light = _Window(radiance.size, (-corner[0], -corner[1]))
        radiance.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._tone_map(inputs, target, (0, 0, *inputs.size), (0, 0), inputs.size, light, None if covered is None else _Window(covered, (0, 0)))
        if covered is not None:
            self.glow_window = _Window(covered, corner).of(radiance.size)  # from a place in all of the light

    def bright(self, inputs: FrameInputs, radiance: moderngl.Texture) -> np.ndarray:
        """What glows of `radiance` (RGBA16F), at a quarter of its size, rounded up: float16 (height, width, 4), row 0 at the bottom."""
        radiance.filter = (moderngl.LINEAR, moderngl.LINEAR)
        radiance.repeat_x = radiance.repeat_y = False
        size = next(bloom_sizes(radiance.size))
        if self._quarter is None or self._quarter.size != size:
            if self._quarter is not None:
                self._quarter.target.release()
            self._quarter = Level.of(self._ctx, size, size)
        self._draw_quarter(inputs, radiance, self._quarter)
        return np.frombuffer(self._quarter.texture.read(), np.float16).reshape(size[1], size[0], 4)

    def spread(self, inputs: FrameInputs, bright: np.ndarray) -> moderngl.Texture:
        """The glow, at the size of `bright` (as the method of that name gives it, of a part of the picture or the whole); it is the next call's, too."""
        self._make_levels((bright.shape[1], bright.shape[0]))
        self._down[0].texture.write(np.ascontiguousarray(bright))
        return self._spread(inputs)

    def develop(
        self,
        inputs: FrameInputs,
        radiance: moderngl.Texture,
        corner: tuple[int, int],
        glow: tuple[moderngl.Texture, tuple[int, int]] | None,
        target: moderngl.Framebuffer,
    ) -> None:
        """Makes `radiance` (RGBA16F), a part of the picture of `inputs` that begins at the pixel `corner`, the same part of it, at (0, 0) in `target`.

        Args:
            glow: as `spread` gives it, and the pixel of the picture, which may lie beyond its edge, where that begins; None without.
        """
        radiance.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.samplers = {"radiance": radiance, "tone_table": self._tone_table(inputs)}
        window = None
        if glow is not None:
            self.samplers["glow"], start = glow
            window = _Window((GLOW_SHRINKS * glow[0].width, GLOW_SHRINKS * glow[0].height), start)
        self._tone_map(inputs, target, (0, 0, *radiance.size), (-corner[0], -corner[1]), inputs.picture, _Window(radiance.size, corner), window)

    def _tone_map(
        self,
        inputs: FrameInputs,
        target: moderngl.Framebuffer,
        viewport: tuple[int, int, int, int],
        origin: tuple[int, int],
        shown: tuple[int, int],
        light: _Window,
        glow: _Window | None,
    ) -> None:
        """Fills `viewport` of `target` from the samplers; the picture is `shown` so large and begins at `origin` there."""
        made = self._programs.get("post/tone_map.frag", inputs, TONE_TABLE)
        made.sample(self.samplers)
        made.set(target_origin=origin, target_texel=_texel(shown), light_window=light.of(inputs.picture))
        if glow is not None:
            self.glow_window = glow.of(inputs.picture)
            made.set(glow_window=self.glow_window)
        target.use()
        outer = target.viewport
        target.viewport = viewport
        made.draw()
        target.viewport = outer

    def release(self) -> None:
        """Gives the GL objects back."""
        self._release_levels()
        if self._quarter is not None:
            self._quarter.target.release()
        self._quarter = None
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
        if may_last and self._lasting is not None and self._served < GLOW_SERVES and _lasts(self._lasting, inputs):
            self._served += 1
            return (self._up or self._down)[-1].texture
        self._lasting, self._served = (inputs, 1) if may_last else (None, 0)
        return self._bloom(inputs, radiance)

    def _bloom(self, inputs: FrameInputs, radiance: moderngl.Texture) -> moderngl.Texture:
        width, height = next(bloom_sizes(radiance.size))
        self._make_levels((width + 2 * (_glow_beyond(inputs) // GLOW_SHRINKS), height))
        self._draw_quarter(inputs, radiance, self._down[0], _glow_beyond(inputs))
        return self._spread(inputs)

    def _draw_quarter(
        self,
        inputs: FrameInputs,
        radiance: moderngl.Texture,
        level: Level,
        beyond: int = 0,
        start: tuple[float, float] = (0.0, 0.0),
        last: tuple[float, float] | None = None,
    ) -> None:
        """What glows of `radiance` from the place `start`, 0…1, to its end or the place `last` on, and of what stands so many pixels `beyond` its left and
        right border if it goes round."""
        down = self._programs.get("post/bloom_down.frag", inputs)
        down.sample({"source": radiance})
        part = _part(radiance, radiance.size) if last is None else (*_texel(radiance.size), *last)
        down.set(source_part=part, shrinks=GLOW_SHRINKS, threshold=inputs.plan.scene.post.bloom_threshold, centre_weight=0.0)
        if not beyond:
            down.set(source_start=start)
            draw_into(level, down)
            down.set(source_start=(0.0, 0.0))
            return
        level.target.frame.use()
        around = projection.filled(inputs.plan.scene.camera, radiance.size)[0]
        first = beyond + 0.5 * (radiance.width - around)  # pixel of the level's that what goes round begins at
        for turn in range(-math.ceil(first / around), math.ceil(first / around) + 1):
            left, right = (min(max(round((first + edge * around) / GLOW_SHRINKS), 0), level.size[0]) for edge in (turn, turn + 1))
            down.set(source_start=(-(beyond + turn * around) / radiance.width, 0.0))
            down.draw_boxes([(left, 0, right - left, level.size[1])])
        down.set(source_start=(0.0, 0.0))

    def _spread(self, inputs: FrameInputs) -> moderngl.Texture:
        """The glow of what the first level holds."""
        post, down = inputs.plan.scene.post, self._programs.get("post/bloom_down.frag", inputs)
        source, size = self._down[0].texture, self._down[0].size
        down.set(shrinks=2, threshold=0.0, centre_weight=4.0)
        for level in self._down[1:]:
            down.sample({"source": source})
            down.set(source_part=_part(source, size))
            draw_into(level, down)
            source, size = level.texture, level.size
        up = self._programs.get("post/bloom_up.frag", inputs)
        up.set(spread=post.bloom_spread / (0.4 + post.bloom_spread))
        for own, level in zip(reversed(self._down[:-1]), self._up):
            up.sample({"wider": source, "level": own.texture})
            up.set(wider_part=_part(source, size))
            draw_into(level, up)
            source, size = level.texture, level.size
        return source

    def _make_levels(self, first: tuple[int, int]) -> None:
        """Those of a picture whose first is so large."""
        if first == self._size:
            return
        self._release_levels()
        _, *others = bloom_sizes((GLOW_SHRINKS * first[0], GLOW_SHRINKS * first[1]))
        self._down = [Level.of(self._ctx, first, first), *(Level.of(self._ctx, other, padded(other)) for other in others)]
        self._up = [Level.of(self._ctx, level.size, level.texture.size) for level in reversed(self._down[:-1])]
        self._size = first


def _glow_beyond(inputs: FrameInputs) -> int:
    """Pixels of a whole picture beyond its left and its right border whose light glows in it: those of the other side, where it goes round."""
    return GLOW_REACH if projection.goes_round(inputs.plan.scene.camera) else 0


def _lasts(before: FrameInputs, now: FrameInputs) -> bool:
    """Whether the glow of the frame `before` will do for `now`."""
    return abs(now.time - before.time) <= GLOW_LASTS and (before.size, before.plan) == (now.size, now.plan)


def _part(source: moderngl.Texture, size: tuple[int, int]) -> tuple[float, float, float, float]:
    """Of a `source` whose light lies in its lower left `size` pixels: 1 over its own, and the last place that holds light."""
    u, v = _texel(source.size)
    return u, v, u * (size[0] - 0.5), v * (size[1] - 0.5)


def _nearest(texture: moderngl.Texture) -> moderngl.Texture:
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture


def _texel(size: tuple[int, int]) -> tuple[float, float]:
    return 1.0 / size[0], 1.0 / size[1]
