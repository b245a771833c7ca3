"""The jet as a medium (float64): a hollow cone or paraboloid of matter that streams along its wall and round it. A shape, and no solution of any flow."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..shapes import Float
from .media import Matter, Momentum, Space

Array = np.ndarray

EDGE = 3.0
"""Widths of the wall's Gaussian at which it ends."""


@dataclass(frozen=True)
class Jet:
    """A smooth jet, of light of one frequency as a far observer sees it; lengths in r_s.

    With theta the angle from the nearer half of the axis, the middle of the wall is where sin(theta/2) = sin(opening/2)/sqrt(1 + collimation (r/inner - 1)),
    and its width a share `thickness` of that. Matter keeps to surfaces of that form at `speed`, as a ZAMO sees it, turned by `pitch_deg` round the axis.
    Emission and absorption, `brightness` and `depth` on 1 r_s where it begins, go with the density, and with the frequency to the powers -index and
    -(2.5 + index).
    """

    inner_radius: float
    outer_radius: float
    opening_deg: float
    thickness: float
    collimation: float
    speed: float
    pitch_deg: float
    falloff: float
    brightness: float
    depth: float
    index: float
    channels: int = 1
    power: float = 3.0

    @property
    def reach(self) -> float:
        return self.outer_radius

    def level(self, x: Float[Array, " 3 *points"], space: Space) -> Float[Array, "*points"]:
        r, half, _ = self._where(x)
        return np.maximum(np.abs(self._beside(r, half)) - EDGE, np.maximum(self.inner_radius / r - 1.0, r / self.outer_radius - 1.0))

    def stride(self, x: Float[Array, " 3 *points"]) -> Float[Array, "*points"]:
        r, half, _ = self._where(x)
        wall = 2.0 * r * self.thickness * self._wall(r)  # the Gaussian's width
        return np.maximum(2.0 * wall, np.minimum(0.3 * r, 0.5 * wall * (np.abs(self._beside(r, half)) - EDGE)))

    def matter(self, x: Float[Array, " 3 *points"], momentum: Momentum, space: Space) -> Matter:
        r, half, side = self._where(x)
        density = self._ends(r) * np.exp(-0.5 * self._beside(r, half) ** 2) * np.minimum(self.inner_radius / r, 1.0) ** self.falloff
        shift = self._shift(x, r, half, side, momentum, space)
        light = density * shift**self.index
        return Matter((self.brightness * light)[None], (self.depth * light * shift**2.5)[None], shift)

    def _shift(self, x: Array, r: Array, half: Array, side: Array, momentum: Momentum, space: Space) -> Array:
        """1/(gamma (E - beta.p)) of light that a ZAMO sees as (E, p): along the wall d(theta)/d(ln r) = -tan(theta/2) dln(1 + c (r/inner - 1))/d(ln r)."""
        spread = 1.0 + self.collimation * np.maximum(r / self.inner_radius - 1.0, 0.0)
        bend = -np.tan(half) * self.collimation * (r / self.inner_radius) / spread
        pitch = math.radians(self.pitch_deg)
        along = self.speed * math.cos(pitch) / np.sqrt(1.0 + bend * bend)
        beta_r, beta_theta, beta_phi = along, along * bend * side, self.speed * math.sin(pitch)
        turning, r_m, cosine = space.turning(x), 2.0 * r, x[2] / r
        sigma = r_m**2 + (space.spin * cosine) ** 2
        delta = r_m**2 - 2.0 * space.mass * r_m + space.spin**2
        omega = -turning.tphi / turning.phiphi
        energy = (1.0 - omega * momentum.lam) / np.sqrt(turning.det / turning.phiphi)
        meridional = beta_r * momentum.k_r * np.sqrt(delta / sigma) + beta_theta * momentum.k_theta / np.sqrt(sigma)
        seen = energy - meridional - beta_phi * momentum.lam / np.sqrt(turning.phiphi)
        return math.sqrt(1.0 - self.speed**2) / seen

    def _wall(self, r: Array) -> Array:
        """sin(theta/2) of the wall's middle."""
        return math.sin(0.5 * math.radians(self.opening_deg)) / np.sqrt(1.0 + self.collimation * np.maximum(r / self.inner_radius - 1.0, 0.0))

    def _beside(self, r: Array, half: Array) -> Array:
        """In widths of the Gaussian from its middle."""
        return (np.sin(half) / self._wall(r) - 1.0) / self.thickness

    def _ends(self, r: Array) -> Array:
        """From 0 to 1 over half of the inner radius, and back over the outer half: cubics without slope at their ends."""
        begun, ended = np.clip(2.0 * (r / self.inner_radius - 1.0), 0.0, 1.0), np.clip(2.0 * r / self.outer_radius - 1.0, 0.0, 1.0)
        return begun**2 * (3.0 - 2.0 * begun) * (1.0 - ended**2 * (3.0 - 2.0 * ended))

    @staticmethod
    def _where(x: Array) -> tuple[Array, Array, Array]:
        """r, half the angle from the nearer half of the axis, and which half: 1 where z >= 0, else -1."""
        return np.sqrt((x * x).sum(axis=0)), 0.5 * np.arctan2(np.hypot(x[0], x[1]), np.abs(x[2])), np.where(x[2] < 0.0, -1.0, 1.0)
