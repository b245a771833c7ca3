"""The profile of a narrow line that the whole disk emits: what of its light arrives at which frequency, for each order of image.

Matter emits at one frequency, ν_e, with the power ε(r) ∝ r^−q from a unit of its surface, alike in all directions. I_ν/ν³ does not change on the way, so that
what arrives between g and g + dg, g = ν/ν_e, is ∫ g³ ε(r) δ(g − g(α, β)) dα dβ over the sky of the observer (Cunningham 1975, ApJ 202, 788). Rays are spread
over all of the disk's image, whatever the picture shows of it, in equal parts of angle and of the logarithm of the distance from the critical curve: so
each of the ever thinner rings has as many as the direct image.
"""

from __future__ import annotations

import csv
import io
import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .. import listed_rays, planning
from ..physics.space_time import is_field, ray_model
from ..rendering.frame import Renderer
from ..scene import Scene, SceneError, met
from ..shapes import Float
from .scenes import critical_radius

ORDERS = ("direct", "first_ring", "second_ring")

_ANGLES = 720
_NEAREST, _STEPS_A_DECADE = 1e-6, 120  # of the distance from the critical curve over its own
_PARTS = (-0.75, -0.25, 0.25, 0.75)  # of the way from a ray half way to the next
_MARGIN = 1.3  # how far beyond the disk's outer edge, seen straight, its image is looked for: bending lifts its far side


@dataclass(frozen=True)
class Screen:
    """Rays over the disk's image, round the critical curve and away from it.

    Attributes:
        rays: (A, D, 2): ψ, χ in radians, or α, β in M for a camera at infinity, as ray lists have them.
        area: (A, D) of the sky round each: steradians, or M².
    """

    rays: Float[np.ndarray, "around away 2"]
    area: Float[np.ndarray, "around away"]


@dataclass(frozen=True)
class LineProfile:
    """Flux over g = E_infinity/E_emitter.

    Attributes:
        edges: of the bins, (B + 1,), rising.
        flux: (3, B), of the direct image, the first ring, the second: in each bin, of a total of 1.
    """

    edges: Float[np.ndarray, " edges"]
    flux: Float[np.ndarray, "orders bins"]

    @property
    def density(self) -> Float[np.ndarray, "orders bins"]:
        """Flux in a unit of g."""
        return self.flux / np.diff(self.edges)

    @property
    def shares(self) -> Float[np.ndarray, " orders"]:
        """Of the light, for each order."""
        return self.flux.sum(axis=1)

    @property
    def mean(self) -> float:
        """g, averaged over the light."""
        return float(self.flux.sum(axis=0) @ (0.5 * (self.edges[1:] + self.edges[:-1])))

    def as_csv(self) -> str:
        """A row a bin: its middle, the flux in a unit of g of all orders and of each."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["g", "total", *ORDERS])
        for g, each in zip(0.5 * (self.edges[1:] + self.edges[:-1]), self.density.T, strict=True):
            writer.writerow([f"{value:.7g}" for value in (g, each.sum(), *each)])
        return text.getvalue()


def measure(renderer: Renderer, scene: Scene, *, index: float = 3.0, bins: int = 200) -> LineProfile:
    """The profile of `scene`'s disk through the shader that pictures use.

    Args:
        index: q of ε ∝ r^−q.
        bins: at least 10, between the least g and the largest.

    Raises:
        SceneError: there is no disk, or its light is no light in the space-time of a hole.
    """
    (found,) = (found for found in in_parts(renderer, scene, index=index, bins=bins, parts=1) if found is not None)
    return found


def in_parts(renderer: Renderer, scene: Scene, *, index: float, bins: int, parts: int, fineness: float = 1.0) -> Iterator[LineProfile | None]:
    """As `measure`, but for a pause after each of `parts` of the rays, in which it yields None; the profile comes last.

    Args:
        fineness: 1 for as many rays as `measure` has, along each of their two ways.
    """
    refuse(scene)
    screen, made = screen_of(scene, fineness), planning.plan(scene)
    r, g = np.zeros((2, *screen.area.shape, len(ORDERS)))
    for part in range(parts):
        found = listed_rays.trace_by_shader(renderer, scene, screen.rays[part::parts].reshape(-1, 2))
        shape = screen.area[part::parts].shape
        r[part::parts], g[part::parts] = (np.nan_to_num(values).reshape(*shape, -1) for values in (found.crossing_r, found.crossing_g))
        yield None
    shines = (r >= made.disk_inner) & (r <= made.disk_outer) & (g > 0.0) & (np.arange(len(ORDERS)) < scene.rays.orders)
    light = np.where(shines, seen_through(scene, shines) * power(r, g, index), 0.0)
    yield binned(g, light * screen.area[..., None], bins)


def refuse(scene: Scene) -> None:
    """Raises SceneError where `scene` has no disk that a line could come from, or something else on its rays' way."""
    if not scene.disk.enabled:
        raise SceneError("disk.enabled", "got false; a line profile is of a disk's light: allowed is true")
    if is_field(scene) or ray_model(scene).traits.space_time == "flat" and scene.rays.lensing:
        raise SceneError("rays.model", f"got {scene.rays.model!r}; a line profile needs light round a hole: allowed are the models of a hole")
    if not met.is_empty(scene):
        raise SceneError("things", "a line profile is of the disk alone: take things and media out of the scene")


