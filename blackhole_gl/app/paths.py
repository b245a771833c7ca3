"""The rays whose ways are shown: which were asked for, and what was recorded of them. No imgui here."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..glsl.compose import ShaderError
from ..planning import plan as make_plan
from ..rendering.diagnostics import most_accurate
from ..rendering.recording import RayPath, pixel_direction
from ..scene import Scene, SceneError
from ..shapes import Float


@dataclass(frozen=True)
class Asked:
    """A ray: that of a camera through a place in its picture.

    Attributes:
        scene: with the camera, the hole, and how rays are traced.
        size: (width, height) of the picture in pixels.
        pixel: (x, y) of the place, in pixels from the bottom left.
    """

    scene: Scene
    size: tuple[int, int]
    pixel: tuple[float, float]

    @cached_property
    def local(self) -> Float[np.ndarray, " 3"]:
        """Its direction in the frame of the view."""
        return pixel_direction(self.scene, self.size, self.pixel)

    def by(self, scene: Scene) -> Asked:
        """The same ray, traced as `scene` traces."""
        return replace(self, scene=replace(self.scene, rays=scene.rays, parameters=scene.parameters))

    def by_most_accurate(self) -> Asked:
        """The same ray by the most accurate method."""
        return self.by(most_accurate(make_plan(self.scene)).scene)


@dataclass(frozen=True, eq=False)
class Shown:
    """A ray and its way."""

    asked: Asked
    path: RayPath


class Paths:
    """The rays in the order in which they were asked for, recorded one a frame.

    Attributes:
        shown: those recorded.
        failure: why the last one could not be, or None.
    """

    def __init__(self) -> None:
        self.shown: list[Shown] = []
        self.failure: str | None = None
        self._waiting: list[Asked] = []

    @property
    def busy(self) -> bool:
        """Whether there are rays to be recorded."""
        return bool(self._waiting)

    def ask(self, asked: Asked) -> None:
        """Has a ray recorded, unless it is there already."""
        if asked not in (*self._waiting, *(item.asked for item in self.shown)):
            self._waiting.append(asked)

    def again(self, made: Callable[[Asked], Asked]) -> None:
        """Has what `made` makes of each pixel shown recorded beside it."""
        pixels = {(item.asked.scene.camera, item.asked.size, item.asked.pixel): item.asked for item in self.shown}
        for asked in pixels.values():
            self.ask(made(asked))

    def remove(self, item: Shown) -> None:
        """Takes one away."""
        self.shown.remove(item)

    def clear(self) -> None:
        """Takes all away."""
        self.shown, self._waiting, self.failure = [], [], None

    def advance(self, record: Callable[[Scene, np.ndarray], RayPath]) -> None:
        """Records the next one, if there is one."""
        if not self._waiting:
            return
        asked = self._waiting.pop(0)
        try:
            self.shown.append(Shown(asked, record(asked.scene, asked.local)))
            self.failure = None
        except (SceneError, ValueError, ShaderError) as error:  # the picture fails for the same reason, and goes on
            self.failure = str(error)


def told(path: RayPath) -> str:
    """What a ray came to, in a line."""
    steps = f"{path.steps} steps" if path.steps else "no steps: closed form"
    errors = path.error[np.isfinite(path.error)]
    largest = f", largest error of one {errors.max():.1e} rad" if errors.size else ""
    met = f", meets the disk's plane at r = {', '.join(f'{np.linalg.norm(place):.2f}' for place in path.crossings)}" if len(path.crossings) else ""
    return f"{path.fate.name.lower()}, {steps}{largest}{met}"


def within(points: np.ndarray, reach: float) -> np.ndarray:
    """The points (P, 3) of a line up to `reach` from the origin, cut where it comes in and goes out; in one piece, as light does both but once."""
    inside = np.flatnonzero(np.linalg.norm(points, axis=1) < reach)
    if not inside.size:
        return points[:0]
    first, last = inside[0], inside[-1]
    before = [] if first == 0 else [_cut(points[first], points[first - 1], reach)]
    after = [] if last == len(points) - 1 else [_cut(points[last], points[last + 1], reach)]
    return np.concatenate([*before, points[first : last + 1], *after])


def _cut(inner: np.ndarray, outer: np.ndarray, reach: float) -> np.ndarray:
    """Where the line from `inner` to `outer` reaches so far out, (1, 3)."""
    way = outer - inner
    a, b, c = float(way @ way), float(inner @ way), float(inner @ inner) - reach**2
    return (inner + (-b + math.sqrt(b * b - a * c)) / a * way)[None]
