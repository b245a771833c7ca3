"""What the rays of the last picture meet, at a place or for an instance, read from the hit map that is kept of it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..scene import Scene
from . import instance_numbers
from .hit_map import HitArrays, HitMap
from .inputs import FrameInputs

if TYPE_CHECKING:
    from .pixel_values import PixelValues


class LastPicture:
    """The last picture of a renderer.

    Args:
        hit_map, asked: that of the picture, and one for single rays; they stay their owner's.
    """

    def __init__(self, hit_map: HitMap, asked: HitMap):
        self._hit_map, self._asked = hit_map, asked
        self._whole: FrameInputs | None = None
        self._apart = False

    def show(self, whole: FrameInputs | None, *, apart: bool = False) -> None:
        """The picture is another: one of `whole`, of whose media the hit map knows nothing where they are marched `apart`; None: no ray is known of it."""
        self._whole, self._apart = whole, apart

    def values_at(self, place: tuple[float, float]) -> PixelValues | None:
        """What the ray meets at `place` of the picture, its width and height counted 0…1 from the bottom left; None where no pixel has a ray of its own."""
        from . import pixel_values  # only for who asks: most pictures are drawn without

        found = self._ray_at(place)
        return None if found is None else pixel_values.of(*found)

    def instance_at(self, place: tuple[float, float]) -> str | None:
        """The key of the thing or medium that is met at `place`, such as ``things.moon``, empty where there is none; None and `place` as in `values_at`."""
        found = self._ray_at(place)
        return None if found is None else instance_numbers.picked(found[0].plan.scene, found[1].met)

    def pixels_of(self, scene: Scene, path: str) -> np.ndarray | None:
        """The pixels of the picture, one of `scene`, whose rays meet the instance called `path`, bool (height, width), bottom row first; None where not
        every pixel has a ray of its own, or no ray can meet it."""
        number = instance_numbers.number_of(scene, path)
        if number is None or self._whole is None or not self._hit_map.textures or not self._hit_map.is_sharp:
            return None
        return self._where_apart(self._whole, number) if self._apart else self._hit_map.where_met(number)

    def _where_apart(self, inputs: FrameInputs, number: instance_numbers.Number) -> np.ndarray:
        """As `HitMap.where_met`, of every fourth ray: those of the map itself have not been asked for the media of `inputs`."""
        width, height = inputs.size
        self._asked.trace(FrameInputs.whole(inputs.plan, inputs.time, (-(-width // 4), -(-height // 4))))
        return np.kron(self._asked.where_met(number), np.ones((4, 4), bool))[:height, :width]

    def _ray_at(self, place: tuple[float, float]) -> tuple[FrameInputs, HitArrays, tuple[int, int]] | None:
        if self._whole is None or not self._hit_map.textures:
            return None
        pixel = math.floor(place[0] * self._hit_map.textures[0].width), math.floor(place[1] * self._hit_map.textures[0].height)
        found = self._hit_map.at(pixel)
        if found is None or not self._apart:
            return None if found is None else (*found, pixel)
        self._asked.trace(replace(self._whole, size=(3, 3), offset=(pixel[0] - 1.0, pixel[1] - 1.0)))  # no power of two: docs/llvmpipe.md
        one = self._asked.at((1, 1))
        return None if one is None else (self._whole, one[1], pixel)
