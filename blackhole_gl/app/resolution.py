"""How coarse a moving picture is drawn so that the window keeps its frame rate. Plain arithmetic: no GL, no clock.

A picture of `scale` times the full width and height costs `scale²` times as much. What the full size would cost is the median of the last few
frames, so that one in which a driver compiled or allocated changes nothing. The scale that fits glides after it, and is rounded to steps of an
eighth of an octave: every step allocates the renderer's targets anew, so a step is left only when the glide is clearly beyond it.
"""

from __future__ import annotations

import math
from collections import deque
from statistics import median_low

STEPS_PER_OCTAVE = 8
"""A step changes width and height by 9 %, which is not seen as a hop."""

COARSEST = {True: 0.25, False: 0.5}
"""The least scale under a moving camera, and under one that rests before a disk that turns."""

REST_SHARE = 0.5
"""Of the frame rate aimed at, what a resting camera gives for a sharper picture: it is looked at, and the disk turns slowly."""

_LEAVE = 0.9  # steps between glide and step at which the step is left: well above 0.5, so that noise does not make it hop
_GLIDE_S = 0.25  # time constant of the glide: a moment, and longer than a frame
_LEAST_SHARE = 0.5  # of a frame that is the picture's: where all else takes more, a coarser picture does not bring the frame rate back
_REMEMBERED = 9  # frames


class Resolution:
    """Chooses the scale from what frames have cost."""

    def __init__(self) -> None:
        # What frames cost at full size, in milliseconds: those that traced rays and those that kept them.
        self._cost = {True: deque[float](maxlen=_REMEMBERED), False: deque[float](maxlen=_REMEMBERED)}
        self._other_ms: deque[float] = deque(maxlen=_REMEMBERED)
        self._step = {True: 0, False: 0}  # below full size, the camera moving or not
        self._glide = 0.0  # likewise, of the movement that goes on
        self._camera_moved: bool | None = None

    def record(self, scale: float, milliseconds: float, *, traced: bool) -> None:
        """Takes in what a picture at `scale` cost. Kept rays save more than their trace: the sky behind them is kept too."""
        self._cost[traced].append(milliseconds / scale**2)

    def record_rest(self, milliseconds: float) -> None:
        """Takes in what a frame cost beside its picture: panel, upscaling, waiting for the screen."""
        self._other_ms.append(max(milliseconds, 0.0))

    def rest(self) -> None:
        """Nothing moves: what moves next begins a movement of its own."""
        self._camera_moved = None

    def scale(self, target_fps: float, *, camera_moving: bool, elapsed: float) -> float:
        """The scale of the next picture, at most 1.

        Args:
            target_fps: the frame rate aimed at; 0 for none: always full size.
            camera_moving: whether rays have to be traced anew.
            elapsed: seconds since the last picture.
        """
        if target_fps <= 0.0:
            return 1.0
        lowest = -STEPS_PER_OCTAVE * math.log2(COARSEST[camera_moving])
        wanted = min(max(self._wanted(target_fps, camera_moving), 0.0), lowest)
        # When a movement begins its cost is known from the last one, so the first picture takes what fits at once.
        goes_on = camera_moving == self._camera_moved
        self._glide = wanted + (self._glide - wanted) * math.exp(-elapsed / _GLIDE_S) if goes_on else wanted
        self._camera_moved = camera_moving
        if abs(self._glide - self._step[camera_moving]) > _LEAVE:
            self._step[camera_moving] = round(self._glide)
        return 2.0 ** (-self._step[camera_moving] / STEPS_PER_OCTAVE)

    def _wanted(self, target_fps: float, camera_moving: bool) -> float:
        """Steps below full size that the budget asks for."""
        known = self._cost[camera_moving]
        if camera_moving and not known:
            return math.inf  # a coarse picture comes sooner
        if not camera_moving and len(known) < 2:
            return 0.0  # the first picture with kept rays also keeps its sky, and says little of what the next will cost
        frame_ms = 1e3 / (target_fps if camera_moving else REST_SHARE * target_fps)
        # Waiting for the screen varies from frame to frame and is no work: the least of the last few is what must be.
        budget = max(frame_ms - min(self._other_ms, default=0.0), _LEAST_SHARE * frame_ms)
        return 0.5 * STEPS_PER_OCTAVE * math.log2(max(median_low(known), 1e-6) / budget)
