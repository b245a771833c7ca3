"""Twin of the closed ray model `weak_field` (float64, r_s = 1), in plane polar coordinates.

In the plane of a ray the camera is at azimuth 0 and the look direction at azimuth pi - psi. A straight line whose direction has azimuth
D and that passes the origin at distance d is r = d/sin(D - phi).
"""

from __future__ import annotations

import math

import numpy as np

from ..physics import deflection, relativity
from .events import IN_PLANE
from .flat import l_z_of_straight_rays
from .hits import CAPTURED, ESCAPED, Crossings, Traced
from .registry import View, twin

Array = np.ndarray


@twin("weak_field", metric=None, spins=False, parameters={"second_order": "rays.weak_field.second_order"})
def weak_field(view: View, second_order: bool = True) -> Traced:
    """One kink at closest approach by (1 + cos psi)/2 of the whole deflection: to first order the angle by which light bends on its way
    from a static observer at r outwards, psi measured by that observer. Second order: of the deflection at the kink.

    No momenta: the places are those of two straight lines and the kink is nowhere along light.
    """
    place, at_infinity = view.place, view.at_infinity
    lapse = 1.0 if at_infinity else math.sqrt((place.r - 1.0) / place.r)
    psi, side, b = _plane(view, lapse)
    inner = place.r < 1.5
    below = b < relativity.CRITICAL_IMPACT
    inward = psi < 0.5 * np.pi
    captured = (inward | ~below) if inner else (inward & below)
    bend = 0.5 * (1.0 + np.cos(psi)) * deflection.weak(np.maximum(b, 1e-6), 2 if second_order else 1)
    leaving = np.pi - psi + bend
    corner = np.where(inward, 0.5 * np.pi - psi, 0.0)
    if at_infinity:
        first, second = b, b * np.cos(bend)
    else:
        first = place.r * np.sin(psi)
        second = np.where(inward, first * np.cos(bend), place.r * np.sin(leaving))
    e_r = place.frame()[0]
    crossings = Crossings.none(len(psi), view.surfaces, view.orders)
    for event, normal in enumerate(view.planes):
        found = np.zeros(len(psi), dtype=int)
        for at in _meetings(normal, e_r, side):
            on_first = inward & (at < corner)
            on_second = ~captured & (at >= corner) & (at < leaving)
            with np.errstate(divide="ignore", invalid="ignore"):
                radius = np.where(on_first, first / np.sin(np.pi - psi - at), second / np.sin(leaving - at))
                n = np.cos(at) * e_r[:, None] + np.sin(at) * side.T
            part = np.flatnonzero((on_first | on_second) & (radius > 0.0) & (found < view.orders))
            crossings.record((part, event, found[part]), at[part], radius[part], n[:, part], (np.nan, np.nan))
            found[part] += 1
    direction = np.where(captured[:, None], 0.0, np.cos(leaving)[:, None] * e_r + np.sin(leaving)[:, None] * side)
    fate = np.where(captured, CAPTURED, ESCAPED).astype(np.int8)
    return Traced(fate, direction, np.zeros(len(psi), dtype=np.int64), np.ones(len(psi)), l_z_of_straight_rays(view) / lapse, crossings)


def _meetings(normal: Array, e_r: Array, side: Array) -> list[Array]:
    """Azimuths (N,) at which the rays' planes meet a plane through the hole, the camera's own excepted; infinite for a ray within it."""
    height, slope = float(normal @ e_r), side @ normal
    base = np.mod(np.arctan2(-height, slope), np.pi) if abs(height) > IN_PLANE else np.where(slope != 0.0, np.pi, np.inf)
    return [base + turn * np.pi for turn in range(3)]


def _plane(view: View, lapse: float) -> tuple[Array, Array, Array]:
    """(psi (N,), unit vector (N, 3) to which the ray turns, impact parameter (N,) in r_s)."""
    _, e_theta, e_phi = view.place.frame()
    if view.at_infinity:
        b = np.hypot(view.screen[:, 0], view.screen[:, 1])
        tangent = np.outer(view.screen[:, 0], e_phi) - np.outer(view.screen[:, 1], e_theta)
        return np.zeros(len(b)), tangent / np.maximum(b, 1e-300)[:, None], b
    sine = np.hypot(view.resting_rays[:, 1], view.resting_rays[:, 2])
    tangent = np.outer(view.resting_rays[:, 1], e_theta) + np.outer(view.resting_rays[:, 2], e_phi)
    return np.arctan2(sine, -view.resting_rays[:, 0]), tangent / np.maximum(sine, 1e-300)[:, None], view.place.r * sine / lapse
