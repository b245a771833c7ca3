"""How coarse a moving picture is drawn so that the window keeps its frame rate. Plain arithmetic: no GL, no clock.

A frame costs ``other + constant + scale² × rate``: what is not the picture's (the panel, the screen), what a picture of any size costs (Python, a dozen
passes over next to nothing), and what its pixels cost. The constant shows where a movement begins or ends, as the picture at rest and those in motion
beside it are of one view and of very different size. Within a movement nothing is learnt of it: a view that grows dearer while the window draws it
coarser looks like a picture that costs the same at any size. The rate is the median of the last few frames, so that one in which a driver compiled or
allocated changes nothing. The scale that fits glides after it, and is rounded to steps of an eighth of an octave: every step allocates the renderer's
targets anew, so a step is left only when the glide is clearly beyond it.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from enum import Enum
from statistics import median, median_low

STEPS_PER_OCTAVE = 8
"""A step changes width and height by 9 %, which is not seen as a hop."""

COARSEST = 0.25
"""The least scale under a moving camera where a scene says nothing else (``playback.coarsest``)."""


class _Kind(Enum):
    """What moves in a picture, and so what it costs."""

    TIME = 0
    LOOK = 1
    """The camera's look alone: light is kept by direction."""
    CAMERA = 2


def coarsest(least: float, *, camera_moving: bool) -> float:
    """The least scale where `least` is that under a moving camera: one that rests before a disk that turns has twice that."""
    return least if camera_moving else min(2.0 * least, 1.0)


REST_SHARE = 0.5
"""Of the frame rate aimed at, what a resting camera gives for a sharper picture: it is looked at, and the disk turns slowly."""

PIXELS_SHARE = 1.0 / 6.0
"""Of all that does not depend on the size, what pixels may always cost. Where that alone fills the frame, fewer pixels cannot bring the frame rate
back: they would blur the picture for a gain that nobody sees."""

# Steps between glide and step at which the step is left: well above 0.5, so that noise does not make it hop. A resting picture must trace all its rays anew.
# So must light by direction.
_LEAVE = {_Kind.CAMERA: 0.9, _Kind.LOOK: 2.0, _Kind.TIME: 2.0}
_GLIDE_S = 0.25  # time constant of the glide: a moment, and longer than a frame
_SETTLING_S = 8.0 * _GLIDE_S  # a movement's step is found then, whatever the noise: e⁻⁸ of the longest glide is less than a hundredth of a step
_MOST_OTHER = 0.5  # of a frame that is not the picture's: waiting for the screen cannot be told from work, and would keep pictures coarse
_REMEMBERED = 9  # frames; those beside a picture at rest that are of the same view
# Estimates of the constant that are kept: of four movements, each of which gives one a picture while the one at rest is remembered, and one at its end.
_ESTIMATES = 4 * (_REMEMBERED + 1)
_APART = 2.0  # ratio of pixels from which two frames tell the constant from the rate
# Of a picture's cost, so that a constant found too large does not make pixels free: the share of the pixels that even the coarsest picture has.
_LEAST_OF_PIXELS = COARSEST**2


@dataclass(frozen=True)
class _Cost:
    """What a picture cost in milliseconds; its pixels as a share of the full size; whether its rays were traced, and its camera at rest."""

    pixels: float
    milliseconds: float
    traced: bool
    at_rest: bool

    def constant(self, other: _Cost) -> float:
        """What both pictures cost beside their pixels, neither less than nothing nor more than all."""
        found = (other.milliseconds * self.pixels - self.milliseconds * other.pixels) / (self.pixels - other.pixels)
        return min(max(found, 0.0), self.milliseconds, other.milliseconds)

    def is_comparable(self, other: _Cost) -> bool:
        """Whether the two tell their constant."""
        few, many = sorted((self.pixels, other.pixels))
        return self.traced and other.traced and self.at_rest != other.at_rest and many >= _APART * few


