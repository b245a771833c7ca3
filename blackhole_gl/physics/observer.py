"""The observer: where the camera is, how it moves, where it looks, and what a ray starts with. All in float64.

A local direction n = (n_r, n_θ, n_φ) of the observer's orthonormal frame is where a pixel looks; the photon's momentum is −n.
Looking at the hole is (−1, 0, 0); right on the screen is +e_φ, up is −e_θ. A camera that looks elsewhere turns this frame: `look_rotation`.

Everything that a ray starts with is linear in (1, n): one 4×4 matrix, ``tetrad · look``, `Observer.observer_map`, serves every observer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..scene import Camera, Scene, SceneError
from ..shapes import Float
from .space_time import space_time

# Half a picture's height at distance 1 per degree of view is no more than this; a direction to the hole less ahead than its inverse is off every screen.
_LEAST_AHEAD = 1e-3


@dataclass(frozen=True)
class Observer:
    """The camera in the space-time of a scene's ray model.

    Attributes:
        kind: ``static``, ``zamo`` or ``infinity``, as used (a static observer gives way to the ZAMO in the ergosphere).
        spin: a* of the space-time the observer sits in (0 in Schwarzschild and flat space).
        w: M/r; 0 at infinity.
        n, e_theta, e_phi: world unit vectors at the camera's place, float64 (3,).
        tetrad: float64 (4, 4): (E, w', n'_θ, n'_φ) = tetrad · (1, n_r, n_θ, n_φ), still to be divided by E; primes are derivatives in Mino time
            (M = 1) along the ray traced backwards (docs/physics.md).
        look: float64 (3, 3) rotation of the view: n = look · v, with v = (−1, 0, 0) for the middle of the picture.
    """

    kind: str
    spin: float
    w: float
    n: Float[np.ndarray, " 3"]
    e_theta: Float[np.ndarray, " 3"]
    e_phi: Float[np.ndarray, " 3"]
    tetrad: Float[np.ndarray, "4 4"]
    look: Float[np.ndarray, "3 3"]

    @cached_property
    def observer_map(self) -> Float[np.ndarray, "4 4"]:
        """tetrad · look, float64 (4, 4): what a pixel's ray starts with from (1, v)."""
        turned = self.tetrad.copy()
        turned[:, 1:] = self.tetrad[:, 1:] @ self.look
        return turned

    @cached_property
    def axes(self) -> Float[np.ndarray, "3 3"]:
        """World unit vectors of the view, float64 rows (3, 3): backwards, down and right on the screen: n, e_θ, e_φ for a camera that looks at the hole."""
        return self.look.T @ np.stack([self.n, self.e_theta, self.e_phi])

    @cached_property
    def hole_on_screen(self) -> tuple[float, float]:
        """Where the direction to the hole meets a screen at distance 1 ahead, (right, up); far off the picture for a hole that is not ahead."""
        ahead, down, right = -self.look[0] * np.array([-1.0, 1.0, 1.0])
        return (right / ahead, -down / ahead) if ahead > _LEAST_AHEAD else (1e6, 1e6)


def cos_sin_deg(degrees: float) -> tuple[float, float]:
    """(cos, sin) of an angle in degrees, exact at the multiples of 90°."""
    quarter, rest = divmod(degrees, 90.0)
    c, s = math.cos(math.radians(rest)), math.sin(math.radians(rest))
    return ((c, s), (-s, c), (-c, -s), (s, -c))[int(quarter) % 4]


def observe(scene: Scene) -> Observer:
    """The observer of `scene`.

    Raises:
        ValueError: the camera is not outside the horizon; the text says by how much.
    """
    where, camera = space_time(scene), scene.camera
    look = look_rotation(camera)
    cos_theta, sin_theta = cos_sin_deg(camera.inclination_deg)
    cos_phi, sin_phi = cos_sin_deg(camera.azimuth_deg)
    n = np.array([sin_theta * cos_phi, sin_theta * sin_phi, cos_theta])
    e_theta = np.array([cos_theta * cos_phi, cos_theta * sin_phi, -sin_theta])
    e_phi = np.array([-sin_phi, cos_phi, 0.0])
    if math.isinf(camera.distance):
        return Observer("infinity", where.observer_spin, 0.0, n, e_theta, e_phi, np.diag([1.0, -1.0, 1.0, 1.0]), look)
    r = 2.0 * camera.distance  # M = 1 from here on
    if where.kind == "flat":
        _outside(camera.distance, where.horizon_radius, where.horizon_spin)
        return Observer("static", 0.0, 1.0 / r, n, e_theta, e_phi, np.diag([1.0, -1.0, r, r]), look)
    kind, tetrad = _kerr_tetrad(r, cos_theta, sin_theta, where.observer_spin, camera.observer)
    return Observer(kind, where.observer_spin, 1.0 / r, n, e_theta, e_phi, tetrad, look)


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
    (cy, sy), (cp, sp), (cr, sr) = (cos_sin_deg(angle) for angle in (camera.yaw_deg, camera.pitch_deg, camera.roll_deg))
    # In (r, θ, φ) = (back, down, right): ahead is −r, up is −θ.
    yaw = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])  # takes ahead to ahead·cos + right·sin
    pitch = np.array([[cp, -sp, 0.0], [sp, cp, 0.0], [0.0, 0.0, 1.0]])  # takes ahead to ahead·cos + up·sin
    roll = np.array([[1.0, 0.0, 0.0], [0.0, cr, sr], [0.0, -sr, cr]])  # takes right to right·cos + down·sin
    return yaw @ pitch @ roll


def _outside(distance: float, horizon: float, a: float) -> None:
    """Raises ValueError where a camera at `distance` is not outside the horizon, both in r_s."""
    if distance <= horizon:
        raise ValueError(f"camera.distance: got {distance:g} r_s; at spin {a:g} the horizon is at {horizon:.6g} r_s and the camera must be outside it")


def _kerr_tetrad(r: float, cos_theta: float, sin_theta: float, a: float, observer: str) -> tuple[str, Float[np.ndarray, "4 4"]]:
    """Kind and tetrad of the observer, from the ZAMO's (Bardeen, Press & Teukolsky 1972, eq. 3.2), boosted along e_φ for the static observer."""
    r_plus = 1.0 + math.sqrt((1.0 - a) * (1.0 + a))
    _outside(0.5 * r, 0.5 * r_plus, a)
    sigma = r * r + (a * cos_theta) ** 2
    delta = (r - r_plus) * (r - (2.0 - r_plus))
    big_a = (r * r + a * a) ** 2 - delta * (a * sin_theta) ** 2
    lapse = math.sqrt(sigma * delta / big_a)
    omega = 2.0 * a * r / big_a
    ring = math.sqrt(big_a / sigma)
    beta = 0.0
    outside_ergosphere = r * r - 2.0 * r + (a * cos_theta) ** 2 > 0.0
    if observer == "static" and outside_ergosphere:
        beta = -omega * ring * sin_theta / lapse
    kind = "static" if observer == "static" and outside_ergosphere else "zamo"
    gamma = 1.0 / math.sqrt((1.0 - beta) * (1.0 + beta))
    drag = omega * ring * sin_theta
    matrix = np.zeros((4, 4))
    matrix[0, 0] = gamma * (lapse + drag * beta)
    matrix[0, 3] = -gamma * (lapse * beta + drag)
    matrix[1, 1] = -math.sqrt(delta * sigma) / (r * r)
    matrix[2, 2] = math.sqrt(sigma)
    matrix[3, 0] = -ring * gamma * beta
    matrix[3, 3] = ring * gamma
    return kind, matrix


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
