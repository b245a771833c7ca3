"""Adaptive Gragg-Bulirsch-Stoer extrapolation for many independent initial-value problems at once.

Every ray has its own step size; all rays of a batch advance together, and the rows of the extrapolation table
run side by side, so that a step of order 14 costs 14 calls of the right-hand side whatever the number of rays.

Source: Hairer, Norsett & Wanner, *Solving Ordinary Differential Equations I*, II.9 (modified midpoint rule,
harmonic sequence 2, 4, 6 ..., Aitken-Neville). The modified midpoint rule is left unsmoothed: with even numbers
of substeps its error is a series in h^2 all the same.

Tolerances below 1e-13 leave nothing to gain: rounding has the rest. Events are found by Newton's method with a fresh step from the last
accepted state to each trial point, not on an interpolant; where the next trial point is near, by a short Runge-Kutta step from this one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from ..shapes import Float, Int

ROWS = 7
ORDER = 2 * ROWS
EVALUATIONS_PER_STEP = ROWS * (ROWS + 1) - ROWS + 1

_SUBSTEPS = 2.0 * np.arange(1, ROWS + 1)
_SAFETY = 0.85
_SHRINK, _GROW = 0.1, 4.0
_LOCATED = 1e-9  # of a step, a correction of a zero: convergence is quadratic, and the next one is below rounding
_NEAR = 1e-3  # of a step, which itself is a good part of the scale of what is solved: what an order of 4 leaves out is below rounding
_MOST_TRIALS = 40  # for a zero; four to six do, but for those found by halves

Array = np.ndarray


class System(Protocol):
    """What the driver asks of a ray model. States are (rows, ...) arrays; every function is elementwise in `...`."""

    def rhs(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        """Derivative of the state with respect to the model's own parameter; same shape as `state`."""

    def scale(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        """Size against which the error of each row is judged; broadcastable to `state`."""

    def longest_step(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        """Upper limit of the step, (...,): short enough that no event can hide inside one step."""

    def rechart(self, before: Float[Array, " rows *points"], after: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        """`after`, or the same rays in coordinates that suit them better; applied between steps."""


def extrapolated_step(
    rhs: Callable[[Array], Array], state: Float[Array, "rows N"], step: Float[Array, " N"]
) -> tuple[Float[Array, "rows N"], Float[Array, "rows N"]]:
    """One step of every ray: (new state, error estimate), both (rows, N), for `state` (rows, N) and `step` (N,)."""
    width = step / _SUBSTEPS[:, None]
    previous = np.repeat(state[:, None, :], ROWS, axis=1)
    current = previous + width * rhs(state)[:, None, :]
    table: list[Array] = []
    for substep in range(1, int(_SUBSTEPS[-1])):
        # Row j takes 2(j + 1) substeps: the rows still under way are those from substep // 2 on.
        finished = substep // 2 - (len(table))
        if finished:
            table.append(current[:, 0])
            previous, current, width = previous[:, 1:], current[:, 1:], width[1:]
        previous, current = current, previous + 2.0 * width * rhs(current)
    table.append(current[:, 0])
    return _aitken_neville(table)


def _aitken_neville(first_column: list[Array]) -> tuple[Array, Array]:
    """Extrapolates to zero step width; the error is the last correction."""
    column = first_column
    correction = np.zeros_like(first_column[0])
    for k in range(1, ROWS):
        refined = []
        for j in range(k, ROWS):
            ratio = (_SUBSTEPS[j] / _SUBSTEPS[j - k]) ** 2 - 1.0
            correction = (column[j - k + 1] - column[j - k]) / ratio
            refined.append(column[j - k + 1] + correction)
        column = refined
    return column[0], np.abs(correction)


def march(
    system: System,
    state: Float[Array, "rows N"],
    first_step: Float[Array, " N"],
    monitor: Callable[[Array, Array, Array, Array], Array],
    *,
    tolerance: float,
    max_steps: int,
) -> tuple[Float[Array, "rows N"], Int[Array, " N"]]:
    """Advances all rays until `monitor` has finished them or `max_steps` trial steps are spent.

    `state` (rows, N), `first_step` (N,). After each accepted step `monitor(rays, before, after, step)` gets the
    indices of the rays that moved and returns a mask of those that are done. A step that comes out non-finite is
    rejected and shortened like any other bad step, so no NaN is ever handed on.
    Returns the last accepted states (rows, N) and the trial steps spent (N,).
    """
    state, step = state.copy(), first_step.copy()
    steps = np.zeros(state.shape[1], dtype=np.int64)
    active = np.arange(state.shape[1])
    for _ in range(max_steps):
        if not active.size:
            break
        before = state[:, active]
        size = np.minimum(step[active], system.longest_step(before))
        with np.errstate(all="ignore"):
            after, error = extrapolated_step(system.rhs, before, size)
            ratio = np.max(error / (tolerance * system.scale(before)), axis=0)
            good = (ratio <= 1.0) & np.all(np.isfinite(after), axis=0)
            factor = np.clip(_SAFETY * ratio ** (-1.0 / (ORDER - 1)), _SHRINK, _GROW)
        steps[active] += 1
        step[active] = size * np.where(np.isfinite(factor), factor, _SHRINK)
        moved = active[good]
        if not moved.size:
            continue
        start, end = before[:, good], after[:, good]
        state[:, moved] = system.rechart(start, end)
        done = monitor(moved, start, end, size[good])
        keep = np.ones(active.size, dtype=bool)
        keep[good] = ~done
        active = active[keep]
    return state, steps


def rate_along(rhs: Callable[[Array], Array], value: Callable[[Array], Array]) -> Callable[[Array, Array], Array]:
    """The rate at which value(state), (..., N), changes along the rays: a function of the state (rows, N) and of a typical step (N,).

    Central differences over 1e-5 of the step: about 1e-10 of the rate is lost, half of it to the third derivative and half to rounding.
    """
    def rate(state: Float[Array, "rows N"], step: Float[Array, " N"]) -> Float[Array, "*values N"]:
        nudge = 1e-5 * step
        flow = nudge * rhs(state)
        return (value(state + flow) - value(state - flow)) / (2.0 * nudge)

    return rate


def locate_zero(
    rhs: Callable[[Array], Array],
    value: Callable[[Array], Array],
    before: Float[Array, "rows N"],
    after: Float[Array, "rows N"],
    step: Float[Array, " N"],
) -> tuple[Float[Array, " N"], Float[Array, "rows N"]]:
    """Where value(state), (N,), vanishes inside one step: (parameter (N,), state (rows, N)) there.

    Newton's method on the parameter, by halves where it leaves what is known to hold the zero; each trial is a single step from `before`,
    shorter than the accepted one and therefore at least as accurate, or one from a trial that was so near that nothing is lost, so that the
    event carries no interpolation error. The rate need not be exact: it decides how fast the zero is found, not where.
    """
    rate = rate_along(rhs, value)
    start_value, start_rate = value(before), rate(before, step)
    parameter = _hermite_zero(start_value, value(after), step * start_rate, step * rate(after, step)) * step
    sign = _sign_before_zero(start_value, start_rate)
    low, high = np.zeros_like(parameter), np.array(step, dtype=float)
    located = np.zeros(parameter.shape, dtype=bool)
    state, _ = extrapolated_step(rhs, before, parameter)
    for _ in range(_MOST_TRIALS):
        here = value(state)
        low, high = np.where(np.sign(here) == sign, parameter, low), np.where(np.sign(here) == -sign, parameter, high)
        trial = parameter - here / rate(state, step)
        # Where the function levels off on both sides of its zero, as an angle does beside the origin, Newton's method runs away.
        within = (trial >= low - _LOCATED * step) & (trial <= high + _LOCATED * step)
        trial = np.clip(np.where(within, trial, 0.5 * (low + high)), 0.0, step)
        moved = np.abs(trial - parameter)
        # What is located stays: a ray's result does not depend on the rays beside it.
        trial = np.where(located, parameter, trial)
        state = _moved(rhs, before, state, parameter, trial, step)
        parameter = trial
        located |= moved <= _LOCATED * step
        if located.all():
            break
    return parameter, state


def _moved(rhs: Callable[[Array], Array], before: Array, state: Array, parameter: Array, trial: Array, step: Array) -> Array:
    """The states at the parameters `trial`, from `state` at `parameter` where that is near, elsewhere from `before`, the step's start."""
    found, moves = state.copy(), trial != parameter
    near = np.abs(trial - parameter) <= _NEAR * step
    if (part := moves & near).any():
        found[:, part] = _runge_kutta_step(rhs, state[:, part], (trial - parameter)[part])
    if (part := moves & ~near).any():
        found[:, part] = extrapolated_step(rhs, before[:, part], trial[part])[0]
    return found


def _runge_kutta_step(rhs: Callable[[Array], Array], state: Array, step: Array) -> Array:
    """One step of the classical rule of order 4."""
    first = rhs(state)
    second = rhs(state + 0.5 * step * first)
    third = rhs(state + 0.5 * step * second)
    fourth = rhs(state + step * third)
    return state + step / 6.0 * (first + 2.0 * (second + third) + fourth)


def _sign_before_zero(value: Array, rate: Array) -> Array:
    """The sign that a function has before its zero in a step; where it begins with 0 (the camera's own place, or infinity) that of its rate."""
    return np.where(value != 0.0, np.sign(value), np.sign(rate))


def _hermite_zero(y0: Array, y1: Array, d0: Array, d1: Array) -> Array:
    """A zero in [0, 1] of the cubic with values y0, y1 and slopes d0, d1 at the ends, by bisection: a first guess."""
    low, high = np.zeros_like(y0), np.ones_like(y0)
    sign = _sign_before_zero(y0, d0)
    for _ in range(20):
        t = 0.5 * (low + high)
        value = (1 + 2 * t) * (1 - t) ** 2 * y0 + t * (1 - t) ** 2 * d0 + t * t * (3 - 2 * t) * y1 + t * t * (t - 1) * d1
        before_zero = np.sign(value) == sign
        low, high = np.where(before_zero, t, low), np.where(before_zero, high, t)
    return 0.5 * (low + high)
