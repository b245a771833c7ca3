"""Parallel transport along light of Kerr, in Cartesian Kerr–Schild coordinates (float64, M = 1): what polarization by a constant of the motion is checked with.

    g = η + f l l,   f = 2 r³/(r⁴ + a² z²),   l = (1, (r x + a y)/(r²+a²), (r y − a x)/(r²+a²), z/r)

(Kerr & Schild 1965). Light k and two vectors are carried backwards in time from the observer by dv^μ = −Γ^μ_αβ k^α v^β ds, with Christoffel's symbols from the
metric's derivatives, which are taken by a complex step and so exact to rounding. Unlike the rays of the twins nothing separates here, and no time is reversed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..shapes import Float
from .integrator import locate_zero, march
from .observers import Place

Array = np.ndarray

FAR = 1e6
"""Distance in M of a camera that stands for one at infinity: what is left of the bending beyond is 4e-6 rad."""

_COMPLEX_STEP = 1e-30
_MAX_STEPS = 1500
_OUTERMOST = 100.0  # M: crossings are found as far out, and as far as the camera
_SLICE = slice(0, 3), slice(3, 7), slice(7, 11), slice(11, 15)  # x, k, and the two vectors across the light


@dataclass(frozen=True)
class Carried:
    """Where N rays cross the equatorial plane the n-th time, and what they carried there; NaN for those that do not.

    Attributes:
        place: (3, N) Kerr–Schild x, y, z in M.
        k: (4, N) the light's wave vector, future-pointing, in units of the energy that the observer measures.
        right, up: (4, N) the observer's two unit vectors across the light, carried there.
    """

    place: Float[Array, "3 N"]
    k: Float[Array, "4 N"]
    right: Float[Array, "4 N"]
    up: Float[Array, "4 N"]


def metric(place: Array, spin: float) -> Array:
    """Covariant metric (4, 4, …) at places (3, …), real or complex."""
    x, y, z = place
    rest = x * x + y * y + z * z - spin * spin
    r2 = 0.5 * (rest + np.sqrt(rest * rest + 4.0 * (spin * z) ** 2))
    r = np.sqrt(r2)
    ring = r2 + spin * spin
    null = np.stack([np.ones_like(r), (r * x + spin * y) / ring, (r * y - spin * x) / ring, z / r])
    flat = np.diag([-1.0, 1.0, 1.0, 1.0]).reshape(4, 4, *[1] * (place.ndim - 1))
    return flat + 2.0 * r * r2 / (r2 * r2 + (spin * z) ** 2) * null[:, None] * null[None, :]


def slopes(place: Float[Array, " 3 *at"], spin: float) -> Float[Array, "3 4 4 *at"]:
    """Derivatives (3, 4, 4, …) of the metric along x, y, z."""
    step = _COMPLEX_STEP * 1j * np.eye(3).reshape(3, 3, *[1] * (place.ndim - 1))
    return np.stack([metric(place + step[i], spin).imag / _COMPLEX_STEP for i in range(3)])


class TransportSystem:
    """x, k and two vectors, (15, …), along light; the parameter runs backwards in time and counts lengths in distances from the hole."""

    def __init__(self, spin: float):
        self.spin = spin
        self.r_plus = 1.0 + math.sqrt((1.0 - spin) * (1.0 + spin))

    def rhs(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        x, k, *carried = (state[rows] for rows in _SLICE)
        slope = np.concatenate([np.zeros((1, 4, 4, *x.shape[1:])), slopes(x, self.spin)])
        inverse = _raised(metric(x, self.spin))
        along = np.einsum("a...,abc...->bc...", k, slope)  # k^α ∂_α g_βγ
        turn = np.einsum("b...,abc...->ac...", k, slope)  # k^β ∂_α g_βγ
        change = [k[1:]]
        for v in (k, *carried):
            force = np.einsum("bc...,c...->b...", along + turn.swapaxes(0, 1) - turn, v)
            change.append(-0.5 * np.einsum("ab...,b...->a...", inverse, force))
        return -np.sqrt((x * x).sum(axis=0)) * np.concatenate(change)

    def scale(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        size = np.ones_like(state)
        size[:3] = np.sqrt((state[:3] ** 2).sum(axis=0))
        return size

    def longest_step(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        return np.full(state.shape[1:], 0.3)  # of the distance: no ray comes to the plane and goes again within one

    def rechart(self, before: Float[Array, " rows *points"], after: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return after

    def radius(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        """Boyer–Lindquist r in M."""
        rest = (state[:3] ** 2).sum(axis=0) - self.spin**2
        return np.sqrt(0.5 * (rest + np.sqrt(rest * rest + 4.0 * (self.spin * state[2]) ** 2)))


def carried_to_plane(place: Place, spin: float, observer: str, rays: Float[Array, "N columns"], order: int, tolerance: float = 1e-11) -> Carried:
    """Carries the observer's right and up back along `rays` to their crossing `order`, from 0, of the equatorial plane.

    Args:
        place: of the camera, r in M and finite or not; its azimuth is of no account. Not on the axis, and not in the plane.
        observer: "static" or "zamo"; of no account far away.
        rays: (N, 3) unit look directions in (r, θ, φ), or (N, 2) α, β in M from infinity. Right and up are e_φ and −e_θ, made to be across the ray.
    """
    system = TransportSystem(spin)
    state = _start(place, spin, observer, rays)
    found = np.full_like(state, np.nan)
    crossed = np.zeros(state.shape[1], dtype=int)

    leaves = 2.0 * (system.radius(state).max() + _OUTERMOST)

    def watch(moved: Array, before: Array, after: Array, step: Array) -> Array:
        crosses = before[2] * after[2] < 0.0
        last = crosses & (crossed[moved] == order)
        crossed[moved[crosses]] += 1
        if last.any():
            found[:, moved[last]] = locate_zero(system.rhs, lambda at: at[2], before[:, last], after[:, last], step[last])[1]
        r = system.radius(after)
        return last | (r < 1.02 * system.r_plus) | (r > leaves)

    march(system, state, np.full(state.shape[1], 0.01), watch, tolerance=tolerance, max_steps=_MAX_STEPS)
    return Carried(*(found[rows] for rows in _SLICE))


def angle_of_synchrotron(carried: Carried, spin: float, angular_velocity: Float[Array, " N"], field: tuple[float, float, float]) -> Float[Array, " N"]:
    """Position angle at the observer, from up towards left, −π … π, of light polarized along ε(u, k, B) where it leaves matter on circular orbits.

    Args:
        angular_velocity: dφ/dt of the matter there, M = 1.
        field: its parts along the axis, outwards and along the orbit, in the frame of the matter.
    """
    x = carried.place
    g = metric(x, spin)
    zero, one = np.zeros_like(x[0]), np.ones_like(x[0])
    u = _unit(g, np.stack([one, -angular_velocity * x[1], angular_velocity * x[0], zero]))
    axis = _unit(g, np.stack([zero, zero, zero, one]))
    outwards = _unit(g, np.einsum("ab...,b...->a...", _raised(g), _slope_of_radius(x, spin)))
    turning = np.stack([zero, -x[1], x[0], zero])
    forward = _unit(g, turning + _product(g, turning, u) * u)
    return _angle(carried, g, u, field[0] * axis + field[1] * outwards + field[2] * forward)


def angle_of_falling(carried: Carried, spin: float, energy: float, momentum: float, field: tuple[float, float, float]) -> Float[Array, " N"]:
    """The same of matter that falls inwards in the plane with that energy and angular momentum a unit of mass, M = 1.

    Args:
        field: its parts along the axis, outwards and counter-clockwise, in the frame of the matter: that of zero angular momentum, boosted and not turned.
    """
    x = carried.place
    g = metric(x, spin)
    inverse, slope, r = _raised(g), _slope_of_radius(x, spin), np.sqrt((x * x).sum(axis=0) - spin**2)
    zero, one = np.zeros_like(x[0]), np.ones_like(x[0])
    still, turning = np.stack([one, zero, zero, zero]), np.stack([zero, -x[1], x[0], zero])
    time = np.stack([one, zero, zero, zero]) - 2.0 * r / (r * (r - 2.0) + spin**2) * slope  # the gradient of Boyer–Lindquist's
    rest, outwards = (_unit(g, np.einsum("ab...,b...->a...", inverse, form)) for form in (-time, slope))
    axis, forward = _unit(g, np.stack([zero, zero, zero, one])), _unit(g, turning)
    around = momentum / np.sqrt(_product(g, turning, turning))
    gamma = -(energy + around * _product(g, forward, still)) / _product(g, rest, still)
    inwards = -np.sqrt(gamma**2 - 1.0 - around**2)
    u = gamma * rest + inwards * outwards + around * forward
    boosted = [v + part / (1.0 + gamma) * (u + rest) for v, part in ((outwards, inwards), (forward, around))]
    return _angle(carried, g, u, field[0] * axis + field[1] * boosted[0] + field[2] * boosted[1])


def _angle(carried: Carried, g: Array, u: Array, magnetic: Array) -> Float[Array, " N"]:
    """Position angle at the observer of light polarized along ε(u, k, B)."""
    lowered = [np.einsum("ab...,b...->a...", g, v) for v in (u, carried.k, magnetic)]
    f = np.einsum("abcd,b...,c...,d...->a...", _permutations(), *lowered)
    return np.arctan2(-_product(g, f, carried.right), _product(g, f, carried.up))


def _start(place: Place, spin: float, observer: str, rays: Array) -> Float[Array, "15 N"]:
    """The observer's place, the light that arrives and the two vectors across it."""
    far = math.isinf(place.r)
    r = FAR if far else place.r
    sine, cosine = place.sin_theta, place.cos_theta
    x = np.array([r * sine, spin * sine, r * cosine])
    frame = _observer_frame(x, r, place, spin, "zamo" if far else observer)
    if far:
        ahead = np.broadcast_to(np.array([-1.0, 0.0, 0.0]), (len(rays), 3))
        offset = rays[:, :1] * frame[3, 1:] - rays[:, 1:] * frame[2, 1:]
    else:
        ahead, offset = rays, np.zeros((len(rays), 3))
    up = np.array([0.0, -1.0, 0.0]) + ahead[:, 1:2] * ahead
    up = up / np.linalg.norm(up, axis=1, keepdims=True)
    k = frame[0] - ahead @ frame[1:]
    return np.concatenate([(x + offset).T, k.T, (np.cross(ahead, up) @ frame[1:]).T, (up @ frame[1:]).T])


