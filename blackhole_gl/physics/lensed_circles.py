"""Where the observer sees circles of the equatorial plane, by which crossing of the plane one likes: closed forms in float64, in Kerr.

In Mino time τ (M = 1, E = 1) the two motions of light part (docs/physics.md). The polar one gives the time of the n-th crossing of the plane as an elliptic
integral; the radial one, w'² = 1 + (a²−λ²−η) w² + 2((λ−a)²+η) w³ − a²η w⁴ for w = M/r, gives w at that time by Biermann's formula with Weierstrass's ℘
(Whittaker & Watson, *A Course of Modern Analysis*, §20.6). Neither asks how often a ray turns round.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..shapes import Bool, Float, Int
from .deflection import carlson_rf
from .observer import Observer, local_directions, parallel_rays, screen_angles
from .relativity import critical_curve, horizon_radius

Array = np.ndarray

_TERMS = 12
_SERIES_REACH = 0.33  # of the length that the invariants give, a quarter of a period: there the terms left out are below 1e-15
_LOOKS = 24  # along a ray, for its end: the shortest way through the hole or infinity and back takes several of them
_BISECTIONS = 20  # of half a turn: 3e-6 rad, an eighth of a pixel where a picture 720 high shows a degree
_AT_ONCE = 300  # places that are looked at in hardly more time than one
_FEW = 16  # places that are halved to as soon as guessed at again
_SECANTS = 8  # most places need three
_LONGEST_SECANT = 0.7
_SHORT = 0.02  # a secant after which the next would be of a thousandth
_NEAR, _SETTLED = 1e-3, 1e-4  # of a radius, and of the shadow: secants whose last step is so short end far closer
_EDGE_POINTS = 720
_NUDGE = 1e-4  # of a crossing's time: w on its two sides says whether light goes in or out there


@dataclass(frozen=True)
class Light:
    """Rays traced backwards from the camera, in units of their energy at infinity with M = 1: arrays (…).

    Attributes:
        spin: a*.
        energy: E over that which the observer measures; where it `is_bound`, 1.
        lam, eta: L_z/E and Q/E², of the light that arrives.
        w, w_rate, u, u_rate: M/r, cos θ at the camera and their rates in Mino time. `w` and `u` are numbers.
        is_bound: whether E ≤ 0, as of some light in the ergosphere: it comes from the horizon.
    """

    spin: float
    energy: Float[Array, "*rays"]
    lam: Float[Array, "*rays"]
    eta: Float[Array, "*rays"]
    w: float
    w_rate: Float[Array, "*rays"]
    u: float
    u_rate: Float[Array, "*rays"]
    is_bound: Bool[Array, "*rays"]


def light(observer: Observer, directions: Float[Array, "*rays 3"]) -> Light:
    """The rays that `observer` sees in local `directions` (…, 3) of its tetrad; for a far one, `parallel_rays`."""
    rows = np.asarray(directions, float) @ observer.tetrad[:, 1:].T + observer.tetrad[:, 0]
    is_bound = rows[..., 0] <= 0.0
    energy = np.where(is_bound, 1.0, rows[..., 0])
    w_rate, down, aside = (rows[..., k] / energy for k in (1, 2, 3))
    cosine, sine = float(observer.n[2]), math.hypot(observer.n[0], observer.n[1])
    eta = down**2 + cosine**2 * (aside**2 - observer.spin**2)
    return Light(observer.spin, energy, -sine * aside, eta, observer.w, w_rate, cosine, -sine * down, is_bound)


def crossing_radius(rays: Light, order: Int[Array, "*#rays"]) -> Float[Array, "*rays"]:
    """Radius in r_s of crossing `order` (…) from 0 of the plane along each ray; 0 where it ends in the hole before, infinite where it escapes before."""
    time = _crossing_time(rays, order)
    horizon = 0.5 / float(horizon_radius(rays.spin))
    shares = np.arange(1, _LOOKS + 1) / _LOOKS
    w = _inverse_radius(rays, time[..., None] * shares)
    fell, left = w > horizon, ~(w > 0.0)
    ends = fell | left
    first = np.argmax(ends, axis=-1)
    falls = np.take_along_axis(fell, first[..., None], axis=-1)[..., 0]
    at_end = np.where(falls, 0.0, np.inf)
    inside = rays.is_bound | (rays.eta <= 0.0)  # light that never meets the plane: it is seen about the axis
    with np.errstate(divide="ignore"):
        return np.where(inside, 0.0, np.where(ends.any(axis=-1), at_end, 0.5 / w[..., -1]))


def crossing_momentum(rays: Light, order: Int[Array, "*#rays"], radius: Float[Array, "*rays"]) -> Float[Array, "*rays 3"]:
    """Covariant (k_r, k_θ, k_φ), (…, 3), of the light that arrives, with E = 1 and M = 1, at crossing `order` of the plane, which is at `radius` (r_s)."""
    a, lam, eta, w = rays.spin, rays.lam, rays.eta, 0.5 / radius
    square = 1.0 + w * w * (a * a - lam**2 - eta + w * (2.0 * ((lam - a) ** 2 + eta) - w * a * a * eta))
    time = _crossing_time(rays, order)
    before, after = np.moveaxis(_inverse_radius(rays, time[..., None] * (1.0 + _NUDGE * np.array([-1.0, 1.0]))), -1, 0)
    outwards = np.sign(after - before) * np.sqrt(np.maximum(square, 0.0)) / (1.0 - 2.0 * w + (a * w) ** 2)
    side = np.where(rays.u != 0.0, np.sign(rays.u), np.sign(rays.u_rate))  # of the plane that crossing 0 comes to
    return np.stack([outwards, -side * (-1.0) ** order * np.sqrt(np.maximum(eta, 0.0)), np.broadcast_to(lam, outwards.shape)], axis=-1)


def circles(
    observer: Observer,
    radii: Float[Array, " circles"],
    orders: Int[Array, " circles"],
    angles: Float[Array, " N"],
    guess: Float[Array, "circles N"] | None = None,
) -> Float[Array, "circles N"]:
    """How far from the hole's centre (`directions`) circles of `radii` (r_s) are seen, each by a crossing of its own, at `angles` on the screen.

    Args:
        guess: about where; from there a fifth of the time is enough. Where it does not lead to the place it is not used.

    Raises:
        ValueError: the camera is not outside the circles.
    """
    if observer.w * 2.0 * radii.max() >= 1.0:
        raise ValueError(f"the image of the circle r = {radii.max():g} r_s is asked for from r = {0.5 / observer.w:g} r_s; allowed is a camera outside of it")
    radius, order, angle = (values.ravel() for values in np.broadcast_arrays(radii[:, None], orders[:, None], angles))
    if guess is None:
        return _bisected(observer, radius, order, angle).reshape(len(radii), -1)
    base = np.where(orders[:, None] == 0, 0.0, shadow_edge(observer, angles)).ravel()
    found, missed = _refined(observer, radius, order, angle, guess.ravel(), base)
    if np.count_nonzero(missed) > _FEW and not missed.all():  # where an image crosses the critical curve: from its neighbours, and from the centre
        places = np.arange(len(found))
        beside = np.interp(places[missed], places[~missed], found[~missed])
        found[missed], again = _refined(observer, radius[missed], order[missed], angle[missed], beside, np.zeros(len(beside)))
        missed[missed] = again
    if missed.any():
        found[missed] = _bisected(observer, radius[missed], order[missed], angle[missed])
    return found.reshape(guess.shape)


def shadow_edge(observer: Observer, angles: Float[Array, " N"]) -> Float[Array, " N"]:
    """How far from the hole's centre (`directions`) the critical curve is seen at `angles` on the screen."""
    away, around = critical_points(observer, _EDGE_POINTS)
    return _along(angles, around, away)