def screen_of(scene: Scene, fineness: float = 1.0) -> Screen:
    """Rays over all of the image of `scene`'s disk, midpoints of equal parts of the angle and of the logarithm of the distance from the critical curve."""
    around, steps = round(_ANGLES * fineness), round(_STEPS_A_DECADE * fineness)
    chi = 2.0 * math.pi * (np.arange(around) + 0.5) / around
    edge = critical_radius(scene, chi)[:, None]
    distance, outer = scene.camera.distance, scene.disk.outer_radius
    at_infinity = math.isinf(distance)
    furthest = 2.0 * outer * _MARGIN + 6.0 if at_infinity else math.pi if distance < _MARGIN * outer else math.asin(min(1.0, _MARGIN * outer / distance)) + 0.1
    inside = _parts(np.ones_like(edge), steps)
    outside = _parts(np.maximum(furthest / edge - 1.0, 1.0), steps)
    low = np.concatenate([edge * (1.0 - inside[:, :-1]), edge * (1.0 + outside[:, :-1])], axis=1)
    high = np.concatenate([edge * (1.0 - inside[:, 1:]), edge * (1.0 + outside[:, 1:])], axis=1)
    if not at_infinity:
        low, high = np.clip(low, 0.0, math.pi), np.clip(high, 0.0, math.pi)
    away = 0.5 * (low + high)
    area = np.abs(high**2 - low**2) / 2.0 if at_infinity else np.abs(np.cos(high) - np.cos(low))
    angles = np.broadcast_to(chi[:, None], away.shape)
    rays = np.stack([away * np.cos(angles), away * np.sin(angles)] if at_infinity else [away, angles], axis=-1)
    return Screen(rays, area * (2.0 * math.pi / around))


def _parts(last: np.ndarray, a_decade: int) -> np.ndarray:
    """Edges (angles, parts + 1) between 0 and `last` (angles, 1), equally far apart in the logarithm but for the first."""
    steps = math.ceil(a_decade * math.log10(float(np.max(last)) / _NEAREST))
    return np.concatenate([np.zeros_like(last), last ** np.linspace(0.0, 1.0, steps) * _NEAREST ** np.linspace(1.0, 0.0, steps)], axis=1)


def seen_through(scene: Scene, shines: np.ndarray) -> np.ndarray:
    """Of the light of each crossing, (…, orders), the part that the crossings before it let through: all of it where they add up."""
    if scene.disk.compositing == "additive":
        return np.ones(shines.shape)
    before = np.cumsum(shines, axis=-1) - shines
    return (1.0 - scene.disk.opacity) ** before


def power(r: np.ndarray, g: np.ndarray, index: float) -> np.ndarray:
    """g³ r^−q, of light that arrives from radius `r` (r_s)."""
    return g**3 * np.maximum(r, 0.1) ** -index


def binned(g: Float[np.ndarray, "around away orders"], light: Float[np.ndarray, "around away orders"], bins: int) -> LineProfile:
    """The profile of `light` that arrives shifted by `g`, each ray's spread over all that g is between it and its neighbours.

    Raises:
        SceneError: no light arrives.
    """
    there = light > 0.0
    if not there.any():
        raise SceneError("disk", "no light of the disk arrives at the camera")
    edges = np.linspace(0.98 * g[there].min(), 1.02 * g[there].max(), bins + 1)
    flux = np.zeros((light.shape[-1], bins))
    around, away = _half_change(g, there, 0), _half_change(g, there, 1)
    for aside, along in itertools.product(_PARTS, _PARTS):
        shifted = g + aside * around + along * away
        for order, counted in enumerate(flux):
            seen = there[..., order]
            counted += np.histogram(shifted[..., order][seen], edges, weights=light[..., order][seen])[0]
    return LineProfile(edges, flux / flux.sum())


def _half_change(g: np.ndarray, there: np.ndarray, axis: int) -> np.ndarray:
    """By how much `g` differs half way to the next ray along `axis`; 0 where one of the two beside a ray has none."""
    before, after = np.roll(g, 1, axis), np.roll(g, -1, axis)
    return np.where(np.roll(there, 1, axis) & np.roll(there, -1, axis), 0.25 * (after - before), 0.0)
