"""The space-time of a scene: the one owner of which spin counts where, and of the radii that follow from it.

Ray models disagree about what the hole's spin does. In Kerr it shapes everything. `kerr_like` drags light about the axis, but its orbits, its horizon and
its observers are Schwarzschild's. Flat space has no spin at all, and still a black ball of Kerr's size to stand for the hole, and matter on Kerr's orbits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

from ..scene import Disk, Scene, catalogue
from . import relativity

_NEAR_CENTRE = 0.1  # r_s
_NEAR_INNER_HORIZON = 1.02  # of its radius


@dataclass(frozen=True)
class SpaceTime:
    """What light runs in.

    Attributes:
        kind: ``flat``, ``schwarzschild`` or ``kerr``: the metric of the observer's frame.
        spin: a* that light's model, matter and its colours feel; 0 for a model without spin.
        observer_spin: a* of the metric that the observer sits in.
        horizon_spin: a* that horizon, photon orbits and innermost stable orbit are those of.
        has_hole: whether there is one; in a field there is not.
        crosses_horizon: whether light is traced through the horizon, so that a camera that falls may be inside.
    """

    kind: str
    spin: float
    observer_spin: float
    horizon_spin: float
    has_hole: bool = True
    crosses_horizon: bool = False

    @cached_property
    def horizon_radius(self) -> float:
        """r_+ in r_s; 0 without a hole."""
        return float(relativity.horizon_radius(self.horizon_spin)) if self.has_hole else 0.0

    @cached_property
    def inner_horizon_radius(self) -> float:
        """r_- in r_s."""
        return float(relativity.inner_horizon_radius(self.horizon_spin)) if self.has_hole else 0.0

    @cached_property
    def innermost_camera(self) -> float:
        """Radius in r_s down to which a camera that falls is followed: before the centre tides are without end, and light's ways before the inner horizon."""
        return max(_NEAR_CENTRE, _NEAR_INNER_HORIZON * self.inner_horizon_radius) if self.crosses_horizon else self.horizon_radius

    @cached_property
    def prograde_photon_orbit(self) -> float:
        """Radius in r_s of the innermost circular orbit of light."""
        return float(relativity.photon_orbit_radius(abs(self.horizon_spin)))

    @cached_property
    def stop_radius(self) -> float:
        """Radius in r_s below which an inward ray is captured without further march.

        Halfway to the prograde photon orbit at most: for spins near 1 that orbit lies closer to the horizon than one per cent.
        """
        return self.horizon_radius + min(0.01 * self.horizon_radius, 0.5 * (self.prograde_photon_orbit - self.horizon_radius))

    def isco_radius(self, disk: Disk) -> float:
        """Innermost stable circular orbit of `disk` in r_s, of the space-time in which light runs; tilted, that of the spin along its axis.

        With `kerr_like` that is Schwarzschild's, whatever the spin: light and matter of two space-times make no sense together close in.
        """
        return _isco_radius(spin_along(self.horizon_spin, disk), disk.orbit)

    def matter_spin(self, disk: Disk) -> float:
        """a* of the hole whose circular orbits the matter of `disk` goes by, and its temperature."""
        return spin_along(self.spin, disk)

    def matter_isco_radius(self, disk: Disk) -> float:
        """`isco_radius` of the space-time whose circular orbits the matter's frequency shift is worked out for."""
        return _isco_radius(self.matter_spin(disk), disk.orbit)

    def disk_radii(self, disk: Disk) -> tuple[float, float]:
        """(inner, outer) edge of the circular orbits of `disk` in r_s: the inner one never inside the ISCO, the outer one never inside the inner."""
        inner = max(disk.inner_radius, self.isco_radius(disk))
        return inner, max(disk.outer_radius, inner * 1.0001)

    def orbit_sense(self, orbit: str) -> float:
        """+1 where the matter goes counter-clockwise seen from +z, or from where a tilted disk's axis points, −1 where clockwise."""
        return float(relativity.orbit_sense(self.spin, orbit))


@lru_cache(maxsize=64)  # each frame asks for the same several times
def _isco_radius(spin: float, orbit: str) -> float:
    return float(relativity.isco_radius(spin, orbit))


def spin_along(spin: float, disk: Disk) -> float:
    """The part of the spin a* along the axis of `disk`."""
    return spin * math.cos(math.radians(disk.tilt_deg)) if disk.tilt_deg else spin


def ray_model(scene: Scene) -> catalogue.PlugIn:
    """The plug-in that traces `scene`: its ``rays.model``, or ``flat`` with lensing off.

    For ``auto``, the exact and general model of its hole; the plan may choose a cheaper one of the same space-time.
    """
    if not scene.rays.lensing:
        key = "flat"
    elif scene.rays.model == "auto":
        artistic = scene.hole.gravity_strength != 1.0 or scene.hole.horizon_size != 1.0
        key = "schwarzschild" if artistic else "kerr"
    else:
        key = scene.rays.model
    return catalogue.plug_ins("ray_model")[key]


def space_time(scene: Scene) -> SpaceTime:
    """The space-time of `scene`'s ray model."""
    traits = ray_model(scene).traits
    return _space_time(traits.space_time, traits.spins, scene.hole.spin, not is_field(scene), traits.crosses_horizon)


def is_field(scene: Scene) -> bool:
    """Whether `scene` is of a field and not of a hole, which with lensing off is still not there."""
    known = catalogue.plug_ins("ray_model").get(scene.rays.model)  # None where the plan chooses: among those of a hole
    return known is not None and known.traits.field


def is_inside(scene: Scene) -> bool:
    """Whether the camera of `scene` is inside the horizon."""
    return scene.camera.distance <= space_time(scene).horizon_radius


@lru_cache(maxsize=256)
def _space_time(kind: str, spins: bool, hole_spin: float, has_hole: bool, crosses_horizon: bool) -> SpaceTime:
    spin = hole_spin if spins else 0.0
    observer_spin, horizon_spin = spin if kind == "kerr" else 0.0, 0.0 if kind == "schwarzschild" else spin
    return SpaceTime(kind, spin, observer_spin, horizon_spin, has_hole, crosses_horizon)
