"""The camera as an observer of Kerr space-time: local directions to conserved quantities (float64, M = 1).

A vector X is told here by (U, V, T2, T3), with P = (r^2+a^2)E - aL, E = -X.d_t, L = X.d_phi, and R = Sigma X^r:

    U = (P + R)/Delta      V = P - R      T2 = Sigma X^theta      T3 = L/sin(theta) - a sin(theta) E

which are Carter's forms (1968) times sqrt(Sigma), with the two null ones scaled so that all are finite for who falls through the horizon. Then

    X.Y = (-(U_X V_Y + V_X U_Y)/2 + T2_X T2_Y + T3_X T3_Y)/Sigma

    d_t = (1, Delta, 0, -a sin)        d_phi/sin = (-a sin, -a sin Delta, 0, r^2+a^2)

and who falls with E and L = 0 has P = (r^2+a^2)E, U = (r^2+a^2)/V where E = 1 or a = 0. Gram and Schmidt on (u, d_theta, d_phi, d_r) gives the axes
that the camera counts directions by. A boost makes new axes of all four, without turning them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..shapes import Float

Array = np.ndarray


def cos_sin_degrees(angle: float) -> tuple[float, float]:
    """(cos, sin) of an angle in degrees; exact at multiples of 90."""
    quarter = round(angle / 90.0)
    rest = math.radians(angle - 90.0 * quarter)
    cosine, sine = math.cos(rest), math.sin(rest)
    return [(cosine, sine), (-sine, cosine), (-cosine, -sine), (sine, -cosine)][quarter % 4]


@dataclass(frozen=True)
class Place:
    """Where the camera is: Boyer-Lindquist r in M (may be inf) and the cosines and sines of theta and phi."""

    r: float
    cos_theta: float
    sin_theta: float
    cos_phi: float
    sin_phi: float

    @classmethod
    def from_degrees(cls, r: float, inclination: float, azimuth: float) -> Place:
        return cls(r, *cos_sin_degrees(inclination), *cos_sin_degrees(azimuth))

    def frame(self) -> tuple[Float[Array, " 3"], Float[Array, " 3"], Float[Array, " 3"]]:
        """World unit vectors (e_r, e_theta, e_phi) of the coordinate directions, each (3,)."""
        c, s, cp, sp = self.cos_theta, self.sin_theta, self.cos_phi, self.sin_phi
        return np.array([s * cp, s * sp, c]), np.array([c * cp, c * sp, -s]), np.array([-sp, cp, 0.0])


@dataclass(frozen=True)
class Momenta:
    """Photons at the observer, in units of the energy it measures: arrays (N,).

    energy, l_over_sin = L_z/sin(theta), p_theta: covariant components; radial_rate = Sigma dr/ds; carter_p = (r^2+a^2)E - aL;
    carter_k = Q + (L - aE)^2.
    """

    energy: Float[Array, " N"]
    l_over_sin: Float[Array, " N"]
    p_theta: Float[Array, " N"]
    radial_rate: Float[Array, " N"]
    carter_p: Float[Array, " N"]
    carter_k: Float[Array, " N"]


def static_observer_exists(place: Place, spin: float) -> bool:
    """True outside the ergosphere, where d_t is time-like."""
    if math.isinf(place.r):
        return True
    delta = place.r * (place.r - 2.0) + spin * spin
    return delta > (spin * place.sin_theta) ** 2


def momenta(directions: Float[Array, "N 3"], place: Place, spin: float, observer: str, velocity: Sequence[float] = (0.0, 0.0, 0.0),
            fall_from: float = math.inf) -> Momenta:
    """Conserved quantities of photons that move along `directions` (N, 3) = (n_r, n_theta, n_phi) of the observer. Finite distance only.

    Args:
        spin: of the hole as the photons have it: the reversed one of the hole that the observer is in, who moves the other way in it.
        observer: "static" (only outside the ergosphere), "zamo", "circular" (in the plane, or any with spin 0), "rain" or "fall" (spin 0).
        velocity: (3,) in (r, theta, phi), of the camera in that observer's frame.
        fall_from: of "fall", r in M.
    """
    sigma, axes = _axes(place, -spin, observer, fall_from)
    axes = _boosted(axes, np.asarray(velocity, dtype=np.float64))
    light = axes[0] - np.asarray(directions, dtype=np.float64) @ axes[1:]  # what arrives from there; what moves there has all but E and P reversed
    u, v, t2, t3 = light.T
    r, sine = place.r, place.sin_theta
    p, outwards = 0.5 * (_delta(place, spin) * u + v), 0.5 * (_delta(place, spin) * u - v)
    return Momenta(
        energy=(p - spin * sine * t3) / sigma,
        l_over_sin=(spin * sine * p - (r * r + spin * spin) * t3) / sigma,
        p_theta=-t2,
        radial_rate=-outwards,
        carter_p=p,
        carter_k=t2**2 + t3**2,
    )


def at_rest(directions: Float[Array, "N 3"], velocity: Sequence[float]) -> Float[Array, "N 3"]:
    """Where light is seen by who is at rest, unit vectors (N, 3), that who moves at `velocity` (3,) sees in unit `directions` (N, 3)."""
    v = np.asarray(velocity, dtype=np.float64)
    gamma = 1.0 / math.sqrt(1.0 - v @ v)
    along = directions @ v
    seen = directions + v * (gamma * gamma / (gamma + 1.0) * along - gamma)[:, None]
    return seen / (gamma * (1.0 - along))[:, None]


def _delta(place: Place, spin: float) -> float:
    r_plus = 1.0 + math.sqrt((1.0 - spin) * (1.0 + spin))
    return (place.r - r_plus) * (place.r - 2.0 + r_plus)


def _axes(place: Place, spin: float, observer: str, fall_from: float) -> tuple[float, Float[Array, "4 4"]]:
    """Sigma, and u, e_r, e_theta, e_phi of the observer as rows (U, V, T2, T3), in a hole with `spin`."""
    r, sine = place.r, place.sin_theta
    sigma, delta, wide = r * r + (spin * place.cos_theta) ** 2, _delta(place, spin), r * r + spin * spin

    def product(x: Array, y: Array) -> float:
        return float((-0.5 * (x[0] * y[1] + x[1] * y[0]) + x[2] * y[2] + x[3] * y[3]) / sigma)

    velocity = _fall(r, spin, sine, observer, fall_from) if observer in ("rain", "fall") else _turn(place, spin, delta, observer)
    u = velocity / math.sqrt(-product(velocity, velocity))
    e_theta = np.array([0.0, 0.0, math.sqrt(sigma), 0.0])
    e_phi = np.array([-spin * sine, -spin * sine * delta, 0.0, wide])
    e_r = np.array([1.0, -1.0, 0.0, 0.0])
    e_phi = e_phi + product(e_phi, u) * u
    e_phi = e_phi / math.sqrt(product(e_phi, e_phi))
    e_r = e_r + product(e_r, u) * u - product(e_r, e_phi) * e_phi
    return sigma, np.stack([u, e_r / math.sqrt(product(e_r, e_r)), e_theta, e_phi])


def _turn(place: Place, spin: float, delta: float, observer: str) -> Float[Array, " 4"]:
    """d_t + Omega d_phi. The orbits are prograde geodesics; out of the plane, where a = 0, sin(theta) d_phi is meant."""
    r, sine = place.r, place.sin_theta
    wide = r * r + spin * spin
    if observer == "circular":
        sense = -1.0 if spin < 0.0 else 1.0
        rate = sense / (r**1.5 + abs(spin))
        return np.array([1.0 - spin * rate, delta * (1.0 - spin * rate), 0.0, wide * rate - spin])
    rate = 0.0
    if observer == "zamo":
        rate = 2.0 * spin * r / (wide * wide - delta * (spin * sine) ** 2)
    null = 1.0 - spin * sine * sine * rate
    return np.array([null, delta * null, 0.0, sine * (wide * rate - spin)])


def _fall(r: float, spin: float, sine: float, observer: str, fall_from: float) -> Float[Array, " 4"]:
    energy = 1.0 if observer == "rain" else math.sqrt(1.0 - 2.0 / fall_from)
    wide = r * r + spin * spin
    inwards = math.sqrt(wide * (wide * energy**2 - (wide - 2.0 * r)))  # P^2 - Delta (r^2 + a^2): light of no mass has K for the last
    v = wide * energy + inwards
    return np.array([wide / v, v, 0.0, -spin * sine])


def _boosted(axes: Float[Array, "4 4"], velocity: Float[Array, " 3"]) -> Float[Array, "4 4"]:
    gamma = 1.0 / math.sqrt(1.0 - velocity @ velocity)
    along = velocity @ axes[1:]
    return np.concatenate([gamma * (axes[:1] + along), axes[1:] + np.outer(velocity, gamma * axes[0] + gamma * gamma / (gamma + 1.0) * along)])
