"""Pictures of any size: drawn in tiles, developed in bands from the top down and handed on, so that no more of one is held than its glow reaches.

What is held are `GLOW_REACH` rows and a band of linear light, eight bytes a pixel, and a sixteenth of as much again that glows: it grows with a picture's
width and not with its height.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from ..physics import projection
from ..planning import Plan
from .inputs import FrameInputs
from .post import GLOW_GRID, GLOW_REACH, GLOW_SHRINKS, PostPass
from .stereo import STRIP, Eyes
from .target import Target

TILE = 512
"""Side in pixels of the tiles of a still; even, so that pixel quads never straddle two."""

# About a tile, drawn with it and left out: whether a pixel is at an edge depends on those beside it. Even, as the tiles are.
_MARGIN = 2


_BAND_PIXELS = 1 << 22  # in a band, or a row of tiles where that is more
_MOST_WIDE = 8192  # pixels of a texture, along either side: drivers end at 16384

Place = tuple[int, int]
"""(x, y) of a pixel from the bottom left."""


@dataclass(frozen=True)
class _Part:
    """A row of tiles, a piece of it: a texture of its light."""

    corner: Place
    light: moderngl.Texture


@dataclass(frozen=True)
class _Band:
    """Rows `first` to `end` from the bottom of a picture, in parts from left to right."""

    first: int
    end: int
    parts: tuple[_Part, ...]


class Stills:
    """Draws pictures in tiles.

    Args:
        draw: makes the radiance of a tile, with a target that the next call may use anew.
        post: makes it the picture.
    """

    def __init__(self, ctx: moderngl.Context, draw: Callable[[FrameInputs], Target], post: PostPass):
        self._ctx, self._draw, self._post = ctx, draw, post
        self._free: list[moderngl.Texture] = []
        self._target: Target | None = None

    def bands(
        self, moments: Sequence[tuple[Plan, float]], size: tuple[int, int], samples: int, tile: int = TILE
    ) -> Iterator[tuple[float, np.ndarray | None]]:
        """Draws the mean light of `moments`, (plan, time), developed as the middle one: the share done, after each tile and with rows that are finished, uint8
        (rows, width, 3) from the top of the picture down, or None.

        Args:
            samples: rays a pixel along each axis.
            tile: side of the tiles in pixels; even.

        Raises:
            ValueError: all light of a picture is needed at once, which the driver has no texture for.
        """
        views = _views(moments, size)
        if _needs_all(moments[0][0]):
            self._refuse_larger_than_a_texture(size)
        if size[0] * size[1] <= tile * tile and max(size) <= _MOST_WIDE:  # one is enough, whatever its shape
            tile = -(-max(size) // GLOW_GRID) * GLOW_GRID
        for number, view in enumerate(views):
            for share, rows in self._view_bands(view, samples, tile):
                yield (number + share) / len(views), rows

    def light(self, moments: Sequence[tuple[Plan, float]], size: tuple[int, int], samples: int) -> np.ndarray:
        """The mean radiance of `moments`, float32 (height, width, 3), top row first."""
        views = _views(moments, size)
        found = np.empty((size[1], size[0], 3), np.float32)
        for number, view in enumerate(views):
            top = size[1] - number * view.size[1]  # rows from the bottom
            upwards = found[::-1][top - view.size[1] : top]
            for _, (x, y), part in self._tiles(view, samples, TILE, view.places(0, view.size[1], TILE)):
                if part is not None:
                    upwards[y : y + part.shape[0], x : x + part.shape[1]] = part[..., :3]
        return found

    def release(self) -> None:
        """Gives the GL objects back."""
        for texture in self._free:
            texture.release()
        self._free = []
        if self._target is not None:
            self._target.release()
        self._target = None

    def _refuse_larger_than_a_texture(self, size: tuple[int, int]) -> None:
        most = self._ctx.info["GL_MAX_TEXTURE_SIZE"]
        if max(size) > most:
            width, height = size
            text = f"at most {most} pixels a side with post.lens, post.beam or post.colours, which need all of a picture at once"
            raise ValueError(f"size: got {width}x{height}; allowed is {text}")

    def _view_bands(self, view: _View, samples: int, tile: int) -> Iterator[tuple[float, np.ndarray | None]]:
        plan, time = view.moments[len(view.moments) // 2]
        inputs = FrameInputs.whole(plan, time, view.size)
        glow = _Glow(self._post, inputs) if _glows(plan) else None
        held: deque[_Band] = deque()
        try:
            for share, band in self._light_bands(view, samples, tile, whole=_needs_all(plan)):
                yield share, None
                if band is None:
                    continue
                held.append(band)
                if glow is not None:
                    glow.add(band)
                lowest = 0 if band.first == 0 else band.first + (0 if glow is None else GLOW_REACH)
                while held and held[0].first >= lowest:
                    yield share, self._developed(inputs, held.popleft(), glow)
        finally:
            for band in held:
                self._free += [part.light for part in band.parts]
            self.release()

    def _light_bands(self, view: _View, samples: int, tile: int, *, whole: bool) -> Iterator[tuple[float, _Band | None]]:
        """Bands from the top down, and the share done with each of their tiles."""
        width, height = view.size
        rows = math.lcm(tile, GLOW_GRID)
        rows = -(-height // rows) * rows if whole else max(min(_BAND_PIXELS // width, _MOST_WIDE) // rows, 1) * rows
        wide = width if whole else max(min(_MOST_WIDE, width) // math.lcm(tile, GLOW_GRID), 1) * math.lcm(tile, GLOW_GRID)
        for first in range((height - 1) // rows * rows, -1, -rows):
            end = min(first + rows, height)
            parts = tuple(_Part((x, first), self._texture((min(wide, width - x), end - first))) for x in range(0, width, wide))
            places = view.places(first, end, tile)
            before = (height - end) / height
            for share, (x, y), light in self._tiles(view, samples, tile, places):
                done = before + share * (end - first) / height
                if light is not None:
                    part = parts[x // wide]
                    data = np.ascontiguousarray(light, np.float16)
                    part.light.write(data, viewport=(x - part.corner[0], y - first, data.shape[1], data.shape[0]))
                    if (x, y) == places[-1]:
                        yield done, _Band(first, end, parts)
                        continue
                yield done, None

    def _tiles(self, view: _View, samples: int, tile: int, places: Sequence[Place]) -> Iterator[tuple[float, Place, np.ndarray | None]]:
        """Draws one ray a pixel of one tile at a time: the share done, the tile's lower left corner and, when all its rays are there, their mean radiance,
        (height, width, 4) with row 0 at the bottom, float16 of a single one, else float32."""
        width, height = view.size
        number, rays = 0, samples * samples * len(view.moments)
        for x, y in places:
            total: np.ndarray | None = None
            wide, high = min(view.tile_width(tile), width - x), min(tile, height - y)
            left, bottom = max(x - _MARGIN, view.least[0]), max(y - _MARGIN, view.least[1])
            drawn = min(x + wide + _MARGIN, width - view.least[0]) - left, min(y + high + _MARGIN, height - view.least[1]) - bottom
            for k in range(rays):
                moment, sample = divmod(k, samples * samples)
                shift = [(part + 0.5) / samples - 0.5 for part in (sample % samples, sample // samples)]
                plan, time = view.moments[moment]
                inputs = FrameInputs(view.plan_at(plan, x), time, drawn, view.size, (left + shift[0], bottom + shift[1]))
                light = _light_of(self._draw(inputs))[y - bottom : y - bottom + high, x - left : x - left + wide]
                if rays > 1:
                    total = np.zeros(light.shape, np.float32) if total is None else total
                    total += np.multiply(light, np.float32(1.0 / rays), dtype=np.float32)
                else:
                    total = light
                number += 1
                yield number / (len(places) * rays), (x, y), total if k + 1 == rays else None

    def _developed(self, inputs: FrameInputs, band: _Band, glow: _Glow | None) -> np.ndarray:
        """The rows of `band`, top row first; its textures are free then."""
        found = np.empty((band.end - band.first, inputs.picture[0], 3), np.uint8)
        for part in band.parts:
            target = self._target_of(part.light.size)
            if _needs_all(inputs.plan):
                self._post.draw(inputs, part.light, target.frame, (0, 0, *part.light.size))
            else:
                self._post.develop(inputs, part.light, part.corner, None if glow is None else glow.about(part.corner, part.light.size), target.frame)
            pixels = np.empty((part.light.height, part.light.width, 3), np.uint8)
            target.frame.read_into(pixels, components=3, alignment=1)
            found[:, part.corner[0] : part.corner[0] + part.light.width] = pixels[::-1]
            self._free.append(part.light)
        return found

    def _texture(self, size: tuple[int, int]) -> moderngl.Texture:
        """One for light, of those that are free where one fits."""
        for texture in self._free:
            if texture.size == size:
                self._free.remove(texture)
                return texture
        return self._ctx.texture(size, 4, dtype="f2")

    def _target_of(self, size: tuple[int, int]) -> Target:
        if self._target is None or self._target.size != size:
            if self._target is not None:
                self._target.release()
            self._target = Target.of(self._ctx, [self._ctx.texture(size, 4, dtype="f1")])
        return self._target


@dataclass(frozen=True)
class _View:
    """A picture by one camera, or by one eye.

    Attributes:
        moments: (plan, time) whose mean it is.
        eyes: where it stands in every column; None of one that stands still.
        goes_round: whether left and right border, and either half of the upper and of the lower, are neighbours.
    """

    moments: tuple[tuple[Plan, float], ...]
    size: tuple[int, int]
    eyes: Eyes | None
    goes_round: bool

    @property
    def least(self) -> Place:
        """Of the pixels that tiles may draw beside their own, the least."""
        return (-_MARGIN, -_MARGIN) if self.goes_round else (0, 0)

    def tile_width(self, tile: int) -> int:
        """Of tiles `tile` high."""
        return tile if self.eyes is None else min(tile, STRIP)

    def places(self, first: int, end: int, tile: int) -> list[Place]:
        """The lower left corners of the tiles in rows `first` to `end`."""
        return [(x, y) for y in range(first, end, tile) for x in range(0, self.size[0], self.tile_width(tile))]

    def plan_at(self, plan: Plan, column: int) -> Plan:
        """`plan` where the tile from `column` on is seen from."""
        return plan if self.eyes is None else self.eyes.plan(plan, column)


class _Glow:
    """What glows of a picture, kept for as long as it may reach a band."""

    def __init__(self, post: PostPass, inputs: FrameInputs):
        self._post, self._inputs = post, inputs
        self._rows: dict[int, np.ndarray] = {}  # rows of a quarter of the picture's
        self._size = -(-inputs.picture[0] // GLOW_SHRINKS), -(-inputs.picture[1] // GLOW_SHRINKS)
        self._goes_round = projection.goes_round(inputs.plan.scene.camera)
        self._last: tuple[tuple[int, ...], moderngl.Texture] | None = None

    def add(self, band: _Band) -> None:
        """`band`, which lies below all before."""
        rows = np.concatenate([self._post.bright(self._inputs, part.light) for part in band.parts], axis=1)
        for number, row in enumerate(rows, band.first // GLOW_SHRINKS):
            self._rows[number] = row

    def about(self, corner: Place, size: tuple[int, int]) -> tuple[moderngl.Texture, Place]:
        """The glow about a part of the picture, and the pixel where it begins."""
        reach = GLOW_REACH // GLOW_SHRINKS
        bounds = []
        for first, wide, whole in zip(corner, size, self._size):
            low, high = first // GLOW_SHRINKS - reach, -(-(first + wide) // GLOW_SHRINKS) + reach
            bounds += [low, high] if self._goes_round else [max(low, 0), min(high, whole)]
        key = tuple(bounds)
        if self._last is None or self._last[0] != key:
            self._last = key, self._post.spread(self._inputs, self._cut(*bounds))
        self._forget_above(bounds[3])
        return self._last[1], (GLOW_SHRINKS * bounds[0], GLOW_SHRINKS * bounds[2])

    def _cut(self, left: int, right: int, bottom: int, top: int) -> np.ndarray:
        """Columns and rows of what glows; beyond a border of what goes round comes what lies there: over a pole, upside down and half way round."""
        width, height = self._size
        columns = np.arange(left, right) % width
        found = np.empty((top - bottom, right - left, 4), np.float16)
        for place, row in enumerate(range(bottom, top)):
            folded = row % (2 * height)
            over = folded >= height
            found[place] = self._rows[2 * height - 1 - folded if over else folded][(columns + width // 2) % width if over else columns]
        return found

    def _forget_above(self, row: int) -> None:
        if self._goes_round and self._size[1] <= 2 * GLOW_REACH // GLOW_SHRINKS:
            return
        for number in [number for number in self._rows if number >= row]:
            del self._rows[number]


def _glows(plan: Plan) -> bool:
    post = plan.scene.post
    return post.bloom and post.colours == "light" and not _needs_all(plan)


def _needs_all(plan: Plan) -> bool:
    """Whether the picture is developed from all of its light at once."""
    post = plan.scene.post
    return post.lens or post.beam or post.colours != "light"


def _views(moments: Sequence[tuple[Plan, float]], size: tuple[int, int]) -> list[_View]:
    """From the top of the picture down."""
    camera = moments[0][0].scene.camera
    round_ = projection.goes_round(camera)
    if camera.projection != projection.STEREO:
        return [_View(tuple(moments), size, None, round_)]
    half = size[0], size[1] // 2
    return [_View(tuple(moments), half, Eyes(side, half[0]), round_) for side in (-1.0, 1.0)]


def _light_of(target: Target) -> np.ndarray:
    """float16 (height, width, 4), row 0 at the bottom. Waits for the GPU."""
    width, height = target.size
    return np.frombuffer(target.texture.read(), np.float16).reshape(height, width, 4)
