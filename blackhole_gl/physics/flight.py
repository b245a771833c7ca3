"""Flights: a scene at every second of a film, by keyframes and, if one likes, on a way that gravity decides. Their files: `flight_files`.

Numbers run through their keys on monotone cubics (Fritsch & Carlson 1980): smooth, and never beyond the keys on either side. All else changes at its key.
The clock of matter that falls like rain is the time of its coordinates (Doran 2000), in which the scene's time then runs, through the horizon, too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np

from ..scene import Scene, Value
from ..shapes import Float
from .observer import cos_sin_deg
from .relativity import horizon_radius, inner_horizon_radius, orbital_frequency, orbital_u_t, zamo_lapse
from .space_time import space_time

WAYS = ("rain", "orbit")
_FALL_SAMPLES = 4096
_ABOVE = 1.001  # inner horizons: a fall ends just above


@dataclass(frozen=True)
class Keyframe:
    """Values of the scene, by dotted key, `at` seconds of the film."""

    at: float
    values: Mapping[str, Value]


@dataclass(frozen=True)
class Note:
    """What is said of what is seen from `at` on, seconds of the film."""

    at: float
    text: str


@dataclass(frozen=True)
class Way:
    """A way that gravity decides: `kind`, of `WAYS`, by `rate` r_s/c of the traveller's clock a second, from `distance` in r_s (the scene's when None).

    A fall that `slows` has this rate at its beginning alone, and then as much less as its radius is: the last r_s would be over in a tenth of a second else.
    """

    kind: Literal["rain", "orbit"]
    rate: float
    distance: float | None = None
    slows: bool = False


@dataclass(frozen=True)
class Moment:
    """A flight at one second of its film.

    Attributes:
        scene, time: what is seen, at which scene time in r_s/c.
        proper_time: of the traveller since the start, r_s/c; NaN without a way.
        far_time: since the start far away, r_s/c; infinite at the horizon and below.
        speed: of the traveller against the observer of zero angular momentum in his place, in c; 1 at the horizon, more below.
    """

    scene: Scene
    time: float
    proper_time: float = math.nan
    far_time: float = math.nan
    speed: float = math.nan


@dataclass(frozen=True)
class Flight:
    """Keys in the order of time, and maybe a way, through a scene.

    Attributes:
        rate: scene time in r_s/c that passes in one second without a way.
        notes: in the order of time.
    """

    scene: Scene
    keys: tuple[Keyframe, ...] = ()
    rate: float = 4.0
    way: Way | None = None
    title: str = ""
    start: float = 0.0
    notes: tuple[Note, ...] = ()
    _tracks: Mapping[str, _Track] = field(default_factory=dict, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_tracks", {key: _track(self.scene, self.keys, key) for key in _keyed(self.keys)})

    @property
    def seconds(self) -> float:
        """The film's length: of its keys, or of its fall; infinite where neither ends it."""
        if self.keys and self.keys[-1].at > 0.0:
            return self.keys[-1].at
        return self._fall_seconds[-1] if self.way and self.way.kind == "rain" else math.inf

    def at(self, seconds: float) -> Moment:
        """The moment `seconds` from the film's start; before its first and after its last key it stays as there.

        Raises:
            SceneError: the scene cannot have such values.
        """
        scene = self.scene.with_values({key: track.at(seconds) for key, track in self._tracks.items()})
        if self.way is None:
            return Moment(scene, self.start + self.rate * seconds)
        return self._falling(scene, seconds) if self.way.kind == "rain" else self._orbiting(scene, self.way.rate * seconds)

    def note_at(self, seconds: float) -> str:
        """What is said there; empty where nothing is."""
        return next((note.text for note in reversed(self.notes) if note.at <= seconds), "")

    def _falling(self, scene: Scene, seconds: float) -> Moment:
        fall = self._fall
        proper = float(np.interp(seconds, self._fall_seconds, fall.proper_time))
        r, far, speed = (float(np.interp(proper, fall.proper_time, values)) for values in (fall.radius, fall.far_time, fall.speed))
        return Moment(scene.with_values({"camera.distance": r, "camera.observer": "rain"}), self.start + proper, proper, far, speed)

    def _orbiting(self, scene: Scene, proper: float) -> Moment:
        spin = space_time(scene).observer_spin
        r = self._distance
        far = float(orbital_u_t(r, spin)) * proper
        turned = math.degrees(float(orbital_frequency(r, spin)) * far)
        azimuth = math.remainder(float(scene.camera.azimuth_deg) + turned, 360.0)
        values = {"camera.distance": self._distance, "camera.observer": "circular", "camera.azimuth_deg": azimuth}
        lapse = float(zamo_lapse(r, math.pi / 2, spin))
        gamma = lapse * float(orbital_u_t(r, spin))
        return Moment(scene.with_values(values), self.start + far, proper, far, math.sqrt(max(1.0 - 1.0 / gamma**2, 0.0)))

    @property
    def _distance(self) -> float:
        return self.way.distance if self.way and self.way.distance is not None else self.scene.camera.distance

    @cached_property
    def _fall_seconds(self) -> Float[np.ndarray, " N"]:
        """Of the film, at the samples of the fall."""
        way, fall = self.way, self._fall
        assert way is not None
        return (fall.slowed_time if way.slows else fall.proper_time) / way.rate

    @cached_property
    def _fall(self) -> _Fall:
        where = space_time(self.scene)
        low = self.scene.field("camera.distance").low
        return _fall(self._distance, where.observer_spin, self.scene.camera.inclination_deg, low)