def critical_points(observer: Observer, samples: int) -> tuple[Float[Array, " samples"], Float[Array, " samples"]]:
    """How far from the hole's centre (`directions`) points of the critical curve are seen, and at which angles on the screen.

    The constants of light on spherical orbits that come to the camera are those that a far observer at its inclination would see on its own critical curve;
    w' is then a root of the radial equation: inwards where the camera is outside of the orbit, where the equation's right-hand side falls with w.
    """
    cosine, sine = float(observer.n[2]), math.hypot(observer.n[0], observer.n[1])
    aside, up = critical_curve(observer.spin, math.atan2(sine, cosine), samples)
    if observer.w == 0.0:
        return np.hypot(aside, up), np.arctan2(up, aside)
    a, lam, w = observer.spin, -sine * aside, observer.w
    eta = up**2 + cosine**2 * (aside**2 - a**2)
    c2, c3, c4 = a * a - lam**2 - eta, 2.0 * ((lam - a) ** 2 + eta), -a * a * eta
    square, slope = 1.0 + w * w * (c2 + w * (c3 + w * c4)), w * (2.0 * c2 + w * (3.0 * c3 + w * 4.0 * c4))
    w_rate = -np.sign(slope) * np.sqrt(np.maximum(square, 0.0))
    seen = np.linalg.solve(observer.tetrad, np.stack([np.ones_like(lam), w_rate, -up, aside]))
    return from_hole(observer, (seen[1:] / seen[0]).T)


