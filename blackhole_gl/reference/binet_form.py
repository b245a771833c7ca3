"""Schwarzschild's light as a plane that turns and Binet's equation in it (float64, r_s = 1): twins of `schwarzschild` and `kerr_like`.

The model is x'' = -(3/2) G h^2 x/r^5 with h = |x cross v|. It is planar, so with d sigma = d t/r^2 (t: the model's
own parameter, normalised to E = 1) the plane turns uniformly and what is left is Binet's equation,

    n' = h e,   e' = -h n,   w'' = -h^2 w + (3/2) G h^2 w^2,   w = 1/r,

regular for radial rays (h = 0) and through infinity (w = 0). At G = 1 these are the null geodesics of Schwarzschild.

The observer is the static one of Schwarzschild at every G: v = n_r e_r + n_t e_t/sqrt(1 - 1/R) for E = 1.

`kerr_like` turns position and velocity together about the spin axis at the Lense-Thirring rate,

    dx/dt = v - omega z cross x,   dv/dt = F(x, v) - omega z cross v,   omega = k a*/(2 r^3)

(minus, because t runs backwards along a backward ray). F commutes with rotations, so the orbit is that of Schwarzschild
seen turned by tau, tau' = -omega r^2 = -(k a*/2) w, and L_z is unchanged. The shadow stays a circle.
"""

from __future__ import annotations

import math

import numpy as np

from .observers import Place

Array = np.ndarray

# Rows of the state; the first four are those of the Kerr-Schild form.
N_X, N_Y, N_Z, W, W_DOT, E_X, E_Y, E_Z, H, TAU = range(10)


class BinetSystem:
    """gravity_strength: G; horizon_size: radius of capture in r_s; twist: k a*, 0 for plain Schwarzschild."""

    def __init__(self, gravity_strength: float, horizon_size: float, twist: float = 0.0):
        self.bending = 1.5 * gravity_strength
        self.horizon_size = horizon_size
        self.twist = twist

    def rhs(self, state: Array) -> Array:
        w, h = state[W], state[H]
        change = np.empty_like(state)
        change[N_X:W] = h * state[E_X:H]
        change[W] = state[W_DOT]
        change[W_DOT] = h * h * w * (self.bending * w - 1.0)
        change[E_X:H] = -h * state[N_X:W]
        change[H] = 0.0
        change[TAU] = -0.5 * self.twist * w
        return change

    def scale(self, state: Array) -> Array:
        size = np.ones_like(state)
        angular = 1.0 + state[H]
        size[W] = 1.0 / angular
        size[W_DOT] = np.maximum(1.0, np.abs(state[W_DOT]))
        return size

    def longest_step(self, state: Array) -> Array:
        return 2.0 / (state[H] + 1e-3)

    def rechart(self, before: Array, after: Array) -> Array:
        return after

    def captured(self, state: Array) -> Array:
        return state[W] * self.horizon_size > 1.0

    def radius(self, state: Array) -> Array:
        """r in r_s, (N,)."""
        return 1.0 / state[W]

    def azimuth(self, state: Array) -> Array:
        return np.arctan2(state[N_Y], state[N_X]) + state[TAU]

    def direction(self, state: Array) -> Array:
        """World direction at infinity (N, 3)."""
        x, y, z = state[N_X:W]
        c, s = np.cos(state[TAU]), np.sin(state[TAU])
        n = np.stack([c * x - s * y, s * x + c * y, z], axis=1)
        return n / np.linalg.norm(n, axis=1, keepdims=True)

    def start(self, place: Place, directions: Array) -> Array:
        """State (10, N) for local directions (N, 3) of the static observer at `place` (r in r_s)."""
        e_r, e_theta, e_phi = place.frame()
        tangent = np.outer(e_theta, directions[:, 1]) + np.outer(e_phi, directions[:, 2])
        size = np.hypot(directions[:, 1], directions[:, 2])
        lapse = math.sqrt((place.r - 1.0) / place.r)
        return self._state(e_r, 1.0 / place.r, -directions[:, 0], tangent, size, place.r * size / lapse)

    def start_at_infinity(self, place: Place, screen: Array) -> Array:
        """State (10, N) of parallel rays at (alpha, beta) = `screen` (N, 2), in r_s."""
        e_r, e_theta, e_phi = place.frame()
        # The ray passes the hole on the side where it starts: n turns towards (alpha, beta).
        tangent = np.outer(e_phi, screen[:, 0]) - np.outer(e_theta, screen[:, 1])
        size = np.hypot(screen[:, 0], screen[:, 1])
        return self._state(e_r, 0.0, np.ones(len(screen)), tangent, size, size)

    @staticmethod
    def _state(n: Array, w: float, w_dot: Array, tangent: Array, tangent_size: Array, h: Array) -> Array:
        state = np.zeros((10, h.size))
        state[N_X:W] = n[:, None]
        state[W], state[W_DOT], state[H] = w, w_dot, h
        state[E_X:H] = tangent / np.where(tangent_size > 0.0, tangent_size, 1.0)
        return state