def _observer_frame(x: Array, r: float, place: Place, spin: float, observer: str) -> Float[Array, "4 4"]:
    """u, e_r, e_θ, e_φ as rows, by Gram and Schmidt from the symmetries' directions and the gradient of r."""
    g = metric(x, spin)
    inverse = _raised(g)
    gradient = _slope_of_radius(x, spin)
    if observer == "static":
        u = np.array([1.0, 0.0, 0.0, 0.0])
    else:
        delta = r * (r - 2.0) + spin * spin
        u = -inverse @ (np.array([1.0, 0.0, 0.0, 0.0]) - 2.0 * r / delta * gradient)  # the gradient of Boyer–Lindquist's time
    u = _unit(g, u)
    sine, cosine = place.sin_theta, place.cos_theta
    downwards = _unit(g, np.array([0.0, r * cosine, spin * cosine, -r * sine]))
    turning = np.array([0.0, -x[1], x[0], 0.0])
    forward = _unit(g, turning + _product(g, turning, u) * u)
    return np.stack([u, _unit(g, inverse @ gradient), downwards, forward])


def _slope_of_radius(x: Array, spin: float) -> Array:
    """Covariant gradient (4, …) of Boyer–Lindquist's r: of x²+y² over r²+a² and z² over r², whose sum is 1."""
    rest = (x * x).sum(axis=0) - spin * spin
    r2 = 0.5 * (rest + np.sqrt(rest * rest + 4.0 * (spin * x[2]) ** 2))
    r = np.sqrt(r2)
    size = r * ((x[0] ** 2 + x[1] ** 2) / (r2 + spin * spin) ** 2 + (x[2] / r2) ** 2)
    return np.stack([np.zeros_like(r), x[0] / (r2 + spin * spin) / size, x[1] / (r2 + spin * spin) / size, x[2] / r2 / size])


def _raised(g: Array) -> Array:
    """The inverse of metrics (4, 4, …)."""
    return np.moveaxis(np.linalg.inv(np.moveaxis(g, (0, 1), (-2, -1))), (-2, -1), (0, 1))


def _product(g: Array, a: Array, b: Array) -> Array:
    return np.einsum("ab...,a...,b...->...", g, a, b)


def _unit(g: Array, v: Array) -> Array:
    return v / np.sqrt(np.abs(_product(g, v, v)))


def _permutations() -> Float[Array, "4 4 4 4"]:
    """Levi-Civita's symbol; √−g is 1 in these coordinates."""
    symbol = np.zeros((4, 4, 4, 4))
    for a in range(4):
        for b in range(4):
            for c in range(4):
                for d in range(4):
                    symbol[a, b, c, d] = np.sign((b - a) * (c - a) * (d - a) * (c - b) * (d - b) * (d - c))
    return symbol
