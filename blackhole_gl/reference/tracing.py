"""From a camera and its rays to hits, in float64: the twin of the shaders' trace pass."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..physics import plunging, relativity
from ..shapes import Float
from .hits import EQUATOR, Crossings, ReferenceHits, angles, joined
from .integrator import EVALUATIONS_PER_STEP
from .marching import INNERMOST_CROSSING
from .observers import Place, static_observer_exists
from .registry import Twin, View, twin_of

_FINEST_TOLERANCE = 1e-13
_BATCH = 512  # rays per batch: the working set of a step stays in the cache

Array = np.ndarray


def trace(model: str, *, spin: float = 0.0, distance: float, inclination_deg: float, azimuth_deg: float = 0.0,
          observer: str = "static", velocity: tuple[float, float, float] = (0.0, 0.0, 0.0), fall_from: float = math.inf,
          directions: ArrayLike | None = None, screen: ArrayLike | None = None, planes: Sequence[Sequence[float]] = (),
          balls: Sequence[Sequence[float]] = (), orders: int = 3, orbit: str = "prograde", falls: bool = False, tolerance: float = 1e-12,
          **parameters: Any) -> ReferenceHits:
    """Traces rays backwards from the camera.

    Args:
        model: a ray model with a twin, one of `registry.models()`.
        spin: a*, -0.9999 ... 0.9999; models without spin take it as 0, flat uses it for the ball's size and the emitters' orbits.
        distance: Boyer-Lindquist r of the camera in r_s, above the horizon; may be inf.
        inclination_deg, azimuth_deg: theta of the camera, 0 ... 180, and its phi.
        observer: "static", "zamo", "circular", "rain" or "fall"; only models in Kerr's metric tell the first two apart.
        velocity: of the camera in that observer's frame, in (r, theta, phi). fall_from: where who falls was at rest, in r_s.
        directions: (N, 3) look directions (n_r, n_theta, n_phi) in the observer's frame; normalised here.
        screen: (N, 2) alpha (right), beta (up) in M: instead of directions, when distance is inf.
        planes: normals (of any length) of further planes through the hole whose crossings are asked for; events 1, 2, ... of the hits, event 0
            being the equatorial plane. With tilted ones the march takes shorter steps and more time.
        balls: (x, y, z, radius) in r_s of spheres whose crossings are asked for, the last events of the hits. They are never jumped, which takes
            more time still.
        orders: number of crossings kept of each plane and ball. orbit: "prograde" or "retrograde" emitters in the equatorial one.
        falls: whether there is matter inside the innermost stable orbit, too, that falls in from it.
        tolerance: error allowed per step of the integrator; below 1e-13 rounding leaves nothing to gain.
        parameters: those that the model's twin declares, such as gravity_strength, by name.

    Raises:
        ValueError: a model without a twin, a parameter that it does not take, a camera below the horizon, rays that do not fit the distance,
            or a normal that is none.
    """
    twin = twin_of(model)
    if unknown := sorted(set(parameters) - set(twin.parameters)):
        raise ValueError(f"the twin of {model} takes no {unknown[0]}; it takes {', '.join(twin.parameters) or 'no parameters'}")
    view = view_of(twin, spin, Place.from_degrees(distance, inclination_deg, azimuth_deg), observer, directions, screen, planes, orders, tolerance)
    view = replace(view, velocity=velocity, fall_from=fall_from, balls=np.array(balls, dtype=np.float64).reshape(-1, 4))
    batches = [view.rays[i:i + _BATCH] for i in range(0, len(view.rays), _BATCH)] or [view.rays]
    traced = joined([twin.trace(replace(view, rays=rays), **parameters) for rays in batches])

    crossings = traced.crossings.emptied(traced.crossings.r < INNERMOST_CROSSING * view.horizon)
    theta, azimuth = angles(traced.direction, traced.fate)
    return ReferenceHits(
        fate=traced.fate, direction=traced.direction, theta=theta, phi=azimuth, steps=traced.steps, evaluations=traced.steps * EVALUATIONS_PER_STEP,
        crossings=crossings, g=_emitter_ratio(crossings.of(EQUATOR), traced.energy, traced.l_z, view.spin, orbit, falls), lambda_=traced.l_z / traced.energy,
        energy_sign=np.sign(traced.energy), energy=view.energies(twin.metric), observer=view.observer)


def view_of(twin: Twin, spin: float, place: Place, observer: str, directions: ArrayLike | None, screen: ArrayLike | None,
            planes: Sequence[Sequence[float]], orders: int, tolerance: float) -> View:
    """What `twin` is to trace, from what `trace` takes.

    Raises:
        ValueError: as `trace`, but for a model's parameters.
    """
    spin = spin if twin.spins else 0.0
    horizon = 0.0 if not twin.has_hole else 1.0 if twin.metric == "schwarzschild" else float(relativity.horizon_radius(spin))
    if place.r <= horizon and observer not in ("rain", "fall"):
        raise ValueError(f"the camera at r = {place.r} r_s lies within the horizon at {horizon} r_s")
    view = View(_rays(place, directions, screen), place, spin, observer, horizon, _normals(planes), orders, max(tolerance, _FINEST_TOLERANCE))
    if twin.metric == "kerr" and observer == "static" and not static_observer_exists(view.place_in_m, spin):
        return replace(view, observer="zamo")
    return view


def _rays(place: Place, directions: ArrayLike | None, screen: ArrayLike | None) -> Float[Array, "N columns"]:
    at_infinity = math.isinf(place.r)
    if (screen is None) == (directions is None) or (screen is None) == at_infinity:
        raise ValueError("rays are given by `screen` when distance is inf, and by `directions` otherwise")
    if at_infinity:
        return np.array(screen, dtype=np.float64).reshape(-1, 2)
    rays = np.array(directions, dtype=np.float64).reshape(-1, 3)
    return rays / np.linalg.norm(rays, axis=1, keepdims=True)


def _normals(planes: Sequence[Sequence[float]]) -> Float[Array, "P 3"]:
    """Unit normals (1 + P, 3), the equatorial plane's first."""
    normals = np.array([(0.0, 0.0, 1.0), *planes], dtype=np.float64)
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    if not np.all((size > 0.0) & np.isfinite(size)):
        raise ValueError(f"planes: got the normals {list(map(tuple, planes))}; allowed are finite vectors with a length")
    return normals / size


def _emitter_ratio(met: Crossings, energy: Array, l_z: Array, spin: float, orbit: str, falls: bool) -> Array:
    """E/(u^t (E - Omega L_z)), inside the ISCO that of matter that falls, or NaN; E is kept apart because a ZAMO in the ergosphere sees E <= 0 too."""
    outside = met.r >= relativity.isco_radius(spin, orbit)
    safe = np.where(outside, met.r, 100.0)
    rate = 0.5 * relativity.orbital_frequency(safe, spin, orbit)
    energy, l_z = energy[:, None], l_z[:, None]
    inside = plunging.emission_shift(met.r, l_z / energy, met.k_r, spin, orbit, np.sign(energy)) if falls else np.nan
    return np.where(outside, energy / (relativity.orbital_u_t(safe, spin, orbit) * (energy - rate * l_z)), inside)
