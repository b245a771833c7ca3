"""What a pixel's ray meets, in numbers: hits of the kept map, and of physics what float64 makes of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..glsl.declared import Fate
from ..physics import accretion, lensed_circles, plunging, relativity, tilted_disk
from ..physics.observer import observe
from ..planning import Plan
from . import instances
from .hit_texels import HitArrays
from .inputs import FrameInputs
from .recording import pixel_direction


@dataclass(frozen=True)
class OnDisk:
    """The first crossing of a ray that meets the disk.

    Attributes:
        order: 0 of the direct image, 1 of the first ring, 2 of the second.
        radius, azimuth: in r_s, and in radians, −π … π, in the world.
        g: E_observer/E_emitter, by the scene's formula.
        temperature: in K, of the light as it colours the picture.
    """

    order: int
    radius: float
    azimuth: float
    g: float
    temperature: float


@dataclass(frozen=True)
class PixelValues:
    """A pixel's ray.

    Attributes:
        fate: what became of it.
        lam, eta: L_z/E in M and Q/E² in M² of the light that arrives; NaN for light of no energy at infinity.
        impact: √(η + λ²) in M where the hole does not spin, which is L/E; else NaN.
        screen: (α, β) in M of a camera infinitely far away; else None.
        disk: None where the ray does not meet it.
        sky: (θ, φ) in radians of the direction that the ray escapes in; else None.
        met: the kind of thing or medium that it meets first; empty where none.
    """

    fate: Fate
    lam: float
    eta: float
    impact: float
    screen: tuple[float, float] | None
    disk: OnDisk | None
    sky: tuple[float, float] | None
    met: str


def of(inputs: FrameInputs, hits: HitArrays, pixel: tuple[int, int]) -> PixelValues:
    """The values of `pixel` (x, y) from the bottom left.

    Args:
        inputs: what the hit map was traced for.
        hits: of that pixel, without further axes.
    """
    plan = inputs.plan
    observer = observe(plan.scene)
    x, y = (place + 0.5 + shift for place, shift in zip(pixel, inputs.offset))
    local = observer.look @ pixel_direction(plan.scene, inputs.picture, (x, y))
    light = lensed_circles.light(observer, local)
    lam, eta = (math.nan, math.nan) if light.is_bound else (float(light.lam), float(light.eta))
    fate = Fate(int(hits.fate))
    n = hits.direction.astype(float)
    return PixelValues(
        fate=fate,
        lam=lam,
        eta=eta,
        impact=math.sqrt(max(eta + lam * lam, 0.0)) if plan.space_time.observer_spin == 0.0 else math.nan,
        screen=(float(local[2]), float(-local[1])) if observer.w == 0.0 else None,
        disk=_on_disk(plan, hits, light),
        sky=(math.atan2(math.hypot(n[0], n[1]), n[2]), math.atan2(n[1], n[0])) if fate == Fate.ESCAPED else None,
        met=_met(plan, hits),
    )


def _on_disk(plan: Plan, hits: HitArrays, light: lensed_circles.Light) -> OnDisk | None:
    radii = np.hypot(*hits.crossing.astype(float).T)
    on = np.flatnonzero((radii >= plan.disk_edge) & (radii <= plan.disk_outer))[: plan.orders]
    if not on.size:
        return None
    order = int(on[0])
    radius, disk, energy = float(radii[order]), plan.scene.disk, 1.0 / float(light.energy)
    place = tilted_disk.placed(hits.crossing[order], disk)
    if radius < plan.disk_inner:
        gravity, motion = _falling_shift(plan, radius, light, order)
    elif disk.tilt_deg:
        gravity, motion = _tilted_shift(plan, place, light, bool(hits.inbound[order]))
    else:
        gravity, motion = frequency_shift(plan, radius, math.nan if light.is_bound else float(light.lam))
    (profile,) = plan.disk_temperatures(np.array([radius]))
    seen = accretion.hottest(plan.scene) * float(profile) * (gravity * energy if disk.redshift else 1.0) * (motion if disk.doppler_colour else 1.0)
    return OnDisk(order, radius, math.atan2(place[1], place[0]), gravity * motion * energy, seen)


def frequency_shift(plan: Plan, radius: float, lam: float) -> tuple[float, float]:
    """E_infinity/E_emitter in two factors, gravity's and the motion's, by the scene's formula (shaders/common/disk_orbit.glsl says how they part)."""
    disk, spin = plan.scene.disk, plan.space_time.spin
    along = plan.space_time.orbit_sense(disk.orbit) * float(np.clip(relativity.azimuthal_cosine(radius, lam), -1.0, 1.0))
    if disk.frequency_shift == "s0":
        gravity = math.sqrt(1.0 - 1.0 / radius)
        return gravity, float(relativity.g_s0(radius, along)) / gravity
    if disk.frequency_shift == "s1":
        return 1.0, float(relativity.g_s1(radius, along))
    gravity = 1.0 / float(relativity.orbital_u_t(radius, spin, disk.orbit))
    return gravity, float(relativity.circular_orbit_g(radius, lam, spin, disk.orbit)) / gravity


def _falling_shift(plan: Plan, radius: float, light: lensed_circles.Light, order: int) -> tuple[float, float]:
    """The two factors of `frequency_shift` of matter that falls in."""
    spin, orbit = plan.space_time.spin, plan.scene.disk.orbit
    gravity = 1.0 / float(plunging.four_velocity(radius, spin, orbit).time)
    k_r = lensed_circles.crossing_momentum(light, np.array(order), np.array(radius))[0]
    return gravity, float(plunging.emission_shift(radius, light.lam, k_r, spin, orbit)) / gravity


def _tilted_shift(plan: Plan, place: np.ndarray, light: lensed_circles.Light, southward: bool) -> tuple[float, float]:
    """The two factors of `frequency_shift` of a tilted disk's matter at `place` (3,) in r_s; NaN by the older viewers' formulas."""
    if plan.scene.disk.frequency_shift != "exact":
        return math.nan, math.nan
    spin, lam, eta = plan.space_time.spin, float(light.lam), float(light.eta)
    sine, cosine = math.hypot(place[0], place[1]) / math.hypot(*place), place[2] / math.hypot(*place)
    k_theta = math.sqrt(max(eta + (plan.space_time.observer_spin * cosine) ** 2 - (lam * cosine / sine) ** 2, 0.0))
    momentum = np.array([0.0, k_theta if southward else -k_theta, lam])  # matter that circles does not feel k_r
    gravity, motion = tilted_disk.shift(place, momentum, spin, plan.scene.disk)
    return float(gravity), float(motion)


def _met(plan: Plan, hits: HitArrays) -> str:
    if hits.met is None or hits.met[0, 0] < 0:
        return ""
    return instances.used(plan.scene)[int(hits.met[0, 0])].label
