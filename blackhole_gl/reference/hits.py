"""What a traced ray met: the records that the twins return (float64)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from ..shapes import Bool, Float, Int

Array = np.ndarray

UNRESOLVED, ESCAPED, CAPTURED = 0, 1, 2
EQUATOR = 0
"""Index of the equatorial plane among the events of a trace."""
_AXIS = 1e-6  # sin(theta) up to here is the axis: what is lost of e_theta's direction is 1e-14/sin(theta)


@dataclass(frozen=True)
class Crossings:
    """Places where rays meet planes through the hole, and the momentum of the photon there. NaN stands for "none".

    The photon is the one that arrives at the camera, forward in time. Its covariant Boyer-Lindquist components are in units of |E|, with
    M = 1: k_r and k_theta here, k_t = -sign(E), k_phi = sign(E) lambda (of the ray, in `ReferenceHits`).

    Attributes: arrays of one shape, (N, events, orders) unless said otherwise.
        along: how far along the ray from the camera, in the twin's own parameter: good for telling what comes first.
        r: in r_s. theta, phi: in radians, phi in (-pi, pi].
        delay: of the light from there to the camera, as `events.TellsTime` has it; NaN where the twin does not tell.
        k_r: a number; k_theta: in M. NaN where the model's rays are no light in any metric; k_theta also on the axis, where e_theta has no direction.
    """

    along: Float[Array, "*shape"]
    r: Float[Array, "*shape"]
    theta: Float[Array, "*shape"]
    phi: Float[Array, "*shape"]
    k_r: Float[Array, "*shape"]
    k_theta: Float[Array, "*shape"]
    delay: Float[Array, "*shape"]

    @classmethod
    def none(cls, rays: int, events: int, orders: int) -> Crossings:
        return cls(*np.full((len(fields(cls)), rays, events, orders), np.nan))

    def record(
        self,
        where: tuple[Any, ...],
        along: Float[Array, " k"],
        r: Float[Array, " k"],
        n: Float[Array, "3 k"],
        momentum: tuple[Float[Array, " k"], Float[Array, " k"]] | tuple[float, float],
        delay: Float[Array, " k"] | float = np.nan,
    ) -> None:
        """Puts crossings at r (k,) in r_s in the unit directions n (3, k) into the entries `where`."""
        self.along[where], self.r[where] = along, r
        self.theta[where] = np.arctan2(np.hypot(n[0], n[1]), n[2])
        self.phi[where] = wrapped(np.arctan2(n[1], n[0]))
        self.k_r[where], self.delay[where] = momentum[0], delay
        self.k_theta[where] = np.where(np.hypot(n[0], n[1]) > _AXIS, momentum[1], np.nan)

    def emptied(self, mask: Bool[Array, "*shape"]) -> Crossings:
        """The same without what is known of the crossings in `mask`, which keep their place in the order."""
        return Crossings(self.along, *(np.where(mask, np.nan, getattr(self, item.name)) for item in fields(self)[1:]))

    def without_rays(self, mask: Bool[Array, " N"]) -> Crossings:
        """The same with nothing met by the rays in `mask` (N,)."""
        return Crossings(*(np.where(mask[:, None, None], np.nan, getattr(self, item.name)) for item in fields(self)))

    def of(self, event: int) -> Crossings:
        """Those of one event, (N, orders)."""
        return Crossings(*(getattr(self, item.name)[:, event] for item in fields(self)))

    def in_order(self) -> tuple[Int[Array, "N K"], Crossings]:
        """All of them in order along each ray: (event (N, K), crossings (N, K)), K = events · orders; event -1 and NaN where there are no more."""
        rays, events, orders = self.r.shape
        flat = Crossings(*(getattr(self, item.name).reshape(rays, -1) for item in fields(self)))
        order = np.argsort(flat.along, axis=1, kind="stable")  # NaN comes last
        event = np.where(np.isnan(flat.along), -1, np.repeat(np.arange(events), orders))
        sorted_ = Crossings(*(np.take_along_axis(getattr(flat, item.name), order, axis=1) for item in fields(self)))
        return np.take_along_axis(event, order, axis=1), sorted_


@dataclass(frozen=True)
class Traced:
    """What a twin finds out about N rays.

    Attributes:
        fate: (N,) int8. direction: (N, 3), zero unless escaped. steps: (N,) int.
        energy, l_z: (N,) of the physical photon, in any common unit with M = 1.
        crossings: of every plane asked for, (N, events, orders).
    """

    fate: Int[Array, " N"]
    direction: Float[Array, "N 3"]
    steps: Int[Array, " N"]
    energy: Float[Array, " N"]
    l_z: Float[Array, " N"]
    crossings: Crossings


def joined(parts: Sequence[Traced]) -> Traced:
    """One record of the rays of `parts`, one after the other."""
    arrays = {name: np.concatenate([getattr(part, name) for part in parts]) for name in ("fate", "direction", "steps", "energy", "l_z")}
    crossings = (np.concatenate([getattr(part.crossings, item.name) for part in parts]) for item in fields(Crossings))
    return Traced(**arrays, crossings=Crossings(*crossings))


@dataclass(frozen=True)
class ReferenceHits:
    """N rays, at most `orders` crossings of each plane. NaN stands for "none" and for nothing else.

    Attributes:
        fate: (N,) int8: 0 unresolved, 1 escaped, 2 captured.
        direction: (N, 3) asymptotic world direction, unit; zero unless escaped.
        theta, phi: (N,) its angles in radians; NaN unless escaped.
        steps: (N,) trial steps of the integrator; evaluations: (N,) of the right-hand side, without event location.
        crossings: of all planes, (N, events, orders), the equatorial one first. Boyer-Lindquist places. Those below 1.02 r_+ keep their
            place in the count and are left empty.
        g: (N, orders) E_infinity/E_emitter of a circular emitter at each crossing of the equatorial plane; NaN = no crossing, or inside its ISCO.
        lambda_: (N,) L_z/E of the physical photon in M.
        energy_sign: (N,) sign of its E: -1 for what a ZAMO in the ergosphere sees of light that is bound to the hole.
        energy: (N,) its E over that which the camera measures; NaN for models whose rays are no light in any metric.
        observer: the one used (a static observer gives way to the ZAMO in the ergosphere).
    """

    fate: Int[Array, " N"]
    direction: Float[Array, "N 3"]
    theta: Float[Array, " N"]
    phi: Float[Array, " N"]
    steps: Int[Array, " N"]
    evaluations: Int[Array, " N"]
    crossings: Crossings
    g: Float[Array, "N orders"]
    lambda_: Float[Array, " N"]
    energy_sign: Float[Array, " N"]
    energy: Float[Array, " N"]
    observer: str

    @property
    def equatorial(self) -> Crossings:
        """Those of the equatorial plane, (N, orders)."""
        return self.crossings.of(EQUATOR)

    @property
    def crossing_r(self) -> Float[Array, "N orders"]:
        """(N, orders) r in r_s where the ray crosses the equatorial plane the n-th time."""
        return self.equatorial.r

    @property
    def crossing_phi(self) -> Float[Array, "N orders"]:
        """(N, orders) azimuth there in radians, in (-pi, pi]."""
        return self.equatorial.phi


def wrapped(angle: Float[Array, "*shape"]) -> Float[Array, "*shape"]:
    """The same angle in (-pi, pi]."""
    return np.pi - np.mod(np.pi - angle, 2.0 * np.pi)


def angles(direction: Float[Array, "N 3"], fate: Int[Array, " N"]) -> tuple[Float[Array, " N"], Float[Array, " N"]]:
    """(theta, phi) of directions (N, 3); NaN where the ray did not escape."""
    escaped = fate == ESCAPED
    theta = np.arctan2(np.hypot(direction[:, 0], direction[:, 1]), direction[:, 2])
    phi = np.arctan2(direction[:, 1], direction[:, 0])
    return np.where(escaped, theta, np.nan), np.where(escaped, phi, np.nan)
