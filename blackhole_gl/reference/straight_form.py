"""Straight lines as a system that is marched, for what goes along them (float64, r_s = 1): the twin of `flat` meets surfaces in closed form."""

from __future__ import annotations

import numpy as np

from ..shapes import Bool, Float

Array = np.ndarray


class StraightSystem:
    """x' = v, v' = 0, with the state (x, v) in r_s and |v| = 1; rays end in a black ball of `capture_radius`."""

    def __init__(self, capture_radius: float):
        self.capture_radius = capture_radius

    def rhs(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return np.concatenate([state[3:], np.zeros_like(state[3:])])

    def scale(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return np.ones_like(state)

    def longest_step(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        """Half the way to the hole: what is not looked at from outside twice its reach is not passed by."""
        return 0.5 * np.sqrt((state[:3] ** 2).sum(axis=0)) + 0.5

    def rechart(self, before: Float[Array, " rows *points"], after: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return after

    def captured(self, state: Float[Array, "rows N"]) -> Bool[Array, " N"]:
        return (state[:3] ** 2).sum(axis=0) < self.capture_radius**2

    def place(self, state: Float[Array, " rows *points"]) -> tuple[Float[Array, "*points"], Float[Array, " 3 *points"]]:
        """(r_s/r (N,), unit vector (3, N))."""
        inverse_radius = 1.0 / np.sqrt((state[:3] ** 2).sum(axis=0))
        return inverse_radius, state[:3] * inverse_radius

    def momentum(self, state: Float[Array, "rows N"]) -> tuple[Float[Array, " N"], Float[Array, " N"]]:
        """(k_r, k_theta), each (N,), of the photon that arrives: E = 1, lengths in M."""
        n = self.place(state)[1]
        ring = np.hypot(n[0], n[1])
        along_theta = n[2] * (n[0] * state[3] + n[1] * state[4]) / ring - ring * state[5]
        return -(n * state[3:]).sum(axis=0), -2.0 * np.sqrt((state[:3] ** 2).sum(axis=0)) * along_theta

    def affine_rate(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        return np.ones_like(state[0])
