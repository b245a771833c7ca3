"""Twins of the ray models `flat` and `screen_lens`: straight lines, in closed form (float64, r_s = 1).

A plane through the hole with normal m is met at x = p + s d with m.x = 0. A photon that arrives along the line has momentum -d: with
E = 1, k_r = -d.n and k_theta = -r d.e_theta at x = r n, null in the flat metric.

`screen_lens` shows the flat picture displaced about the hole's place on the screen, and a black disc on it: its rays are straight, only not
those that were asked for.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..shapes import Float
from .events import LightRays
from .hits import CAPTURED, ESCAPED, Crossings, Traced
from .marching import surfaces_of
from .observers import Place
from .registry import View, twin
from .straight_form import StraightSystem

Array = np.ndarray

_FAR = 1e4  # r_s: from where parallel rays come, for what lies in space and not in planes


def flat_light(view: View, horizon_size: float = 1.0) -> LightRays:
    """The rays of `view` at the camera; where that is at infinity, from far beyond all that is asked for."""
    position, direction = lines(view)
    if view.at_infinity:
        position = position - _FAR * direction
    return LightRays(StraightSystem(horizon_size * view.horizon), np.concatenate([position.T, direction.T]), np.ones(len(position)), l_z_of_straight_rays(view))


@twin("flat", metric="flat", parameters={"horizon_size": "hole.horizon_size"}, light=flat_light)
def flat(view: View, horizon_size: float = 1.0) -> Traced:
    """Straight rays past a black ball of `horizon_size` horizon radii."""
    return straight(view, horizon_size * view.horizon)


@twin("screen_lens", metric="flat", spins=False, parameters={"lens_radius": "rays.screen_lens.radius", "lens_shadow": "rays.screen_lens.shadow"})
def screen_lens(view: View, lens_radius: float = 1.0, lens_shadow: float = 2.598) -> Traced:
    """The displaced rays, in flat space without a ball; lens_radius and lens_shadow in r_s. At infinity the sky is all that there is to see."""
    psi, b = _from_the_hole(view)
    ahead = psi < 0.5 * np.pi
    hidden = ahead & (b < lens_shadow)
    fate = np.where(hidden, CAPTURED, ESCAPED).astype(np.int8)
    if view.at_infinity:
        direction = np.where(hidden[:, None], 0.0, _bent_by_thin_lens(view, b, lens_radius))
        none = Crossings.none(len(b), view.surfaces, view.orders)
        return Traced(fate, direction, np.zeros(len(b), dtype=np.int64), np.ones(len(b)), l_z_of_straight_rays(view), none)
    traced = straight(replace(view, rays=_displaced(view, psi, lens_radius), velocity=(0.0, 0.0, 0.0)), 0.0)
    return replace(traced, fate=fate, direction=np.where(hidden[:, None], 0.0, traced.direction), crossings=traced.crossings.without_rays(hidden))


def straight(view: View, radius: float) -> Traced:
    """The rays of `view` along straight lines that end on a ball of `radius` in r_s."""
    position, direction = lines(view)
    along = np.einsum("ij,ij->i", position, direction)
    closest2 = np.maximum(np.einsum("ij,ij->i", position, position) - along**2, 0.0)
    hit = (along < 0.0) & (closest2 < radius**2)
    end = np.where(hit, -along - np.sqrt(np.maximum(radius**2 - closest2, 0.0)), np.inf)
    crossings = Crossings.none(len(position), view.surfaces, view.orders)
    for event, surface in enumerate(surfaces_of(view)):
        for order, s in enumerate(surface.on_line(position, direction)[: view.orders]):
            with np.errstate(divide="ignore", invalid="ignore"):  # without a ball a line may go through r = 0, where there is no n
                part = np.flatnonzero(np.isfinite(s) & (s > 0.0) & (s <= end))
                point = position[part] + s[part, None] * direction[part]
                r = np.linalg.norm(point, axis=1)
                n = point / r[:, None]
                crossings.record((part, event, order), s[part], r, n.T, _momentum(r, n, direction[part]))
    fate = np.where(hit, CAPTURED, ESCAPED).astype(np.int8)
    zero = np.zeros(len(position), dtype=np.int64)
    return Traced(fate, np.where(hit[:, None], 0.0, direction), zero, np.ones(len(position)), l_z_of_straight_rays(view), crossings)


def lines(view: View) -> tuple[Float[Array, "N 3"], Float[Array, "N 3"]]:
    """Where straight rays begin, in r_s, and the unit vectors that they go along, both (N, 3) in the world."""
    return _start_at_infinity(view) if view.at_infinity else _start(view.place, view.resting_rays)


def l_z_of_straight_rays(view: View) -> Float[Array, " N"]:
    """L_z/E in M of photons on straight rays."""
    place, rays = view.place, view.resting_rays
    return -rays[:, 0] * place.sin_theta if view.at_infinity else -2.0 * place.r * place.sin_theta * rays[:, 2]


def _momentum(r: Array, n: Array, direction: Array) -> tuple[Array, Array]:
    ring = np.hypot(n[:, 0], n[:, 1])
    along_theta = n[:, 2] * (n[:, 0] * direction[:, 0] + n[:, 1] * direction[:, 1]) / ring - ring * direction[:, 2]
    return -np.einsum("ij,ij->i", n, direction), -2.0 * r * along_theta


def _start(place: Place, directions: Array) -> tuple[Array, Array]:
    """World positions and directions (N, 3) of local directions (N, 3) seen from `place` (r in r_s)."""
    e_r, e_theta, e_phi = place.frame()
    world = directions @ np.stack([e_r, e_theta, e_phi])
    return np.repeat((place.r * e_r)[None], len(world), axis=0), world


def _start_at_infinity(view: View) -> tuple[Array, Array]:
    """As `_start`, for parallel rays, from a place far beyond all crossings asked for."""
    e_r, e_theta, e_phi = view.place.frame()
    direction = np.repeat(-e_r[None], len(view.rays), axis=0)
    offset = np.outer(view.screen[:, 0], e_phi) - np.outer(view.screen[:, 1], e_theta)
    # A plane is met at s = -m.offset/m.direction; a start before that point misses nothing, wherever it lies.
    with np.errstate(divide="ignore", invalid="ignore"):
        s = np.abs(offset @ view.planes.T / (direction @ view.planes.T))
    reach = 2.0 * np.where(np.isfinite(s), s, 0.0).max(axis=1) + 10.0
    return offset - reach[:, None] * direction, direction


def _from_the_hole(view: View) -> tuple[Array, Array]:
    """(psi, impact parameter of the straight ray in r_s), each (N,)."""
    if view.at_infinity:
        return np.zeros(len(view.rays)), np.hypot(view.screen[:, 0], view.screen[:, 1])
    sine = np.hypot(view.resting_rays[:, 1], view.resting_rays[:, 2])
    return np.arctan2(sine, -view.resting_rays[:, 0]), view.place.r * sine


def _bent_by_thin_lens(view: View, b: Array, lens_radius: float) -> Array:
    """World directions (N, 3) of the displaced rays of a camera at infinity."""
    e_r, e_theta, e_phi = view.place.frame()
    inwards = -(np.outer(view.screen[:, 0], e_phi) - np.outer(view.screen[:, 1], e_theta)) / np.maximum(b, 1e-300)[:, None]
    bend = np.arctan2(2.0 * lens_radius, b)
    return np.sin(bend)[:, None] * inwards - np.cos(bend)[:, None] * e_r


def _displaced(view: View, psi: Array, lens_radius: float) -> Array:
    """Local directions (N, 3) of what the flat picture is asked for instead: offset *= 1 - 2 lens_radius/(rho sqrt(D))^2 on the screen."""
    ahead = psi < 0.5 * np.pi
    tangent = np.tan(np.where(ahead, psi, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = np.arctan(tangent - 2.0 * lens_radius / (tangent * view.place.r))
        across = view.resting_rays[:, 1:] / np.sin(psi)[:, None]
    lensed = np.column_stack([-np.cos(moved), np.sin(moved)[:, None] * across])
    return np.where((ahead & (psi > 0.0))[:, None], lensed, view.resting_rays)
