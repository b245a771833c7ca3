"""What marched rays meet: events along a ray, found on the ray itself (float64).

An event is a function of the place along the ray, Boyer-Lindquist's 1/r and the world unit vector n of theta and phi, that vanishes where
the event is. `Watch` looks at both ends of every accepted step; where an event's function changes sign in between, its zero is located by
Newton's method with fresh steps of the integrator (`integrator.locate_zero`), and place and momentum there are recorded.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np

from ..shapes import Bool, Float, Int
from .hits import CAPTURED, ESCAPED, UNRESOLVED, Crossings
from .integrator import System, locate_zero, rate_along

Array = np.ndarray

IN_PLANE = 1e-15
"""A camera this near to a plane (sine of the angle) is in it: a few roundings of a unit vector."""


class RaySystem(System, Protocol):
    """What the watch asks of a marched ray model, beside what the integrator asks."""

    capture_radius: float
    """r in r_s below which a ray that goes in is captured."""

    def place(self, state: Float[Array, " rows *points"]) -> tuple[Float[Array, "*points"], Float[Array, " 3 *points"]]:
        """(r_s/r (N,), world unit vector (3, N) of Boyer-Lindquist theta and phi). Regular through infinity, where r_s/r changes sign."""

    def momentum(self, state: Float[Array, "rows N"]) -> tuple[Float[Array, " N"], Float[Array, " N"]]:
        """(k_r, k_theta), each (N,), of the photon that arrives: see `hits.Crossings`."""

    def captured(self, state: Float[Array, "rows N"]) -> Bool[Array, " N"]:
        """Mask (N,): inside `capture_radius` with no way back."""


class LightSystem(RaySystem, Protocol):
    """A ray model whose rays are light of a metric."""

    def affine_rate(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        """Affine length in r_s, of a photon with E = 1 far away, by the model's own parameter, (N,)."""


@runtime_checkable
class TellsTime(Protocol):
    """A ray model that tells how long light is under way."""

    def delay(self, state: Float[Array, "rows N"]) -> Float[Array, " N"]:
        """From there to the camera, (N,) in r_s/c, of Boyer-Lindquist's time; to a camera at infinity, less r + ln r of it in r_s."""


class LightRays(NamedTuple):
    """Rays at the camera, ready to be marched: `state` (rows, N); `energy` and `l_z`, (N,), as in `hits.Traced`."""

    system: LightSystem
    state: Float[Array, "rows N"]
    energy: Float[Array, " N"]
    l_z: Float[Array, " N"]


class Event(Protocol):
    """A function of the place along the ray that vanishes where the event is."""

    def value(self, inverse_radius: Float[Array, "*points"], n: Float[Array, " 3 *points"]) -> Float[Array, "*points"]:
        """From r_s/r and n."""


@dataclass(frozen=True)
class Sphere:
    """r = `radius` in r_s, which may be infinite."""

    radius: float

    def value(self, inverse_radius: Float[Array, "*points"], n: Float[Array, " 3 *points"]) -> Float[Array, "*points"]:
        return inverse_radius - 1.0 / self.radius


@dataclass(frozen=True)
class Plane:
    """The plane through the hole with the unit normal `normal` (3,)."""

    normal: Float[Array, " 3"]

    def value(self, inverse_radius: Float[Array, "*points"], n: Float[Array, " 3 *points"]) -> Float[Array, "*points"]:
        return self.normal @ n

    def on_line(self, x: Float[Array, "N 3"], v: Float[Array, "N 3"]) -> list[Float[Array, " N"]]:
        """s (N,) at which the lines x + s v meet it; not finite, or not above 0, where they do not: a camera in the plane does not meet its own place."""
        height = x @ self.normal
        with np.errstate(divide="ignore", invalid="ignore"):
            return [np.where(np.abs(height) > IN_PLANE * np.linalg.norm(x, axis=1), -height / (v @ self.normal), np.nan)]

    @property
    def may_return(self) -> bool:
        """Whether a ray may come near it and go away again within a step: theta swings about the equator itself, there a ray that nears it goes through."""
        return bool(np.any(self.normal[:2]))


@dataclass(frozen=True)
class Ball:
    """The sphere of `radius` in r_s about `centre` (3,), in r_s."""

    centre: Float[Array, " 3"]
    radius: float

    may_return = True

    def value(self, inverse_radius: Float[Array, "*points"], n: Float[Array, " 3 *points"]) -> Float[Array, "*points"]:
        """(|x - centre|^2 - radius^2)/r^2, which is regular through infinity."""
        offset = n - np.multiply.outer(self.centre, inverse_radius)
        return (offset * offset).sum(axis=0) - (self.radius * inverse_radius) ** 2

    def on_line(self, x: Float[Array, "N 3"], v: Float[Array, "N 3"]) -> list[Float[Array, " N"]]:
        """s (N,) at which the lines x + s v, v unit vectors, enter and leave it; NaN where they do not."""
        arm = x - self.centre
        along = -np.einsum("ij,ij->i", arm, v)
        deep = self.radius**2 - np.sum((arm + along[:, None] * v) ** 2, axis=1)
        chord = np.sqrt(np.where(deep > 0.0, deep, np.nan))
        return [along - chord, along + chord]


INFINITY = Sphere(math.inf)


