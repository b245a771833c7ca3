"""From a camera and its rays to hits, in float64: the twin of the shaders' trace pass."""

from __future__ import annotations

import math

import numpy as np

from ..physics import relativity
from . import flat, lenses
from .binet_form import N_Z, BinetSystem, W
from .hits import CAPTURED, ESCAPED, UNRESOLVED, ReferenceHits, angles, wrapped
from .integrator import EVALUATIONS_PER_STEP, locate_zero, march
from .kerr_schild_form import KerrSchildSystem
from .mino_form import ENERGY, MinoSystem
from .mino_form import L as L_MINO
from .observers import Place, momenta, static_observer_exists
from .post_newtonian import PostNewtonianSystem

MODELS = ("flat", "screen_lens", "weak_field", "post_newtonian", "post_newtonian_drag", "schwarzschild", "schwarzschild_binet", "kerr_like",
          "kerr", "kerr_schild")
# Each form of one space-time is checked by another form: Mino time by Kerr-Schild, that by Mino time, Binet by Kerr-Schild without spin.
_KERR = ("kerr", "kerr_schild", "schwarzschild_binet")
_WITHOUT_SPIN = ("screen_lens", "weak_field", "post_newtonian", "schwarzschild", "schwarzschild_binet")
INNERMOST_CROSSING = 1.02  # in units of the horizon: below, a crossing is left empty
_MAX_STEPS = 4000  # a ray 1e-8 from the critical curve of a* = 0.9999 winds through 1,600
_FINEST_TOLERANCE = 1e-13
_BATCH = 512  # rays per batch: the working set of a step stays in the cache

Array = np.ndarray


def trace(model: str, *, spin: float = 0.0, distance: float, inclination_deg: float, azimuth_deg: float = 0.0,
          observer: str = "static", directions: Array | None = None, screen: Array | None = None,
          gravity_strength: float = 1.0, horizon_size: float = 1.0, drag: float = 1.0, orders: int = 3,
          orbit: str = "prograde", tolerance: float = 1e-12, second_order: bool = True, lens_radius: float = 1.0,
          lens_shadow: float = 2.598) -> ReferenceHits:
    """Traces rays backwards from the camera.

    model            one of MODELS
    spin             a*, -0.9999 ... 0.9999; models without spin take it as 0, flat uses it for the ball's size and the emitters' orbits
    distance         Boyer-Lindquist r of the camera in r_s, above the horizon; may be inf
    inclination_deg  theta of the camera, 0 ... 180; azimuth_deg: its phi
    observer         "static" or "zamo"; only kerr and kerr_schild tell them apart
    directions       (N, 3) look directions (n_r, n_theta, n_phi) in the observer's frame; normalised here
    screen           (N, 2) alpha (right), beta (up) in M: instead of directions, when distance is inf
    gravity_strength G of schwarzschild, kerr_like and the post-Newtonian models; horizon_size: their capture radius in horizon radii
    drag             k of kerr_like
    second_order     of weak_field; lens_radius, lens_shadow: of screen_lens, in r_s
    orders           number of plane crossings kept; orbit: "prograde" or "retrograde" emitters
    tolerance        error allowed per step of the integrator; below 1e-13 rounding leaves nothing to gain

    Raises ValueError for an unknown model, a camera below the horizon, or rays that do not fit the distance.
    """
    if model not in MODELS:
        raise ValueError(f"unknown ray model {model!r}: one of {', '.join(MODELS)}")
    tolerance = max(tolerance, _FINEST_TOLERANCE)
    at_infinity = math.isinf(distance)
    if (screen is None) == (directions is None) or (screen is None) == at_infinity:
        raise ValueError("rays are given by `screen` when distance is inf, and by `directions` otherwise")
    if model in _WITHOUT_SPIN:
        spin = 0.0
    horizon = 1.0 if model == "kerr_like" else relativity.horizon_radius(spin)
    if distance <= horizon:
        raise ValueError(f"the camera at r = {distance} r_s lies within the horizon at {horizon} r_s")
    rays = np.array(screen if at_infinity else directions, dtype=np.float64).reshape(-1, 2 if at_infinity else 3)
    if not at_infinity:
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)

    place_m = Place.from_degrees(2.0 * distance, inclination_deg, azimuth_deg)
    place = Place.from_degrees(distance, inclination_deg, azimuth_deg)
    used = observer
    if model in _KERR and observer == "static" and not static_observer_exists(place_m, spin):
        used = "zamo"
    parts = [rays[i:i + _BATCH] for i in range(0, len(rays), _BATCH)] or [rays]
    if model in _KERR:
        form = MinoSystem(-spin) if model == "kerr_schild" else KerrSchildSystem(-spin)
        traced = [_trace_kerr(part, place_m, form, used, orders, tolerance) for part in parts]
    elif model == "weak_field":
        traced = [_trace_weak_field(part, place, second_order, orders) for part in parts]
    elif model == "screen_lens":
        traced = [_trace_screen_lens(part, place, lens_radius, lens_shadow, orders) for part in parts]
    elif model.startswith("post_newtonian"):
        system = PostNewtonianSystem(gravity_strength, horizon_size * horizon, spin)
        traced = [_trace_post_newtonian(part, place, system, orders, tolerance) for part in parts]
    elif model == "flat":
        traced = [_trace_flat(part, place, horizon_size * horizon, orders) for part in parts]
    else:
        system = BinetSystem(gravity_strength, horizon_size, drag * spin if model == "kerr_like" else 0.0)
        traced = [_trace_schwarzschild(part, place, system, orders, tolerance) for part in parts]
    fate, direction, steps, r, phi, energy, l_z = (np.concatenate(pieces) for pieces in zip(*traced, strict=True))

    r = np.where(r < INNERMOST_CROSSING * horizon, np.nan, r)
    theta, azimuth = angles(direction, fate)
    return ReferenceHits(
        fate=fate, direction=direction, theta=theta, phi=azimuth, steps=steps, evaluations=steps * EVALUATIONS_PER_STEP,
        crossing_r=r, crossing_phi=np.where(np.isnan(r), np.nan, wrapped(phi)),
        g=_emitter_ratio(r, energy, l_z, spin, orbit), lambda_=l_z / energy, observer=used)


