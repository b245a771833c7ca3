"""Pictures of any size: drawn in tiles, developed in bands from the top down and handed on, so that no more of one is held than its glow reaches.

What is held are `GLOW_REACH` rows and a band of linear light, eight bytes a pixel, and a sixteenth of as much again that glows: it grows with a picture's
width and not with its height.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import moderngl
import numpy as np

from ..physics import projection
from ..planning import Plan
from . import tiles
from .inputs import FrameInputs
from .post import GLOW_GRID, GLOW_REACH, GLOW_SHRINKS, PostPass
from .target import Target
from .tiles import TILE, Kind, Light, Lights, Place, Tile, View

_BAND_PIXELS = 1 << 22  # in a band, or a row of tiles where that is more
_MOST_WIDE = 8192  # pixels of a texture, along either side: drivers end at 16384


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
        self, moments: Sequence[tuple[Plan, float]], size: tuple[int, int], samples: int, tile: int = TILE, lights: Lights | None = None
    ) -> Iterator[tuple[float, np.ndarray | None]]:
        """Draws the mean light of `moments`, (plan, time), developed as the middle one: the share done, after each tile and with rows that are finished, uint8
        (rows, width, 3) from the top of the picture down, or None.

        Args:
            samples: rays a pixel along each axis.
            tile: side of the tiles in pixels; even.
            lights: what draws the tiles in the place of this.

        Raises:
            ValueError: all light of a picture is needed at once, which the driver has no texture for.
        """
        views = tiles.views(moments, size)
        if _needs_all(moments[0][0]):
            self._refuse_larger_than_a_texture(size)
        if size[0] * size[1] <= tile * tile and max(size) <= _MOST_WIDE:  # one is enough, whatever its shape
            tile = -(-max(size) // GLOW_GRID) * GLOW_GRID
        wanted = ((k, place) for k, view in enumerate(views) for rows in _bands_of(view, tile) for place in view.places(*rows, tile))
        drawn = (lights or self._lights(views, samples))(tile, wanted, np.float16)
        for number, view in enumerate(views):
            for share, rows in self._view_bands(view, tile, drawn):
                yield (number + share) / len(views), rows

    def light(self, moments: Sequence[tuple[Plan, float]], size: tuple[int, int], samples: int, lights: Lights | None = None) -> np.ndarray:
        """The mean radiance of `moments`, float32 (height, width, 3), top row first; `lights` as in `bands`."""
        views = tiles.views(moments, size)
        found = np.empty((size[1], size[0], 3), np.float32)
        wanted = [(number, place) for number, view in enumerate(views) for place in view.places(0, view.size[1], TILE)]
        drawn = (lights or self._lights(views, samples))(TILE, wanted, np.float32)
        for (number, (x, y)), part in zip(wanted, (light for _, light in drawn if light is not None)):
            high = views[number].size[1]
            top = size[1] - number * high  # rows from the bottom
            upwards = found[::-1][top - high : top]
            upwards[y : y + part.shape[0], x : x + part.shape[1]] = part[..., :3]
        return found

    def tiles(
        self, moments: Sequence[tuple[Plan, float]], size: tuple[int, int], samples: int, side: int, wanted: Sequence[Tile], kind: Kind
    ) -> list[np.ndarray]:
        """The mean light of `moments` in each of the tiles `wanted`, as what `lights` of `bands` is asked for."""
        drawn = self._lights(tiles.views(moments, size), samples)(side, wanted, kind)
        return [light for _, light in drawn if light is not None]

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

    def _lights(self, views: Sequence[View], samples: int) -> Lights:
        return partial(tiles.drawn, self._draw, views, samples)

    def _view_bands(self, view: View, tile: int, drawn: Iterator[Light]) -> Iterator[tuple[float, np.ndarray | None]]:
        plan, time = view.moments[len(view.moments) // 2]
        inputs = FrameInputs.whole(plan, time, view.size)
        glow = _Glow(self._post, inputs) if _glows(plan) else None
        held: deque[_Band] = deque()
        try:
            for share, band in self._light_bands(view, tile, drawn):
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

    def _light_bands(self, view: View, tile: int, drawn: Iterator[Light]) -> Iterator[tuple[float, _Band | None]]:
        """Bands from the top down, and the share done with each of their tiles."""
        width, height = view.size
        whole = math.lcm(tile, GLOW_GRID)
        wide = width if _needs_all(view.moments[0][0]) else max(min(_MOST_WIDE, width) // whole, 1) * whole
        for first, end in _bands_of(view, tile):
            parts = tuple(_Part((x, first), self._texture((min(wide, width - x), end - first))) for x in range(0, width, wide))
            places = view.places(first, end, tile)
            number = 0
            while number < len(places):
                share, light = next(drawn)
                done = (height - end + (number + share) / len(places) * (end - first)) / height
                if light is not None:
                    x, y = places[number]
                    part = parts[x // wide]
                    part.light.write(light, viewport=(x - part.corner[0], y - first, light.shape[1], light.shape[0]))
                    number += 1
                yield done, _Band(first, end, parts) if number == len(places) else None

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


def _bands_of(view: View, tile: int) -> Iterator[tuple[int, int]]:
    """First row and end of each band of `view`, from the top down: whole rows of tiles, and of what glows."""
    width, height = view.size
    rows = math.lcm(tile, GLOW_GRID)
    rows = -(-height // rows) * rows if _needs_all(view.moments[0][0]) else max(min(_BAND_PIXELS // width, _MOST_WIDE) // rows, 1) * rows
    for first in range((height - 1) // rows * rows, -1, -rows):
        yield first, min(first + rows, height)
