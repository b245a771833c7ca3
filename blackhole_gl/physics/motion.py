"""Where instances of a scene are at a scene time, and how they move there: places in r_s, velocities dx/dt with c = 1, all in float64.

Places are those that rays tell: x = r (sin θ cos φ, sin θ sin φ, cos θ), in Kerr with Boyer and Lindquist's r, θ and φ. Phases are wrapped before they become
single precision, so that nothing runs away after hours.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..scene import Instance, Scene, met
from ..scene.instances import Instances
from ..scene.plug_in import PlugIn
from ..scene.schema import number_of
from ..scene.traits import MetTraits
from ..shapes import Float
from . import relativity
from .moving_matter import own_time_squared
from .observer import cos_sin_deg
from .space_time import SpaceTime


@dataclass(frozen=True)
class Motion:
    """One instance at one scene time.

    Attributes:
        centre: float64 (3,), r_s.
        reach: r_s from there, beyond which no part of it lies: with `centre` its bounding sphere.
        velocity: dx/dt of the centre, float64 (3,); on a circle that is gone round faster than light can, of a slower one: `outruns_light`.
        spin: angular velocity about the centre, float64 (3,), rad c/r_s.
        attitude: unit quaternion (x, y, z, w), float64 (4,), that turns the instance's own axes to the world's.
        orbit_rate: of its circle about the hole, rad c/r_s; 0 where it is on none.
    """

    centre: Float[np.ndarray, " 3"]
    reach: float
    velocity: Float[np.ndarray, " 3"]
    spin: Float[np.ndarray, " 3"]
    attitude: Float[np.ndarray, " 4"]
    orbit_rate: float = 0.0


_STILL = np.zeros(3)
_UPRIGHT = np.array([0.0, 0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Mover:
    """An instance whose motion is another at another time: its place in the scene's order, and its name."""

    place: int
    name: str
    instance: Instance
    traits: MetTraits


def rows(scene: Scene, slot: str, where: SpaceTime, time: float) -> Float[np.ndarray, "instances 4 4"]:
    """The motion at `time` (r_s/c) of the instances of `slot`, ``thing`` or ``medium``, in the scene's order: centre and reach, velocity and
    the circle's rate, spin, attitude. Not to be written to: it is kept."""
    return _rows(met.named(scene, slot), met.kinds(scene, slot), where, time)


@lru_cache(maxsize=4)  # a frame asks for those of its time alone, again and again
def _rows(named: Instances, kinds: tuple[PlugIn, ...], where: SpaceTime, time: float) -> Float[np.ndarray, "instances 4 4"]:
    standing, moving = _parted(named, kinds)
    if not moving:
        return standing
    found = standing.copy()
    for mover in moving:
        found[mover.place] = _row(of(mover.instance, mover.traits, where, time))
    found.setflags(write=False)
    return found


def movers(scene: Scene, slot: str) -> tuple[Mover, ...]:
    """Those instances of `slot` that move or turn, in the scene's order."""
    return _parted(met.named(scene, slot), met.kinds(scene, slot))[1]


@lru_cache(maxsize=met.SCENES_KEPT)
def _parted(named: Instances, kinds: tuple[PlugIn, ...]) -> tuple[Float[np.ndarray, "instances 4 4"], tuple[Mover, ...]]:
    """The rows of those that stand, nothing in those of the others; and the others."""
    traits = {kind.key: kind.traits for kind in kinds}
    standing, moving = np.zeros((len(named), 4, 4)), []
    for place, (name, instance) in enumerate(named.items()):
        if _stands(instance, traits[instance.kind]):
            standing[place] = _row(_standing(instance, traits[instance.kind]))
        else:
            moving.append(Mover(place, name, instance, traits[instance.kind]))
    standing.setflags(write=False)
    return standing, tuple(moving)


def _row(motion: Motion) -> Float[np.ndarray, "4 4"]:
    return np.array([(*motion.centre, motion.reach), (*motion.velocity, motion.orbit_rate), (*motion.spin, 0.0), motion.attitude])


def of(instance: Instance, traits: MetTraits, where: SpaceTime, time: float) -> Motion:
    """The motion of `instance`, whose kind has `traits`, at scene time `time` (r_s/c)."""
    if _stands(instance, traits):
        return _standing(instance, traits)
    centre, velocity = (_at_rest(instance), _STILL) if instance.values["path"] == "fixed" else _on_circle(instance, where, time)
    velocity = _possible_share(centre, velocity, where) * velocity
    axis, attitude = _attitude(instance, time)
    rate = 0.0 if instance.values["path"] == "fixed" else orbit_rate(instance, where)
    return Motion(centre, met.extent(instance, traits), velocity, _number(instance, "turn_rate") * axis, attitude, rate)


def _stands(instance: Instance, traits: MetTraits) -> bool:
    """Whether its motion is the same at all times."""
    return not traits.moves or instance.values["path"] == "fixed" and instance.values["turn_rate"] == 0.0


