"""The camera as an observer of Kerr space-time: local directions to conserved quantities (float64, M = 1).

The metric is orthonormal in Carter's frame, whose forms are

    w0 = sqrt(Delta/Sigma) (dt - a sin^2 theta dphi)      w1 = sqrt(Sigma/Delta) dr
    w2 = sqrt(Sigma) dtheta                               w3 = sin theta/sqrt(Sigma) ((r^2+a^2) dphi - a dt)

(Carter 1968). Gram-Schmidt on (u, d_r, d_theta, d_phi) leaves e_r and e_theta as they are; u and e_phi lie in the
plane of w0 and w3, where u is Carter's observer boosted along phi by

    static observer, u ~ d_t:                     beta = -a sin theta/sqrt(Delta)
    ZAMO,            u ~ d_t + omega d_phi:       beta = -a sin theta sqrt(Delta)/(r^2+a^2)

No difference of nearly equal numbers occurs, not even just above the horizon, and no division by sin theta.
"""

from __future__ import annotations

import math
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

    energy, l_over_sin = L_z/sin(theta), p_theta: covariant components; radial = n_r; carter_p = (r^2+a^2)E - aL;
    carter_k = Q + (L - aE)^2.
    """

    energy: Float[Array, " N"]
    l_over_sin: Float[Array, " N"]
    p_theta: Float[Array, " N"]
    radial: Float[Array, " N"]
    carter_p: Float[Array, " N"]
    carter_k: Float[Array, " N"]


def static_observer_exists(place: Place, spin: float) -> bool:
    """True outside the ergosphere, where d_t is time-like."""
    if math.isinf(place.r):
        return True
    delta = place.r * (place.r - 2.0) + spin * spin
    return delta > (spin * place.sin_theta) ** 2


def momenta(directions: Float[Array, "N 3"], place: Place, spin: float, observer: str) -> Momenta:
    """Conserved quantities of photons that move along `directions` (N, 3) = (n_r, n_theta, n_phi) of the observer.

    `observer`: "static" (only outside the ergosphere) or "zamo". Finite distance only.
    """
    r, sine = place.r, place.sin_theta
    sigma = r * r + (spin * place.cos_theta) ** 2
    r_plus = 1.0 + math.sqrt((1.0 - spin) * (1.0 + spin))
    delta = (r - r_plus) * (r - 2.0 + r_plus)
    root_delta, root_sigma = math.sqrt(delta), math.sqrt(sigma)
    if observer == "static":
        # gamma beta and gamma from Delta - a^2 sin^2, so that nothing is lost near the static limit.
        gamma = root_delta / math.sqrt(delta - (spin * sine) ** 2)
        beta = -spin * sine / root_delta
    else:
        beta = -spin * sine * root_delta / (r * r + spin * spin)
        gamma = 1.0 / math.sqrt((1.0 - beta) * (1.0 + beta))
    n_r, n_theta, n_phi = np.asarray(directions, dtype=np.float64).T
    k0 = gamma * (1.0 + beta * n_phi)
    k3 = gamma * (n_phi + beta)
    return Momenta(
        energy=(root_delta * k0 + spin * sine * k3) / root_sigma,
        l_over_sin=(spin * sine * root_delta * k0 + (r * r + spin * spin) * k3) / root_sigma,
        p_theta=root_sigma * n_theta,
        radial=n_r,
        carter_p=root_sigma * root_delta * k0,
        carter_k=sigma * (n_theta**2 + k3**2),
    )
