"""Light of media along rays, in float64: the twin of the shaders' transfer pass.

    from blackhole_gl.reference import media, transfer
    seen = transfer.gather("kerr", media.AnalyticPlasma(...), spin=0.9, distance=30.0, inclination_deg=60.0, directions=rays)
    seen.intensity  # (N, channels)

With s the affine parameter of a photon that has E = 1 far away, and g = E_infinity/E_matter,

    dI = e^-tau g^(p-1) j ds,   dtau = alpha/g ds          p: 3 for light of one frequency, 4 for that of all

from the camera on; j and alpha in the matter's frame, on 1 r_s. What I is at the camera, for a far observer: one nearby sees it times the power p of its
own energy of light over E. tau and I are rows of the ray's state, so the integrator's own error control holds for them. Where a ray comes to
the medium's surface its step ends, found on the ray itself, and so what jumps there costs no digits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..shapes import Bool, Float, Int
from .events import LightRays, LightSystem
from .hits import CAPTURED, ESCAPED, UNRESOLVED
from .integrator import locate_zero, march, rate_along
from .media import Medium, Momentum, Space
from .observers import Place
from .registry import Twin, View, twin_of
from .tracing import view_of

Array = np.ndarray

HORIZON_MARGIN = 1e-4
"""Of the horizon's radius: where media end above it."""
_BATCH = 4096
_MAX_STEPS = 20000
_BEYOND = 1e-11  # of a step, beyond the surface: more than rounding leaves open, and from the state there, which a fresh step need not come to again
_DEEPEST = 3.0  # optical depth of a step, as its start has it
_DARK = 40.0  # optical depth behind which nothing is seen: e^-40 is 4e-18


@dataclass(frozen=True)
class Gathered:
    """What N rays gathered.

    Attributes:
        fate: (N,) int8, as in `ReferenceHits`; UNRESOLVED also where the medium let nothing through and the ray was not followed on.
        intensity, transmittance: (N, C) at the camera.
        steps: (N,) trial steps of the integrator.
    """

    fate: Int[Array, " N"]
    intensity: Float[Array, "N C"]
    transmittance: Float[Array, "N C"]
    steps: Int[Array, " N"]


def gather(model: str, medium: Medium, *, spin: float = 0.0, distance: float, inclination_deg: float, azimuth_deg: float = 0.0, observer: str = "static",
           directions: ArrayLike | None = None, screen: ArrayLike | None = None, tolerance: float = 1e-10, unit: float = 1.0, **parameters: Any) -> Gathered:
    """The light of `medium` along rays traced backwards from the camera.

    Args:
        model: a ray model whose twin has light: its metric is the one that the medium's matter moves in.
        unit: the radiance against which errors are judged, where there is less.
        tolerance: error allowed per step of the integrator, of the ray and of its light.
        The others as in `tracing.trace`.

    Raises:
        ValueError: as `tracing.trace`; or a model whose rays are no light in any metric.
    """
    twin = twin_of(model)
    if twin.light is None:
        raise ValueError(f"the twin of {model} has no light to go through a medium; its rays belong to no metric, or are others than those asked for")
    if unknown := sorted(set(parameters) - set(twin.parameters)):
        raise ValueError(f"the twin of {model} takes no {unknown[0]}; it takes {', '.join(twin.parameters) or 'no parameters'}")
    view = view_of(twin, spin, Place.from_degrees(distance, inclination_deg, azimuth_deg), observer, directions, screen, (), 0, tolerance)
    space = Space(0.0 if twin.metric == "flat" else 1.0, view.spin if twin.metric == "kerr" else 0.0)
    batches = [view.rays[i:i + _BATCH] for i in range(0, len(view.rays), _BATCH)] or [view.rays]
    inner = _inner_radius(twin, view.horizon, parameters.get("horizon_size", 1.0))
    parts = (replace(view, rays=rays) for rays in batches)
    light = twin.light
    return _joined([_gathered(part, light(part, **parameters), medium, space, inner, unit) for part in parts])


