"""Media that shine and dim along rays: what each kind is at a place (float64).

A medium says what is there, in the frame of its matter: light that it adds and depth on 1 r_s. Places are (3, ...), r n in r_s with Boyer-Lindquist's
r, theta and phi; `space` is the space-time that the matter moves in.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from ..physics import circling, torus
from ..shapes import Float

Array = np.ndarray


@dataclass(frozen=True)
class Space:
    """The metric that matter moves in: Kerr's with the spin a*, or flat where `mass` is 0."""

    mass: float
    spin: float

    def turning(self, x: Float[Array, " 3 *points"]) -> circling.Turning:
        """What matter that turns about the axis feels at x, in M."""
        r2, ring2 = (x * x).sum(axis=0), x[0] ** 2 + x[1] ** 2
        return circling.turning_metric(2.0 * np.sqrt(r2), np.maximum(ring2 / r2, 1e-24), self.spin, self.mass)


class Momentum(NamedTuple):
    """Covariant momentum of the photon that arrives, E = 1 and M = 1, in Boyer-Lindquist's coordinates; each (...)."""

    k_r: Array
    k_theta: Array
    lam: Array


class Matter(NamedTuple):
    """What is at a place: emission and absorption on 1 r_s in each colour, broadcastable to (C, ...); shift = E_infinity/E_matter (...)."""

    emission: Array
    absorption: Array
    shift: Array


class Medium(Protocol):
    """A kind of medium.

    Attributes:
        reach: r in r_s beyond which there is none.
        channels: C, of its colours.
        power: of the frequency's shift on its light: 3 for light of one frequency, whose emission is then that at the emitter's frequency; 4 for all.
    """

    @property
    def reach(self) -> float: ...

    @property
    def channels(self) -> int: ...

    @property
    def power(self) -> float: ...

    def level(self, x: Float[Array, " 3 *points"], space: Space) -> Float[Array, "*points"]:
        """Negative where the medium is, its sign changing on the surface."""

    def stride(self, x: Float[Array, " 3 *points"]) -> Float[Array, "*points"]:
        """How far one may go from x, in it or not, without overlooking it or what changes in it; in r_s."""

    def matter(self, x: Float[Array, " 3 *points"], momentum: Momentum, space: Space) -> Matter:
        """What is at x, for light of that momentum there."""


@dataclass(frozen=True)
class Ball:
    """A ball of uniform fog at rest: on a chord c in flat space it gives S (1 - exp(-alpha c)).

    centre (3,) and radius in r_s; absorption alpha on 1 r_s and source S, one for each colour.
    """

    centre: tuple[float, float, float]
    radius: float
    absorption: tuple[float, ...]
    source: tuple[float, ...]
    power: float = 4.0

    @property
    def reach(self) -> float:
        return float(np.linalg.norm(self.centre)) + self.radius

    @property
    def channels(self) -> int:
        return len(self.absorption)

    def level(self, x: Float[Array, " 3 *points"], space: Space) -> Float[Array, "*points"]:
        return self._distance(x) - self.radius

    def stride(self, x: Float[Array, " 3 *points"]) -> Float[Array, "*points"]:
        return np.maximum(np.abs(self._distance(x) - self.radius), 0.5 * self.radius)

    def matter(self, x: Float[Array, " 3 *points"], momentum: Momentum, space: Space) -> Matter:
        still = circling.with_angular_velocity(0.0, space.turning(x))
        absorption = _colours(self.absorption, x)
        return Matter(absorption * _colours(self.source, x), absorption, circling.shift(still, momentum.lam))

    def _distance(self, x: Array) -> Array:
        offset = np.moveaxis(x, 0, -1) - np.array(self.centre)
        return np.sqrt((offset * offset).sum(axis=-1))


@dataclass(frozen=True)
class AnalyticPlasma:
    """The plasma of the EHT code comparison (Gold et al. 2020): n = exp(-((r/size)^2 + (h cos theta)^2)/2), light of one frequency.

    Emission n emissivity f^-index, absorption n depth f^-(2.5 + index) on 1 r_s, f = 1/shift the matter's frequency over that far away; the matter's
    angular momentum is l0 R^1.5/(1 + R), R = r sin theta in M.

    size and reach in r_s; flatness: h; turning: l0.
    """

    emissivity: float = 1.0
    depth: float = 0.0
    index: float = 0.0
    flatness: float = 0.0
    turning: float = 1.0
    size: float = 5.0
    reach: float = 50.0
    channels: int = 1
    power: float = 3.0

    def level(self, x: Float[Array, " 3 *points"], space: Space) -> Float[Array, "*points"]:
        return np.sqrt((x * x).sum(axis=0)) - self.reach

    def stride(self, x: Float[Array, " 3 *points"]) -> Float[Array, "*points"]:
        r = np.sqrt((x * x).sum(axis=0))
        if not self.flatness:
            return 0.5 * r + 0.2 * self.size
        # Farther from the plane than there is any to speak of, half the way back to it.
        thickness = r / self.flatness
        return np.minimum(0.5 * r + 0.2 * self.size, np.maximum(thickness, 0.5 * np.abs(x[2])))

    def matter(self, x: Float[Array, " 3 *points"], momentum: Momentum, space: Space) -> Matter:
        r2 = (x * x).sum(axis=0)
        density = np.exp(-0.5 * (r2 / self.size**2 + self.flatness**2 * x[2] ** 2 / r2))
        ring = 2.0 * np.sqrt(x[0] ** 2 + x[1] ** 2)
        shift = circling.shift(circling.with_angular_momentum(self.turning * ring**1.5 / (1.0 + ring), space.turning(x)), momentum.lam)
        return Matter((density * self.emissivity * shift**self.index)[None], (density * self.depth * shift ** (2.5 + self.index))[None], shift)


