"""Twins of the closed ray models `weak_field` and `screen_lens` (float64, r_s = 1), in plane polar coordinates.

In the plane of a ray the camera is at azimuth 0 and the look direction at azimuth pi - psi. A straight line whose direction has azimuth
D and that passes the origin at distance d is r = d/sin(D - phi).
"""

from __future__ import annotations

import math

import numpy as np

from ..physics import relativity
from .hits import CAPTURED, ESCAPED
from .observers import Place

Array = np.ndarray


def weak_field(place: Place, rays: Array, second_order: bool, orders: int) -> tuple[Array, Array, Array, Array]:
    """(fate, direction, crossing radius, crossing azimuth) for local directions (N, 3), or screen places (N, 2) in r_s at infinity.

    One kink at closest approach by (1 + cos psi)/2 of the whole deflection: to first order the angle by which light bends on its way
    from a static observer at r outwards, psi measured by that observer.
    """
    psi, side, b = _plane(place, rays)
    inner = place.r < 1.5
    below = b < relativity.CRITICAL_IMPACT
    inward = psi < 0.5 * np.pi
    captured = (inward | ~below) if inner else (inward & below)
    bend = 0.5 * (1.0 + np.cos(psi)) * relativity.weak_deflection(np.maximum(b, 1e-6), 2 if second_order else 1)
    leaving = np.pi - psi + bend
    corner = np.where(inward, 0.5 * np.pi - psi, 0.0)
    e_r = place.frame()[0]
    if math.isinf(place.r):
        first, second = b, b * np.cos(bend)
    else:
        first = place.r * np.sin(psi)
        second = np.where(inward, first * np.cos(bend), place.r * np.sin(leaving))
    r, phi = np.full((2, len(psi), orders), np.nan)
    found = np.zeros(len(psi), dtype=int)
    # Azimuths at which the ray's plane meets z = 0, the camera's own excepted; a ray within z = 0 meets it nowhere.
    base = np.mod(np.arctan2(-e_r[2], side[:, 2]), np.pi) if e_r[2] != 0.0 else np.where(side[:, 2] != 0.0, np.pi, np.inf)
    for turn in range(3):
        at = base + turn * np.pi
        on_first = inward & (at < corner)
        on_second = ~captured & (at >= corner) & (at < leaving)
        with np.errstate(divide="ignore", invalid="ignore"):
            radius = np.where(on_first, first / np.sin(np.pi - psi - at), second / np.sin(leaving - at))
            point = np.cos(at)[:, None] * e_r + np.sin(at)[:, None] * side
        part = np.flatnonzero((on_first | on_second) & (radius > 0.0) & (found < orders))
        r[part, found[part]], phi[part, found[part]] = radius[part], np.arctan2(point[part, 1], point[part, 0])
        found[part] += 1
    direction = np.cos(leaving)[:, None] * e_r + np.sin(leaving)[:, None] * side
    fate = np.where(captured, CAPTURED, ESCAPED).astype(np.int8)
    return fate, np.where(captured[:, None], 0.0, direction), r, phi


def screen_lens(place: Place, rays: Array, lens_radius: float, shadow: float) -> tuple[Array, Array]:
    """(fate without regard to the displaced ray, displaced rays): what the flat picture is asked for instead.

    The displaced rays are local directions (N, 3) at a finite place, and world directions at infinity, where nothing nearer than the sky
    is seen.
    """
    psi, _, b = _plane(place, rays, flat=True)
    ahead = psi < 0.5 * np.pi
    fate = np.where(ahead & (b < shadow), CAPTURED, ESCAPED).astype(np.int8)
    if math.isinf(place.r):
        e_r, e_theta, e_phi = place.frame()
        inwards = -(np.outer(rays[:, 0], e_phi) - np.outer(rays[:, 1], e_theta)) / np.maximum(b, 1e-300)[:, None]
        bend = np.arctan2(2.0 * lens_radius, b)
        return fate, np.sin(bend)[:, None] * inwards - np.cos(bend)[:, None] * e_r
    tangent = np.tan(np.where(ahead, psi, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = np.arctan(tangent - 2.0 * lens_radius / (tangent * place.r))
        across = rays[:, 1:] / np.sin(psi)[:, None]
    lensed = np.column_stack([-np.cos(moved), np.sin(moved)[:, None] * across])
    return fate, np.where((ahead & (psi > 0.0))[:, None], lensed, rays)


def _plane(place: Place, rays: Array, flat: bool = False) -> tuple[Array, Array, Array]:
    """(psi, unit vector to which the ray turns, impact parameter in r_s)."""
    _, e_theta, e_phi = place.frame()
    if math.isinf(place.r):
        b = np.hypot(rays[:, 0], rays[:, 1])
        tangent = np.outer(rays[:, 0], e_phi) - np.outer(rays[:, 1], e_theta)
        return np.zeros(len(rays)), tangent / np.maximum(b, 1e-300)[:, None], b
    sine = np.hypot(rays[:, 1], rays[:, 2])
    tangent = np.outer(rays[:, 1], e_theta) + np.outer(rays[:, 2], e_phi)
    lapse = 1.0 if flat else math.sqrt((place.r - 1.0) / place.r)
    return np.arctan2(sine, -rays[:, 0]), tangent / np.maximum(sine, 1e-300)[:, None], place.r * sine / lapse
