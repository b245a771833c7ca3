"""Rays given as a list: read from CSV, traced by the pictures' own shader or by the float64 twin, written as CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from . import number_lists, reference
from .glsl.declared import Fate
from .number_lists import Allowed, ListError, NumberList
from .output.files import write_whole
from .physics import observer, observer_frames, projection, tilted_disk
from .physics.space_time import ray_model, space_time
from .planning import plan
from .rendering.frame import Renderer
from .scene import Camera, Disk, Scene, lengths, met
from .shapes import Float, Int

FATES = tuple(fate.name.lower() for fate in Fate)
ANGLES = ("psi", "chi")
SCREEN = ("alpha", "beta")
_CROSSINGS = 3
# A float64 that is rounded up to π where written must not be refused.
_ALLOWED = {"psi": Allowed("0 to π (3.14159…) radians, from the direction to the hole's centre", 0.0, math.nextafter(math.pi, 4.0))}
_AT_CROSSINGS, _MOMENTA = ("r", "phi", "g"), ("theta", "k_r", "k_theta")


def _numbered(columns: Iterable[str]) -> list[str]:
    return [f"{name}{n}" for n in range(_CROSSINGS) for name in columns]


_HEADER = [
    *("fate", "theta", "phi", "steps", "evaluations", *_numbered(_AT_CROSSINGS), "lambda", *_numbered(_MOMENTA), "energy"),
    *_numbered(["intensity"]), *_numbered(["t"]),
]  # fmt: skip


@dataclass(frozen=True)
class TracedRays:
    """What became of N rays.

    Attributes:
        fate: int (N,), an index of `FATES`.
        direction: (N, 3) asymptotic unit vectors in the world; NaN unless escaped.
        steps, evaluations: int (N,); of refined pictures float, the mean of all their pixels.
        crossing_r, crossing_phi, crossing_g: (N, 3); r in r_s, φ in radians (any branch), g = E_infinity/E_emitter of a circular
            emitter, inside the ISCO of matter that falls in where there is some; NaN where there is none, and without it g also inside the ISCO.
        lambda_: (N,) L_z/E in M of the photon that arrives; NaN where the shader keeps no crossings, and with them no λ.
        crossing_theta: (N, 3) polar angle in radians.
        crossing_k_r, crossing_k_theta: (N, 3) the covariant momentum of the photon that arrives, in Boyer–Lindquist coordinates and units
            of its energy at infinity with M = 1; NaN also for ray models whose rays are no light in any metric.
        crossing_delay: (N, 3) how long light is under way from there to the camera, in r_s/c of who is far away; to a camera at infinity, less r + ln r of it
            in r_s. NaN for ray models that do not tell.
        energy: (N,) E_infinity/E_camera of the photon that arrives: the inverse of the shift that the camera's place and motion give to the sky's light.
    """

    fate: Int[np.ndarray, " N"]
    direction: Float[np.ndarray, "N 3"]
    steps: Int[np.ndarray, " N"] | Float[np.ndarray, " N"]
    evaluations: Int[np.ndarray, " N"] | Float[np.ndarray, " N"]
    crossing_r: Float[np.ndarray, "N 3"]
    crossing_phi: Float[np.ndarray, "N 3"]
    crossing_g: Float[np.ndarray, "N 3"]
    lambda_: Float[np.ndarray, " N"]
    crossing_theta: Float[np.ndarray, "N 3"]
    crossing_k_r: Float[np.ndarray, "N 3"]
    crossing_k_theta: Float[np.ndarray, "N 3"]
    energy: Float[np.ndarray, " N"]
    crossing_delay: Float[np.ndarray, "N 3"]


def columns(scene: Scene) -> tuple[str, str]:
    """The columns that a ray list for `scene` has: angles, or screen coordinates for a camera at infinity."""
    return SCREEN if math.isinf(scene.camera.distance) else ANGLES


def read(path: Path, scene: Scene, unit: str = "M") -> NumberList:
    """The rays of the CSV file at `path`: ψ (0…π) and χ in radians, or α, β in `unit` for a camera at infinity; here they are in M.

    Raises:
        ListError, OSError: as `number_lists.read`.
    """
    wanted = columns(scene)
    found = number_lists.read(path, wanted, "this camera", _ALLOWED, _HEADER)
    return replace(found, values=found.values * lengths.factor("M") / lengths.factor(unit)) if wanted == SCREEN else found


def local_vectors(rays: Float[np.ndarray, "N 2"], scene: Scene) -> Float[np.ndarray, "N 3"]:
    """The local vectors (N, 3) of rays (N, 2) as `read` gives them."""
    return (observer.parallel_rays if columns(scene) == SCREEN else observer.local_directions)(rays[:, 0], rays[:, 1])


def pixel_rays(scene: Scene, size: tuple[int, int]) -> Float[np.ndarray, "height width 2"]:
    """The rays through the middles of the pixels of a picture of `size`, top row first, (height, width, 2) as `read` gives them."""
    width, height = size
    places = np.stack(np.meshgrid(np.arange(width) + 0.5, height - 0.5 - np.arange(height)), axis=-1)
    seen = projection.directions(scene.camera, size, places) @ observer.look_rotation(scene.camera).T
    if columns(scene) == SCREEN:
        return np.stack([seen[..., 2], -seen[..., 1]], axis=-1)
    return np.stack(observer.screen_angles(seen), axis=-1)


def trace_by_shader(renderer: Renderer, scene: Scene, rays: Float[np.ndarray, "N 2"]) -> TracedRays:
    """`rays` (N, 2) through the shader that pictures use."""
    if len(rays) == 0:
        return unknown(0)
    local = local_vectors(rays, scene)
    hits, shifts, ray_plan = renderer.trace_listed(scene, local)
    r, theta, phi = _spherical(tilted_disk.placed(hits.crossing, ray_plan.scene.disk))
    none = r == 0.0
    innermost = 0.0 if ray_plan.scene.disk.plunging else ray_plan.space_time.matter_isco_radius(ray_plan.scene.disk)
    momentum = hits.momenta.astype(float)
    return TracedRays(
        hits.fate,
        np.where((hits.fate == 1)[:, None], hits.direction.astype(float), np.nan),
        hits.steps,
        hits.steps * ray_plan.evaluations_per_step,
        np.where(none, np.nan, r),
        np.where(none, np.nan, phi),
        np.where(none | (r < innermost), np.nan, shifts.astype(float)),
        np.where(scene.rays.orders > 0, hits.lambda_.astype(float), np.nan),
        np.where(none, np.nan, theta),
        momentum[..., 0],
        momentum[..., 1],
        observer.observe(ray_plan.scene).energies(local),
        np.full(r.shape, np.nan) if hits.delay is None else hits.delay.astype(float),
    )


def trace_by_reference(scene: Scene, rays: Float[np.ndarray, "N 2"]) -> TracedRays:
    """`rays` (N, 2) by the float64 twin of the scene's ray model.

    Raises:
        ValueError: the model has no twin.
        ListError: the scene has things or media, which no twin knows.
    """
    if not met.is_empty(scene):
        raise ListError("the float64 reference knows no things and no media: take them out of the scene, or trace by the shader")
    if len(rays) == 0:
        return unknown(0)
    camera, model, disk = scene.camera, ray_model(scene), plan(scene, keep_crossings=True).scene.disk
    far = columns(scene) == SCREEN
    parameters: dict[str, Any] = {name: scene.get(key) for name, key in reference.twin_of(model.key).parameters.items()}
    found = reference.trace(
        model.key,
        spin=space_time(scene).spin,
        distance=camera.distance,
        inclination_deg=camera.inclination_deg,
        azimuth_deg=camera.azimuth_deg,
        **_motion(camera),
        orders=_CROSSINGS,
        orbit=scene.disk.orbit,
        falls=disk.plunging,
        directions=None if far else local_vectors(rays, scene),
        screen=rays if far else None,
        planes=[tilted_disk.axes(disk)[2]] if disk.tilt_deg else (),
        **parameters,
    )
    kept = np.arange(_CROSSINGS) < scene.rays.orders
    direction = np.where((found.fate == 1)[:, None], found.direction, np.nan)
    plane = found.crossings.of(1) if disk.tilt_deg else found.equatorial
    g = _tilted_shift(plane, found.lambda_, scene, disk) if disk.tilt_deg else found.g
    found_there = (plane.r, plane.phi, g, plane.theta, plane.k_r, plane.k_theta, plane.delay)
    r, phi, g, theta, k_r, k_theta, delay = (np.where(kept, values, np.nan) for values in found_there)
    return TracedRays(found.fate.astype(int), direction, found.steps, found.evaluations, r, phi, g, found.lambda_, theta, k_r, k_theta, found.energy, delay)


def _motion(camera: Camera) -> dict[str, Any]:
    """What the twins are told of the observer."""
    if not camera.aberration:  # then light comes from where who is at rest sees it
        return {"observer": "zamo" if camera.observer == "zamo" else "static"}
    return {"observer": camera.observer, "velocity": tuple(observer_frames.boost(camera)), "fall_from": camera.fall_from}


def _spherical(place: Float[np.ndarray, "*points 3"]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """r, θ, φ."""
    x, y, z = np.moveaxis(place, -1, 0)
    across = np.hypot(x, y)
    return np.hypot(across, z), np.arctan2(across, z), np.arctan2(y, x)


def _tilted_shift(plane: reference.Crossings, lam: Float[np.ndarray, " N"], scene: Scene, disk: Disk) -> Float[np.ndarray, "N 3"]:
    """g of the twin's crossings of the tilted disk's plane; NaN inside its innermost orbit."""
    where = space_time(scene)
    outward = np.stack([np.sin(plane.theta) * np.cos(plane.phi), np.sin(plane.theta) * np.sin(plane.phi), np.cos(plane.theta)], axis=-1)
    momentum = np.stack([plane.k_r, plane.k_theta, np.broadcast_to(lam[:, None], plane.r.shape)], axis=-1)
    gravity, motion = tilted_disk.shift(plane.r[..., None] * outward, momentum, where.spin, disk)
    return np.where(plane.r >= where.matter_isco_radius(disk), gravity * motion, np.nan)


def unknown(count: int) -> TracedRays:
    """`count` rays of which nothing is known."""
    nothing, none, number = np.full((count, _CROSSINGS), np.nan), np.zeros(count, int), np.full(count, np.nan)
    return TracedRays(none, np.full((count, 3), np.nan), none, none, nothing, nothing, nothing, number, nothing, nothing, nothing, number, nothing)


def intensities(scene: Scene, rays: TracedRays) -> Float[np.ndarray, "N 3"]:
    """Bolometric intensity that the camera of `scene` receives from the smooth disk at each crossing, over what the hottest matter sends out there:
    (E_camera/E_emitter)^p (T/T_peak)^4, p being the scene's beaming exponent; 0 beside the disk, NaN where there is no crossing.

    By the exact shift, with all of it, whatever switches the scene has; without layers, limb darkening and what covers what.
    """
    made = plan(scene, keep_crossings=True)
    none = np.isnan(rays.crossing_r)
    radii = np.where(none, made.disk_outer, rays.crossing_r)
    shows = (radii >= made.disk_edge) & (radii <= made.disk_outer) & scene.disk.enabled & ~np.isnan(rays.crossing_g)
    shift = np.where(shows, rays.crossing_g, 0.0) / rays.energy[:, None]
    return np.where(none, np.nan, np.where(shows, np.maximum(shift, 0.0) ** scene.disk.beaming_exponent * made.disk_temperatures(radii) ** 4, 0.0))


def in_unit(rays: TracedRays, unit: str) -> TracedRays:
    """`rays` with all lengths in `unit`, one of `lengths.UNITS`: radii, times (of r_s/c or M), and λ and k_θ, which are momenta times lengths."""
    own = lengths.factor(unit)  # of r_s, in which radii are; momenta are in M
    momenta = own / lengths.factor("M")
    lengths_and_times = {"crossing_r": own * rays.crossing_r, "crossing_delay": own * rays.crossing_delay}
    return replace(rays, **lengths_and_times, lambda_=momenta * rays.lambda_, crossing_k_theta=momenta * rays.crossing_k_theta)


def write(path: Path, scene: Scene, rays: TracedRays, digits: int, listed: NumberList | None = None, unit: str | None = None) -> None:
    """Writes `rays` of `scene` as CSV, a row a ray, numbers with `digits` significant digits; what there is not is left empty.

    The columns of `listed` stand behind the others, as they were given, so that these are where they always are. `unit`: as in `in_unit`.
    """
    intensity = intensities(scene, rays)
    rays = rays if unit is None else in_unit(rays, unit)
    theta = np.arctan2(np.hypot(rays.direction[:, 0], rays.direction[:, 1]), rays.direction[:, 2])
    phi = np.arctan2(rays.direction[:, 1], rays.direction[:, 0])
    at_crossings = (rays.crossing_r, rays.crossing_phi, rays.crossing_g)
    momenta = (rays.crossing_theta, rays.crossing_k_r, rays.crossing_k_theta)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*_HEADER, *(listed.names if listed else ())])
    for i, fate in enumerate(rays.fate):
        ends = _texts((theta[i], phi[i]), digits)
        there = _texts((*_in_turn(at_crossings, i), rays.lambda_[i], *_in_turn(momenta, i), rays.energy[i], *intensity[i], *rays.crossing_delay[i]), digits)
        writer.writerow([FATES[fate], *ends, rays.steps[i], rays.evaluations[i], *there, *(listed.texts[i] if listed else ())])
    write_whole(path, text.getvalue().encode())


def _in_turn(columns: Iterable[np.ndarray], ray: int) -> list[float]:
    """A ray's values in the order of `_numbered`."""
    return [values[ray, n] for n in range(_CROSSINGS) for values in columns]


def _texts(values: Iterable[float], digits: int) -> list[str]:
    return ["" if math.isnan(value) else f"{value:.{digits}g}" for value in values]