def _standing(instance: Instance, traits: MetTraits) -> Motion:
    """The motion of an instance that stands."""
    if traits.moves:
        return Motion(_at_rest(instance), met.extent(instance, traits), _STILL, _STILL, _attitude(instance, 0.0)[1])
    centre = np.array([_number(instance, name) for name in traits.centre]) if traits.centre else _STILL
    return Motion(centre, met.extent(instance, traits), _STILL, _STILL, _UPRIGHT)


def moves(instance: Instance, traits: MetTraits) -> bool:
    """Whether rays meet `instance` elsewhere at another time."""
    turns = not traits.round and traits.moves and instance.values["turn_rate"] != 0.0
    return turns or traits.moves and instance.values["path"] != "fixed"


def outruns_light(instance: Instance, traits: MetTraits, where: SpaceTime) -> bool:
    """Whether `instance` is to go round its circle faster than matter can there; its light is shifted as if it were just slower."""
    if not traits.moves or instance.values["path"] == "fixed":
        return False
    return any(_possible_share(*_on_circle(instance, where, time), where) < 1.0 for time in _quarters(orbit_rate(instance, where)))


def _quarters(rate: float) -> list[float]:
    """Times at which a circle is at its highest, lowest and between: its speed limit is one of those there, as space-time is alike all round the axis."""
    return [0.5 * math.pi * quarter / abs(rate) if rate else 0.0 for quarter in range(4)]


def _possible_share(centre: Float[np.ndarray, " 3"], velocity: Float[np.ndarray, " 3"], where: SpaceTime) -> float:
    """The share of `velocity` that matter at `centre` can have: 1, or so much that its own time runs at a tenth of its rate at rest."""
    if not np.any(velocity) or math.hypot(centre[0], centre[1]) < 1e-9:
        return 1.0
    mass = 0.0 if where.kind == "flat" else 1.0
    clock = {share: float(own_time_squared(centre, share * velocity, where.observer_spin, mass)) for share in (-1.0, 0.0, 1.0)}
    rest, curved, slope = clock[0.0], 0.5 * (clock[1.0] + clock[-1.0]) - clock[0.0], 0.5 * (clock[1.0] - clock[-1.0])
    least = 0.01 * max(rest, 0.0)
    if clock[1.0] >= least or rest <= 0.0:
        return 1.0
    root = math.sqrt(max(slope * slope - 4.0 * curved * (rest - least), 0.0))
    return min((slope + root) / (-2.0 * curved), 1.0)


def _at_rest(instance: Instance) -> Float[np.ndarray, " 3"]:
    return np.array([_number(instance, name) for name in "xyz"])


def _on_circle(instance: Instance, where: SpaceTime, time: float) -> tuple[Float[np.ndarray, " 3"], Float[np.ndarray, " 3"]]:
    radius, rate = _number(instance, "orbit_radius"), orbit_rate(instance, where)
    cos_tilt, sin_tilt = cos_sin_deg(_number(instance, "orbit_tilt_deg"))
    cos_node, sin_node = cos_sin_deg(_number(instance, "orbit_node_deg"))
    along = np.array([cos_node, sin_node, 0.0])
    across = np.array([-cos_tilt * sin_node, cos_tilt * cos_node, sin_tilt])
    phase = math.radians(_number(instance, "orbit_phase_deg")) + math.remainder(rate * time, 2.0 * math.pi)
    outward = math.cos(phase) * along + math.sin(phase) * across
    onward = math.cos(phase) * across - math.sin(phase) * along
    return radius * outward, radius * rate * onward


def orbit_rate(instance: Instance, where: SpaceTime) -> float:
    """dφ/dt in rad c/r_s of an `instance` on a circle: counter-clockwise seen from +z is positive, where the circle is not tilted."""
    sense = str(instance.values["orbit_sense"])
    if instance.values["path"] == "geodesic":
        return float(relativity.orbital_frequency(_number(instance, "orbit_radius"), where.spin, sense))
    return _number(instance, "orbit_rate") * where.orbit_sense(sense)


def _attitude(instance: Instance, time: float) -> tuple[Float[np.ndarray, " 3"], Float[np.ndarray, " 4"]]:
    """The instance's own axis in the world, and what turns its axes to the world's: a turn about z, a lean towards x, a turn about z."""
    tilt, azimuth = (math.radians(_number(instance, name)) for name in ("axis_tilt_deg", "axis_azimuth_deg"))
    turn = math.radians(_number(instance, "turn_deg")) + math.remainder(_number(instance, "turn_rate") * time, 2.0 * math.pi)
    axis = np.array([math.sin(tilt) * math.cos(azimuth), math.sin(tilt) * math.sin(azimuth), math.cos(tilt)])
    difference, total = 0.5 * (azimuth - turn), 0.5 * (azimuth + turn)
    lean = math.sin(0.5 * tilt), math.cos(0.5 * tilt)
    # R_z(azimuth) R_y(tilt) R_z(turn) as a quaternion.
    return axis, np.array([-lean[0] * math.sin(difference), lean[0] * math.cos(difference), lean[1] * math.sin(total), lean[1] * math.cos(total)])


def _number(instance: Instance, name: str) -> float:
    return float(number_of(instance.values[name]))
