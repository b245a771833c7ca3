"""Null geodesics of Kerr by Carter's separated equations in Mino time (float64, M = 1): the twin of the ray model `kerr_schild`.

In Boyer-Lindquist coordinates, with dtau = dlambda/Sigma (Carter 1968, Mino 2003),

    (dr/dtau)^2  = P^2 - K Delta                     P = E (r^2 + a^2) - a L,  K = Q + (L - a E)^2
    (dmu/dtau)^2 = (1 - mu^2)(Q + a^2 E^2 mu^2) - L^2 mu^2       mu = cos theta
    dphi/dtau    = L/(1 - mu^2) + a (P/Delta - E)

Turning points are no trouble once the first two are differentiated. With w = 1/r: w'' = (1/2) dW/dw, W = w^4 (P^2 - K Delta).
The first term of phi' has a pole on the axis; sin(theta) e^{i phi} of that term alone obeys zeta'' = -(Q + L^2 + 2 a^2 E^2 mu^2) zeta,
which has none. The second is a quadrature, the twist.

As in the Kerr-Schild form, a ray traced backwards is a photon of Kerr with -a along the look direction. Other than there, the horizon
is out of reach: rays stop above it, where light that goes in cannot turn any more.
"""

from __future__ import annotations

import math

import numpy as np

from ..physics import relativity
from ..shapes import Bool, Float
from .events import LightRays
from .hits import Traced
from .marching import follow
from .observers import Momenta, Place
from .registry import View, twin

Array = np.ndarray

# Rows of the state.
N_X, N_Y, N_Z, W, W_DOT, NX_DOT, NY_DOT, NZ_DOT, TWIST, ENERGY, L, Q = range(12)


