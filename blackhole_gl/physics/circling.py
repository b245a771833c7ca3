"""Matter that turns about the axis of Kerr and moves in no other way: closed forms at any place (float64, vectorised over arrays).

Lengths in M, spin a* in [-1, 1]; r and sin^2(theta) of Boyer-Lindquist. A `mass` of 0 is flat space. The matter is told by its specific angular
momentum l = -u_phi/u_t, or by its angular velocity Omega = u^phi/u^t; positive is counter-clockwise seen from +z.

Sources: Bardeen, Press & Teukolsky 1972 (ApJ 178, 347); Abramowicz, Jaroszynski & Sikora 1978 (A&A 63, 221).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..shapes import Float

Array = np.ndarray


class Turning(NamedTuple):
    """Components of the metric that turning matter feels, and `det` = g_tphi^2 - g_tt g_phiphi = Delta sin^2(theta), formed from its factors."""

    tt: Array
    tphi: Array
    phiphi: Array
    det: Array


class Circling(NamedTuple):
    """Matter that turns: u^t, Omega in 1/M, and u_t, minus its energy."""

    u_t: Array
    omega: Array
    energy_down: Array


def turning_metric(r: ArrayLike, sine2: ArrayLike, spin: float, mass: float = 1.0) -> Turning:
    """The metric at r in M and sin^2(theta) = `sine2`."""
    r, sine2 = np.asarray(r, dtype=np.float64), np.asarray(sine2, dtype=np.float64)
    a, root = spin * mass, mass * np.sqrt((1.0 - spin) * (1.0 + spin))
    sigma = r * r + a * a * (1.0 - sine2)
    delta = (r - mass - root) * (r - mass + root)
    drag = 2.0 * mass * r / sigma
    return Turning(drag - 1.0, -a * sine2 * drag, sine2 * (r * r + a * a + a * a * sine2 * drag), delta * sine2)


def with_angular_momentum(l: ArrayLike, metric: Turning) -> Circling:  # noqa: E741
    """Matter of specific angular momentum `l` in M; NaN where none can turn so: at the horizon and within, or too fast."""
    l = np.asarray(l, dtype=np.float64)  # noqa: E741
    own = metric.phiphi + l * (2.0 * metric.tphi + l * metric.tt)
    with np.errstate(divide="ignore", invalid="ignore"):
        onward = metric.phiphi + l * metric.tphi  # has the sign of u^t: in the ergosphere there is an own > 0 that runs backwards in time
        down = -np.sqrt(np.where((own > 0.0) & (metric.det > 0.0) & (onward > 0.0), metric.det / own, np.nan))
        omega = -(metric.tphi + l * metric.tt) / onward
    return Circling(-1.0 / (down * (1.0 - omega * l)), omega, down)


def with_angular_velocity(omega: ArrayLike, metric: Turning) -> Circling:
    """Matter of angular velocity `omega` in 1/M; NaN where that is faster than light."""
    omega = np.asarray(omega, dtype=np.float64)
    own = -(metric.tt + omega * (2.0 * metric.tphi + omega * metric.phiphi))
    up = 1.0 / np.sqrt(np.where(own > 0.0, own, np.nan))
    return Circling(up, omega + 0.0 * up, up * (metric.tt + omega * metric.tphi))


def shift(matter: Circling, lam: ArrayLike) -> Float[Array, "*shape"]:
    """E_infinity/E_matter = 1/(u^t (1 - Omega lambda)) of light with L_z/E = `lam` in M."""
    return 1.0 / (matter.u_t * (1.0 - matter.omega * np.asarray(lam, dtype=np.float64)))
