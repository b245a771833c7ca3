"""The observer: where the camera is, how it moves, and what a ray starts with. All in float64.

A local direction n = (n_r, n_θ, n_φ) of the observer's orthonormal frame is where the camera looks; the photon's momentum is −n.
Looking at the hole is (−1, 0, 0); right on the screen is +e_φ, up is −e_θ.

Everything that a ray starts with is linear in (1, n): one 4×4 matrix, `Frame.observer_map`, serves every observer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..scene import Scene, catalogue
from . import relativity


@dataclass(frozen=True)
class Observer:
    """The camera in the space-time of a scene's ray model.

    Attributes:
        kind: ``static``, ``zamo`` or ``infinity``, as used (a static observer gives way to the ZAMO in the ergosphere).
        spin: a* of the space-time the observer sits in (0 in Schwarzschild and flat space).
        w: M/r; 0 at infinity.
        n, e_theta, e_phi: world unit vectors at the camera's place, float64 (3,).
        observer_map: float64 (4, 4): (E, w', n'_θ, n'_φ) = observer_map · (1, n_r, n_θ, n_φ), still to be divided by E;
            primes are derivatives in Mino time (M = 1) along the ray traced backwards, as SPEC §3 starts a ray.
    """

    kind: str
    spin: float
    w: float
    n: np.ndarray
    e_theta: np.ndarray
    e_phi: np.ndarray
    observer_map: np.ndarray


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


def effective_spin(scene: Scene) -> float:
    """a* that the scene's matter feels: 0 for a model without spin."""
    return scene.hole.spin if ray_model(scene).traits.spins else 0.0


def horizon_spin(scene: Scene) -> float:
    """a* that the horizon of the marched space-time has: `kerr_like` drags, but its orbits are Schwarzschild's."""
    return 0.0 if ray_model(scene).traits.space_time == "schwarzschild" else effective_spin(scene)


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
    space_time = ray_model(scene).traits.space_time
    camera = scene.camera
    spin = scene.hole.spin if space_time == "kerr" else 0.0
    cos_theta, sin_theta = cos_sin_deg(camera.inclination_deg)
    cos_phi, sin_phi = cos_sin_deg(camera.azimuth_deg)
    n = np.array([sin_theta * cos_phi, sin_theta * sin_phi, cos_theta])
    e_theta = np.array([cos_theta * cos_phi, cos_theta * sin_phi, -sin_theta])
    e_phi = np.array([-sin_phi, cos_phi, 0.0])
    if math.isinf(camera.distance):
        return Observer("infinity", spin, 0.0, n, e_theta, e_phi, np.diag([1.0, -1.0, 1.0, 1.0]))
    r = 2.0 * camera.distance  # M = 1 from here on
    if space_time == "flat":
        _outside(camera.distance, relativity.horizon_radius(effective_spin(scene)), effective_spin(scene))
        return Observer("static", 0.0, 1.0 / r, n, e_theta, e_phi, np.diag([1.0, -1.0, r, r]))
    kind, matrix = _kerr_map(r, cos_theta, sin_theta, spin, camera.observer)
    return Observer(kind, spin, 1.0 / r, n, e_theta, e_phi, matrix)


def _outside(distance: float, horizon: float, a: float) -> None:
    """Raises ValueError where a camera at `distance` is not outside the horizon, both in r_s."""
    if distance <= horizon:
        raise ValueError(f"camera.distance: got {distance:g} r_s; at spin {a:g} the horizon is at {horizon:.6g} r_s and the camera must be outside it")


def _kerr_map(r: float, cos_theta: float, sin_theta: float, a: float, observer: str) -> tuple[str, np.ndarray]:
    """The observer map from the ZAMO's tetrad (Bardeen, Press & Teukolsky 1972, eq. 3.2), boosted along e_φ for the static observer."""
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


def local_directions(psi: np.ndarray, chi: np.ndarray) -> np.ndarray:
    """Local directions (…, 3) from ψ (angle from the hole's centre) and χ (angle on the screen from right towards up), radians."""
    psi, chi = np.broadcast_arrays(np.asarray(psi, float), np.asarray(chi, float))
    return np.stack([-np.cos(psi), -np.sin(psi) * np.sin(chi), np.sin(psi) * np.cos(chi)], axis=-1)


def parallel_rays(alpha: np.ndarray, beta: np.ndarray) -> np.ndarray:
    """Local vectors (…, 3) of a far observer's parallel rays at screen coordinates α (right), β (up), in M."""
    alpha, beta = np.broadcast_arrays(np.asarray(alpha, float), np.asarray(beta, float))
    return np.stack([-np.ones_like(alpha), -beta, alpha], axis=-1)


def stop_radius(spin: float) -> float:
    """Radius in r_s below which an inward ray is captured without further march.

    Halfway to the prograde photon orbit at most: for spins near 1 that orbit lies closer to the horizon than one per cent.
    """
    r_plus = relativity.horizon_radius(spin)
    return r_plus + min(0.01 * r_plus, 0.5 * (relativity.photon_orbit_radius(abs(spin)) - r_plus))
