"""Tiles of stills: where they lie, from where each is seen, and their light. Each is drawn for itself, here or elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..physics import projection
from ..planning import Plan
from ..scene import Camera, Scene
from .inputs import FrameInputs
from .stereo import STRIP, Eyes
from .target import Target

TILE = 512
"""Side in pixels of the tiles of a still; even, so that pixel quads never straddle two."""

# About a tile, drawn with it and left out: whether a pixel is at an edge depends on those beside it. Even, as the tiles are.
_MARGIN = 2

Place = tuple[int, int]
"""(x, y) of a pixel from the bottom left."""

Tile = tuple[int, Place]
"""The number of a view, from the top of the picture, and the lower left corner of a tile of it."""

Kind = type[np.float16] | type[np.float32]
"""In what light is given: float16 as textures hold it, or float32, which a mean of many rays keeps more of."""

Light = tuple[float, np.ndarray | None]
"""How much of a tile is drawn, 0…1, and when all of it is its light: (height, width, 4), row 0 at the bottom."""

Lights = Callable[[int, Iterable[Tile], Kind], Iterator[Light]]
"""Draws tiles of a picture, whose side in pixels it is given, in the order that they come in."""

Spread = Callable[[Sequence[tuple[Scene, float]], tuple[int, int], int, int, Iterable[Tile], Kind], Iterator[Light]]
"""`Lights` of the picture of `moments`, (scene, time), of a size and with so many rays a pixel along each axis, which come before its own arguments."""


@dataclass(frozen=True)
class View:
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


def views(moments: Sequence[tuple[Plan, float]], size: tuple[int, int]) -> list[View]:
    """From the top of the picture down."""
    camera = moments[0][0].scene.camera
    round_ = projection.goes_round(camera)
    if camera.projection != projection.STEREO:
        return [View(tuple(moments), size, None, round_)]
    half = size[0], size[1] // 2
    return [View(tuple(moments), half, Eyes(side, half[0]), round_) for side in (-1.0, 1.0)]


def in_a_square(camera: Camera, side: int) -> int:
    """How many tiles `side` high are as wide as that, which are narrower where the camera goes on from one to the next."""
    return max(side // STRIP, 1) if camera.projection == projection.STEREO else 1


def drawn(
    draw: Callable[[FrameInputs], Target], seen: Sequence[View], samples: int, side: int, wanted: Iterable[Tile], kind: Kind
) -> Iterator[Light]:
    """Draws one ray a pixel of one tile at a time.

    Args:
        draw: makes the radiance of a part of a picture, with a target that the next call may use anew.
        seen: the views of the picture.
        samples: rays a pixel along each axis.
    """
    for number, (x, y) in wanted:
        view = seen[number]
        width, height = view.size
        rays = samples * samples * len(view.moments)
        total: np.ndarray | None = None
        wide, high = min(view.tile_width(side), width - x), min(side, height - y)
        left, bottom = max(x - _MARGIN, view.least[0]), max(y - _MARGIN, view.least[1])
        size = min(x + wide + _MARGIN, width - view.least[0]) - left, min(y + high + _MARGIN, height - view.least[1]) - bottom
        for k in range(rays):
            moment, sample = divmod(k, samples * samples)
            shift = [(part + 0.5) / samples - 0.5 for part in (sample % samples, sample // samples)]
            plan, time = view.moments[moment]
            inputs = FrameInputs(view.plan_at(plan, x), time, size, view.size, (left + shift[0], bottom + shift[1]))
            light = _light_of(draw(inputs))[y - bottom : y - bottom + high, x - left : x - left + wide]
            if rays > 1:
                total = np.zeros(light.shape, np.float32) if total is None else total
                total += np.multiply(light, np.float32(1.0 / rays), dtype=np.float32)
            else:
                total = light
            yield (k + 1) / rays, total.astype(kind, order="C") if k + 1 == rays else None


def _light_of(target: Target) -> np.ndarray:
    """float16 (height, width, 4), row 0 at the bottom. Waits for the GPU."""
    width, height = target.size
    return np.frombuffer(target.texture.read(), np.float16).reshape(height, width, 4)
