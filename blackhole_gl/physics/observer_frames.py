"""The frames that a camera may rest in: static, of zero angular momentum (ZAMO), on a circular geodesic, falling; and boosts between frames. Float64.

A frame's tetrad takes (1, n) of light that is seen in the local direction n = (n_r, n_θ, n_φ) to what its ray starts with (docs/physics.md). It is linear,
so that a frame that moves in another one at β has the tetrad of that one times `lorentz` (β). Inside, M = 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..scene import Camera, SceneError
from ..shapes import Float
from . import relativity
from .space_time import SpaceTime

# The components of a boost, and what each of them is along in (r, θ, φ).
_VELOCITY = (("velocity_forward", 0, -1.0), ("velocity_up", 1, -1.0), ("velocity_right", 2, 1.0))


@dataclass(frozen=True)
class Frame:
    """The frame of an observer, before any boost.

    Attributes:
        kind: ``static``, ``zamo``, ``circular``, ``rain`` or ``fall``, as used (a static observer gives way to the ZAMO in the ergosphere).
        tetrad: float64 (4, 4): (E, w', n'_θ, n'_φ) from (1, n).
        velocity: (r, θ, φ) against the frame of zero angular momentum there; what flat space has for it is at rest. None inside the horizon.
        rest_speed: of who is at rest there, along e_φ against that frame: static, or the ZAMO where that is asked for or nothing can rest.
    """

    kind: str
    tetrad: Float[np.ndarray, "4 4"]
    velocity: tuple[float, float, float] | None
    rest_speed: float

    @cached_property
    def zamo(self) -> Float[np.ndarray, "4 4"] | None:
        """(E, n) in the frame of zero angular momentum there from (1, n), (4, 4); None inside the horizon."""
        return None if self.velocity is None else lorentz(np.array(self.velocity))

    @cached_property
    def rest(self) -> Float[np.ndarray, "4 4"]:
        """The same from (1, n) of who is at rest there; without meaning inside the horizon."""
        return lorentz(np.array([0.0, 0.0, self.rest_speed]))


@dataclass(frozen=True)
class _Place:
    """Where the observer is, and the metric there: r in M, spin a, and what Boyer and Lindquist's coordinates are made of."""

    r: float
    cosine: float
    sine: float
    a: float

    @property
    def r_plus(self) -> float:
        return 1.0 + math.sqrt((1.0 - self.a) * (1.0 + self.a))

    @property
    def sigma(self) -> float:
        return self.r * self.r + (self.a * self.cosine) ** 2

    @property
    def delta(self) -> float:
        return (self.r - self.r_plus) * (self.r - (2.0 - self.r_plus))

    @property
    def big_a(self) -> float:
        return (self.r * self.r + self.a * self.a) ** 2 - self.delta * (self.a * self.sine) ** 2

    @property
    def lapse(self) -> float:
        return math.sqrt(self.sigma * self.delta / self.big_a)

    @property
    def omega(self) -> float:
        """dφ/dt of the ZAMO."""
        return 2.0 * self.a * self.r / self.big_a

    @property
    def ring(self) -> float:
        """√g_φφ over sin θ."""
        return math.sqrt(self.big_a / self.sigma)

    @property
    def has_rest(self) -> bool:
        """Whether anything can be at rest there: outside the ergosphere."""
        return self.r * self.r - 2.0 * self.r + (self.a * self.cosine) ** 2 > 0.0


def lorentz(velocity: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "4 4"]:
    """(E, n) in a frame, (4, 4) from (1, n) in one that moves in it at `velocity` (3,), |β| < 1, its axes not turned; light comes from n, so moves along −n."""
    square = float(velocity @ velocity)
    gamma = 1.0 / math.sqrt((1.0 - math.sqrt(square)) * (1.0 + math.sqrt(square)))
    matrix = np.eye(4)
    matrix[0, 0] = gamma
    matrix[0, 1:] = matrix[1:, 0] = -gamma * velocity
    matrix[1:, 1:] += gamma * gamma / (gamma + 1.0) * np.outer(velocity, velocity)
    return matrix


def boost(camera: Camera) -> Float[np.ndarray, " 3"]:
    """The velocity (3,) in (r, θ, φ) that `camera` has in its observer's frame.

    Raises:
        SceneError: it is not below that of light.
    """
    velocity = np.zeros(3)
    for name, axis, sign in _VELOCITY:
        velocity[axis] = sign * getattr(camera, name)
    speed = float(np.linalg.norm(velocity))
    if speed >= 1.0:
        name = max(_VELOCITY, key=lambda entry: abs(getattr(camera, entry[0])))[0]
        raise SceneError(f"camera.{name}", f"got {getattr(camera, name):g}, with the other two a speed of {speed:.4g} c; allowed is a speed below 1 c")
    return velocity


def refuse_far(camera: Camera) -> None:
    """For a camera at infinity, whose rays are parallel: SceneError where it moves. Its observers are all at rest there, but one that fell from somewhere."""
    if camera.observer == "fall":
        raise SceneError("camera.observer", "got fall for a camera at infinity; allowed there are static, zamo, circular and rain, which are all at rest")
    for name, _, _ in _VELOCITY:
        if getattr(camera, name):
            raise SceneError(f"camera.{name}", f"got {getattr(camera, name):g}; a camera at infinity has parallel rays, so allowed is 0")


def flat_frame(r: float, camera: Camera) -> Frame:
    """The frame at rest in flat space, at `r` in M.

    Raises:
        SceneError: another is asked for.
    """
    if camera.observer not in ("static", "zamo"):
        text = f"got {camera.observer}; in flat space, as with lensing off, nothing falls or circles: allowed are static and zamo, with a velocity of their own"
        raise SceneError("camera.observer", text)
    return Frame("static", np.diag([1.0, -1.0, r, r]), (0.0, 0.0, 0.0), 0.0)


def hole_frame(r: float, cosine: float, sine: float, where: SpaceTime, camera: Camera) -> Frame:
    """The frame of the observer of `camera` at `r` in M and the polar angle of that cosine and sine.

    Raises:
        SceneError: there is no such observer there.
    """
    place = _Place(r, cosine, sine, where.observer_spin)
    if camera.observer in ("rain", "fall"):
        return _falling(place, camera)
    kind = "zamo" if camera.observer != "zamo" and not place.has_rest else camera.observer
    if camera.observer == "circular":
        _refuse_circular(place, where, camera)
        kind = "circular"
    beta = _speed_round(place, kind)
    return Frame(kind, _turning(place, beta), (0.0, 0.0, beta), _rest_speed(place, camera.observer))


def _speed_round(place: _Place, kind: str) -> float:
    """Speed along e_φ, seen by the ZAMO."""
    if kind == "static":
        return -place.omega * place.ring * place.sine / place.lapse
    if kind == "circular":
        return (0.5 * float(relativity.orbital_frequency(0.5 * place.r, place.a)) - place.omega) * place.ring / place.lapse
    return 0.0


def _turning(place: _Place, beta: float) -> Float[np.ndarray, "4 4"]:
    """Tetrad of who moves at `beta` along e_φ: the ZAMO's (Bardeen, Press & Teukolsky 1972, eq. 3.2), boosted."""
    gamma = 1.0 / math.sqrt((1.0 - beta) * (1.0 + beta))
    drag = place.omega * place.ring * place.sine
    matrix = np.zeros((4, 4))
    matrix[0, 0] = gamma * (place.lapse + drag * beta)
    matrix[0, 3] = -gamma * (place.lapse * beta + drag)
    matrix[1, 1] = -math.sqrt(place.delta * place.sigma) / (place.r * place.r)
    matrix[2, 2] = math.sqrt(place.sigma)
    matrix[3, 0] = -place.ring * gamma * beta
    matrix[3, 3] = place.ring * gamma
    return matrix


def _rest_speed(place: _Place, observer: str) -> float:
    return _speed_round(place, "static" if place.has_rest and observer != "zamo" else "zamo")


def _falling(place: _Place, camera: Camera) -> Frame:
    """Who fell from rest: at infinity in Kerr at constant θ, Σ r' = −√(2r(r² + a²)); at `camera.fall_from` in Schwarzschild. No lapse is divided by."""
    if camera.observer == "rain":
        energy, beta = 1.0, math.sqrt(2.0 * place.r * (place.r * place.r + place.a * place.a) / place.big_a)
    else:
        _refuse_fall(place, camera)
        above = 1.0 - 1.0 / camera.fall_from
        energy, beta = math.sqrt(above), math.sqrt(max(2.0 / place.r - 1.0 / camera.fall_from, 0.0) / above)
    drag = place.omega * place.ring * place.sine
    matrix = np.zeros((4, 4))
    matrix[0] = energy, energy * beta, 0.0, -drag
    matrix[1, 0], matrix[1, 1] = -energy * beta * math.sqrt(place.big_a) / place.r**2, -energy * math.sqrt(place.big_a) / place.r**2
    matrix[2, 2] = math.sqrt(place.sigma)
    matrix[3, 3] = place.ring
    if place.r <= place.r_plus:
        return Frame(camera.observer, matrix, None, 0.0)
    return Frame(camera.observer, matrix, (-beta, 0.0, 0.0), _rest_speed(place, camera.observer))


def _refuse_circular(place: _Place, where: SpaceTime, camera: Camera) -> None:
    if place.a != 0.0 and camera.inclination_deg != 90.0:
        text = f"got circular at an inclination of {camera.inclination_deg:g}°; round a hole that spins such orbits lie in the equatorial plane: allowed is 90°"
        raise SceneError("camera.observer", text)
    innermost = float(relativity.photon_orbit_radius(place.a))
    if 0.5 * place.r <= innermost:
        text = f"got circular at {0.5 * place.r:g} r_s; allowed is outside the photon orbit at {innermost:.6g} r_s, within which nothing circles freely"
        raise SceneError("camera.observer", text)


def _refuse_fall(place: _Place, camera: Camera) -> None:
    if place.a != 0.0:
        raise SceneError("camera.observer", "got fall; round a hole that spins only the fall from infinity keeps to a closed form: allowed there is rain")
    if camera.distance > camera.fall_from:
        text = f"got {camera.fall_from:g} r_s for a camera at {camera.distance:g} r_s; a fall begins above: allowed is at least camera.distance"
        raise SceneError("camera.fall_from", text)


def ingoing_lag(distance: float, spin: float) -> float:
    """∫ a/Δ dr from `distance` (r_s) to infinity: by how much φ is ahead of the azimuth that stays along light that falls straight in. 0 inside the horizon."""
    half_gap = math.sqrt((1.0 - spin) * (1.0 + spin))  # of the horizons
    above = 2.0 * distance - 1.0 - half_gap
    return 0.5 * spin / half_gap * math.log1p(2.0 * half_gap / above) if math.isfinite(above) and above > 0.0 else 0.0
