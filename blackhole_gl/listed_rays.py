"""Rays given as a list: read from CSV, traced by the pictures' own shader or by the float64 twin, written as CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import reference
from .glsl.declared import Fate
from .output.files import write_whole
from .physics import observer
from .physics.space_time import ray_model, space_time
from .render.frame import Renderer
from .scene import Scene, met
from .shapes import Float, Int

FATES = tuple(fate.name.lower() for fate in Fate)
ANGLES = ("psi", "chi")
SCREEN = ("alpha", "beta")
_CROSSINGS = 3


class RayListError(ValueError):
    """A ray list that cannot be used; the text names file, line and column."""


@dataclass(frozen=True)
class TracedRays:
    """What became of N rays.

    Attributes:
        fate: int (N,), an index of `FATES`.
        direction: (N, 3) asymptotic unit vectors in the world; NaN unless escaped.
        steps, evaluations: int (N,); of refined pictures float, the mean of all their pixels.
        crossing_r, crossing_phi, crossing_g: (N, 3); r in r_s, φ in radians (any branch), g = E_infinity/E_emitter of a circular
            emitter; NaN where there is none, and g also inside the ISCO.
        lambda_: (N,) L_z/E in M of the photon that arrives; NaN where the shader keeps no crossings, and with them no λ.
        crossing_theta: (N, 3) polar angle in radians.
        crossing_k_r, crossing_k_theta: (N, 3) the covariant momentum of the photon that arrives, in Boyer–Lindquist coordinates and units
            of its energy at infinity with M = 1; NaN also for ray models whose rays are no light in any metric.
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


def columns(scene: Scene) -> tuple[str, str]:
    """The columns that a ray list for `scene` has: angles, or screen coordinates for a camera at infinity."""
    return SCREEN if math.isinf(scene.camera.distance) else ANGLES


def read(path: Path, scene: Scene) -> Float[np.ndarray, "N 2"]:
    """The rays of the CSV file at `path` as (N, 2) float64: ψ, χ in radians, or α, β in M for a camera at infinity.

    Raises:
        RayListError: no such columns, or a value that is no finite number.
        OSError: the file cannot be read.
    """
    wanted = columns(scene)
    with open(path, newline="", encoding="utf-8-sig") as file:
        reader = csv.DictReader(file, skipinitialspace=True)
        names = [name.strip() for name in reader.fieldnames or ()]
        if missing := [name for name in wanted if name not in names]:
            found = ",".join(names) or "nothing"
            raise RayListError(f"{path}: column {missing[0]} is missing; this camera needs {wanted[0]},{wanted[1]}, the file has {found}")
        reader.fieldnames = names
        rows = [[_number(row[name], path, reader.line_num, name) for name in wanted] for row in reader]
    return np.array(rows, float).reshape(-1, 2)


def _number(text: str | None, path: Path, line: int, column: str) -> float:
    try:
        value = float(text or "")
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise RayListError(f"{path}, line {line}, column {column}: got {text!r}; allowed is a finite number")
    return value


def local_vectors(rays: Float[np.ndarray, "N 2"], scene: Scene) -> Float[np.ndarray, "N 3"]:
    """The local vectors (N, 3) of rays (N, 2) as `read` gives them."""
    return (observer.parallel_rays if columns(scene) == SCREEN else observer.local_directions)(rays[:, 0], rays[:, 1])


def trace_by_shader(renderer: Renderer, scene: Scene, rays: Float[np.ndarray, "N 2"]) -> TracedRays:
    """`rays` (N, 2) through the shader that pictures use."""
    if len(rays) == 0:
        return unknown(0)
    hits, shifts, ray_plan = renderer.trace_listed(scene, local_vectors(rays, scene))
    r = np.hypot(hits.crossing[..., 0].astype(float), hits.crossing[..., 1])
    phi = np.arctan2(hits.crossing[..., 1].astype(float), hits.crossing[..., 0])
    none = r == 0.0
    isco = ray_plan.space_time.matter_isco_radius(scene.disk.orbit)
    momentum = hits.momenta.astype(float)
    return TracedRays(
        hits.fate,
        np.where((hits.fate == 1)[:, None], hits.direction.astype(float), np.nan),
        hits.steps,
        hits.steps * ray_plan.evaluations_per_step,
        np.where(none, np.nan, r),
        np.where(none, np.nan, phi),
        np.where(none | (r < isco), np.nan, shifts.astype(float)),
        np.where(scene.rays.orders > 0, hits.lambda_.astype(float), np.nan),
        np.where(none, np.nan, 0.5 * np.pi),
        momentum[..., 0],
        momentum[..., 1],
    )


