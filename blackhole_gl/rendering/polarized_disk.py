"""Polarization of the disk's light: Stokes parameters where one looks, by closed forms (`physics.polarization`), and ticks over a picture. No GL here.

The disk is taken to be smooth: what it emits is as bright as g^p T⁴, with the scene's temperature law and p, and its layers have no bearing.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ..physics import disk_profile, lensed_circles, polarization, projection, scattering_atmosphere
from ..physics.observer import Observer, observe
from ..physics.polarization import MagneticField, PolarizedLight
from ..planning import Plan
from ..planning import plan as make_plan
from ..scene import Scene, met
from ..shapes import Float
from . import labels
from .beam import sigma_px
from .labels import Curve, Labels
from .views import Colour

SYNCHROTRON_DEGREE = 0.75
"""Of light of electrons with a power law of 3 in a field that is straight: (p + 1)/(p + 7/3), which is as bright as sin² of its angle with the field."""

TICKS: Colour = (0.35, 1.0, 0.95)
_DARK: Colour = (0.02, 0.05, 0.08)
_ONLY_ORDER = {"direct": 0, "first_ring": 1, "second_ring": 2}
_SAMPLES_A_SIGMA, _SAMPLES_IN_MOTION = 6.0, 2.5  # of a beam: light is then right to 2 % and 7 % of the brightest
_FINEST = 4  # samples to a tick, of a narrow beam
_LEAST_SHARE = 1e-4  # of the brightest polarized light: ticks of less are left out
_NUDGE = 1e-5  # of a direction: what is seen beside it tells how a tick lies on the picture
_LENGTH = 0.85  # of the longest tick, in distances between them


@dataclass(frozen=True)
class Stokes:
    """Light as astronomers write it down: arrays (…).

    Attributes:
        i: in units of a disk's hottest place that comes straight and unshifted, for light that is alike in all directions.
        q, u: the polarized part, towards up on the picture and towards 45° counter-clockwise from there.
    """

    i: Float[np.ndarray, "*rays"]
    q: Float[np.ndarray, "*rays"]
    u: Float[np.ndarray, "*rays"]

    @property
    def polarized(self) -> Float[np.ndarray, "*rays"]:
        """√(Q² + U²)."""
        return np.hypot(self.q, self.u)

    @property
    def angle(self) -> Float[np.ndarray, "*rays"]:
        """Position angle, from up counter-clockwise, −π/2 … π/2."""
        return 0.5 * np.arctan2(self.u, self.q)


def why_not(plan: Plan) -> str:
    """Why the polarization of a picture is not known; empty where it is."""
    if not plan.scene.disk.enabled:
        return "No polarization: there is no disk."
    if plan.is_inside:
        return "No polarization: it is told by a frame of zero angular momentum, and inside the horizon there is none."
    if not met.is_empty(plan.scene):
        return "No polarization: it is that of the disk alone, and the scene has things or media."
    if plan.scene.polarization.emission == "synchrotron" and _field(plan.scene) == MagneticField(0.0, 0.0, 0.0):
        return "No polarization: all three parts of the magnetic field are 0; polarization.field_vertical is one of them."
    if plan.scene.disk.tilt_deg:
        return "No polarization: its closed forms are of a disk in the equator, and this one is tilted."
    return labels.without_closed_forms(plan, "polarization")


def stokes(plan: Plan, observer: Observer, directions: Float[np.ndarray, "N 3"]) -> Stokes:
    """What comes from local `directions` (N, 3) of the observer's tetrad, of all orders that are kept and shown; where `why_not` is empty."""
    total = np.zeros((3, len(directions)))
    passes = np.ones(len(directions))
    still = np.arange(len(directions))  # rays that have neither fallen in nor escaped
    for order in range(plan.orders):
        r = lensed_circles.crossing_radius(lensed_circles.light(observer, directions[still]), np.array(order))
        shines = (r >= plan.disk_edge) & (r <= plan.disk_outer)
        met_here = still[shines]
        still = still[(r > 0.0) & np.isfinite(r)]
        if len(met_here) and _ONLY_ORDER.get(plan.scene.disk.orders_shown, order) == order:
            total[:, met_here] += passes[met_here] * _of_crossing(plan, observer, directions[met_here], r[shines], order)
            if plan.scene.disk.compositing == "opacity":
                passes[met_here] *= 1.0 - plan.scene.disk.opacity
    return Stokes(*total)


