"""How many rays a pixel a picture at rest takes, one more a frame, as long as the window goes on answering."""

from __future__ import annotations

import time as clock
from collections.abc import Callable

from ..rendering import views
from ..scene import Scene

# A picture at rest that takes longer than this for one more ray a pixel, two times running, is left as it is, in seconds: meanwhile the window answers
# nothing. Once is no more than a first draw, or another program's doing.
_LONGEST_SAMPLE_S = 0.5


class Sharpening:
    """The rays a pixel of one picture after the other.

    Attributes:
        samples: rays a pixel that the last picture is the mean of.
    """

    def __init__(self) -> None:
        self.samples = 1
        self._most = 1  # that the picture is to have at rest
        self._took_s = 0.0  # the last one

    @property
    def is_done(self) -> bool:
        """Whether the picture is to have no more."""
        return self.samples >= self._most

    def forget(self) -> None:
        """There is no picture yet that may have more than one."""
        self.samples = self._most = 1

    def begin(self, scene: Scene) -> None:
        """There is a new picture, of `scene`."""
        self._most = scene.rays.at_rest if views.has_mean(scene) else 1

    def take(self, draw: Callable[[], int]) -> bool:
        """Has one more taken by `draw`, which returns how many there are then. Returns whether there was one to take."""
        if self.is_done:
            return False
        begun = clock.perf_counter()
        self.samples = draw()
        before, self._took_s = self._took_s, clock.perf_counter() - begun
        if min(before, self._took_s) > _LONGEST_SAMPLE_S:
            self._most = self.samples
        return True
