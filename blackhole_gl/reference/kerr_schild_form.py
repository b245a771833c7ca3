"""Null geodesics of Kerr by Hamilton's equations in Cartesian Kerr-Schild coordinates (float64, M = 1): the twin of the ray model `kerr`.

With ingoing coordinates the inverse metric is flat space minus f l l, so that

    H = 1/2 (-E^2 + |p|^2 - f kappa^2) = 0,   kappa = E + l.p
    f = 2 r^3/(r^4 + a^2 z^2),   l = ((r x + a y)/(r^2+a^2), (r y - a x)/(r^2+a^2), z/r)

(Kerr & Schild 1965). They are regular on the axis, in the equatorial plane and on the future horizon. Near the horizon they
serve inward light only: outward light has |p| ~ 1/Delta there and loses its digits. A ray therefore carries the sign of its
chart, +1 ingoing, -1 outgoing (its time reversal: p -> -p, a -> -a, parameter reversed), and changes over where it turns.

A ray traced backwards is a photon of the time-reversed space-time, which is Kerr with -a: the photon starts along the
look direction n and falls through the future horizon when the picture shows the hole. Its L_z is minus the physical one.

To reach infinity exactly, the state is not (x, p) but, with R = |x| and the parameter d sigma = d lambda/R^2,

    n = x/R,   w = 1/R,   L = x cross p,   p_n = n.p         (p = p_n n + w L cross n)

In these f = w F, and F and l depend on n and a w alone: every factor R cancels and the equations are analytic through w = 0.
L' needs only the explicit dependence on the axis: what is left rotates jointly with x and p.

Three things that cost digits until they were known:

- Ingoing coordinates alone leave 1e-5 rad of error for a camera at 1.0001 r_+. The change of chart is a rotation about the axis by
  zeta(r) = 2 int_r^inf a/Delta dr - 2 atan(a/r) and a kick of p along grad r.
- Whether a ray goes in or out is to be read from Boyer-Lindquist's r: R grows as well when light slides from the pole to the equator.
- n.n = 1 and n.L = 0 must be neutral: with 1 - n_z^2 where n_x^2 + n_y^2 belongs, an error of |n| grows as e^(kappa sigma), kappa ~ 1/sqrt(Delta).

The photon's time T' = (E + f kappa) R^2 has no bound far out; U = T + R (ingoing, T - R outgoing) has: with E + p_n = w^2 e and kappa = w^2 (e + d),

    U' = (E - w')/w^2 + F kappa/w = e + (1 - c (rho + a^2 w^2 s sigma)) F w (e + d)

for light that comes in, regular at w = 0. Boyer-Lindquist's time is t = U -+ (R + int 2r/Delta dr).

Boyer-Lindquist's azimuth is phi = arg(x + i y) - atan(a/r) + int_r^inf a/Delta dr, the integral being
log1p((r_+ - r_-)/(r - r_+)) a/(r_+ - r_-).
"""

from __future__ import annotations

import math

import numpy as np

from ..shapes import Bool, Float
from .events import LightRays
from .hits import Traced
from .marching import follow
from .observers import Momenta, Place
from .registry import View, twin

Array = np.ndarray

_FAR = 1e-3  # w below which the time of light that comes in is formed as it is regular there

# Rows of the state.
N_X, N_Y, N_Z, W, L_X, L_Y, L_Z, P_N, ENERGY, CHART, TIME = range(11)