def _of_crossing(plan: Plan, observer: Observer, directions: Float[np.ndarray, "K 3"], r: Float[np.ndarray, " K"], order: int) -> Float[np.ndarray, "3 K"]:
    """I, Q, U of the light that leaves the disk at `r` (r_s)."""
    scene, spin = plan.scene, observer.spin
    disk = scene.disk
    light = lensed_circles.light(observer, directions)
    momentum = lensed_circles.crossing_momentum(light, np.array(order), r)
    is_synchrotron = scene.polarization.emission == "synchrotron"
    field = _field(scene) if is_synchrotron else MagneticField()
    left = polarization.emitted(r, momentum, _velocity(plan, r), field.local, spin)
    temperature = _temperature(plan, r)
    shift = left.g / light.energy
    bright, degree = _emission(left, is_synchrotron)
    i = temperature**4 * shift**disk.beaming_exponent * bright
    vectors = polarization.arriving(observer, directions, left.constant)
    angle = polarization.position_angle(observer, directions, vectors)
    share = np.where(np.isfinite(angle), i * degree, 0.0)  # straight along the field, or the normal, there is none
    angle = np.nan_to_num(angle)
    return np.stack([i, share * np.cos(2.0 * angle), share * np.sin(2.0 * angle)])


def _field(scene: Scene) -> MagneticField:
    return MagneticField(scene.polarization.field_vertical, scene.polarization.field_radial, scene.polarization.field_toroidal)


def _velocity(plan: Plan, r: Float[np.ndarray, " K"]) -> Float[np.ndarray, "K 3"]:
    """Of the matter at `r` (r_s), in the frame of zero angular momentum: on circular orbits, or falling in from the innermost stable one."""
    spin, orbit = plan.space_time.spin, plan.scene.disk.orbit
    inside = r < plan.space_time.isco_radius(plan.scene.disk)
    found = polarization.circular_velocity(np.where(inside, plan.disk_outer, r), spin, orbit)
    found[inside] = polarization.falling_velocity(r[inside], spin, orbit)
    return found


def _temperature(plan: Plan, r: Float[np.ndarray, " K"]) -> Float[np.ndarray, " K"]:
    """T/T_peak at `r` (r_s) by the table that pictures of the disk use."""
    disk, edge, outer = plan.scene.disk, plan.disk_edge, plan.disk_outer
    table = _table(disk.temperature_law, plan.space_time.spin, disk.orbit, plan.disk_inner, outer, torque=disk.inner_torque, edge=edge)
    way = np.sqrt(np.clip((r - edge) / (outer - edge), 0.0, 1.0))
    return np.interp(way, (np.arange(len(table)) + 0.5) / len(table), table)


_table = lru_cache(maxsize=4)(disk_profile.table)


def _emission(left: PolarizedLight, is_synchrotron: bool) -> tuple[Float[np.ndarray, "*rays"], Float[np.ndarray, "*rays"]]:
    """How bright the light is by its direction, and the polarized share of it."""
    if is_synchrotron:
        return left.sine**2, np.full_like(left.sine, SYNCHROTRON_DEGREE)
    return scattering_atmosphere.limb(left.rise), scattering_atmosphere.degree(left.rise)


def directions_at(observer: Observer, scene: Scene, aspect: float, places: Float[np.ndarray, "N 2"]) -> Float[np.ndarray, "N 3"]:
    """The local directions (N, 3) of the observer's tetrad that `places` (right, down) of a picture show, in its heights: the inverse of `labels.places`.

    Unit vectors, but for a far observer, whose rays are parallel.
    """
    half = projection.half_height(scene.camera)
    right, down = half * (2.0 * places[:, 0] - aspect), half * (2.0 * places[:, 1] - 1.0)
    found = np.stack([-np.ones_like(right), down, right], axis=-1) @ observer.look.T
    return found if observer.w == 0.0 else found / np.linalg.norm(found, axis=-1, keepdims=True)


