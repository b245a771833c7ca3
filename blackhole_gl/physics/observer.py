"""The observer: where the camera is, how it moves, where it looks, and what a ray starts with. All in float64.

A local direction n = (n_r, n_θ, n_φ) of the observer's orthonormal frame is where a pixel looks; the photon's momentum is −n.
Looking at the hole is (−1, 0, 0); right on the screen is +e_φ, up is −e_θ. A camera that looks elsewhere turns this frame: `look_rotation`.

Everything that a ray starts with is linear in (1, n): one 4×4 matrix, ``tetrad · boost · look``, `Observer.observer_map`, serves every observer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from ..scene import Camera, Scene, SceneError
from ..shapes import Float
from . import observer_frames
from .space_time import SpaceTime, space_time

# Half a picture's height at distance 1 per degree of view is no more than this; a direction to the hole less ahead than its inverse is off every screen.
_LEAST_AHEAD = 1e-3

RESTING = ("static", "zamo")
"""The observers that there are in flat space, too."""

FALLING = ("rain", "fall")
"""The observers that may be inside a horizon."""

NOWHERE = (1e6, 1e6)
"""Where the direction to a hole that is not ahead meets a screen at distance 1: far off every picture."""

_INWARDS = np.array([-1.0, 0.0, 0.0])
_SEEN = np.array([1.0, 0.0, 0.0, 0.0])
_BOTH_SEEN = np.stack([_SEEN, _SEEN])


@dataclass(frozen=True)
class Observer:
    """The camera in the space-time of a scene's ray model.

    Attributes:
        kind: ``static``, ``zamo``, ``circular``, ``rain``, ``fall`` or ``infinity``, as used (a static observer gives way to the ZAMO in the ergosphere).
        spin: a* of the space-time the observer sits in (0 in Schwarzschild and flat space).
        w: M/r; 0 at infinity.
        n, e_theta, e_phi: world unit vectors at the camera's place, float64 (3,).
        tetrad: float64 (4, 4): (E, w', n'_θ, n'_φ) = tetrad · (1, n_r, n_θ, n_φ), still to be divided by E; primes are derivatives in Mino time
            (M = 1) along the ray traced backwards (docs/physics.md). Of the moving observer, or of one at rest in his place where aberration is off.
        look: float64 (3, 3) rotation of the view: n = look · v, with v = (−1, 0, 0) for the middle of the picture.
        frame: that of `kind` at finite distance, before any boost.
        moves: float64 (4, 4): (E, n) in that frame from (1, n), where the camera moves in it.
        hole: local unit vector (3,) to the hole's centre, as the aberration of straight inwards has it.
        colour, beaming: float64 (4,): the energy that light from n shows, · (1, n), as it counts for colours and for brightness: (1, 0, 0, 0) unless the
            observer's motion is not to count.
    """

    kind: str
    spin: float
    w: float
    n: Float[np.ndarray, " 3"]
    e_theta: Float[np.ndarray, " 3"]
    e_phi: Float[np.ndarray, " 3"]
    tetrad: Float[np.ndarray, "4 4"]
    look: Float[np.ndarray, "3 3"]
    frame: observer_frames.Frame | None = None
    moves: Float[np.ndarray, "4 4"] | None = None
    hole: Float[np.ndarray, " 3"] = field(default_factory=lambda: _INWARDS)
    colour: Float[np.ndarray, " 4"] = field(default_factory=lambda: _SEEN)
    beaming: Float[np.ndarray, " 4"] = field(default_factory=lambda: _SEEN)

    @cached_property
    def zamo(self) -> Float[np.ndarray, "4 4"] | None:
        """(E, n) in the frame of zero angular momentum from (1, n), float64 (4, 4); None inside the horizon, and for a camera at infinity."""
        still = None if self.frame is None else self.frame.zamo
        return still if still is None or self.moves is None else still @ self.moves

    @cached_property
    def observer_map(self) -> Float[np.ndarray, "4 4"]:
        """tetrad · look, float64 (4, 4): what a pixel's ray starts with from (1, v)."""
        return self._of_view(self.tetrad)

    @cached_property
    def shown_energies(self) -> Float[np.ndarray, "2 4"]:
        """`colour` and `beaming` from (1, v), float64 (2, 4)."""
        if self.colour is _SEEN and self.beaming is _SEEN:
            return _BOTH_SEEN
        return self._of_view(np.stack([self.colour, self.beaming]))

    def energies(self, directions: Float[np.ndarray, "*rays 3"]) -> Float[np.ndarray, "*rays"]:
        """E_infinity/E_observer (…) of light from local `directions` (…, 3), as colours have it; 1 for a far observer."""
        if self.w == 0.0:
            return np.ones(np.shape(directions)[:-1])
        local = np.asarray(directions, float)
        return (self.tetrad[0, 0] + local @ self.tetrad[0, 1:]) / (self.colour[0] + local @ self.colour[1:])

    def _of_view(self, rows: Float[np.ndarray, "rows 4"]) -> Float[np.ndarray, "rows 4"]:
        turned = rows.copy()
        turned[:, 1:] = rows[:, 1:] @ self.look
        return turned

    @cached_property
    def axes(self) -> Float[np.ndarray, "3 3"]:
        """World unit vectors of the view, float64 rows (3, 3): backwards, down and right on the screen: n, e_θ, e_φ for a camera that looks at the hole."""
        return self.look.T @ np.stack([self.n, self.e_theta, self.e_phi])

    @cached_property
    def hole_on_screen(self) -> tuple[float, float]:
        """Where the direction to the hole meets a screen at distance 1 ahead, (right, up); far off the picture for a hole that is not ahead."""
        back, down, right = self.hole @ self.look
        return (-right / back, down / back) if back < -_LEAST_AHEAD else NOWHERE


def cos_sin_deg(degrees: float) -> tuple[float, float]:
    """(cos, sin) of an angle in degrees, exact at the multiples of 90°."""
    quarter, rest = divmod(degrees, 90.0)
    c, s = math.cos(math.radians(rest)), math.sin(math.radians(rest))
    return ((c, s), (-s, c), (-c, -s), (s, -c))[int(quarter) % 4]


def observe(scene: Scene) -> Observer:
    """The observer of `scene`.

    Raises:
        ValueError: the camera is not outside the horizon, or there is no such observer in its place; the text says why.
    """
    where, camera = space_time(scene), scene.camera
    look, n = look_rotation(camera), outwards(camera)
    cos_theta, sin_theta = cos_sin_deg(camera.inclination_deg)
    cos_phi, sin_phi = cos_sin_deg(camera.azimuth_deg)
    e_theta = np.array([cos_theta * cos_phi, cos_theta * sin_phi, -sin_theta])
    e_phi = np.array([-sin_phi, cos_phi, 0.0])
    if math.isinf(camera.distance):
        observer_frames.refuse_far(camera)
        return Observer("infinity", where.observer_spin, 0.0, n, e_theta, e_phi, np.diag([1.0, -1.0, 1.0, 1.0]), look)
    _refuse_inside(camera, where)
    r = 2.0 * camera.distance  # M = 1 from here on
    flat = where.kind == "flat"
    frame = observer_frames.flat_frame(r, camera) if flat else observer_frames.hole_frame(r, cos_theta, sin_theta, where, camera)
    seen = Observer(frame.kind, 0.0 if flat else where.observer_spin, 1.0 / r, n, e_theta, e_phi, frame.tetrad, look, frame)
    return _moving(seen, frame, camera)


def outwards(camera: Camera) -> Float[np.ndarray, " 3"]:
    """Unit vector (3,) in the world from the hole to `camera`."""
    cos_theta, sin_theta = cos_sin_deg(camera.inclination_deg)
    cos_phi, sin_phi = cos_sin_deg(camera.azimuth_deg)
    return np.array([sin_theta * cos_phi, sin_theta * sin_phi, cos_theta])


def is_possible(scene: Scene) -> bool:
    """Whether there is an observer where the camera of `scene` is, in the space-time of its ray model."""
    try:
        observe(scene)
    except SceneError:
        return False
    return True


def is_moving(camera: Camera) -> bool:
    """Whether the observer of `camera` moves against one at rest in his place."""
    return camera.observer not in RESTING or any((camera.velocity_right, camera.velocity_up, camera.velocity_forward))


def _moving(seen: Observer, frame: observer_frames.Frame, camera: Camera) -> Observer:
    """`seen` with the boost of `camera`, and with what of its motion is to be seen."""
    if not is_moving(camera):
        return seen
    moves = observer_frames.lorentz(observer_frames.boost(camera))
    if frame.zamo is None:
        return _moving_inside(seen, moves, camera)
    zamo = frame.zamo @ moves
    motion = np.linalg.solve(frame.rest, zamo)  # (E, n) at rest there from the observer's (1, n)
    energies = {True: _SEEN, False: motion[0]}
    if not camera.aberration:
        at_rest = np.linalg.inv(motion)
        energies = {True: at_rest[0], False: _SEEN}
        moves = np.linalg.solve(frame.zamo, frame.rest)
    hole = np.linalg.solve(zamo, frame.rest @ np.array([1.0, *_INWARDS]))[1:] if camera.aberration else _INWARDS
    return replace(
        seen,
        tetrad=seen.tetrad @ moves,
        moves=moves,
        hole=hole / np.linalg.norm(hole),
        colour=energies[camera.doppler_colour],
        beaming=energies[camera.beaming],
    )


def _moving_inside(seen: Observer, moves: Float[np.ndarray, "4 4"], camera: Camera) -> Observer:
    """The same inside the horizon, where nobody can be at rest to leave a part of the motion to.

    Raises:
        SceneError: a part of it is switched off.
    """
    for name in ("aberration", "doppler_colour", "beaming"):
        if not getattr(camera, name):
            text = "got false; inside the horizon all is in motion, and there is nobody at rest to see without: allowed is true"
            raise SceneError(f"camera.{name}", text)
    hole = np.linalg.solve(moves, np.array([1.0, *_INWARDS]))[1:]
    return replace(seen, tetrad=seen.tetrad @ moves, moves=moves, hole=hole / np.linalg.norm(hole))


def least_distance(scene: Scene) -> float:
    """Radius in r_s that the camera of `scene` has to be outside of: the horizon, or for one that falls the innermost that it is followed to."""
    where = space_time(scene)
    return where.innermost_camera if scene.camera.observer in FALLING else where.horizon_radius


def look_rotation(camera: Camera) -> Float[np.ndarray, "3 3"]:
    """The rotation (3, 3) in (r, θ, φ) of a camera's look: rolled about the line of sight, then pitched, then yawed, as a head turns.

    Positive yaw looks to the right, positive pitch up; positive roll turns the camera clockwise, and so the picture counter-clockwise.

    Raises:
        SceneError: a camera at infinity looks aside; its rays are parallel.
    """
    if math.isinf(camera.distance):
        for name in ("yaw_deg", "pitch_deg"):
            if getattr(camera, name):
                text = f"got {getattr(camera, name):g}; a camera at infinity has parallel rays, so allowed is 0 (camera.roll_deg turns its picture)"
                raise SceneError(f"camera.{name}", text)
    return _turned(camera.yaw_deg, camera.pitch_deg, camera.roll_deg, camera.dome_tilt_deg if camera.projection == "dome" else None)


@lru_cache(maxsize=16)
def _turned(yaw_deg: float, pitch_deg: float, roll_deg: float, dome_tilt_deg: float | None) -> Float[np.ndarray, "3 3"]:
    (cy, sy), (cp, sp), (cr, sr) = map(cos_sin_deg, (yaw_deg, pitch_deg, roll_deg))
    # In (r, θ, φ) = (back, down, right): ahead is −r, up is −θ.
    yaw = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])  # takes ahead to ahead·cos + right·sin
    pitch = np.array([[cp, -sp, 0.0], [sp, cp, 0.0], [0.0, 0.0, 1.0]])  # takes ahead to ahead·cos + up·sin
    roll = np.array([[1.0, 0.0, 0.0], [0.0, cr, sr], [0.0, -sr, cr]])  # takes right to right·cos + down·sin
    turned = yaw @ pitch @ roll
    if dome_tilt_deg is not None:
        ct, st = cos_sin_deg(dome_tilt_deg)
        turned = turned @ np.array([[ct, -st, 0.0], [st, ct, 0.0], [0.0, 0.0, 1.0]])
    turned.setflags(write=False)
    return turned