class Resolution:
    """Chooses the scale from what frames have cost."""

    def __init__(self) -> None:
        # Of moving cameras' pictures, with those at rest that trace as they do; and of others, which save more than the trace: their sky is kept too.
        self._costs = {kind: deque[_Cost](maxlen=_REMEMBERED) for kind in _Kind}
        self._constants: deque[float] = deque(maxlen=_ESTIMATES)
        self._cheapest = math.inf  # median cost of a few pictures that followed each other, in milliseconds
        self._other_ms: deque[float] = deque(maxlen=_REMEMBERED)
        self._step = dict.fromkeys(_Kind, 0)  # below full size
        self._glide = 0.0  # steps below full size, of the movement that goes on
        self._lasted = 0.0  # seconds that it has gone on
        self._kind: _Kind | None = None  # of the last picture

    @property
    def constant_ms(self) -> float:
        """What a picture of any size that traces rays is taken to cost; 0 until two movements have been seen, half of those that count.

        It is no more than pictures have cost at their cheapest. When a machine becomes busy as a movement begins, coarse pictures seem to cost as much as
        the whole one did; were that believed, the next would be drawn far too large.
        """
        return min(median(self._constants), self._cheapest) if 2 * len(self._constants) >= _ESTIMATES else 0.0

    def record(self, scale: float, milliseconds: float, *, traced: bool) -> None:
        """Takes in what a picture at `scale` cost."""
        cost = _Cost(scale**2, milliseconds, traced, at_rest=self._kind not in (_Kind.CAMERA, _Kind.LOOK))
        if self._kind is _Kind.LOOK and not traced:
            self._costs[_Kind.LOOK].append(cost)
            return
        known = self._costs[_Kind.CAMERA if traced or not cost.at_rest else _Kind.TIME]  # a camera that turns about the axis keeps its rays and moves
        found = [cost.constant(other) for other in known if cost.is_comparable(other)]
        if found:
            self._constants.append(median(found))
        known.append(cost)
        if traced and len(known) == _REMEMBERED:
            self._cheapest = min(self._cheapest, median(other.milliseconds for other in known))

    def record_rest(self, milliseconds: float) -> None:
        """Takes in what a frame cost beside its picture: panel, upscaling, waiting for the screen."""
        self._other_ms.append(max(milliseconds, 0.0))

    def rest(self) -> None:
        """Nothing moves: what moves next begins a movement of its own."""
        self._kind = None

    def scale(self, target_fps: float, *, camera_moving: bool, elapsed: float, least: float = COARSEST, turns: bool = False) -> float:
        """The scale of the next picture, at most 1.

        Args:
            target_fps: the frame rate aimed at; 0 for none: always full size.
            camera_moving: whether the camera moves.
            turns: whether that is no more than a look, for which rays need not be traced anew.
            elapsed: seconds since the last picture.
            least: the least scale under a moving camera.
        """
        kind = _Kind.TIME if not camera_moving else _Kind.LOOK if turns else _Kind.CAMERA
        goes_on, self._kind = kind is self._kind, kind
        if target_fps <= 0.0:
            return 1.0
        constant = self.constant_ms if kind is _Kind.CAMERA else 0.0  # not known of pictures that keep their rays
        budget = self._budget(target_fps, camera_moving, constant)
        lowest = -STEPS_PER_OCTAVE * math.log2(coarsest(least, camera_moving=camera_moving))
        wanted = min(max(self._wanted(budget, kind, constant), 0.0), lowest)
        if kind is _Kind.LOOK and not goes_on:
            self._step[kind] = self._step[_Kind.TIME]  # the picture at rest does not hop when it begins to turn
        # When a movement begins its cost is known from the last one, so the first picture takes what fits at once.
        self._glide = wanted + (self._glide - wanted) * math.exp(-elapsed / _GLIDE_S) if goes_on else wanted
        self._lasted = self._lasted + elapsed if goes_on else 0.0
        # The less of a picture's cost is its pixels', the more steps the noise of the whole is worth, and the less a step changes the frame's time.
        leave = _LEAVE[kind] * (1.0 + constant / budget if self._lasted > _SETTLING_S else 1.0)
        if abs(self._glide - self._step[kind]) > leave:
            self._step[kind] = round(self._glide)
        return 2.0 ** (-self._step[kind] / STEPS_PER_OCTAVE)

    def _budget(self, target_fps: float, camera_moving: bool, constant: float) -> float:
        """Milliseconds that the pixels of a picture may cost."""
        frame = 1e3 / (target_fps if camera_moving else REST_SHARE * target_fps)
        # Waiting for the screen varies from frame to frame and is no work: the least of the last few is what must be.
        fixed = constant + min(min(self._other_ms, default=0.0), _MOST_OTHER * frame)
        return max(frame - fixed, PIXELS_SHARE * fixed)

    def _wanted(self, budget: float, kind: _Kind, constant: float) -> float:
        """Steps below full size that `budget` [ms] asks for."""
        known = self._costs[kind]
        if kind is _Kind.LOOK and len(known) < _REMEMBERED // 2:
            known = self._costs[_Kind.TIME]  # dearer by a quarter
        if kind is _Kind.CAMERA and not known:
            return math.inf  # a coarse picture comes sooner
        if kind is not _Kind.CAMERA and len(known) < 2:
            return 0.0  # the first picture with kept rays also keeps its sky, and says little of what the next will cost
        rate = median_low(max(cost.milliseconds - constant, _LEAST_OF_PIXELS * cost.milliseconds, 1e-6) / cost.pixels for cost in known)
        return 0.5 * STEPS_PER_OCTAVE * math.log2(rate / budget)