@dataclass(frozen=True)
class Doughnut:
    """A Polish doughnut: absorption on 1 r_s goes with its density, and is `absorption` at the pressure's maximum; the source is the same everywhere.

    There is none beyond `limit`, r in r_s.
    """

    torus: torus.Torus
    absorption: tuple[float, ...]
    source: tuple[float, ...]
    limit: float = 1e4
    power: float = 4.0

    @property
    def reach(self) -> float:
        return min(0.5 * self.torus.outer_radius, self.limit)

    @property
    def channels(self) -> int:
        return len(self.absorption)

    def level(self, x: Float[Array, " 3 *points"], space: Space) -> Float[Array, "*points"]:
        r, sine2 = self._where(x)
        outside = self.torus.potential(r, sine2) - self.torus.surface_potential
        return np.where(np.isfinite(outside) & (r > self.torus.cusp), np.maximum(outside, 0.5 * r - self.limit), 1.0)

    def stride(self, x: Float[Array, " 3 *points"]) -> Float[Array, "*points"]:
        return 0.05 * np.sqrt((x * x).sum(axis=0)) + 0.05

    def matter(self, x: Float[Array, " 3 *points"], momentum: Momentum, space: Space) -> Matter:
        r, sine2 = self._where(x)
        density = self.torus.density(r, sine2)
        absorption = density * _colours(self.absorption, x)
        turning = circling.with_angular_momentum(self.torus.momentum, space.turning(x))
        return Matter(absorption * _colours(self.source, x), absorption, circling.shift(turning, momentum.lam))

    @staticmethod
    def _where(x: Array) -> tuple[Array, Array]:
        r2 = (x * x).sum(axis=0)
        return 2.0 * np.sqrt(r2), np.maximum((x[0] ** 2 + x[1] ** 2) / r2, 1e-24)


@dataclass(frozen=True)
class Slab:
    """A smooth slab, |z| < height and inner < R < outer in r_s: density (1 - m) exp(-z^2/(2 height^2)), m from 0 at the inner edge to 1 at the outer one.

    Absorption on 1 r_s goes with the density and is `absorption` at its densest; the source falls as (inner/R)^3 from `source`. It turns counter-clockwise, as
    the circular geodesic of the same R in the plane does.
    """

    inner: float
    outer: float
    height: float
    absorption: float
    source: float
    channels: int = 1
    power: float = 4.0

    @property
    def reach(self) -> float:
        return self.outer + self.height

    def level(self, x: Float[Array, " 3 *points"], space: Space) -> Float[Array, "*points"]:
        ring = np.hypot(x[0], x[1])
        return np.maximum(np.maximum(self.inner - ring, ring - self.outer), np.abs(x[2]) - self.height)

    def stride(self, x: Float[Array, " 3 *points"]) -> Float[Array, "*points"]:
        return np.maximum(0.5 * self.height, 0.7 * (np.abs(x[2]) - self.height))

    def matter(self, x: Float[Array, " 3 *points"], momentum: Momentum, space: Space) -> Matter:
        ring = np.hypot(x[0], x[1])
        share = (ring - self.inner) / (self.outer - self.inner)
        absorption = self.absorption * (1.0 - share) * np.exp(-0.5 * (x[2] / self.height) ** 2)
        turning = circling.with_angular_velocity(1.0 / ((2.0 * ring) ** 1.5 + space.spin), space.turning(x))
        return Matter((absorption * self.source * (self.inner / ring) ** 3)[None], absorption[None], circling.shift(turning, momentum.lam))


def _colours(values: tuple[float, ...], x: Array) -> Array:
    """(C, 1, ...) from C numbers, to go with arrays of the points x (3, ...)."""
    return np.array(values, dtype=np.float64).reshape((-1,) + (1,) * (x.ndim - 1))