class KerrSchildSystem:
    """Right-hand side for photons of Kerr with spin parameter `spin` (the reversed one, see above)."""

    def __init__(self, spin: float):
        self.spin = spin
        self.r_plus = 1.0 + math.sqrt((1.0 - spin) * (1.0 + spin))
        self.capture_radius = 0.5 * self.r_plus  # in r_s, as all that is not of these equations' own

    def rhs(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        nx, ny, s, w, lx, ly, lz, pn, energy, chart, _ = state
        a = chart * self.spin
        lx, ly, lz, pn = chart * lx, chart * ly, chart * lz, chart * pn
        ah = a * w
        a2, s2 = ah * ah, s * s
        root = np.sqrt((1.0 - a2) ** 2 + 4.0 * a2 * s2)
        rho2 = 0.5 * (1.0 - a2 + root)  # rho = w r
        rho = np.sqrt(rho2)
        inv_d = 1.0 / (rho2 * root)  # 1/(rho^4 + a2 s2)
        c = 1.0 / (rho2 + a2)
        big_f = 2.0 * rho / root
        sr = s / rho

        lnx, lny, lnz = ly * s - lz * ny, lz * nx - lx * s, lx * ny - ly * nx  # L cross n
        pz = pn * s + w * lnz
        wlz = w * lz
        kappa = energy + c * (rho * pn - ah * wlz + a2 * sr * pz)
        fk = big_f * kappa

        # l = c (rho n + ah n cross z + a2 sr z); its parts along and across n
        c_twist, c_axis = fk * c * ah, fk * c * a2 * sr
        nx_dot = lnx - c_twist * ny + c_axis * s * nx
        ny_dot = lny + c_twist * nx + c_axis * s * ny
        nz_dot = lnz - c_axis * (nx * nx + ny * ny)  # not 1 - s2: errors of |n| = 1 would grow
        w_dot = w * fk * c * (rho + a2 * s * sr) - pn

        # L' = q z cross n + fk c ah (z cross L) - fk c a ah sr (z cross p)
        sigma = s * rho * inv_d  # d rho/ds = a2 sigma
        slope_f = s * rho * rho2 * inv_d * inv_d * (2.0 * (3.0 * a2 * s2 - rho2 * rho2) * inv_d - 4.0)
        slope_l = (c * c * sigma * ((a2 - rho2) * pn + 2.0 * rho * ah * wlz)
                   + pz * (c / rho - s * a2 * sigma * (c / rho2 + 2.0 * c * c)))
        q = -a * ah * (0.5 * kappa * kappa * slope_f + fk * (slope_l + c * sr * pn))
        q_p = fk * c * a * ah * sr * w
        lx_dot = -q * ny - c_twist * ly + q_p * lny
        ly_dot = q * nx + c_twist * lx - q_p * lnx

        # p_n' = w (L cross n).n' - kappa^2/2 d(w F)/dw - w fk a d(l.p)/d(ah)
        rho_a = ah * (s2 - rho2) * rho * inv_d
        f_a = big_f * (3.0 * rho_a / rho - (4.0 * rho * rho2 * rho_a + 2.0 * ah * s2) * inv_d)
        c_a = -2.0 * c * c * (rho * rho_a + ah)
        lp_a = ((c_a * rho + c * rho_a) * pn - (c_a * ah + c) * wlz
                + (c_a * a2 + 2.0 * c * ah - c * a2 * rho_a / rho) * sr * pz)
        pn_dot = (w * (lnx * nx_dot + lny * ny_dot + lnz * nz_dot)
                  - 0.5 * kappa * kappa * (big_f + ah * f_a) - w * fk * a * lp_a)
        along = c * (rho + a2 * s * sr)  # w' = w F kappa along - p_n
        with np.errstate(all="ignore"):  # w is 0 where a ray from infinity starts, and then only `far` counts
            near = (energy + pn - w * fk * along) / (w * w) + fk / w
            come_in = (fk * np.where(w > 0.0, kappa / w, 0.0) - lx * lx - ly * ly - lz * lz) / (pn - energy)  # (E + p_n)/w^2
            flat = 2.0 * a * a * (1.0 - s2) / ((1.0 + a2 + root) * (1.0 + rho))  # (1 - rho)/w^2
            beside = c * (pn * (rho * flat - a * a) - a * lz + a * a * sr * pz)
            far = come_in + (1.0 - along) * big_f * w * (come_in + beside)
        time_dot = np.where((w < _FAR) & (pn < 0.0), far, near)
        zero = np.zeros_like(w)
        return np.stack([chart * nx_dot, chart * ny_dot, chart * nz_dot, chart * w_dot, lx_dot, ly_dot, zero, pn_dot, zero, zero, time_dot])

    def rechart(self, before: Float[Array, " rows *points"], after: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        """`after` with the rays that turned round in their last step, from `before`, moved to the chart that suits their way."""
        with np.errstate(all="ignore"):  # r is infinite where a ray from infinity starts, and meaningless beyond w = 0
            turned = (self.radius(after) - self.radius(before)) * after[CHART] > 0.0
        turned &= (after[W] > 0.0) & ~self.captured(after)
        if not turned.any():
            return after
        result = after.copy()
        result[:, turned] = self._other_chart(after[:, turned])
        return result

    def _other_chart(self, state: Array) -> Array:
        """The same rays in the other chart.

        It has x turned about z by zeta(r) = 2 lag - 2 atan2(a, r), and T shifted by -+ the integral of 4r/Delta, so that p changes
        by the same turn and by grad r (zeta' L_z + 4 r E/Delta).
        """
        chart, w, l_z = state[CHART], state[W], state[L_Z]
        a, r = chart * self.spin, self.radius(state)
        delta = (r - self.r_plus) * (r - 2.0 + self.r_plus)
        kick = (4.0 * chart * r * state[ENERGY] - 2.0 * a * l_z) / delta + 2.0 * a * l_z / (r * r + a * a)
        z = state[N_Z] / w
        inv_d = 1.0 / (r**4 + (a * z) ** 2)
        result = state.copy()
        result[P_N] -= kick * r * inv_d * (r * r / w + a * a * z * state[N_Z])
        tilt = kick * a * a * r * z * inv_d / w
        result[L_X] -= tilt * state[N_Y]
        result[L_Y] += tilt * state[N_X]
        result[TIME] -= 2.0 * chart * (1.0 / w + self.time_lead(r))
        zeta = 2.0 * chart * self.azimuth_lag(r) - 2.0 * np.arctan2(a, r)
        c, s = np.cos(zeta), np.sin(zeta)
        for x, y in ((N_X, N_Y), (L_X, L_Y)):
            result[x], result[y] = c * result[x] - s * result[y], s * result[x] + c * result[y]
        result[CHART] = -chart
        return result

    def scale(self, state: Float[Array, " rows *points"]) -> Float[Array, " rows *points"]:
        size = np.ones_like(state)
        angular = 1.0 + self._angular_momentum(state)
        size[W] = 1.0 / angular  # the angle swept until w has changed by dw is L dw
        size[L_X:P_N] = angular
        size[P_N] = np.maximum(np.abs(state[P_N]), np.abs(state[ENERGY]))
        size[TIME] = 1e3  # it drives nothing
        return size

    def longest_step(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        # Below half a turn of the orbit's plane: a ray meets z = 0 at most once in a step.
        return 2.0 / (self._angular_momentum(state) + abs(self.spin) * np.abs(state[ENERGY]) + 1e-3)

    def captured(self, state: Float[Array, "rows N"]) -> Bool[Array, " N"]:
        """Mask (N,): behind the future horizon, whence nothing comes back."""
        return (state[W] * self.r_plus > self._rho(state)) & (state[CHART] > 0.0)

    def radius(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        """Boyer-Lindquist r in M, (N,)."""
        return self._rho(state) / state[W]

    def place(self, state: Float[Array, " rows *points"]) -> tuple[Float[Array, "*points"], Float[Array, " 3 *points"]]:
        """(r_s/r (N,), unit vector (3, N) of Boyer-Lindquist theta and phi).

        (n_x + i n_y) = (rho + i a w) sin(theta) e^{i phi~} and n_z = rho cos(theta) with rho = w r; phi - phi~ is the lag, in closed form.
        """
        w, chart, rho = state[W], state[CHART], self._rho(state)
        size = np.sqrt(rho * rho + (self.spin * w) ** 2)
        turn = chart * (self.azimuth_lag(rho / w) - np.arctan(self.spin * w / rho))
        c, s = np.cos(turn) / size, np.sin(turn) / size
        return 2.0 * w / rho, np.stack([c * state[N_X] - s * state[N_Y], s * state[N_X] + c * state[N_Y], state[N_Z] / rho])

    def momentum(self, state: Float[Array, "rows N"]) -> tuple[Float[Array, " N"], Float[Array, " N"]]:
        """(k_r, k_theta), each (N,), in Boyer-Lindquist coordinates, of the photon that arrives; in units of |E|, M = 1.

        Components of p = p_n n + w L cross n along dx/dr and dx/dtheta, n.dx/dtheta = a^2 w sin(theta) cos(theta). The azimuths and times of the
        two coordinate systems differ by functions of r: Boyer-Lindquist's p_r is that less +-(2 r E - a L_z)/Delta, + on ingoing coordinates.
        The photon that arrives has momentum -p.
        """
        n, w, chart, energy = state[N_X:W], state[W], state[CHART], state[ENERGY]
        rho, aw = self._rho(state), chart * self.spin * w
        size2 = rho * rho + aw * aw
        cos = n[2] / rho
        ring = np.hypot(n[0], n[1])
        outward = np.stack([(rho * n[0] + aw * n[1]) / size2, (rho * n[1] - aw * n[0]) / size2, cos])
        cotangent = cos * np.sqrt(size2) / ring
        downward = np.stack([n[0] * cotangent, n[1] * cotangent, -rho * ring / np.sqrt(size2)])
        across = np.cross(state[L_X:P_N], n, axis=0)
        p_r = state[P_N] * (outward * n).sum(axis=0) + w * (outward * across).sum(axis=0)
        p_theta = state[P_N] * self.spin**2 * w * cos * ring / np.sqrt(size2) + (downward * across).sum(axis=0)
        r = rho / w
        delta = (r - self.r_plus) * (r - 2.0 + self.r_plus)
        p_r -= chart * (2.0 * r * energy - self.spin * state[L_Z]) / delta
        return -p_r / np.abs(energy), -p_theta / np.abs(energy)

    def affine_rate(self, state: Float[Array, " rows *points"]) -> Float[Array, "*points"]:
        """E R^2, of lengths in M."""
        return 0.5 * np.abs(state[ENERGY]) / state[W] ** 2

    def delay(self, state: Float[Array, "rows N"]) -> Float[Array, " N"]:
        """Time of light from there to the camera, (N,); see `events.TellsTime`."""
        return 0.5 * (state[TIME] - state[CHART] * (1.0 / state[W] + self.time_lead(self.radius(state))))

    def time_lead(self, r: Array | float) -> Array | float:
        """Integral of 2r/Delta, 2 ln r far out: the time of the ingoing coordinates less Boyer-Lindquist's, which inside the horizon has none."""
        outside = np.where(r > self.r_plus, r - self.r_plus, np.nan)
        gap = 2.0 * (self.r_plus - 1.0)
        return 2.0 * np.log(outside) - 2.0 * (2.0 - self.r_plus) / gap * np.log1p(gap / outside)

    def azimuth_lag(self, r: Array | float) -> Array | float:
        """Integral of a/Delta from r to infinity: phi_BL minus the azimuth that stays fixed along ingoing principal rays; 0 where there is no phi_BL."""
        gap = 2.0 * (self.r_plus - 1.0)
        outside = np.where(r > self.r_plus, r - self.r_plus, np.inf)
        return self.spin * np.log1p(gap / outside) / gap

    def start(self, place: Place, photons: Momenta) -> Float[Array, "rows N"]:
        """State (11, N) of photons at a finite place; inside the horizon its azimuth is that of the chart.

        There all of them go outwards, and those that have P <= 0 at the horizon never come to it: they are put into the chart in which they count as captured.
        """
        r, cos, sin = place.r, place.cos_theta, place.sin_theta
        inside = r <= self.r_plus
        leaves = photons.radial_rate > 0.0
        if inside:
            leaves &= 2.0 * self.r_plus * photons.energy > self.spin * sin * photons.l_over_sin
        chart = np.where(leaves, -1.0, 1.0)
        a = chart * self.spin
        sigma = r * r + (self.spin * cos) ** 2
        root = np.abs(photons.radial_rate)
        # p_r of the chart, -+(P - root)/Delta +- E, with the difference formed as K/(P + root).
        p_r = chart * (photons.carter_k / (photons.carter_p + root) - photons.energy)
        p_theta = photons.p_theta - a * photons.l_over_sin * cos / r
        along_u = (r / sigma) * (r * sin * p_r + cos * p_theta)
        along_z = (cos * (r * r + a * a) * p_r - r * sin * p_theta) / sigma
        along_e = (photons.l_over_sin + a * along_u) / r

        lag = chart * self.azimuth_lag(r)
        c, s = np.cos(lag), np.sin(lag)
        cp, sp = place.cos_phi * c + place.sin_phi * s, place.sin_phi * c - place.cos_phi * s
        x = np.stack([sin * (r * cp - a * sp), sin * (r * sp + a * cp), np.full_like(a, r * cos)])
        p = np.stack([along_u * cp - along_e * sp, along_u * sp + along_e * cp, along_z])
        distance = math.sqrt(r * r + (self.spin * sin) ** 2)
        momentum = np.cross(x.T, p.T).T
        momentum[2] = sin * photons.l_over_sin
        state = self._state(x / distance, 1.0 / distance, momentum, p, photons.energy, chart)
        lead = self.time_lead(r) if r > self.r_plus else 0.0  # inside there is no Boyer-Lindquist time: the camera's is that of the ingoing coordinates
        state[TIME] = chart * (distance + lead)
        return state

    def start_at_infinity(self, place: Place, screen: Float[Array, "N 2"]) -> Float[Array, "rows N"]:
        """State (11, N) of parallel rays that enter at (alpha, beta) = `screen` (N, 2), in M."""
        e_r, e_theta, e_phi = place.frame()
        alpha, beta = screen.T
        momentum = -np.outer(e_theta, alpha) - np.outer(e_phi, beta)
        momentum[2] = alpha * place.sin_theta
        n, one = np.repeat(e_r[:, None], len(screen), axis=1), np.ones(len(screen))
        state = self._state(n, 0.0, momentum, -n, one, one)
        state[TIME] = 2.0 * math.log(2.0)  # less r + 2 ln(r/2) of the camera
        return state

    @staticmethod
    def _state(n: Array, w: float, momentum: Array, p: Array, energy: Array, chart: Array) -> Array:
        state = np.zeros((11, energy.size))
        state[N_X:W], state[W], state[L_X:P_N] = n, w, momentum
        state[P_N] = np.einsum("ij,ij->j", n, p)
        state[ENERGY], state[CHART] = energy, chart
        return state

    @staticmethod
    def _angular_momentum(state: Array) -> Array:
        return np.sqrt(state[L_X] ** 2 + state[L_Y] ** 2 + state[L_Z] ** 2)

    def _rho(self, state: Array) -> Array:
        a2 = (self.spin * state[W]) ** 2
        q = 1.0 - a2
        return np.sqrt(0.5 * (q + np.sqrt(q * q + 4.0 * a2 * state[N_Z] ** 2)))


def kerr_schild_light(view: View) -> LightRays:
    """The rays of `view` at the camera."""
    system, place = KerrSchildSystem(-view.spin), view.place_in_m
    if view.at_infinity:
        state = system.start_at_infinity(place, view.rays)
    else:
        state = system.start(place, view.momenta(system.spin))
    return LightRays(system, state, state[ENERGY].copy(), -state[L_Z])


@twin("kerr", metric="kerr", light=kerr_schild_light)
@twin("schwarzschild_binet", metric="schwarzschild", spins=False, light=kerr_schild_light)
def kerr_schild_form(view: View) -> Traced:
    """Light of Kerr by this form. Binet's equation has it for a twin too: other coordinates and no orbital plane."""
    return follow(view, *kerr_schild_light(view))