def _gathered(view: View, rays: LightRays, medium: Medium, space: Space, inner: float, unit: float) -> Gathered:
    system = _WithMedium(rays.system, len(rays.state), medium, space, inner, unit)
    with np.errstate(all="ignore"):  # r is infinite at infinity, and no place has a frame at the horizon
        state = system.begun(rays.state, rays.l_z / rays.energy)
        watch = _Fates(system, state.shape[1])
        state, steps = march(system, state, 0.05 * system.longest_step(state), watch, tolerance=view.tolerance, max_steps=_MAX_STEPS)
    return Gathered(watch.fate, state[system.light].T.copy(), np.exp(-state[system.depth]).T, steps)


def _joined(parts: Sequence[Gathered]) -> Gathered:
    return Gathered(*(np.concatenate([getattr(part, name) for part in parts]) for name in ("fate", "intensity", "transmittance", "steps")))


def _inner_radius(twin: Twin, horizon: float, horizon_size: float) -> float:
    """Radius in r_s at which rays end: the black ball of flat space, else just above the horizon, where matter can still be, or that of an artistic hole."""
    if twin.metric == "flat":
        return horizon_size * horizon
    return max(horizon_size, 1.0 + HORIZON_MARGIN) * horizon


class _WithMedium:
    """The equations of a ray and of the light that it gathers: below the model's own rows lambda, whether the ray is within, the parameter, tau and I.

    Attributes:
        light, depth: the rows of I and tau.
        turned_back: which rays the last step, cut short, left on the medium's surface, (k,).
    """

    def __init__(self, system: LightSystem, rows: int, medium: Medium, space: Space, inner: float, unit: float):
        self._system, self._medium, self._space, self._inner, self._unit = system, medium, space, inner, unit
        self._own = slice(0, rows)
        self._lam, self.within, self._parameter = rows, rows + 1, rows + 2
        self.depth = slice(rows + 3, rows + 3 + medium.channels)
        self.light = slice(rows + 3 + medium.channels, rows + 3 + 2 * medium.channels)
        self.turned_back: Array = np.zeros(0, dtype=bool)

    def begun(self, state: Float[Array, "rows N"], lam: Float[Array, " N"]) -> Float[Array, "more N"]:
        """The whole state of rays in the model's own `state`, which have gathered nothing yet."""
        whole = np.zeros((self.light.stop, state.shape[1]))
        whole[self._own], whole[self._lam] = state, lam
        whole[self.within] = self._level(whole) < 0.0
        return whole

    def rhs(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        own = state[self._own]
        inverse_radius, n = self._system.place(own)
        momentum = Momentum(*self._system.momentum(own), state[self._lam])
        matter = self._medium.matter(n / inverse_radius, momentum, self._space)
        within = state[self.within] > 0.0
        rate = self._system.affine_rate(own)
        gained = np.exp(-state[self.depth]) * (matter.shift ** (self._medium.power - 1.0) * rate * matter.emission)
        change = np.zeros_like(state)
        change[self._own] = self._system.rhs(own)
        change[self._parameter] = 1.0
        change[self.depth] = np.where(within, rate / matter.shift * matter.absorption, 0.0)
        change[self.light] = np.where(within, gained, 0.0)
        return change

    def scale(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        size = np.ones_like(state)
        size[self._own] = self._system.scale(state[self._own])
        size[self._parameter] = np.inf
        size[self.light] = np.maximum(np.abs(state[self.light]), self._unit)
        return size

    def longest_step(self, state: Float[Array, "rows N"]) -> Float[Array, " N"]:
        """The model's own, or shorter: from far away to the edge of what the medium reaches, and there by its strides, and by its depth."""
        own = state[self._own]
        step = self._system.longest_step(own)
        inverse_radius, n = self._system.place(own)
        rate = rate_along(self._system.rhs, lambda at: np.vstack(self._system.place(at)))(own, step)
        speed = np.linalg.norm(rate[1:] * inverse_radius - n * rate[0], axis=0) / inverse_radius**2
        r = 1.0 / inverse_radius
        stride = np.minimum(self._medium.stride(n * r), np.maximum(0.5 * np.abs(r - self._inner), 0.2 * self._inner if self._inner else np.inf))
        edge = 1.0 / (1.5 * self._medium.reach)
        far, approaches = inverse_radius < 0.75 * edge, rate[0] > 0.0
        near = np.maximum(stride / speed, 1e-6 * step)
        limit = np.where(far, np.where(approaches, (edge - inverse_radius) / rate[0], np.inf), near)
        # What lies deeper within a step than any of its points shows is not missed by the error's estimate.
        dims = np.where(state[self.depth] < _DARK, self.rhs(state)[self.depth], 0.0).max(axis=0)
        return np.fmin(np.fmin(step, limit), _DEEPEST / dims)

    def rechart(self, before: Float[Array, "rows N"], after: Float[Array, "rows N"]) -> Float[Array, "rows N"]:
        """`after`, in the model's best coordinates; or, where a ray has crossed the surface, the state there."""
        step = after[self._parameter] - before[self._parameter]
        end, width = after.copy(), step.copy()
        crossed = self._is_within(after) != (before[self.within] > 0.0)
        dips, nearest, state = self._dips(before, after, step, ~crossed)
        crossed[dips], end[:, dips], width[dips] = True, state, nearest
        if crossed.any():
            end[:, crossed] = self._surface(before[:, crossed], end[:, crossed], width[crossed])
        end[self._own] = self._system.rechart(before[self._own], end[self._own])
        self.turned_back = crossed
        return end

    def has_fallen(self, state: Float[Array, "rows N"]) -> Bool[Array, " N"]:
        """Mask (N,): where rays end, or on a way that leads there, with no medium left."""
        own = state[self._own]
        return (state[self.within] == 0.0) & ((self._system.place(own)[0] * self._inner > 1.0) | self._system.captured(own))

    def has_left(self, before: Float[Array, "rows N"], after: Float[Array, "rows N"]) -> Bool[Array, " N"]:
        """Mask (N,): beyond all that the medium reaches, and going out."""
        was, now = (self._system.place(state[self._own])[0] for state in (before, after))
        return (after[self.within] == 0.0) & (now < was) & (now * self._medium.reach < 1.0)

    def _level(self, state: Array) -> Array:
        inverse_radius, n = self._system.place(state[self._own])
        r = 1.0 / inverse_radius
        level = np.maximum(self._medium.level(n * r, self._space), self._inner - r)
        return np.where(np.isfinite(level), level, 1.0)

    def _is_within(self, state: Array) -> Array:
        return self._level(state) < 0.0

    def _dips(self, before: Array, after: Array, step: Array, where: Array) -> tuple[Array, Array, Array]:
        """Rays that come to the surface, cross it and go back within a step: indices, and parameter and state where they are farthest across."""
        rate = rate_along(self.rhs, self._level)
        start, end = self._level(before), self._level(after)
        returns = np.flatnonzero(where & (start * rate(before, step) < 0.0) & (end * rate(after, step) > 0.0) & (start * end > 0.0))
        if not returns.size:
            return returns, step[returns], after[:, returns]
        nearest, state = locate_zero(self.rhs, lambda at: rate(at, step[returns]), before[:, returns], after[:, returns], step[returns])
        across = self._is_within(state) != (before[self.within, returns] > 0.0)
        return returns[across], nearest[across], state[:, across]

    def _surface(self, before: Array, after: Array, step: Array) -> Array:
        """The states on the medium's surface, a hair beyond, with what is within exchanged for what is without."""
        parameter, state = locate_zero(self.rhs, self._level, before, after, step)
        state = state + (np.minimum(parameter + _BEYOND * step, step) - parameter) * self.rhs(state)
        state[self.within] = 1.0 - before[self.within]
        return state


class _Fates:
    """The monitor of a march: fate (N,) int8 of its rays."""

    def __init__(self, system: _WithMedium, count: int):
        self.fate = np.full(count, UNRESOLVED, dtype=np.int8)
        self._system = system

    def __call__(
        self, rays: Int[Array, " k"], before: Float[Array, "rows k"], after: Float[Array, "rows k"], step: Float[Array, " k"]
    ) -> Bool[Array, " k"]:
        system, ends = self._system, ~self._system.turned_back
        captured, escaped = ends & system.has_fallen(after), ends & system.has_left(before, after)
        self.fate[rays[escaped]], self.fate[rays[captured]] = ESCAPED, CAPTURED
        return captured | escaped | (ends & (after[system.depth].min(axis=0) > _DARK))
