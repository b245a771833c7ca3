"""Closed forms of Schwarzschild and Kerr: orbits, observers, shadows (float64, vectorised over arrays).

Units: lengths in Schwarzschild radii (r_s = 2M = 1), angular velocities in c/r_s, impact parameters lambda = L_z/E and
screen coordinates in M, spin a* in [-1, 1]. Inside the functions M = 1. Angles in radians.

"prograde" means co-rotating with the hole; where a* < 0 that is clockwise seen from +z, and a* = 0 counts as positive.

Sources: Bardeen 1973 (*Black Holes*, Les Houches) [B73]; Bardeen, Press & Teukolsky 1972 (ApJ 178, 347) [BPT];
Carter 1968 (Phys. Rev. 174, 1559); Synge 1966 (MNRAS 131, 463); Teo 2003 (Gen. Relativ. Gravit. 35, 1909) [T03].
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..shapes import Float

Array = np.ndarray

CRITICAL_IMPACT = 1.5 * np.sqrt(3.0)
"""b_c of Schwarzschild in r_s."""


def relative_spin(spin: ArrayLike, orbit: str) -> Array:
    """Spin as the orbiting matter sees it: positive if co-rotating. ValueError for an unknown orbit."""
    if orbit not in ("prograde", "retrograde"):
        raise ValueError(f"orbit must be 'prograde' or 'retrograde', not {orbit!r}")
    magnitude = np.abs(np.asarray(spin, dtype=np.float64))
    return magnitude if orbit == "prograde" else -magnitude


def orbit_sense(spin: ArrayLike, orbit: str = "prograde") -> Array:
    """+1 where the matter goes counter-clockwise seen from +z, -1 where clockwise."""
    sense = np.where(np.asarray(spin) < 0.0, -1.0, 1.0)
    return sense if orbit == "prograde" else -sense


# --- radii ---------------------------------------------------------------------------------------------------------

def horizon_radius(spin: ArrayLike) -> Array:
    """Outer horizon r_+ in r_s [BPT]."""
    a = np.asarray(spin, dtype=np.float64)
    return 0.5 * (1.0 + np.sqrt((1.0 - a) * (1.0 + a)))


def inner_horizon_radius(spin: ArrayLike) -> Array:
    """Inner horizon r_- in r_s, as a^2/r_+ so that small spins keep their digits."""
    return 0.25 * np.square(spin) / horizon_radius(spin)


def ergosphere_radius(spin: ArrayLike, theta: ArrayLike) -> Array:
    """Static limit in r_s at polar angle theta [BPT]."""
    a = np.asarray(spin, dtype=np.float64) * np.cos(theta)
    return 0.5 * (1.0 + np.sqrt((1.0 - a) * (1.0 + a)))


def isco_radius(spin: ArrayLike, orbit: str = "prograde") -> Array:
    """Innermost stable circular equatorial orbit in r_s [BPT eq. 2.21].

    3 - Z1 is formed from s = (1+a)^(1/3) + (1-a)^(1/3), which satisfies (2-s)(s+1)^2 = 3 s a^2/(1+c+c^2): as printed, the
    formula loses half its digits at small spins.
    """
    a = relative_spin(spin, orbit)
    c, s = np.cbrt((1.0 - a) * (1.0 + a)), np.cbrt(1.0 + a) + np.cbrt(1.0 - a)
    z1 = 1.0 + c * s
    z2 = np.sqrt(3.0 * a * a + z1 * z1)
    return 0.5 * (3.0 + z2 - a / (s + 1.0) * np.sqrt(s * (4.0 + s * (2.0 + s)) / (1.0 + c + c * c) * (3.0 + z1 + 2.0 * z2)))


def photon_orbit_radius(spin: ArrayLike, orbit: str = "prograde") -> Array:
    """Circular equatorial photon orbit in r_s, 1 + cos(2/3 arccos(-+a)) [BPT eq. 2.18], from arcsin for small spins."""
    return 1.5 + 0.5 * _photon_orbit_offset(relative_spin(spin, orbit))


def _photon_orbit_offset(a: Array) -> Array:
    """r_ph - 3 (M = 1) of the orbit that sees spin a, without cancellation as a -> 0."""
    x = np.arcsin(a) * (2.0 / 3.0)
    return -2.0 * np.sin(0.5 * x) ** 2 - np.sqrt(3.0) * np.sin(x)


# --- circular equatorial emitters ------------------------------------------------------------------------------------

def orbital_frequency(r: ArrayLike, spin: ArrayLike, orbit: str = "prograde") -> Array:
    """Omega = d phi/d t in c/r_s of a circular equatorial geodesic at r (r_s) [BPT eq. 2.16]; negative is clockwise."""
    a = relative_spin(spin, orbit)
    return orbit_sense(spin, orbit) * 2.0 / ((2.0 * np.asarray(r, dtype=np.float64)) ** 1.5 + a)


def orbital_u_t(r: ArrayLike, spin: ArrayLike, orbit: str = "prograde") -> Array:
    """u^t of that emitter; NaN inside the photon orbit, where none exists.

    With x = sqrt(r), x^3 - 3x + 2a is formed as (x-1)^2 (x+2) - 2(1-a), which keeps its digits as a -> 1.
    """
    a = relative_spin(spin, orbit)
    x = np.sqrt(2.0 * np.asarray(r, dtype=np.float64))
    norm = (x - 1.0) ** 2 * (x + 2.0) - 2.0 * (1.0 - a)
    return (x**3 + a) / np.sqrt(np.where(norm > 0.0, x**3 * norm, np.nan))


def circular_orbit_g(r: ArrayLike, lam: ArrayLike, spin: ArrayLike, orbit: str = "prograde") -> Array:
    """E_infinity/E_emitter = 1/(u^t (1 - Omega lambda)) of light with L_z/E = `lam` (in M) leaving that emitter [B73]."""
    rate = 0.5 * orbital_frequency(r, spin, orbit)
    return 1.0 / (orbital_u_t(r, spin, orbit) * (1.0 - rate * np.asarray(lam, dtype=np.float64)))


def azimuthal_cosine(r: ArrayLike, lam: ArrayLike) -> Array:
    """Cosine between light with L_z/E = `lam` (in M) and +e_phi, in the static frame of Schwarzschild at equatorial r (r_s)."""
    r = np.asarray(r, dtype=np.float64)
    return 0.5 * np.asarray(lam, dtype=np.float64) * np.sqrt(1.0 - 1.0 / r) / r


def g_s0(r: ArrayLike, cosine: ArrayLike) -> Array:
    """An older viewer's (``s0``, docs/sources.md) frequency ratio delta sqrt(1 - 1/r), local speed sqrt(M/(r-2M)): exact in Schwarzschild.

    `cosine`: between the emitter's velocity and the light, in the static frame. NaN inside r = 3/2.
    """
    r = np.asarray(r, dtype=np.float64)
    speed2 = np.where(r > 1.5, 0.5 / np.where(r > 1.0, r - 1.0, 1.0), np.nan)
    return np.sqrt(1.0 - speed2) * np.sqrt(np.maximum(1.0 - 1.0 / r, 0.0)) / (1.0 - np.sqrt(speed2) * cosine)


def g_s1(r: ArrayLike, cosine: ArrayLike) -> Array:
    """BlackHoleGPU's (docs/sources.md) Doppler factor gamma (1 + beta.n), beta = sqrt((M/r)(1 - 3M/r)); no redshift. NaN inside r = 3/2."""
    r = np.asarray(r, dtype=np.float64)
    beta2 = np.where(r >= 1.5, (0.5 / r) * (1.0 - 1.5 / r), np.nan)
    return (1.0 + np.sqrt(beta2) * cosine) / np.sqrt(1.0 - beta2)


