"""The Polish doughnut: a thick torus of constant specific angular momentum in closed form (float64, lengths in M, spin a*).

Its matter turns with l = -u_phi/u_t everywhere the same, and is held by pressure where its potential W = ln|u_t| is below that of its surface, W_in.
Equal W is equal pressure and density:

    rho = [ (Gamma - 1)/(Gamma K) (e^(W_in - W) - 1) ]^(1/(Gamma - 1))

In the equatorial plane W has its minimum, the pressure's maximum, and its cusp, over which matter falls into the hole, where Kepler's l is the torus's: l is
more than that of the marginally stable orbit. It is closed for W_in below W at the cusp and below 0; above l of the marginally bound orbit 0 is the lower,
and above l of the circular orbit of light there is no cusp.

Source: Abramowicz, Jaroszynski & Sikora 1978 (A&A 63, 221); Font & Daigne 2002 (MNRAS 334, 383) for the density.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..shapes import Float
from . import circling, relativity

Array = np.ndarray


def kepler_momentum(r: ArrayLike, spin: float) -> Array:
    """l of the circular geodesic at r in M that goes counter-clockwise; a negative `spin` is a hole that turns against it."""
    x = np.sqrt(np.asarray(r, dtype=np.float64))
    return (x**4 - 2.0 * spin * x + spin * spin) / (x**3 - 2.0 * x + spin)


def bound_radius(spin: float) -> float:
    """r in M of the marginally bound circular orbit that goes counter-clockwise."""
    return 2.0 - spin + 2.0 * float(np.sqrt(1.0 - spin))


def stable_radius(spin: float) -> float:
    """r in M of the marginally stable circular orbit that goes counter-clockwise."""
    return 2.0 * float(relativity.isco_radius(spin, "prograde" if spin >= 0.0 else "retrograde"))


def momentum_range(spin: float) -> tuple[float, float]:
    """l in M between which a torus may reach its cusp and still be closed: that of the marginally stable and that of the marginally bound orbit."""
    return float(kepler_momentum(stable_radius(spin), spin)), float(kepler_momentum(bound_radius(spin), spin))


@dataclass(frozen=True)
class Torus:
    """A torus that goes counter-clockwise.

    Attributes:
        spin: a* of the hole; negative where that turns the other way.
        momentum: l in M, above the lower end of `momentum_range`.
        filling: W_in, as the part 0 ... 1 of the way from its value at the pressure's maximum, where nothing is left, to that at the cusp or to 0, whichever
            is lower, where all is full.
        gamma: the adiabatic index.

    Raises:
        ValueError: `momentum`, `filling` or `gamma` outside what has a closed torus; the text says what is allowed.
    """

    spin: float
    momentum: float
    filling: float = 1.0
    gamma: float = 4.0 / 3.0

    def __post_init__(self) -> None:
        low = momentum_range(self.spin)[0]
        if not low < self.momentum:
            raise ValueError(f"torus: got the angular momentum {self.momentum:g}; at spin {self.spin:g} it is above {low:.6g}")
        if not 0.0 < self.filling <= 1.0:
            raise ValueError(f"torus: got the filling {self.filling:g}; allowed is above 0, up to 1")
        if not self.gamma > 1.0:
            raise ValueError(f"torus: got the adiabatic index {self.gamma:g}; allowed is above 1")

    @classmethod
    def between(cls, spin: float, inner: float, centre: float, gamma: float = 4.0 / 3.0) -> Torus:
        """The torus with its inner edge, or W_in, and its pressure's maximum at these radii in M."""
        whole = cls(spin, float(kepler_momentum(centre, spin)), 1.0, gamma)
        lowest = float(whole.potential(centre, 1.0))
        filling = (float(whole.potential(inner, 1.0)) - lowest) / (whole.surface_potential - lowest)
        return cls(spin, whole.momentum, filling, gamma)

    @cached_property
    def cusp(self) -> float:
        """r in M of the cusp; the circular orbit of light's where there is none."""
        light = 2.0 * float(relativity.photon_orbit_radius(abs(self.spin), "prograde" if self.spin >= 0.0 else "retrograde"))
        return self._kepler_radius(light * (1.0 + 1e-12), stable_radius(self.spin))

    @cached_property
    def centre(self) -> float:
        """r in M of the pressure's maximum."""
        start = stable_radius(self.spin)
        return self._kepler_radius(start, start + 4.0 * self.momentum**2 + 10.0)

    def _kepler_radius(self, low: float, high: float) -> float:
        """Where between two radii Kepler's l is the torus's."""
        rising = kepler_momentum(high, self.spin) > kepler_momentum(low, self.spin)
        for _ in range(200):
            middle = 0.5 * (low + high)
            if (kepler_momentum(middle, self.spin) < self.momentum) == rising:
                low = middle
            else:
                high = middle
        return 0.5 * (low + high)

    def matter(self, r: ArrayLike, sine2: ArrayLike) -> circling.Circling:
        """How it moves at r in M and sin^2(theta) = `sine2`; NaN where no matter has its l."""
        return circling.with_angular_momentum(self.momentum, circling.turning_metric(r, sine2, self.spin))

    def potential(self, r: ArrayLike, sine2: ArrayLike) -> Float[Array, "*shape"]:
        """W at r in M and sin^2(theta); NaN where no matter has its l."""
        return np.log(-self.matter(r, sine2).energy_down)

    @cached_property
    def surface_potential(self) -> float:
        """W_in."""
        lowest, rim = float(self.potential(self.centre, 1.0)), float(np.fmin(self.potential(self.cusp, 1.0), 0.0))
        return lowest + self.filling * (rim - lowest)

    @cached_property
    def inner_radius(self) -> float:
        """r in M of its inner edge in the equatorial plane."""
        return self._edge(self.cusp, self.centre)

    @cached_property
    def outer_radius(self) -> float:
        """r in M of its outer edge in the equatorial plane; infinite where W_in is 0."""
        far = 2.0 * self.centre
        while float(self.potential(far, 1.0)) < self.surface_potential:
            if far > 1e12:
                return float("inf")
            far *= 2.0
        return self._edge(far, self.centre)

    def _edge(self, outside: float, inside: float) -> float:
        for _ in range(200):
            middle = 0.5 * (outside + inside)
            if float(self.potential(middle, 1.0)) < self.surface_potential:
                inside = middle
            else:
                outside = middle
        return 0.5 * (outside + inside)

    def density(self, r: ArrayLike, sine2: ArrayLike) -> Float[Array, "*shape"]:
        """rho at r in M and sin^2(theta), 1 at the pressure's maximum; 0 outside of the torus, and on the hole's side of the cusp."""
        r = np.asarray(r, dtype=np.float64)
        power = 1.0 / (self.gamma - 1.0)
        deep = np.expm1(self.surface_potential - self.potential(r, sine2))
        inside = (deep > 0.0) & (r > self.cusp)
        deepest = np.expm1(self.surface_potential - float(self.potential(self.centre, 1.0)))
        return np.where(inside, np.where(inside, deep, 0.0) / deepest, 0.0) ** power
