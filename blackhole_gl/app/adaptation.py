"""How a window's exposure follows what the light meter says: as an eye does, in a moment. It is told the time by the clock alone."""

from __future__ import annotations

import math
import time as clock

_FOLLOWS_S = 0.25  # time constant: a few meterings of a moving camera, so that no step shows
_LONGEST_S = 0.1  # that counts between two frames: a picture at rest has waited for nothing
_CLOSE = 0.01  # stops, less than a change of a grey level in a hundred


class Adaptation:
    """The stops that a window shows; see ``render.metering.Exposure``."""

    def __init__(self) -> None:
        self._shown: float | None = None
        self._at = 0.0

    def __call__(self, metered: float) -> float:
        """The stops of the frame that is drawn now."""
        now = clock.perf_counter()
        elapsed, self._at = min(now - self._at, _LONGEST_S), now
        if self._shown is None or abs(metered - self._shown) <= _CLOSE:
            self._shown = metered
        else:
            self._shown = metered + (self._shown - metered) * math.exp(-elapsed / _FOLLOWS_S)
        return self._shown

    def forget(self) -> None:
        """The next frame shows what is metered."""
        self._shown = None