# --- observers -------------------------------------------------------------------------------------------------------

class Photon(NamedTuple):
    """Constants of a photon in units of its local energy (M = 1): E, L_z/sin(theta), K = Q + (L_z - aE)^2."""

    energy: Array
    l_over_sin: Array
    k: Array


def _metric(r: ArrayLike, theta: ArrayLike, a: ArrayLike):
    """(r, sin, Sigma, Delta, A) at M = 1 from r in r_s; Delta from its factors."""
    a = np.asarray(a, dtype=np.float64)
    root = np.sqrt((1.0 - a) * (1.0 + a))
    r = 2.0 * np.asarray(r, dtype=np.float64)
    sine, cosine = np.sin(theta), np.cos(theta)
    delta = (r - 1.0 - root) * (r - 1.0 + root)
    sigma = r * r + (a * cosine) ** 2
    return r, sine, sigma, delta, (r * r + a * a) * sigma + 2.0 * r * (a * sine) ** 2


def static_lapse(r: ArrayLike, theta: ArrayLike = np.pi / 2, spin: ArrayLike = 0.0) -> Array:
    """sqrt(-g_tt): energy at infinity over energy seen by a static observer; NaN in the ergosphere [BPT]."""
    _, sine, sigma, delta, _ = _metric(r, theta, spin)
    norm = (delta - (np.asarray(spin) * sine) ** 2) / sigma
    return np.sqrt(np.where(norm > 0.0, norm, np.nan))