def trace_by_reference(scene: Scene, rays: Float[np.ndarray, "N 2"]) -> TracedRays:
    """`rays` (N, 2) by the float64 twin of the scene's ray model.

    Raises:
        ValueError: the model has no twin.
        RayListError: the scene has things or media, which no twin knows.
    """
    if not met.is_empty(scene):
        raise RayListError("the float64 reference knows no things and no media: take them out of the scene, or trace by the shader")
    if len(rays) == 0:
        return unknown(0)
    camera, model = scene.camera, ray_model(scene)
    far = columns(scene) == SCREEN
    parameters: dict[str, Any] = {name: scene.get(key) for name, key in reference.twin_of(model.key).parameters.items()}
    found = reference.trace(
        model.key,
        spin=space_time(scene).spin,
        distance=camera.distance,
        inclination_deg=camera.inclination_deg,
        azimuth_deg=camera.azimuth_deg,
        observer=camera.observer,
        orders=_CROSSINGS,
        orbit=scene.disk.orbit,
        directions=None if far else local_vectors(rays, scene),
        screen=rays if far else None,
        **parameters,
    )
    kept = np.arange(_CROSSINGS) < scene.rays.orders
    direction = np.where((found.fate == 1)[:, None], found.direction, np.nan)
    plane = found.equatorial
    r, phi, g, theta, k_r, k_theta = (np.where(kept, values, np.nan) for values in (plane.r, plane.phi, found.g, plane.theta, plane.k_r, plane.k_theta))
    return TracedRays(found.fate.astype(int), direction, found.steps, found.evaluations, r, phi, g, found.lambda_, theta, k_r, k_theta)


def unknown(count: int) -> TracedRays:
    """`count` rays of which nothing is known."""
    nothing, none, number = np.full((count, _CROSSINGS), np.nan), np.zeros(count, int), np.full(count, np.nan)
    return TracedRays(none, np.full((count, 3), np.nan), none, none, nothing, nothing, nothing, number, nothing, nothing, nothing)


def write(path: Path, rays: TracedRays, digits: int) -> None:
    """Writes `rays` as CSV, a row a ray, numbers with `digits` significant digits; what there is not is left empty."""
    theta = np.arctan2(np.hypot(rays.direction[:, 0], rays.direction[:, 1]), rays.direction[:, 2])
    phi = np.arctan2(rays.direction[:, 1], rays.direction[:, 0])
    at_crossings = {"r": rays.crossing_r, "phi": rays.crossing_phi, "g": rays.crossing_g}
    momenta = {"theta": rays.crossing_theta, "k_r": rays.crossing_k_r, "k_theta": rays.crossing_k_theta}
    header = ["fate", "theta", "phi", "steps", "evaluations", *_numbered(at_crossings), "lambda", *_numbered(momenta)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    for i, fate in enumerate(rays.fate):
        ends = _texts((theta[i], phi[i]), digits)
        there = _texts((*_in_turn(at_crossings, i), rays.lambda_[i], *_in_turn(momenta, i)), digits)
        writer.writerow([FATES[fate], *ends, rays.steps[i], rays.evaluations[i], *there])
    write_whole(path, text.getvalue().encode())


def _numbered(columns: Mapping[str, np.ndarray]) -> list[str]:
    return [f"{name}{n}" for n in range(_CROSSINGS) for name in columns]


def _in_turn(columns: Mapping[str, np.ndarray], ray: int) -> list[float]:
    """A ray's values in the order of `_numbered`."""
    return [values[ray, n] for n in range(_CROSSINGS) for values in columns.values()]


def _texts(values: Iterable[float], digits: int) -> list[str]:
    return ["" if math.isnan(value) else f"{value:.{digits}g}" for value in values]
