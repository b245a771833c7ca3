"""What the pictures of a movement took, from one to the next, and how coarse the next one therefore is. It is told the time, and asks no clock."""

from __future__ import annotations

from typing import Any

from ..scene import Playback
from .resolution import Resolution


class Pace:
    """Feeds `Resolution` with what a window sees of its frames."""

    def __init__(self) -> None:
        self._resolution = Resolution()
        self._begun: float | None = None  # when the last picture of this movement was begun, in seconds
        self._took_ms = 0.0

    def scale(self, playback: Playback, now: float, *, moving: bool, camera_moving: bool, turns: bool = False) -> float:
        """Width and height of the picture begun `now` [s] over those of its area, at most 1; the rest is as for `Resolution.scale`."""
        if not moving:
            self.pause()
            self._resolution.rest()
            return 1.0
        elapsed = 0.0
        if self._begun is not None:
            elapsed = now - self._begun
            self._resolution.record_rest(1e3 * elapsed - self._took_ms)
        self._begun = now
        return self._resolution.scale(playback.target_fps, camera_moving=camera_moving, turns=turns, elapsed=elapsed, least=playback.coarsest)

    def pause(self) -> None:
        """The time until the next picture says nothing."""
        self._begun = None

    def forget(self) -> None:
        """What is known is of another scene."""
        self._resolution = Resolution()

    def learn(self, report: Any, scale: float) -> None:
        """Takes in what the picture at `scale` cost; see ``rendering.frame_report.FrameReport``."""
        self._took_ms = report.trace_ms + report.shade_ms + report.post_ms
        if not report.sharpened:
            self._resolution.record(scale, self._took_ms, traced=report.traced)