def zamo_lapse(r: ArrayLike, theta: ArrayLike, spin: ArrayLike) -> Array:
    """Lapse sqrt(Sigma Delta/A) of the zero-angular-momentum observer [BPT eq. 3.2]."""
    _, _, sigma, delta, big_a = _metric(r, theta, spin)
    return np.sqrt(sigma * delta / big_a)


def frame_dragging(r: ArrayLike, theta: ArrayLike, spin: ArrayLike) -> Array:
    """omega = 2 M a r/A in c/r_s [BPT eq. 2.5]; a*/(2 r^3) far away."""
    r_m, _, _, _, big_a = _metric(r, theta, spin)
    return 4.0 * np.asarray(spin) * r_m / big_a


def photon_constants(n_theta: ArrayLike, n_phi: ArrayLike, r: ArrayLike, theta: ArrayLike, spin: ArrayLike,
                     observer: str = "static") -> Photon:
    """Constants of the physical photon p = -n that a static observer or ZAMO sees when looking along n.

    From the ZAMO's tetrad, boosted along phi for the static observer [BPT eq. 3.2]; regular on the axis.
    """
    a = np.asarray(spin, dtype=np.float64)
    _, sine, sigma, delta, big_a = _metric(r, theta, spin)
    lapse, drag = np.sqrt(sigma * delta / big_a), 0.5 * frame_dragging(r, theta, spin)
    ring = np.sqrt(big_a / sigma)
    p_t, p_phi = 1.0, -np.asarray(n_phi, dtype=np.float64)
    if observer == "static":
        beta = -drag * ring * sine / lapse
        gamma = 1.0 / np.sqrt((1.0 - beta) * (1.0 + beta))
        p_t, p_phi = gamma * (1.0 + beta * p_phi), gamma * (p_phi + beta)
    l_over_sin = ring * p_phi
    energy = lapse * p_t + drag * sine * l_over_sin
    k = sigma * np.asarray(n_theta) ** 2 + (l_over_sin - a * energy * sine) ** 2
    return Photon(energy, l_over_sin, k)


# --- momenta ---------------------------------------------------------------------------------------------------------

