"""The chart of one view, measured bit by bit while a window goes on: a few draw calls a frame."""

from __future__ import annotations

import time as clock
from collections.abc import Iterator
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import listed_rays, planning
from ..listed_rays import TracedRays
from ..rendering.frame import Renderer
from ..scene import Scene, met
from ..worker import Worker
from . import timing
from .errors import compare
from .methods import Combination, sensible
from .scenes import NEAR_CRITICAL, ChartScene, is_physical

RAYS = 200
_SIZE = (192, 108)  # pixels of a timed frame
_TRIALS = 2
_BUDGET_S = 0.02  # of a frame; the bit that is under way when it is spent, a draw call or two, is finished


@dataclass(frozen=True)
class LivePoint:
    """A method with one step setting, on the view.

    Attributes:
        error: of the escape direction at 99 % of the rays, in radians; NaN where no ray escapes in both.
        pixels: the same in pixels of a picture 1080 high.
        wrong_fates: share of rays.
        cost: frame time over that of the flat frame.
        evaluations: of the right-hand side, mean over the rays.
    """

    method: Combination
    setting: float
    error: float
    pixels: float
    wrong_fates: float
    cost: float
    evaluations: float


@dataclass(frozen=True)
class _Truth:
    rays: np.ndarray
    apart: np.ndarray  # mask (N,) of the rays off the critical curve
    traced: TracedRays


def view_of(scene: Scene) -> tuple[Any, ...]:
    """All of `scene` that the chart of a view depends on: not the method itself, nor how things glow."""
    return scene.hole, scene.camera, scene.disk.enabled, scene.disk.orbit, scene.disk.tilt_deg, scene.disk.tilt_azimuth_deg


class Live:
    """Measures the methods on the view of `scene`. The float64 twin runs in the worker's process, the shader in the caller's context.

    Attributes:
        scene: the scene measured: the view without things and media, which bend no ray and which the twin does not know.
        points: what has been found so far.
        failure: why there is nothing to measure; empty when there is.
    """

    def __init__(self, scene: Scene, worker: Worker):
        self.scene = met.without_any(scene)
        self._worker = worker
        self.points: list[LivePoint] = []
        self.failure = "" if is_physical(scene) else "Gravity or horizon are not physical: there is no truth to compare with."
        methods = sensible(self.scene, whole=False)
        # All methods with their coarsest step first: the chart's outline is there early.
        settings = [(rank, method, setting) for method in methods for rank, setting in enumerate(method.settings(quick=True))]
        self._left = [(method, setting) for _, method, setting in sorted(settings, key=lambda item: item[0])]
        self._count = len(self._left)
        self._compiled: set[Combination] = set()
        self._truth: Future[_Truth] | None = None
        self._bits: Iterator[None] = iter(())

    @property
    def busy(self) -> bool:
        """Whether anything is left to measure."""
        return bool(self._left) and not self.failure

    @property
    def waiting(self) -> bool:
        """Whether the float64 twin is still at work, so that `advance` does nothing."""
        return self.busy and (self._truth is None or not self._truth.done())

    @property
    def share(self) -> float:
        """The share done, 0…1."""
        return 1.0 - len(self._left) / self._count

    def advance(self, renderer: Renderer) -> bool:
        """Does the next bits with `renderer`, whose context is current, until `_BUDGET_S` has passed. True when there is a new point."""
        if not self.busy:
            return False
        if self._truth is None:
            self._truth = self._worker.submit(_find_truth, self.scene)
        truth = self._truth
        if not truth.done():
            return False
        found, end = len(self.points), clock.perf_counter() + _BUDGET_S
        while self.busy and clock.perf_counter() < end:
            self._next_bit(renderer, truth)
        return len(self.points) > found

    def _next_bit(self, renderer: Renderer, truth: Future[_Truth]) -> None:
        try:
            # The last bit of a point ends the generator, and may leave nothing to go on with.
            if next(self._bits, "over") == "over" and self._left:
                self._bits = self._measure(renderer, *self._left[0], truth.result())
        except ValueError:  # a camera where this model has no observer
            self._left = [item for item in self._left if item[0] != self._left[0][0]]
            self._bits = iter(())
        except (RuntimeError, OSError) as error:  # of the other process
            self.failure = f"The float64 reference failed: {error}"

    def cancel(self) -> None:
        """Gives up what has not begun."""
        if self._truth is not None:
            self._truth.cancel()
        self._left = []

    def _measure(self, renderer: Renderer, method: Combination, setting: float, truth: _Truth) -> Iterator[None]:
        """One point; pauses after every bit."""
        scene = method.applied(self.scene, setting)
        made, flat = planning.plan(scene), planning.plan(timing.flat_scene(self.scene))
        if method not in self._compiled:  # drivers compile at the first draw
            self._compiled.add(method)
            for unmeasured in (flat, made):
                renderer.time_trace(unmeasured, _SIZE)
                yield
        found = listed_rays.trace_by_shader(renderer, scene, truth.rays)
        yield
        ratios = []
        for _ in range(_TRIALS):
            yard = min(renderer.time_trace(flat, _SIZE) for _ in range(2))
            ratios.append(renderer.time_trace(made, _SIZE) / yard)
            yield
        errors = compare(found, truth.traced, truth.apart)
        pixel = ChartScene("view", self.scene).pixel
        self.points.append(
            LivePoint(method, setting, errors.direction_99, errors.direction_99 / pixel, errors.wrong_fates, min(ratios), float(np.mean(found.evaluations)))
        )
        self._left.pop(0)


def _find_truth(scene: Scene) -> _Truth:
    view = ChartScene("view", scene, RAYS)
    return _Truth(view.rays, view.epsilon >= NEAR_CRITICAL, view.truth)