def _keyed(keys: tuple[Keyframe, ...]) -> list[str]:
    return sorted({key for keyframe in keys for key in keyframe.values})


@dataclass(frozen=True)
class _Track:
    """One value of the scene over the film, at the keys that set it."""

    times: Float[np.ndarray, " K"]
    values: tuple[Value, ...]
    slopes: Float[np.ndarray, " K"] | None

    def at(self, seconds: float) -> Value:
        k = min(max(int(np.searchsorted(self.times, seconds, side="right")) - 1, 0), len(self.times) - 1)
        if self.slopes is None or k + 1 == len(self.times) or seconds <= self.times[0]:
            return self.values[k]
        width = self.times[k + 1] - self.times[k]
        t = (seconds - self.times[k]) / width
        left, right = float(self.values[k]), float(self.values[k + 1])  # type: ignore[arg-type]
        a, b = width * self.slopes[k], width * self.slopes[k + 1]
        return float(left + t * (a + t * (3.0 * (right - left) - 2.0 * a - b + t * (a + b - 2.0 * (right - left)))))


def _track(scene: Scene, keys: tuple[Keyframe, ...], key: str) -> _Track:
    there = [keyframe for keyframe in keys if key in keyframe.values]
    times = np.array([keyframe.at for keyframe in there])
    values = tuple(keyframe.values[key] for keyframe in there)
    runs = scene.field(key).kind == "float" and all(math.isfinite(value) for value in values)  # type: ignore[arg-type]
    return _Track(times, values, _monotone_slopes(times, np.array(values, float)) if runs else None)


def _monotone_slopes(times: Float[np.ndarray, " K"], values: Float[np.ndarray, " K"]) -> Float[np.ndarray, " K"]:
    """Slopes at the keys with which cubics between them are monotone where the keys are (Fritsch & Carlson 1980); 0 at the ends: a flight eases in and out."""
    slopes = np.zeros(len(times))
    if len(times) > 2:
        secants = np.diff(values) / np.diff(times)
        before, after = secants[:-1], secants[1:]
        same_way = before * after > 0.0
        mean = np.where(same_way, 0.5 * (before + after), 0.0)
        # No more than three times the lesser of both secants keeps each piece monotone.
        slopes[1:-1] = np.sign(mean) * np.minimum(np.abs(mean), 3.0 * np.minimum(np.abs(before), np.abs(after)))
    return slopes


@dataclass(frozen=True)
class _Fall:
    """A fall like rain, sampled along its proper time: radius in r_s, times in r_s/c, speed in c.

    `slowed_time` is that of a clock which runs as much slower than the traveller's as the radius is smaller than at the beginning.
    """

    proper_time: Float[np.ndarray, " N"]
    slowed_time: Float[np.ndarray, " N"]
    radius: Float[np.ndarray, " N"]
    far_time: Float[np.ndarray, " N"]
    speed: Float[np.ndarray, " N"]


def _fall(distance: float, spin: float, inclination_deg: float, least: float) -> _Fall:
    """From rest at infinity with no angular momentum, at constant θ, from `distance` on (Doran 2000).

    With M = 1: dτ = −Σ dr / √(2r(r² + a²)), dt = A/(ΔΣ) dτ. In x = r^{3/2} the first integrand is smooth down to the centre.
    """
    outer, inner = 2.0 * float(horizon_radius(spin)), 2.0 * float(inner_horizon_radius(spin))
    end = max(2.0 * least, _ABOVE * inner)
    start = 2.0 * distance
    x = np.linspace(start**1.5, end**1.5, _FALL_SAMPLES)
    r = x ** (2.0 / 3.0)
    cosine, sine = cos_sin_deg(inclination_deg)
    sigma = r * r + (spin * cosine) ** 2
    delta = (r - outer) * (r - inner)
    area = (r * r + spin * spin) ** 2 - delta * (spin * sine) ** 2
    by_x = sigma / np.sqrt(2.0 * r * (r * r + spin * spin)) * (2.0 / 3.0) / np.sqrt(r)
    outside = r > outer
    with np.errstate(divide="ignore", invalid="ignore"):
        dilation = np.where(outside, area / (delta * sigma), np.inf)
    proper = _integrated(by_x, -x)
    slowed = _integrated(by_x * 3.0 * start, -np.sqrt(r))  # start/r dτ, with dx = 3r d√r: smooth as well
    far = np.where(outside, _integrated(np.where(outside, by_x * dilation, 0.0), -x), np.inf)
    return _Fall(0.5 * proper, 0.5 * slowed, 0.5 * r, 0.5 * far, np.sqrt(2.0 * r * (r * r + spin * spin) / area))


def _integrated(rates: Float[np.ndarray, " N"], places: Float[np.ndarray, " N"]) -> Float[np.ndarray, " N"]:
    """From the first place to each, by the trapezium rule: of so smooth a function with 4096 pieces it errs by 1e-7 of the whole."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (rates[1:] + rates[:-1]) * np.diff(places))])