def null_residual(r: ArrayLike, theta: ArrayLike, spin: ArrayLike, lam: ArrayLike, k_r: ArrayLike, k_theta: ArrayLike,
                  mass: float = 1.0) -> Array:
    """How far a momentum is from light's: Sigma g^{mu nu} k_mu k_nu relative to the largest of its terms; 0 for a photon, 1e-16 at best.

    Covariant Boyer-Lindquist components in units of |E| with M = 1: k_t = -+1 and k_phi = +-`lam` with `lam` = L_z/E in M (the sign of E makes
    no difference), `k_r` a number and `k_theta` in M; at `r` in r_s and the polar angle `theta`, off the axis and off the horizons. With
    `mass` 0 and spin 0 the metric is flat. The four terms are the squares of Carter's frame,

        Sigma g(k, k) = -[(r^2+a^2) E - a L]^2/Delta + [L/sin(theta) - a E sin(theta)]^2 + Delta k_r^2 + k_theta^2

    (Carter 1968), so that nothing but the null condition itself cancels. NaN where a component is.
    """
    a, sine = np.asarray(spin, dtype=np.float64), np.sin(theta)
    r, lam = 2.0 * np.asarray(r, dtype=np.float64), np.asarray(lam, dtype=np.float64)
    root = np.sqrt((mass - a) * (mass + a))
    delta = (r - mass - root) * (r - mass + root)
    in_time = -np.square(r * r + a * a - a * lam) / delta
    around, outward, down = np.square(lam / sine - a * sine), delta * np.square(k_r), np.square(k_theta)
    largest = np.maximum(np.maximum(np.abs(in_time), around), np.maximum(np.abs(outward), down))
    return np.abs(in_time + around + outward + down) / largest


def carter_constant(theta: ArrayLike, spin: ArrayLike, lam: ArrayLike, k_theta: ArrayLike) -> Array:
    """Q/E^2 = k_theta^2 + cos^2(theta) (lam^2/sin^2(theta) - a^2) in M^2 of a momentum as in `null_residual` (Carter 1968)."""
    return np.square(k_theta) + np.square(np.cos(theta)) * (np.square(np.asarray(lam, dtype=np.float64) / np.sin(theta)) - np.square(spin))


# --- shadows ---------------------------------------------------------------------------------------------------------

def schwarzschild_shadow_angle(r: ArrayLike) -> Array:
    """Half-angle of the shadow for a static observer at r (r_s), above 90 degrees inside the photon sphere [Synge].

    From cos psi = (1 - 3/(2r)) sqrt(1 + 3/r) and sin psi = b_c sqrt(1 - 1/r)/r together: no digits lost anywhere.
    """
    r = np.asarray(r, dtype=np.float64)
    return np.arctan2(CRITICAL_IMPACT * np.sqrt(1.0 - 1.0 / r) / r, (1.0 - 1.5 / r) * np.sqrt(1.0 + 3.0 / r))


def schwarzschild_shadow_distance(angle: ArrayLike) -> Array:
    """Distance in r_s, outside the photon sphere, at which `schwarzschild_shadow_angle` is `angle`, 0 < angle <= pi/2: the cubic's largest root."""
    angle = np.asarray(angle, dtype=np.float64)
    return 3.0 / np.sin(angle) * np.cos((0.5 * np.pi + angle) / 3.0)


def spherical_photon_orbit(s: ArrayLike, spin: ArrayLike) -> tuple[Array, Array]:
    """(lambda, eta) in M, M^2 of the spherical photon orbit r = 3 + a s (M = 1) [B73], finite as a -> 0."""
    a, s = np.asarray(spin, dtype=np.float64), np.asarray(s, dtype=np.float64)
    r = 3.0 + a * s
    return -(r * r * s + a * r + a) / (r - 1.0), r**3 * (4.0 - r * s * s) / (r - 1.0) ** 2


