"""When a scene's programs may be compiled, so that the window goes on while they are not there yet.

A scene whose programs are missing is handed to another process first (`warm_up`); the last picture stays on the screen meanwhile. Then the
window compiles them itself, in a bounded part of each frame: milliseconds where the driver has kept the other's work, a program or two a frame where not.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import Future

from ..scene import Scene

FRAME_SHARE_S = 0.05
"""Of a frame, after which no further program is begun. The one under way is finished: a longest frame is this, one program and its first draw."""

FIRST_SHARE_S = 0.25
"""The same before there is any picture. The panel's own frames take time too, and the picture would wait for many of them."""

_PATIENCE_S = 30.0  # for the other process, on a busy machine; then the window does it alone


Submit = Callable[[Scene, tuple[int, int]], Future]


class Preparation:
    """Decides from frame to frame.

    Args:
        submit: has the programs of a scene compiled elsewhere, for pictures of a size; None where nobody can.

    Attributes:
        since: when what is missing was first missed, in seconds; None when nothing is.
    """

    def __init__(self, submit: Submit | None):
        self._submit = submit
        self._elsewhere: Future | None = None
        self._may_compile = True  # the first picture has nothing to wait for: there is none to show meanwhile
        self._share = FIRST_SHARE_S
        self.since: float | None = None

    def waits(self, now: float) -> bool:
        """Whether to draw no picture in this frame, as the other process is at work."""
        if self._elsewhere is None or self.since is None:
            return False
        if not self._elsewhere.done() and now - self.since < _PATIENCE_S:
            return True
        if self._elsewhere.done() and self._elsewhere.exception() is not None:
            self._submit = None
        self._elsewhere, self._may_compile = None, True
        return False

    def deadline(self, now: float) -> float:
        """After when no program may be compiled, for ``Programs.deadline``."""
        return now + self._share if self._may_compile else -math.inf

    def missed(self, scene: Scene, size: tuple[int, int], now: float) -> None:
        """A program of `scene` was missing; its first picture will have this `size`."""
        if self.since is None:
            self.since = now
        if self._submit is not None and not self._may_compile:
            self._hand_over(self._submit, scene, size)

    def over(self) -> None:
        """Nothing is missing any more: a picture is there, or an error."""
        self.since, self._may_compile, self._share = None, self._submit is None, FRAME_SHARE_S

    def _hand_over(self, submit: Submit, scene: Scene, size: tuple[int, int]) -> None:
        try:
            self._elsewhere = submit(scene, size)
        except RuntimeError:  # the other process has ended
            self._submit, self._may_compile = None, True