def _emitter_ratio(r: Array, energy: Array, l_z: Array, spin: float, orbit: str) -> Array:
    """E/(u^t (E - Omega L_z)), NaN inside the ISCO; E is kept apart because a ZAMO in the ergosphere sees E <= 0 too."""
    outside = r >= relativity.isco_radius(spin, orbit)
    safe = np.where(outside, r, 100.0)
    rate = 0.5 * relativity.orbital_frequency(safe, spin, orbit)
    energy, l_z = energy[:, None], l_z[:, None]
    return np.where(outside, energy / (relativity.orbital_u_t(safe, spin, orbit) * (energy - rate * l_z)), np.nan)


def _trace_kerr(rays, place, system, observer, orders, tolerance):
    if math.isinf(place.r):
        state = system.start_at_infinity(place, rays)
    else:
        state = system.start(place, momenta(rays, place, system.spin, observer))
    rows = (ENERGY, L_MINO) if isinstance(system, MinoSystem) else (8, 6)
    energy, l_z = state[rows[0]].copy(), -state[rows[1]]
    fate, direction, steps, r, phi = _follow(system, state, orders, tolerance)
    return fate, direction, steps, 0.5 * r, phi, energy, l_z


def _flat_l_z(rays, place):
    """L_z/E in M of the photons on straight rays."""
    return -rays[:, 0] * place.sin_theta if math.isinf(place.r) else -2.0 * place.r * place.sin_theta * rays[:, 2]


def _trace_post_newtonian(rays, place, system, orders, tolerance):
    state = system.start_at_infinity(place, 0.5 * rays) if math.isinf(place.r) else system.start(place, rays)
    return *_follow(system, state, orders, tolerance), np.ones(len(rays)), _flat_l_z(rays, place)


def _trace_weak_field(rays, place, second_order, orders):
    at_infinity = math.isinf(place.r)
    lapse = 1.0 if at_infinity else math.sqrt((place.r - 1.0) / place.r)
    fate, direction, r, phi = lenses.weak_field(place, 0.5 * rays if at_infinity else rays, second_order, orders)
    return fate, direction, np.zeros(len(rays), dtype=np.int64), r, phi, np.ones(len(rays)), _flat_l_z(rays, place) / lapse