def photon_shell(spin: float, samples: int = 65) -> tuple[Float[Array, " samples"], Float[Array, " samples"]]:
    """Radii in r_s of the spherical photon orbits from the prograde to the retrograde one, and the cosine 0 ... 1 of the polar angle that each reaches [T03].

    Of the two edges of the region that such orbits fill, it is the one above the equator. At a* = 0 they all lie on one sphere and are told apart by
    the angle alone.
    """
    if spin == 0.0:
        return np.full(samples, 1.5), np.sin(np.linspace(0.0, np.pi, samples))
    ends = [float(_photon_orbit_offset(np.asarray(x))) / spin for x in (abs(spin), -abs(spin))]
    turn = np.linspace(0.0, np.pi, samples)
    s = 0.5 * (ends[0] + ends[1]) + 0.5 * (ends[0] - ends[1]) * np.cos(turn)
    lam, eta = spherical_photon_orbit(s, spin)
    eta = np.maximum(eta, 0.0)  # at its ends it is 0, up to rounding
    b = eta + lam * lam - spin * spin
    # The root in 0 ... 1 of a^2 u^2 + b u - eta = 0, u = cos^2(theta), without cancellation.
    u = 2.0 * eta / (b + np.sqrt(b * b + 4.0 * spin * spin * eta))
    return 1.5 + 0.5 * spin * s, np.sqrt(np.clip(u, 0.0, 1.0))


def critical_curve(spin: float, theta: float, samples: int = 512) -> tuple[Float[Array, " samples"], Float[Array, " samples"]]:
    """Closed critical curve (alpha, beta) in M on the screen of an observer at infinity, (samples,) each [B73].

    Starts at the middle of the visible range of lambda with beta > 0. At a* = 0 and on the axis it is a circle of its own.
    """
    cosine, sine = np.cos(theta), np.sin(theta)
    turn = 2.0 * np.pi * np.arange(samples) / samples
    if spin == 0.0 or abs(sine) < 1e-9:
        lam, eta = spherical_photon_orbit(_axis_orbit(spin), spin)
        radius = np.sqrt(eta + lam * lam + (spin * cosine) ** 2)
        return radius * np.sin(turn), radius * np.cos(turn)
    low, high = _visible_orbits(spin, theta)
    s = 0.5 * (low + high) + 0.5 * (high - low) * np.sin(turn)
    beta = np.sqrt(np.maximum(_beta_squared(s, spin, cosine, sine), 0.0))
    return -spherical_photon_orbit(s, spin)[0] / sine, np.sign(np.cos(turn)) * beta


def _beta_squared(s: ArrayLike, spin: float, cosine: float, sine: float) -> Array:
    lam, eta = spherical_photon_orbit(s, spin)
    return eta + cosine**2 * (spin**2 - (lam / sine) ** 2)


def _axis_orbit(spin: float) -> float:
    """s of the orbit with lambda = 0, which passes over the poles; 0 by convention at a* = 0 (lambda is then free)."""
    if spin == 0.0:
        return 0.0
    return float((_barrier_offset(np.asarray(spin * spin), np.asarray(0.0)) - 2.0) / spin)


@lru_cache(maxsize=16)
def _visible_orbits(spin: float, theta: float) -> tuple[float, float]:
    """Range of s of the spherical orbits that reach polar angle theta: roots of beta^2 to either side of lambda = 0."""
    cosine, sine = np.cos(theta), np.sin(theta)
    middle = _axis_orbit(spin)
    ends = [float(_photon_orbit_offset(np.asarray(x))) / spin for x in (spin, -spin)]
    inside, outside = np.full(2, middle), np.sort(ends)
    for _ in range(60):
        trial = 0.5 * (inside + outside)
        seen = _beta_squared(trial, spin, cosine, sine) >= 0.0
        inside, outside = np.where(seen, trial, inside), np.where(seen, outside, trial)
    return float(inside[0]), float(inside[1])


