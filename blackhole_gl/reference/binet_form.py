"""Schwarzschild's light as a plane that turns and Binet's equation in it (float64, r_s = 1): twins of `schwarzschild` and `kerr_like`.

The model is x'' = -(3/2) G h^2 x/r^5 with h = |x cross v|. It is planar, so with d sigma = d t/r^2 (t: the model's
own parameter, normalised to E = 1) the plane turns uniformly and what is left is Binet's equation,

    n' = h e,   e' = -h n,   w'' = -h^2 w + (3/2) G h^2 w^2,   w = 1/r,

regular for radial rays (h = 0) and through infinity (w = 0). At G = 1 these are the null geodesics of Schwarzschild. Any other G multiplies
the force law: for parallel rays from infinity that is a hole of another size, from nearer by the picture of no space-time, as the observer's
frame stays that of G = 1.

The observer is the static one of Schwarzschild at every G: v = n_r e_r + n_t e_t/sqrt(1 - 1/R) for E = 1.

`kerr_like` turns position and velocity together about the spin axis at the Lense-Thirring rate,

    dx/dt = v - omega z cross x,   dv/dt = F(x, v) - omega z cross v,   omega = k a*/(2 r^3)

(minus, because t runs backwards along a backward ray). F commutes with rotations, so the orbit is that of Schwarzschild
seen turned by tau, tau' = -omega r^2 = -(k a*/2) w, and L_z is unchanged. The shadow stays a circle.
"""

from __future__ import annotations

import math

import numpy as np

from ..shapes import Bool, Float
from .events import LightRays
from .hits import Traced
from .marching import follow
from .observers import Place
from .registry import View, twin

Array = np.ndarray

# Rows of the state.
N_X, N_Y, N_Z, W, W_DOT, E_X, E_Y, E_Z, H, TAU = range(10)


class BinetSystem:
    """gravity_strength: G; capture_radius in r_s; twist: k a*, 0 for plain Schwarzschild."""

    def __init__(self, gravity_strength: float, capture_radius: float, twist: float = 0.0):
        self.bending = 1.5 * gravity_strength
        self.capture_radius = capture_radius
        self.twist = twist

    def rhs(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        w, h = state[W], state[H]
        change = np.empty_like(state)
        change[N_X:W] = h * state[E_X:H]
        change[W] = state[W_DOT]
        change[W_DOT] = h * h * w * (self.bending * w - 1.0)
        change[E_X:H] = -h * state[N_X:W]
        change[H] = 0.0
        change[TAU] = -0.5 * self.twist * w
        return change

    def scale(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        size = np.ones_like(state)
        angular = 1.0 + state[H]
        size[W] = 1.0 / angular
        size[W_DOT] = np.maximum(1.0, np.abs(state[W_DOT]))
        return size

    def longest_step(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        return 2.0 / (state[H] + 1e-3)

    def rechart(self, before: Float[Array, " rows *points"], after: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        return after

    def captured(self, state: Float[Array, "rows N"]) -> Bool[Array, " N"]:
        return state[W] * self.capture_radius > 1.0

    def place(self, state: Float[Array, " rows *points"]) -> tuple[Float[Array, "*points"], Float[Array, " 3 *points"]]:
        """(r_s/r (N,), unit vector (3, N)): n turned by tau."""
        c, s = np.cos(state[TAU]), np.sin(state[TAU])
        return state[W], np.stack([c * state[N_X] - s * state[N_Y], s * state[N_X] + c * state[N_Y], state[N_Z]])

    def momentum(self, state: Float[Array, "rows N"]) -> tuple[Float[Array, " N"], Float[Array, " N"]]:
        """(k_r, k_theta), each (N,), of the photon that arrives; E = 1, M = 1. NaN at G != 1, where the orbits are no light of Schwarzschild.

        Schwarzschild's own, r^2 dr/dt = -w' and r^2 dtheta/dt = h e.e_theta of the ray traced backwards; tau turns them about the axis and
        changes neither.
        """
        if self.bending != 1.5:
            none = np.full(state.shape[1], np.nan)
            return none, none
        ring = np.hypot(state[N_X], state[N_Y])
        along_theta = state[N_Z] * (state[N_X] * state[E_X] + state[N_Y] * state[E_Y]) / ring - ring * state[E_Z]
        return state[W_DOT] / (1.0 - state[W]), -2.0 * state[H] * along_theta

    def affine_rate(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        """r^2, of the parameter t."""
        return 1.0 / state[W] ** 2

    def start(self, place: Place, directions: Float[Array, "N 3"]) -> Float[Array, "rows N"]:
        """State (10, N) for local directions (N, 3) of the static observer at `place` (r in r_s)."""
        e_r, e_theta, e_phi = place.frame()
        tangent = np.outer(e_theta, directions[:, 1]) + np.outer(e_phi, directions[:, 2])
        size = np.hypot(directions[:, 1], directions[:, 2])
        lapse = math.sqrt((place.r - 1.0) / place.r)
        return self._state(e_r, 1.0 / place.r, -directions[:, 0], tangent, size, place.r * size / lapse)

    def start_at_infinity(self, place: Place, screen: Float[Array, "N 2"]) -> Float[Array, "rows N"]:
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


_STRENGTHS = {"gravity_strength": "hole.gravity_strength", "horizon_size": "hole.horizon_size"}


def binet_light(view: View, gravity_strength: float = 1.0, horizon_size: float = 1.0) -> LightRays:
    """The rays of `view` at the camera, as `binet_form` has them."""
    return _light(view, BinetSystem(gravity_strength, horizon_size * view.horizon))


def twisted_binet_light(view: View, gravity_strength: float = 1.0, horizon_size: float = 1.0, drag: float = 1.0, twist: bool = True) -> LightRays:
    """The same of `twisted_binet_form`."""
    return _light(view, BinetSystem(gravity_strength, horizon_size * view.horizon, drag * view.spin if twist else 0.0))


@twin("schwarzschild", "schwarzschild_table", metric="schwarzschild", spins=False, parameters=_STRENGTHS, light=binet_light)
def binet_form(view: View, gravity_strength: float = 1.0, horizon_size: float = 1.0) -> Traced:
    """gravity_strength: G, 1 is physics; horizon_size: radius of capture in horizon radii."""
    return follow(view, *binet_light(view, gravity_strength, horizon_size))


_TWISTED = {**_STRENGTHS, "drag": "rays.kerr_like.drag", "twist": "rays.kerr_like.twist"}


@twin("kerr_like", metric="schwarzschild", parameters=_TWISTED, light=twisted_binet_light)
def twisted_binet_form(view: View, gravity_strength: float = 1.0, horizon_size: float = 1.0, drag: float = 1.0, twist: bool = True) -> Traced:
    """As `binet_form`, turned about the axis; drag: k; twist: whether it is turned at all."""
    return follow(view, *twisted_binet_light(view, gravity_strength, horizon_size, drag, twist))


def _light(view: View, system: BinetSystem) -> LightRays:
    place = view.place
    if view.at_infinity:
        state = system.start_at_infinity(place, view.screen)
        l_z = -view.resting_rays[:, 0] * place.sin_theta
    else:
        state = system.start(place, view.resting_rays)
        l_z = -2.0 * place.r * place.sin_theta * view.resting_rays[:, 2] / math.sqrt((place.r - 1.0) / place.r)
    return LightRays(system, state, np.ones(len(view.rays)), l_z)
