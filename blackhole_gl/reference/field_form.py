"""Rays that a field bends in flat space, x'' = f(x, x') within a sphere about the origin and straight lines beyond it (float64, r_s = 1).

The state is (x, x'), and how far the ray has gone within the sphere: its length, or the parameter where the ray is slower than 1. A ray that has gone
farther than is allowed is held in the field, and counts as captured. Planes through the origin are met on the straight ways too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..shapes import Bool, Float, Int
from .events import Ball, Plane, Sphere, Watch
from .flat import l_z_of_straight_rays, lines
from .hits import ESCAPED, Traced
from .integrator import System, locate_zero, march
from .marching import Unhurried, surfaces_of
from .registry import View

Array = np.ndarray
Force = Callable[[Array, Array], Array]

# Rows of the state.
X, V, WAY = slice(0, 3), slice(3, 6), 6

SPHERE: Mapping[str, str] = {"field_radius": "rays.field_radius", "field_way": "rays.field_way"}
"""The parameters that every field has."""

_MAX_STEPS = 20000
_NO_HORIZON = 1e-6  # r_s; there is none to come near
_LONGEST = 0.1  # of the sphere's radius, a step: no way to a plane and back hides in it that is worth the name
_INSIDE = 1e-12  # relative: a ray that comes in begins so far within the sphere


@dataclass(frozen=True)
class Field:
    """A field and where it acts.

    Attributes:
        force: f(x, v), each (3, ...).
        radius: of the sphere in r_s. way: the longest within it, in r_s.
        entry_speed: |x'| of rays that begin or come in at x (3, N), (N,).
    """

    force: Force
    radius: float
    way: float
    entry_speed: Callable[[Array], Array] = lambda x: np.ones(x.shape[1])


class FieldSystem:
    """The equations of rays within the sphere."""

    capture_radius = 0.0

    def __init__(self, field: Field):
        self._field = field

    def rhs(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        change = np.empty_like(state)
        change[X] = state[V]
        change[V] = self._field.force(state[X], state[V])
        change[WAY] = np.maximum(np.linalg.norm(state[V], axis=0), 1.0)
        return change

    def scale(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        size = np.ones_like(state)
        size[V] = np.maximum(np.linalg.norm(state[V], axis=0), 1.0)
        size[WAY] = 1e6 * self._field.way  # its rate has a kink, and only ends what is held
        return size

    def longest_step(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        return _LONGEST * self._field.radius / np.maximum(np.linalg.norm(state[V], axis=0), 1e-3)

    def rechart(self, before: Float[Array, " rows *points"], after: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return after

    def captured(self, state: Float[Array, "rows N"]) -> Bool[Array, " N"]:
        return state[WAY] > self._field.way

    def place(self, state: Float[Array, " rows *points"]) -> tuple[Float[Array, "*points"], Float[Array, " 3 *points"]]:
        """(r_s/r (N,), unit vector (3, N))."""
        r = np.linalg.norm(state[X], axis=0)
        return 1.0 / r, state[X] / r

    def momentum(self, state: Float[Array, "rows N"]) -> tuple[Float[Array, " N"], Float[Array, " N"]]:
        """NaN: what moves here is light in no metric."""
        none = np.full(state.shape[1], np.nan)
        return none, none


class _FieldWatch(Watch):
    """Looks at the straight ways too; `places` (N, 3) is where rays leave the sphere, NaN for those that do not."""

    swings_about_equator = False

    def __init__(self, system: FieldSystem, state: Array, surfaces: Sequence[Plane | Ball], orders: int, radius: float):
        super().__init__(system, state, surfaces, orders, Sphere(radius), None)
        self.places = np.full((state.shape[1], 3), np.nan)

    def _heading(self, rays: Int[Array, " k"], state: Float[Array, "rows k"]) -> Float[Array, "k 3"]:
        self.places[rays] = state[X].T
        return state[V].T

    def look_along(self, rays: Array, x: Array, v: Array, far: Array | float) -> None:
        """Records what rays (k,) meet on the lines x + s v, both (k, 3), for 0 < s < far."""
        for index, surface in enumerate(self._surfaces):
            for s in surface.on_line(x, v):
                part = np.flatnonzero((s > 0.0) & (s < far) & (self._found[index, rays] < self._orders))
                point = x[part] + s[part, None] * v[part]
                r = np.linalg.norm(point, axis=1)
                crossing = rays[part]
                where = (crossing, index, self._found[index, crossing])
                self.crossings.record(where, self._travelled[crossing] + s[part], r, point.T / r, (np.nan, np.nan))
                self._found[index, crossing] += 1
        self._travelled[rays] += np.where(np.isfinite(far), far, 0.0)


@dataclass(frozen=True)
class FieldTraced:
    """What became of N rays, and `places` (N, 3) in r_s where they leave the sphere; NaN for those that do not."""

    traced: Traced
    places: Float[Array, "N 3"]


def follow_field(view: View, field: Field) -> Traced:
    """What the rays of `view` meet in `field`."""
    return through_field(view, field).traced


def through_field(view: View, field: Field) -> FieldTraced:
    """As `follow_field`, with the places where rays leave the field."""
    position, direction = lines(view)
    enter, leave = _chord(position, direction, field.radius)
    inside = np.flatnonzero(leave > enter)
    start = position + enter[:, None] * direction
    start *= np.where(enter > 0.0, 1.0 - _INSIDE, 1.0)[:, None]
    state = np.zeros((7, len(position)))
    state[X], state[V] = start.T, direction.T
    state[V, inside] *= field.entry_speed(start[inside].T)
    system = FieldSystem(field)
    watch = _FieldWatch(system, state, surfaces_of(view), view.orders, field.radius)
    passing = np.flatnonzero(leave <= enter)
    watch.look_along(passing, position[passing], direction[passing], np.inf)
    watch.fate[passing], watch.direction[passing] = ESCAPED, direction[passing]
    watch.look_along(inside, position[inside], direction[inside], enter[inside])
    steps = np.zeros(len(position), dtype=np.int64)
    within = _Within(watch, inside, system, field.radius)
    driven: System = Unhurried(system, _NO_HORIZON, view.balls) if len(view.balls) else system
    first = 0.1 * driven.longest_step(state[:, inside])
    with np.errstate(all="ignore"):
        steps[inside] = march(driven, state[:, inside], first, within, tolerance=view.tolerance, max_steps=_MAX_STEPS)[1]
    out = inside[watch.fate[inside] == ESCAPED]
    watch.look_along(out, watch.places[out], watch.direction[out], np.inf)
    traced = Traced(watch.fate, watch.direction, steps, np.ones(len(position)), l_z_of_straight_rays(view), watch.crossings)
    return FieldTraced(traced, watch.places)


class _Within:
    """The monitor of a march of some of a watch's rays. A step that leads out of the sphere and back is taken as far as where it is farthest out."""

    def __init__(self, watch: Watch, rays: Int[Array, " k"], system: FieldSystem, radius: float):
        self._watch, self._rays, self._system, self._radius = watch, rays, system, radius

    def __call__(self, rays: Array, before: Array, after: Array, step: Array) -> Array:
        after, step = after.copy(), step.copy()
        turned = np.flatnonzero((_outwards(before) > 0.0) & (_outwards(after) < 0.0))
        if turned.size:
            far, state = locate_zero(self._system.rhs, _outwards, before[:, turned], after[:, turned], step[turned])
            out = np.linalg.norm(state[X], axis=0) > self._radius
            after[:, turned[out]], step[turned[out]] = state[:, out], far[out]
        return self._watch(self._rays[rays], before, after, step)


def _outwards(state: Array) -> Array:
    return np.asarray((state[X] * state[V]).sum(axis=0))


def _chord(position: Array, direction: Array, radius: float) -> tuple[Array, Array]:
    """Where (N,) along each line from `position` on it comes into the sphere (0: it begins there), and goes out; not larger for one that passes it by."""
    along = np.einsum("ij,ij->i", position, direction)
    nearest = np.linalg.norm(position - along[:, None] * direction, axis=1)
    half = np.sqrt(np.maximum((radius - nearest) * (radius + nearest), 0.0))
    return np.maximum(-along - half, 0.0), -along + half