def _barrier_offset(a2: Array, a_lambda: Array) -> Array:
    """r_p - 1 of the photon barrier for given a^2 and a lambda: the one root >= 0 of y^3 - p y - 2(1 - a^2), p = 3 - a^2 - a lambda.

    It is where (r^2 + a^2 - a lambda)^2/Delta has its minimum (Bardeen's condition on spherical orbits). Newton from above:
    the cubic is convex there and the iteration monotone.
    """
    p, q = 3.0 - a2 - a_lambda, 2.0 * (1.0 - a2)
    y = np.sqrt(np.maximum(p, 0.0)) + np.cbrt(q)
    for _ in range(30):
        slope = 3.0 * y * y - p
        y = y - np.where(slope > 0.0, (y * (y * y - p) - q) / np.where(slope > 0.0, slope, 1.0), 0.0)
    return y


def falls_in(n_r: ArrayLike, n_theta: ArrayLike, n_phi: ArrayLike, r: ArrayLike, theta: ArrayLike, spin: float,
             observer: str = "static") -> Array:
    """True where the backward ray along n of an observer at r (r_s) ends in the hole: the exact fate, without tracing.

    With V = (r^2 + a^2 - a lambda)^2/Delta a ray may be where V >= K/E^2, K = Q + (L - a E)^2. V falls from the horizon to its minimum at
    the barrier r_p and then rises: a ray is turned there if K exceeds the minimum. r_p depends on a lambda only (`_barrier_offset`). Near r_p
    the difference is formed from its factors,

        V(r) - V(r_p) = (r - r_p)^2 (r^2 + 2 r_p r + q)/Delta,   q = r_p^2 - 4 r_p Delta_p/(r_p - 1)^2

    Two cases need no barrier: E <= 0 (a ZAMO in the ergosphere sees such light) is captured, and a lambda >= 2 r_+ cannot enter.
    """
    photon = photon_constants(n_theta, n_phi, r, theta, spin, observer)
    r_o, sine, sigma, delta, _ = _metric(r, theta, spin)
    n_r, a, bound = np.asarray(n_r, dtype=np.float64), np.float64(spin), photon.energy <= 0.0
    energy = np.where(bound, 1.0, photon.energy)
    a_lambda = a * sine * photon.l_over_sin / energy
    y = _barrier_offset(np.asarray(a * a), a_lambda)
    r_p, root = 1.0 + y, np.sqrt((1.0 - a) * (1.0 + a))
    steepness = np.where(y > 0.0, (y - root) * (y + root) / np.where(y > 0.0, y, 1.0) ** 2, 1.0)  # Delta/(r-1)^2 at r_p
    q = r_p * (r_p - 4.0 * steepness)
    climb = (r_o - r_p) * energy * np.sqrt(np.maximum(r_o * (r_o + 2.0 * r_p) + q, 0.0) / delta)
    captured = np.where(r_o > 2.0 * r_p, (n_r < 0.0) & (photon.k < 4.0 * (r_p * energy) ** 2 * steepness),
                        np.sqrt(sigma) * n_r + climb < 0.0)
    # No barrier outside the horizon: its angular velocity keeps the light out (a lambda >= 2 r_+).
    return bound | (captured & (a_lambda < 2.0 * (1.0 + root)))


def shadow_angle(chi: ArrayLike, r: float, theta: float, spin: float = 0.0, observer: str = "static") -> Array:
    """Angle psi_c between the hole's centre and the shadow's edge in the screen direction chi, seen from r (r_s), theta.

    chi runs from right (+e_phi) to up (-e_theta). `observer`: "static" (outside the ergosphere) or "zamo". Bisection of the
    exact fate over psi in [0, pi], to the last digit.
    """
    chi = np.asarray(chi, dtype=np.float64)
    low, high = np.zeros_like(chi), np.full_like(chi, np.pi)
    for _ in range(80):
        psi = 0.5 * (low + high)
        sine = np.sin(psi)
        inside = falls_in(-np.cos(psi), -sine * np.sin(chi), sine * np.cos(chi), r, theta, spin, observer)
        low, high = np.where(inside, psi, low), np.where(inside, high, psi)
    return 0.5 * (low + high)
