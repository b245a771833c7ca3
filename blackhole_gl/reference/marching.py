"""Marched ray models from their start to their fate, watched for what they meet."""

from __future__ import annotations

import math

import numpy as np

from ..shapes import Float
from .events import INFINITY, Ball, Plane, RaySystem, Sphere, Watch
from .hits import Traced
from .integrator import System, march, rate_along
from .registry import View

Array = np.ndarray

INNERMOST_CROSSING = 1.02
"""In units of the horizon: below, a crossing is left empty."""
_MAX_STEPS = 4000  # a ray 1e-8 from the critical curve of a* = 0.9999 winds through 1,600
_LONGEST_TURN = 0.5  # rad: how far a ray's place would turn in one step at the rate of its start where tilted planes are watched
_LONGEST_FALL = 0.25  # and the share of the way to the horizon, in 1/r, that it would go
_LONGEST_APPROACH = 0.7  # and the share of the way to the nearest ball's surface, and of its radius


def follow(
    view: View, system: RaySystem, state: Float[Array, "rows N"], energy: Float[Array, " N"], l_z: Float[Array, " N"]
) -> Traced:
    """Marches the rays of `view` from `state` to their fate; `energy` and `l_z` are those of the photons, as in `hits.Traced`."""
    surfaces = surfaces_of(view)
    inner = Sphere(max(INNERMOST_CROSSING * view.horizon, system.capture_radius))
    watch = Watch(system, state, surfaces, view.orders, INFINITY, inner)
    driven: System = system
    if any(surface.may_return for surface in surfaces):
        driven = Unhurried(system, min(view.horizon, system.capture_radius), view.balls)
    with np.errstate(all="ignore"):
        _, steps = march(driven, state, 0.05 * driven.longest_step(state), watch, tolerance=view.tolerance, max_steps=_MAX_STEPS)
    return Traced(watch.fate, watch.direction, steps, energy, l_z, watch.crossings)


def surfaces_of(view: View) -> list[Plane | Ball]:
    """What is watched for, in the order of the events."""
    return [*(Plane(normal) for normal in view.planes), *(Ball(ball[:3], float(ball[3])) for ball in view.balls)]


class Unhurried:
    """A system with steps so short that a ray's place turns about the hole by less than half a turn in each.

    The models' own longest step is below half a turn of the orbit's plane, which is enough for z = 0: dragging does not move a ray towards
    it or away. A tilted plane it does, and many times round near the horizon, where the rate goes as 1/d with the distance d: a step that takes
    the share q of d turns by (d x rate) (-ln(1 - q)), or, where the rate happens to be nil at its start, by (d x rate) (-ln(1 - q) - q), which
    is below 1.4 even at a* = 0.9999. Rays that fall in from `INNERMOST_CROSSING` on are let go.

    Near one of the `balls` (B, 4), centres and radii in r_s, steps are shorter than the way to its surface and than it is wide.
    """

    def __init__(self, system: RaySystem, horizon: float, balls: Float[Array, "B 4"]):
        self._system = system
        self._horizon = horizon
        self._balls = balls

    def longest_step(self, state: Float[Array, "rows N"]) -> Float[Array, " N"]:
        step = self._system.longest_step(state)
        inverse_radius = self._system.place(state)[0]
        rate = rate_along(self._system.rhs, lambda at: np.vstack(self._system.place(at)))(state, step)
        falling = (inverse_radius * INNERMOST_CROSSING * self._horizon > 1.0) & (rate[0] > 0.0)
        turn = _LONGEST_TURN / np.linalg.norm(rate[1:], axis=0)
        fall = _LONGEST_FALL * (1.0 / self._horizon - inverse_radius) / np.abs(rate[0])
        return np.where(falling, step, np.minimum(np.minimum(step, self._approach(state, rate, step)), np.minimum(turn, fall)))

    def _approach(self, state: Float[Array, "rows N"], rate: Float[Array, "4 N"], step: Float[Array, " N"]) -> Float[Array, " N"]:
        """The longest step with a view to the balls; `rate` is that of 1/r and n."""
        inverse_radius, n = self._system.place(state)
        longest = np.full(step.shape, np.inf)
        speed = np.linalg.norm(rate[1:] * inverse_radius - n * rate[0], axis=0) / inverse_radius**2
        for *centre, radius in self._balls:
            leaves = (rate[0] < 0.0) & (inverse_radius * (math.hypot(*centre) + radius) < 1.0)
            clear = np.abs(np.linalg.norm(n / inverse_radius - np.array(centre)[:, None], axis=0) - radius)
            longest = np.where(leaves, longest, np.minimum(longest, _LONGEST_APPROACH * (clear + radius) / speed))
        return np.maximum(longest, 1e-4 * step)  # from infinity too

    def rhs(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return self._system.rhs(state)

    def scale(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return self._system.scale(state)

    def rechart(self, before: Float[Array, " rows *points"], after: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return self._system.rechart(before, after)