def _trace_screen_lens(rays, place, lens_radius, shadow, orders):
    if math.isinf(place.r):
        fate, direction = lenses.screen_lens(place, 0.5 * rays, lens_radius, shadow)
        traced = fate, direction, np.zeros(len(rays), dtype=np.int64), *np.full((2, len(rays), orders), np.nan), np.ones(len(rays)), _flat_l_z(rays, place)
    else:
        fate, lensed = lenses.screen_lens(place, rays, lens_radius, shadow)
        traced = (fate, *_trace_flat(lensed, place, 0.0, orders)[1:])
    hidden = fate == CAPTURED
    traced[1][hidden], traced[3][hidden], traced[4][hidden] = 0.0, np.nan, np.nan
    return traced


def _trace_schwarzschild(rays, place, system, orders, tolerance):
    if math.isinf(place.r):
        state = system.start_at_infinity(place, 0.5 * rays)
        l_z = -rays[:, 0] * place.sin_theta
    else:
        state = system.start(place, rays)
        lapse = math.sqrt((place.r - 1.0) / place.r)
        l_z = -2.0 * place.r * place.sin_theta * rays[:, 2] / lapse
    return *_follow(system, state, orders, tolerance), np.ones(len(rays)), l_z


def _trace_flat(rays, place, radius, orders):
    if math.isinf(place.r):
        position, direction = flat.start_at_infinity(place, 0.5 * rays)
    else:
        position, direction = flat.start(place, rays)
    l_z = _flat_l_z(rays, place)
    fate, point = flat.trace_lines(position, direction, radius)
    direction = np.where((fate == ESCAPED)[:, None], direction, 0.0)
    r, phi = np.full((2, len(rays), orders), np.nan)
    if orders:
        r[:, 0] = np.hypot(point[:, 0], point[:, 1])
        phi[:, 0] = np.arctan2(point[:, 1], point[:, 0])
    return fate, direction, np.zeros(len(rays), dtype=np.int64), r, phi, np.ones(len(rays)), l_z


def _follow(system, state: Array, orders: int, tolerance: float):
    """Marches rays to their fate: (fate, direction, steps, crossing radius in the system's unit, crossing azimuth)."""
    events = _Events(system, state, orders)
    with np.errstate(all="ignore"):
        _, steps = march(system, state, 0.05 * system.longest_step(state), events, tolerance=tolerance, max_steps=_MAX_STEPS)
    return events.fate, events.direction, steps, events.radius, events.azimuth


class _Events:
    """Watches accepted steps for crossings of z = 0, escape (w = 0) and capture."""

    def __init__(self, system, state: Array, orders: int):
        count = state.shape[1]
        self.system = system
        self.orders = orders
        self.side = np.sign(state[N_Z])
        self.crossings = np.zeros(count, dtype=np.int64)
        self.fate = np.full(count, UNRESOLVED, dtype=np.int8)
        self.direction = np.zeros((count, 3))
        self.radius, self.azimuth = np.full((2, count, orders), np.nan)

    def __call__(self, rays: Array, before: Array, after: Array, step: Array) -> Array:
        escaped = after[W] <= 0.0
        end = step.copy()
        if escaped.any():
            part = np.flatnonzero(escaped)
            end[part], state = locate_zero(self.system, W, before[:, part], after[:, part], step[part])
            self.direction[rays[part]] = self.system.direction(state)
            self.fate[rays[part]] = ESCAPED
        self._cross(rays, before, after, step, end)
        captured = ~escaped & self.system.captured(after)
        self.fate[rays[captured]] = CAPTURED
        return escaped | captured

    def _cross(self, rays: Array, before: Array, after: Array, step: Array, end: Array) -> None:
        side = np.sign(after[N_Z])
        # A camera in the plane (side 0) takes the side its ray leaves to; its own place is no crossing.
        part = np.flatnonzero((side * self.side[rays] < 0.0) & (self.crossings[rays] < self.orders))
        self.side[rays] = np.where(side != 0.0, side, self.side[rays])
        if not part.size:
            return
        parameter, state = locate_zero(self.system, N_Z, before[:, part], after[:, part], step[part])
        real = (parameter < end[part]) & ~self.system.captured(state) & (state[W] > 0.0)
        part, state = part[real], state[:, real]
        order = self.crossings[rays[part]]
        self.radius[rays[part], order] = self.system.radius(state)
        self.azimuth[rays[part], order] = self.system.azimuth(state)
        self.crossings[rays[part]] += 1
