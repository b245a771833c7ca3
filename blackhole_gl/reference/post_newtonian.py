"""Twins of the ray models `post_newtonian` and `post_newtonian_drag`, wrong as published (float64, r_s = 1, M = 1/2).

    x'' = -G (M/r^3) x (1 + 3 h^2/r^2) - G (6 M/r^3) v cross J,    h = |x cross v| at the camera,  |v| = 1 there,  J = (0, 0, a M)

with a = a*/2. The orbit is not planar with J, so the unknowns are n = x/r, w = 1/r, l = x cross v, v_n = n.v, and the parameter
d sigma = dt/r^2: as in the Kerr-Schild form, infinity is w = 0.

    n' = l cross n,  w' = -v_n,  l' = k n cross (z cross v),  v_n' = w l^2 - G M (1 + 3 h^2 w^2) + k w n.(z cross v),  k = 6 G M a M
"""

from __future__ import annotations

import numpy as np

from ..shapes import Bool, Float
from .flat import l_z_of_straight_rays
from .hits import Traced
from .marching import follow
from .observers import Place
from .registry import View, twin

Array = np.ndarray

# Rows of the state.
N_X, N_Y, N_Z, W, L_X, L_Y, L_Z, V_N, H2 = range(9)


class PostNewtonianSystem:
    """gravity_strength: G; capture_radius in r_s; spin: a* of the drag, 0 without."""

    def __init__(self, gravity_strength: float, capture_radius: float, spin: float = 0.0):
        self.mass = 0.5 * gravity_strength
        self.capture_radius = capture_radius
        self.drag = 6.0 * gravity_strength * 0.5 * (0.5 * spin) * 0.5

    def rhs(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        n, w, momentum, v_n = state[N_X:W], state[W], state[L_X:V_N], state[V_N]
        across = np.cross(momentum, n, axis=0)
        v = v_n * n + w * across
        turned = np.stack([-v[1], v[0], np.zeros_like(w)])
        change = np.zeros_like(state)
        change[N_X:W] = across
        change[W] = -v_n
        change[L_X:V_N] = self.drag * np.cross(n, turned, axis=0)
        force = self.drag * w * (n * turned).sum(axis=0) - self.mass * (1.0 + 3.0 * state[H2] * w * w)
        change[V_N] = w * (across * across).sum(axis=0) + force
        return change

    def scale(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        size = np.ones_like(state)
        angular = 1.0 + self._l(state)
        size[W], size[L_X:V_N] = 1.0 / angular, angular
        size[V_N] = np.maximum(1.0, np.abs(state[V_N]))
        return size

    def longest_step(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        # Short against half a turn, and against the way on which a pull alone would bring a ray back through infinity.
        return 1.0 / (self._l(state) + abs(self.drag) + self.mass)

    def rechart(self, before: Float[Array, " rows *points"], after: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return after

    def captured(self, state: Float[Array, "rows N"]) -> Bool[Array, " N"]:
        return state[W] * self.capture_radius > 1.0

    def place(self, state: Float[Array, " rows *points"]) -> tuple[Float[Array, "*points"], Float[Array, " 3 *points"]]:
        """(r_s/r (N,), unit vector (3, N))."""
        return state[W], state[N_X:W]

    def momentum(self, state: Float[Array, "rows N"]) -> tuple[Float[Array, " N"], Float[Array, " N"]]:
        """NaN: what moves here changes its speed as a slow mass does, and is light in no metric."""
        none = np.full(state.shape[1], np.nan)
        return none, none

    def start(self, place: Place, directions: Float[Array, "N 3"]) -> Float[Array, "rows N"]:
        """State (9, N) for local directions (N, 3) in a flat frame at `place` (r in r_s): the observer's own frame is skipped."""
        frame = np.stack(place.frame())
        return self._state(frame[0], 1.0 / place.r, np.cross(place.r * frame[0], directions @ frame).T, directions[:, 0])

    def start_at_infinity(self, place: Place, screen: Float[Array, "N 2"]) -> Float[Array, "rows N"]:
        """State (9, N) of parallel rays at (alpha, beta) = `screen` (N, 2), in r_s."""
        e_r, e_theta, e_phi = place.frame()
        offset = np.outer(screen[:, 0], e_phi) - np.outer(screen[:, 1], e_theta)
        return self._state(e_r, 0.0, np.cross(e_r, offset).T, -np.ones(len(screen)))

    @staticmethod
    def _state(n: Array, w: float, momentum: Array, v_n: Array) -> Array:
        state = np.empty((9, v_n.size))
        state[N_X:W], state[W], state[L_X:V_N], state[V_N] = n[:, None], w, momentum, v_n
        state[H2] = (momentum * momentum).sum(axis=0)
        return state

    @staticmethod
    def _l(state: Array) -> Array:
        return np.sqrt((state[L_X:V_N] ** 2).sum(axis=0))


_STRENGTHS = {"gravity_strength": "hole.gravity_strength", "horizon_size": "hole.horizon_size"}


@twin("post_newtonian_drag", metric=None, parameters=_STRENGTHS)
@twin("post_newtonian", metric=None, spins=False, parameters=_STRENGTHS)
def post_newtonian(view: View, gravity_strength: float = 1.0, horizon_size: float = 1.0) -> Traced:
    """gravity_strength: G; horizon_size: radius of capture in horizon radii. The drag is that of the spin: none without."""
    system = PostNewtonianSystem(gravity_strength, horizon_size * view.horizon, view.spin)
    state = system.start_at_infinity(view.place, view.screen) if view.at_infinity else system.start(view.place, view.resting_rays)
    return follow(view, system, state, np.ones(len(view.rays)), l_z_of_straight_rays(view))