def from_hole(observer: Observer, directions: Float[Array, "*rays 3"]) -> tuple[Float[Array, "*rays"], Float[Array, "*rays"]]:
    """How far from the hole's centre local `directions` (…, 3) are, in radians, and at which angles on the screen. Not for a far observer."""
    return screen_angles(directions @ _about_hole(observer))


def directions(observer: Observer, away: Float[Array, "*at N"], angles: Float[Array, " N"]) -> Float[Array, "*at N 3"]:
    """Local directions (…, 3) at `angles` on the screen, from right towards up, `away` from the hole's centre: radians, or M for a far observer."""
    if observer.w == 0.0:
        return parallel_rays(away * np.cos(angles), away * np.sin(angles))
    return local_directions(away, angles) @ _about_hole(observer).T


def _about_hole(observer: Observer) -> Float[Array, "3 3"]:
    """The turn (3, 3) that takes straight inwards to where a moving observer sees the hole's centre, the shortest way."""
    hole = observer.hole
    if hole[0] == -1.0:
        return np.eye(3)
    across = np.array([0.0, hole[2], -hole[1]])  # inwards × hole
    skew = np.array([[0.0, -across[2], across[1]], [across[2], 0.0, -across[0]], [-across[1], across[0], 0.0]])
    return np.eye(3) + skew + skew @ skew / (1.0 - min(hole[0], 1.0 - 1e-9))


def _along(angles: Float[Array, " N"], around: Float[Array, " M"], away: Float[Array, " M"]) -> Float[Array, " N"]:
    """How far away the polygon of the points (`around`, `away`) in polar coordinates, which goes once round the origin, is at `angles`."""
    order = np.argsort(around)
    x, y = away[order] * np.cos(around[order]), away[order] * np.sin(around[order])
    turned = (angles - around[order[0]]) % (2.0 * math.pi) + around[order[0]]
    first = np.searchsorted(around[order], turned, side="right") - 1
    second = (first + 1) % len(x)
    return (x[first] * y[second] - y[first] * x[second]) / (np.cos(angles) * (y[second] - y[first]) - np.sin(angles) * (x[second] - x[first]))


