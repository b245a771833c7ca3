"""What rays of a frame may meet, so that two frames can be compared by it."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..scene import Scene, met
from ..scene.instances import Instances
from ..scene.plug_in import PlugIn
from . import instances, reach
from .inputs import FrameInputs


@dataclass(frozen=True, eq=False)
class FrameMet:
    """The things and media of a frame.

    Attributes:
        kinds: of each.
        key: what its hits depend on, of each.
        balls: that hold each, (N, 4).
        numbers: 1 + kind + 32·index of each thing, as hits number them; 0 of media, int (N,).
        fills: which fill their balls with something opaque, bool (N,).
        bodies: those, and which are shapes that lie in their balls, bool (N,).
    """

    kinds: tuple
    key: tuple
    balls: np.ndarray
    numbers: np.ndarray
    fills: np.ndarray
    bodies: np.ndarray

    @classmethod
    def of(cls, inputs: FrameInputs) -> FrameMet:
        """Those of `inputs`."""
        if not inputs.plan.meetings:
            return NOTHING_MET
        key = instances.key(inputs.plan, inputs.time)
        return cls(tuple(entry[:2] for entry in key), key, reach.balls(inputs.plan, inputs.time), *_numbers(inputs.plan.scene))


NOTHING_MET = FrameMet((), (), np.empty((0, 4)), np.empty(0, int), np.empty(0, bool), np.empty(0, bool))
"""Where rays meet the disk and the hole alone."""


def _numbers(scene: Scene) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return _numbers_of(scene.things, met.kinds(scene, "thing"), len(scene.media))


@lru_cache(maxsize=met.SCENES_KEPT)
def _numbers_of(things: Instances, kinds: tuple[PlugIn, ...], media: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Kept by the scene's instances: while only the camera moves they are the same object."""
    numbers = {kind.key: number for number, kind in enumerate(kinds)}
    filling = {kind.key for kind in kinds if kind.traits.round and kind.traits.opaque}
    shapes = {kind.key for kind in kinds if kind.traits.tells_apart}
    met_before: Counter[str] = Counter()
    found, fills, bodies = np.zeros(len(things) + media, int), np.zeros(len(things) + media, bool), np.zeros(len(things) + media, bool)
    for place, one in enumerate(things.values()):
        found[place], fills[place] = 1 + numbers[one.kind] + 32 * met_before[one.kind], one.kind in filling
        bodies[place] = fills[place] or one.kind in shapes
        met_before[one.kind] += 1
    return found, fills, bodies
