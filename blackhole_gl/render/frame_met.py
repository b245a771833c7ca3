"""What rays of a frame may meet, so that two frames can be compared by it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import instances, reach
from .inputs import FrameInputs


@dataclass(frozen=True, eq=False)
class FrameMet:
    """The things and media of a frame.

    Attributes:
        kinds: of each.
        key: what its hits depend on, of each.
        balls: that hold each, (N, 4).
    """

    kinds: tuple
    key: tuple
    balls: np.ndarray

    @classmethod
    def of(cls, inputs: FrameInputs) -> FrameMet:
        """Those of `inputs`."""
        if not inputs.plan.meetings:
            return NOTHING_MET
        key = instances.key(inputs.plan, inputs.time)
        return cls(tuple(entry[:2] for entry in key), key, reach.balls(inputs.plan, inputs.time))


NOTHING_MET = FrameMet((), (), np.empty((0, 4)))
"""Where rays meet the disk and the hole alone."""