def ticks(scene: Scene, aspect: float, *, moving: bool = False) -> Labels:
    """Ticks along the polarization over a picture of `scene` whose width is `aspect` heights, as long as the fourth root of the polarized light; or a note
    why there are none.

    Args:
        moving: for a picture that the next one replaces; through a beam they are then worked out from fewer rays.

    Raises:
        SceneError, ValueError: the scene cannot be drawn; the text says why.
    """
    return _ticks(shape_of(scene), aspect, _SAMPLES_IN_MOTION if moving and scene.post.beam else _SAMPLES_A_SIGMA)


def shape_of(scene: Scene) -> Scene:
    """`scene` with nothing but what ticks depend on."""
    disk, bare = scene.disk, Scene()
    kept = {
        name: getattr(disk, name)
        for name in (
            "enabled", "inner_radius", "outer_radius", "orbit", "plunging", "inner_torque", "temperature_law", "beaming_exponent", "compositing", "opacity",
            "orders_shown",
        )  # fmt: skip
    }
    made = replace(
        bare, hole=scene.hole, camera=replace(scene.camera, azimuth_deg=0.0), rays=scene.rays, disk=replace(bare.disk, **kept), things=scene.things,
        media=scene.media, polarization=scene.polarization,
    )  # fmt: skip
    return replace(made, source=scene.source, post=replace(bare.post, beam=True, beam_uas=scene.post.beam_uas)) if scene.post.beam else made


@lru_cache(maxsize=4)
def _ticks(scene: Scene, aspect: float, samples: float) -> Labels:
    plan = make_plan(scene)
    if why := why_not(plan):
        return Labels(note=why, note_line=1)  # below that of labels
    observer, rows = observe(scene), scene.polarization.tick_rows
    columns = max(round(rows * aspect), 1)
    x, y = np.meshgrid((np.arange(columns) + 0.5) / columns * aspect, (np.arange(rows) + 0.5) / rows)
    places = np.stack([x.ravel(), y.ravel()], axis=-1)
    directions = directions_at(observer, scene, aspect, places)
    found = _through_beam(plan, observer, aspect, x[0], y[:, 0], samples) if scene.post.beam else stokes(plan, observer, directions)
    light = found.polarized
    shown = light > _LEAST_SHARE * light.max(initial=0.0)
    half = 0.5 * _LENGTH / rows * (light[shown] / light.max(initial=1e-300)) ** 0.25
    beside = directions[shown] + _NUDGE * polarization.direction_of(observer, directions[shown], found.angle[shown])
    step = labels.places(observer, scene, aspect, beside) - places[shown]
    step *= (half / np.linalg.norm(step, axis=-1))[:, None]
    ends = np.stack([places[shown] - step, places[shown] + step, np.full_like(step, np.nan)], axis=1).reshape(-1, 2)
    return Labels(curves=(Curve(ends, _DARK, 3.4), Curve(ends, TICKS, 1.7)))


def _through_beam(
    plan: Plan, observer: Observer, aspect: float, right: Float[np.ndarray, " columns"], down: Float[np.ndarray, " rows"], samples: float
) -> Stokes:
    """The light at the crossings of columns `right` and rows `down` through the scene's beam: each of I, Q, U is a mean over a grid, of `samples` to its σ."""
    scene = plan.scene
    sigma = sigma_px(scene, 1)
    rows = int(np.clip(np.ceil(samples / sigma), len(down), _FINEST * len(down)))
    columns = max(round(rows * aspect), 1)
    x, y = (np.arange(columns) + 0.5) / columns * aspect, (np.arange(rows) + 0.5) / rows
    places = np.stack([np.tile(x, rows), np.repeat(y, columns)], axis=-1)
    fine = stokes(plan, observer, directions_at(observer, scene, aspect, places))
    sideways, upwards = _weights(right, x, sigma), _weights(down, y, sigma)
    return Stokes(*((upwards @ part.reshape(rows, columns) @ sideways.T).ravel() for part in (fine.i, fine.q, fine.u)))


def _weights(at: Float[np.ndarray, " n"], samples: Float[np.ndarray, " m"], sigma: float) -> Float[np.ndarray, "n m"]:
    """A Gaussian's at `samples`, equally spaced, about each of `at`, of a total of 1 where none is beyond the edge; there is no light."""
    spacing = samples[1] - samples[0] if len(samples) > 1 else 1.0
    width = max(sigma, 0.5 * spacing)
    return spacing / (width * np.sqrt(2.0 * np.pi)) * np.exp(-0.5 * ((at[:, None] - samples) / width) ** 2)