def _bisected(observer: Observer, radius: Float[Array, " K"], order: Int[Array, " K"], angle: Float[Array, " K"]) -> Float[Array, " K"]:
    """`circles` for places listed one by one."""
    low = np.zeros(len(radius))
    high = low + (4.0 * radius + 20.0 if observer.w == 0.0 else math.pi)
    parts = int(np.clip(_AT_ONCE // len(radius), 2, 32))
    shares = (np.arange(1, parts) / parts)[:, None]
    for _ in range(math.ceil(_BISECTIONS / math.log2(parts))):
        between = low + shares * (high - low)
        inside = crossing_radius(light(observer, directions(observer, between, angle)), order) < radius
        first = np.where(inside.all(axis=0), parts - 1, np.argmin(inside, axis=0))  # within all before it the crossing lies too far in
        width = (high - low) / parts
        low, high = low + first * width, low + (first + 1) * width
    return 0.5 * (low + high)


def _refined(
    observer: Observer, radius: Float[Array, " K"], order: Int[Array, " K"], angle: Float[Array, " K"], guess: Float[Array, " K"], base: Float[Array, " K"]
) -> tuple[Float[Array, " K"], Bool[Array, " K"]]:
    """`circles` by secants from a guess, for places listed one by one, and where they did not lead there.

    In the logarithm of the distance from `base`: beside the critical curve a crossing's radius runs through all its values in a like stretch at every order.
    """

    def miss(distance: Float[Array, " L"], at: Int[Array, " L"]) -> Float[Array, " L"]:
        rays = light(observer, directions(observer, base[at] + distance, angle[at]))
        return _inverse_radius(rays, _crossing_time(rays, order[at])[..., None])[..., 0] - 0.5 / radius[at]

    found, there = np.full(len(radius), np.nan), np.zeros(len(radius), bool)
    with np.errstate(all="ignore"):  # what leads nowhere is told
        at, before = np.arange(len(radius)), guess - base
        before_missed, now = miss(before, at), 1.01 * before
        for _ in range(_SECANTS):
            missed = miss(now, at)
            step = -missed * np.log(now / before) / (missed - before_missed)
            step = np.clip(np.where(np.isfinite(step), step, 0.0), -_LONGEST_SECANT, _LONGEST_SECANT)
            after = now * np.exp(step)
            settled = (np.abs(step) < _SHORT) & (np.abs(after - now) < _SETTLED * (base[at] + after))
            found[at[settled]] = (base[at] + after)[settled]
            going = ~settled
            at, before, before_missed, now = at[going], now[going], missed[going], after[going]
            if not len(at):
                break
        at = np.flatnonzero(np.isfinite(found))
        looked_at = crossing_radius(light(observer, directions(observer, found[at], angle[at])), order[at])
        there[at] = np.abs(looked_at / radius[at] - 1.0) < _NEAR
    return found, ~there


def _crossing_time(rays: Light, order: Int[Array, "*#rays"]) -> Float[Array, "*rays"]:
    """Mino time to crossing `order`, from (du/dτ)² = (p − u²)(q + a²u²)."""
    a2, eta = rays.spin**2, np.maximum(rays.eta, 1e-30)
    b = eta + rays.lam**2 - a2
    root = np.sqrt(b * b + 4.0 * a2 * eta)
    q = np.where(b >= 0.0, 0.5 * (b + root), 2.0 * a2 * eta / np.where(b >= 0.0, 1.0, root - b))
    p = eta / q
    m = a2 * p / q
    sine2 = np.minimum(rays.u**2 / p, 1.0)
    to_plane = np.sqrt(sine2 / q) * carlson_rf(1.0 - sine2, 1.0 + m * sine2, np.ones_like(m))
    quarter = carlson_rf(np.zeros_like(m), 1.0 + m, np.ones_like(m)) / np.sqrt(q)
    away = (rays.u_rate * rays.u > 0.0) | (rays.u == 0.0)  # from the plane; a camera in it does not count as a crossing
    return np.where(away, 2.0 * quarter - to_plane, to_plane) + 2.0 * order * quarter


def _inverse_radius(rays: Light, time: Float[Array, "*rays times"]) -> Float[Array, "*rays times"]:
    """w = M/r at Mino times (…, T) along the rays (…), by Biermann's formula."""
    a, lam, eta, w = rays.spin, rays.lam[..., None], rays.eta[..., None], rays.w
    c2, c3, c4 = a * a - lam**2 - eta, 2.0 * ((lam - a) ** 2 + eta), -a * a * eta
    f = rays.w_rate[..., None] ** 2
    slope, bend, third, fourth = w * (2.0 * c2 + w * (3.0 * c3 + w * 4.0 * c4)), 2.0 * c2 + w * (6.0 * c3 + w * 12.0 * c4), 6.0 * c3 + 24.0 * w * c4, 24.0 * c4
    value, rate = weierstrass(time, c4 + c2**2 / 12.0, c4 * c2 / 6.0 - c2**3 / 216.0 - c3**2 / 16.0)
    lifted = value - bend / 24.0
    with np.errstate(divide="ignore", invalid="ignore"):
        return w + (0.5 * slope * lifted + f * third / 24.0 - rays.w_rate[..., None] * rate) / (2.0 * lifted**2 - f * fourth / 48.0)


def weierstrass(z: Float[Array, "*at"], g2: Float[Array, "*with"], g3: Float[Array, "*with"]) -> tuple[Float[Array, "*all"], Float[Array, "*all"]]:
    """℘ and ℘' at real z ≠ 0 with the invariants `g2`, `g3`: Laurent's series near 0, then the duplication of the argument.

    Each duplication makes relative errors of ℘' seventeen times as large, and so there are no more than the series needs.
    """
    scale = np.maximum(np.abs(g2 / 20.0) ** 0.25, np.abs(g3 / 28.0) ** (1.0 / 6.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        halvings = np.maximum(np.ceil(np.log2(np.abs(z) * scale / _SERIES_REACH)), 0.0)
    halvings = np.where(np.isfinite(halvings), halvings, 0.0)  # of no number nothing comes
    near = z / 2.0**halvings
    square = near**2
    coefficients = [g2 / 20.0, g3 / 28.0]
    for k in range(4, _TERMS + 2):
        products = [coefficients[m - 2] * coefficients[k - m - 2] for m in range(2, k - 1)]
        coefficients.append(3.0 / ((2 * k + 1) * (k - 3)) * np.sum(products, axis=0))
    value, rate = 1.0 / square, -2.0 / (square * near)
    power = np.ones_like(square)
    for k, coefficient in enumerate(coefficients, 2):
        rate = rate + (2 * k - 2) * coefficient * power * near
        power = power * square
        value = value + coefficient * power
    for done in range(int(halvings.max(initial=0.0))):
        ratio = (6.0 * value**2 - 0.5 * g2) / rate
        doubled = 0.25 * ratio**2 - 2.0 * value
        goes_on = done < halvings
        rate = np.where(goes_on, ratio * (value - doubled) - rate, rate)
        value = np.where(goes_on, doubled, value)
    return value, rate
