"""What rays of a frame may meet, so that two frames can be compared by it."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..scene import Scene, met
from . import instances, reach
from .inputs import FrameInputs


@dataclass(frozen=True, eq=False)
class FrameMet:
    """The things and media of a frame.

    Attributes:
        kinds: of each.
        key: what its hits depend on, of each.
        balls: that hold each, (N, 4).
        fills: 1 + kind + 32·index of each that fills its ball with something opaque, as hits number them; 0 of the others, int (N,).
    """

    kinds: tuple
    key: tuple
    balls: np.ndarray
    fills: np.ndarray

    @classmethod
    def of(cls, inputs: FrameInputs) -> FrameMet:
        """Those of `inputs`."""
        if not inputs.plan.meetings:
            return NOTHING_MET
        key = instances.key(inputs.plan, inputs.time)
        return cls(tuple(entry[:2] for entry in key), key, reach.balls(inputs.plan, inputs.time), _fills(inputs.plan.scene))


NOTHING_MET = FrameMet((), (), np.empty((0, 4)), np.empty(0, int))
"""Where rays meet the disk and the hole alone."""


@lru_cache(maxsize=met.SCENES_KEPT)
def _fills(scene: Scene) -> np.ndarray:
    kinds = {(kind.slot, kind.key): (number, kind) for number, kind in enumerate(instances.used(scene))}
    found: list[int] = []
    for slot in met.SLOTS:
        met_before: Counter[str] = Counter()
        for one in met.instances(scene, slot):
            number, kind = kinds[slot, one.kind]
            fills = slot == "thing" and kind.traits.round and kind.traits.opaque
            found.append(1 + number + 32 * met_before[one.kind] if fills else 0)
            met_before[one.kind] += 1
    return np.array(found, int)