class Watch:
    """The monitor of a march: the fates of its rays and their crossings of `surfaces`, at most `orders` of each.

    Rays escape at `outer`. A step that ends in the hole is looked at as far as `inner`, since Boyer-Lindquist's azimuth has no limit at the horizon; without
    one, as where there is no hole, it is not looked at.

    Attributes: fate (N,) int8, direction (N, 3), crossings (N, surfaces, orders), as in `hits.Traced`.
    """

    swings_about_equator = True
    """Whether theta does, as round a hole, so that no ray comes near the equatorial plane and turns back."""

    def __init__(
        self, system: RaySystem, state: Float[Array, "rows N"], surfaces: Sequence[Plane | Ball], orders: int, outer: Event, inner: Event | None
    ):
        count = state.shape[1]
        self.fate = np.full(count, UNRESOLVED, dtype=np.int8)
        self.direction = np.zeros((count, 3))
        self.crossings = Crossings.none(count, len(surfaces), orders)
        self._system = system
        self._surfaces = surfaces
        self._orders = orders
        self._outer = outer
        self._inner = inner
        self._travelled = np.zeros(count)
        self._found = np.zeros((len(surfaces), count), dtype=np.int64)
        # A camera in a plane (side 0) takes the side its ray leaves to; its own place is no crossing.
        with np.errstate(divide="ignore"):  # r is infinite at infinity
            start = np.stack([self._value(surface)(state) for surface in surfaces])
        self._side = np.where(np.abs(start) > IN_PLANE, np.sign(start), 0.0)

    def __call__(
        self, rays: Int[Array, " k"], before: Float[Array, "rows k"], after: Float[Array, "rows k"], step: Float[Array, " k"]
    ) -> Bool[Array, " k"]:
        escaped = self._value(self._outer)(after) <= 0.0
        captured = ~escaped & self._system.captured(after)
        self.fate[rays[escaped]], self.fate[rays[captured]] = ESCAPED, CAPTURED
        last, end = after.copy(), step.copy()
        ends = [(escaped, self._outer)]
        if self._inner is not None:
            ends.append((captured & (self._value(self._inner)(before) < 0.0), self._inner))
        for part, event in ends:
            if part.any():
                end[part], last[:, part] = self._locate(event, before[:, part], after[:, part], step[part])
        n = self._heading(rays[escaped], last[:, escaped])
        self.direction[rays[escaped]] = n / np.linalg.norm(n, axis=1, keepdims=True)
        watched = ~captured | (end < step)
        for index, surface in enumerate(self._surfaces):
            self._look(index, surface, rays[watched], before[:, watched], last[:, watched], end[watched])
        self._travelled[rays] += step
        return escaped | captured

    def _heading(self, rays: Int[Array, " k"], state: Float[Array, "rows k"]) -> Float[Array, "k 3"]:
        """The asymptotic directions, of any length, of `rays` that have come to `outer`."""
        return self._system.place(state)[1].T

    def _value(self, event: Event) -> Callable[[Array], Array]:
        return lambda state: event.value(*self._system.place(state))

    def _locate(self, event: Event, before: Array, after: Array, step: Array) -> tuple[Array, Array]:
        return locate_zero(self._system.rhs, self._value(event), before, after, step)

    def _look(self, index: int, surface: Plane | Ball, rays: Array, before: Array, after: Array, step: Array) -> None:
        """One surface in one step: the step whole, or in two pieces where the ray comes near it and goes away again within it."""
        returning = np.zeros(rays.size, dtype=bool)
        if surface.may_return or not self.swings_about_equator:
            value, rate = self._value(surface), rate_along(self._system.rhs, self._value(surface))
            returning = (value(before) * rate(before, step) < 0.0) & (value(after) * rate(after, step) > 0.0) & (value(before) * value(after) > 0.0)
        whole = ~returning
        self._cross(index, surface, rays[whole], before[:, whole], after[:, whole], step[whole], 0.0)
        if returning.any():
            rays, before, after, step = rays[returning], before[:, returning], after[:, returning], step[returning]
            nearest, middle = locate_zero(self._system.rhs, lambda state: rate(state, step), before, after, step)
            self._cross(index, surface, rays, before, middle, nearest, 0.0)
            self._cross(index, surface, rays, middle, after, step - nearest, nearest)

    def _cross(self, index: int, surface: Plane | Ball, rays: Array, before: Array, after: Array, step: Array, offset: Array | float) -> None:
        """Records the crossing of each ray whose side of the surface changes between two states; `offset`: of `before` from the step's start."""
        side = np.sign(self._value(surface)(after))
        part = np.flatnonzero((side * self._side[index, rays] < 0.0) & (self._found[index, rays] < self._orders))
        self._side[index, rays] = np.where(side != 0.0, side, self._side[index, rays])
        if not part.size:
            return
        parameter, state = self._locate(surface, before[:, part], after[:, part], step[part])
        inverse_radius, n = self._system.place(state)
        crossing = rays[part]
        along = self._travelled[crossing] + np.broadcast_to(offset, rays.shape)[part] + parameter
        where = (crossing, index, self._found[index, crossing])
        self.crossings.record(where, along, 1.0 / inverse_radius, n, self._system.momentum(state), self._delay(state))
        self._found[index, crossing] += 1

    def _delay(self, state: Array) -> Array | float:
        return self._system.delay(state) if isinstance(self._system, TellsTime) else np.nan