class MinoSystem:
    """Right-hand side for photons of Kerr with spin parameter `spin` (the reversed one, see above)."""

    def __init__(self, spin: float):
        self.spin = spin
        self.r_plus = 1.0 + math.sqrt((1.0 - spin) * (1.0 + spin))
        # Inside the innermost photon orbit there is no turning point for light that goes in.
        photon_orbit = 2.0 * float(relativity.photon_orbit_radius(abs(spin)))
        self.stop = self.r_plus + min(0.01 * self.r_plus, 0.5 * (photon_orbit - self.r_plus))
        self.capture_radius = 0.5 * self.stop  # in r_s, as all that is not of these equations' own

    def rhs(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        n_x, n_y, mu, w, _, _, _, _, _, energy, l_z, carter = state
        a = self.spin
        p = energy + (a * energy - l_z) * a * w * w  # P w^2
        p_slope = 2.0 * (a * energy - l_z) * a * w
        delta = (1.0 - self.r_plus * w) * (1.0 - (2.0 - self.r_plus) * w)  # Delta w^2
        delta_slope = 2.0 * (a * a * w - 1.0)
        k = carter + (l_z - a * energy) ** 2
        pull = carter + l_z * l_z + 2.0 * (a * energy * mu) ** 2
        change = np.zeros_like(state)
        change[N_X:W] = state[NX_DOT:TWIST]
        change[W] = state[W_DOT]
        change[W_DOT] = p * p_slope - k * w * (delta + 0.5 * w * delta_slope)
        change[NX_DOT], change[NY_DOT] = -pull * n_x, -pull * n_y
        change[NZ_DOT] = mu * ((a * energy) ** 2 * (1.0 - 2.0 * mu * mu) - carter - l_z * l_z)
        change[TWIST] = a * (p / delta - energy)
        return change

    def scale(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        size = np.ones_like(state)
        angular = 1.0 + np.sqrt(np.abs(state[Q] + state[L] ** 2))
        size[W] = 1.0 / angular
        size[W_DOT] = np.maximum(np.abs(state[W_DOT]), np.abs(state[ENERGY]))
        size[NX_DOT:TWIST] = angular
        return size

    def longest_step(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        # Below half a turn of the orbit's plane: a ray meets z = 0 at most once in a step.
        return 2.0 / (np.sqrt(np.abs(state[Q] + state[L] ** 2)) + abs(self.spin) * np.abs(state[ENERGY]) + 1e-3)

    def rechart(self, before: Float[Array, " rows *points"], after: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return after

    def captured(self, state: Float[Array, "rows N"]) -> Bool[Array, " N"]:
        """Mask (N,): going in, with no turning point left."""
        return (state[W] * self.stop > 1.0) & (state[W_DOT] > 0.0)

    def place(self, state: Float[Array, " rows *points"]) -> tuple[Float[Array, "*points"], Float[Array, " 3 *points"]]:
        """(r_s/r (N,), unit vector (3, N) of Boyer-Lindquist theta and phi)."""
        c, s = np.cos(state[TWIST]), np.sin(state[TWIST])
        return 2.0 * state[W], np.stack([c * state[N_X] - s * state[N_Y], s * state[N_X] + c * state[N_Y], state[N_Z]])

    def momentum(self, state: Float[Array, "rows N"]) -> tuple[Float[Array, " N"], Float[Array, " N"]]:
        """(k_r, k_theta), each (N,), of the photon that arrives; in units of |E|, M = 1.

        r' = -w'/w^2 = Delta p_r and theta' = n'.e_theta = p_theta of the ray traced backwards, whose photon arrives with the opposite momentum.
        """
        n_x, n_y, n_z, w = state[:4]
        delta = (1.0 - self.r_plus * w) * (1.0 - (2.0 - self.r_plus) * w)  # Delta w^2
        ring = np.hypot(n_x, n_y)
        theta_dot = n_z * (n_x * state[NX_DOT] + n_y * state[NY_DOT]) / ring - ring * state[NZ_DOT]
        return state[W_DOT] / (delta * np.abs(state[ENERGY])), -theta_dot / np.abs(state[ENERGY])

    def affine_rate(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        """E Sigma, of lengths in M."""
        return 0.5 * np.abs(state[ENERGY]) * (1.0 / state[W] ** 2 + (self.spin * state[N_Z]) ** 2)

    def start(self, place: Place, photons: Momenta) -> Float[Array, "rows N"]:
        """State (12, N) of photons at a finite place."""
        inward = -photons.radial_rate / (place.r * place.r)
        return self._state(place, 1.0 / place.r, inward, photons.p_theta, photons.l_over_sin, photons.energy)

    def start_at_infinity(self, place: Place, screen: Float[Array, "N 2"]) -> Float[Array, "rows N"]:
        """State (12, N) of parallel rays that enter at (alpha, beta) = `screen` (N, 2), in M."""
        one = np.ones(len(screen))
        return self._state(place, 0.0, one, -screen[:, 1], screen[:, 0], one)

    def _state(self, place: Place, w: float, inward: Array, p_theta: Array, l_over_sin: Array, energy: Array) -> Array:
        e_r, e_theta, e_phi = place.frame()
        state = np.zeros((12, energy.size))
        state[N_X:W], state[W], state[W_DOT] = e_r[:, None], w, inward
        state[NX_DOT:TWIST] = np.outer(e_theta, p_theta) + np.outer(e_phi, l_over_sin)
        state[ENERGY], state[L] = energy, place.sin_theta * l_over_sin
        state[Q] = p_theta**2 + place.cos_theta**2 * (l_over_sin**2 - (self.spin * energy) ** 2)
        return state


def mino_light(view: View) -> LightRays:
    """The rays of `view` at the camera."""
    system, place = MinoSystem(-view.spin), view.place_in_m
    if view.at_infinity:
        state = system.start_at_infinity(place, view.rays)
    else:
        state = system.start(place, view.momenta(system.spin))
    return LightRays(system, state, state[ENERGY].copy(), -state[L])


@twin("kerr_schild", metric="kerr", light=mino_light)
def mino_form(view: View) -> Traced:
    """Light of Kerr by this form."""
    return follow(view, *mino_light(view))