def _refuse_inside(camera: Camera, where: SpaceTime) -> None:
    """Raises SceneError where `camera` is not outside the horizon, unless it falls and light is traced from there."""
    horizon = where.horizon_radius
    if camera.distance > horizon:
        return
    text = f"got {camera.distance:g} r_s; at spin {where.horizon_spin:g} the horizon is at {horizon:.6g} r_s"
    if camera.observer not in FALLING:
        raise SceneError("camera.distance", f"{text} and the camera must be outside it: nothing rests or circles inside, where only rain and fall are")
    if not where.crosses_horizon:
        raise SceneError("camera.distance", f"{text} and this ray model does not lead through it: allowed inside are rays.model kerr and auto")
    if camera.distance < where.innermost_camera:
        raise SceneError("camera.distance", f"{text} and a fall is followed down to {where.innermost_camera:.6g} r_s: allowed is that at least")


def local_directions(psi: ArrayLike, chi: ArrayLike) -> Float[np.ndarray, "*rays 3"]:
    """Local directions (…, 3) from ψ (angle from the hole's centre) and χ (angle on the screen from right towards up), radians."""
    away, round_ = np.broadcast_arrays(np.asarray(psi, float), np.asarray(chi, float))
    return np.stack([-np.cos(away), -np.sin(away) * np.sin(round_), np.sin(away) * np.cos(round_)], axis=-1)


def screen_angles(directions: Float[np.ndarray, "*rays 3"]) -> tuple[Float[np.ndarray, "*rays"], Float[np.ndarray, "*rays"]]:
    """(ψ, χ), each (…), of local directions (…, 3): what `local_directions` takes."""
    n_r, n_theta, n_phi = np.moveaxis(np.asarray(directions, float), -1, 0)
    return np.arctan2(np.hypot(n_theta, n_phi), -n_r), np.arctan2(-n_theta, n_phi)


def parallel_rays(alpha: ArrayLike, beta: ArrayLike) -> Float[np.ndarray, "*rays 3"]:
    """Local vectors (…, 3) of a far observer's parallel rays at screen coordinates α (right), β (up), in M."""
    right, up = np.broadcast_arrays(np.asarray(alpha, float), np.asarray(beta, float))
    return np.stack([-np.ones_like(right), -up, right], axis=-1)
