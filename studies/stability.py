"""Runs the cases of `stability_cases` through every method that the catalogue offers, and judges them.

Truth is the float64 twin of the space-time that a method is meant to show: Kerr's, with the spin that the model knows. A model that is exact in
flat space is judged by flat space. Shadows and fates are judged by closed forms.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from blackhole_gl import reference
from blackhole_gl.measure.methods import Combination
from blackhole_gl.physics import observer, relativity
from blackhole_gl.physics.space_time import ray_model, space_time
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.hit_texels import HitArrays
from blackhole_gl.scene import Scene, catalogue, presets
from blackhole_gl.scene.catalogue import PlugIn
from blackhole_gl.scene.traits import RayModelTraits
from studies.stability_case import CHI, DEGREE, HALF_PIXEL, SHADOW_FAILS, SHADOW_FINE, Case, shadow_edge
from studies.stability_cases import CASES

FINE, DEGRADED, FAILS, NOT_APPLICABLE = "fine", "degraded", "fails", "does not apply"
UNRESOLVED, ESCAPED, CAPTURED = 0, 1, 2

# Crossings outside this range of r are not compared: azimuths wind up at the horizon, and far away a grazing ray's place is rounding.
_CROSSING_RANGE = (1.2, 60.0)  # in horizon radii; in r_s

# Of random rays, the share whose fate rounding may turn: those within about 1e-5 of the critical curve.
_FATE_SHARE = 1e-4

_SHADOW_TRIALS, _SHADOW_ROUNDS = 48, 5


@dataclass(frozen=True)
class Judgement:
    """How one method did in one case.

    Attributes:
        verdict: ``fine``, ``degraded``, ``fails`` or ``does not apply``.
        note: how it fails, or why it does not apply; empty otherwise.
        error: the worst error, in rad (``rays``) or relative (``shadow``); NaN where none was measured.
    """

    verdict: str
    note: str = ""
    error: float = math.nan


def methods() -> list[Combination]:
    """Every combination that the catalogue lets through: models in its order, each model's default method first."""
    found: list[Combination] = []
    for model in catalogue.plug_ins("ray_model").values():
        if model.traits.field:
            continue
        if model.traits.kind == "closed":
            found += [Combination(model.key), *_variants(model)]
            continue
        pairs = ((i, c) for i in catalogue.keys("integrator") for c in catalogue.keys("step_control"))
        fitting = [Combination(model.key, i, c) for i, c in pairs if not catalogue.reasons_against(model.key, i, c)]
        found += sorted(fitting, key=lambda method: not is_default(method))
    return found


def _variants(model: PlugIn) -> list[Combination]:
    """A closed model with each of its switches and whole numbers at every other value."""
    found = []
    for key, item in model.parameters.items():
        values = (False, True) if item.kind == "switch" else range(int(item.low), int(item.high) + 1) if item.kind == "int" else ()
        found += [Combination(model.key, changes=((key, value),)) for value in values if value != item.default]
    return found


def is_default(method: Combination) -> bool:
    """Whether this is its model's first method: the catalogue's first integrator and the model's own step control."""
    if not method.integrator:
        return not method.changes
    return (method.integrator, method.step_control) == (catalogue.keys("integrator")[0], traits(method).step_control)


def traits(method: Combination) -> RayModelTraits:
    """The traits of its ray model."""
    return catalogue.plug_ins("ray_model")[method.model].traits


def chosen(method: Combination) -> dict[str, Any]:
    """The scene values that choose it."""
    values = {"rays.model": method.model, "rays.integrator": method.integrator, "rays.step_control": method.step_control, **dict(method.changes)}
    return {key: value for key, value in values.items() if value != ""}


def run(renderer: Renderer, case: Case, method: Combination, rays: int = 20_000) -> Judgement:
    """The judgement of one cell; `rays` is the size of a sweep."""
    facts = traits(method)
    if case.needs == "steps" and facts.kind == "closed":
        return Judgement(NOT_APPLICABLE, "takes no steps")
    if case.key == "sweep-art" and facts.marches_in != "cartesian":
        return Judgement(NOT_APPLICABLE, "knows no artistic gravity")
    if case.needs == "spin" and not facts.spins:
        return Judgement(NOT_APPLICABLE, "knows no spin")
    if case.measure == "sweep":
        return sweep(renderer, method, rays, artistic=bool(case.values))
    scene = scene_of(case, method)
    try:
        observer.observe(scene)
    except ValueError:
        return Judgement(NOT_APPLICABLE, "its horizon encloses the camera, which is refused")
    if case.measure == "shadow":
        return _judge_shadow(renderer, scene)
    return _judge_rays(renderer, scene, case)


def scene_of(case: Case, method: Combination) -> Scene:
    """The scene of one cell: the shipped preset `reference`, the case's values, the method."""
    return presets.load(["reference"], {"disk.outer_radius": 20.0, **case.values, **chosen(method)})


def _judge_rays(renderer: Renderer, scene: Scene, case: Case) -> Judgement:
    rays = case.rays_in(scene)
    directions = observer.local_directions(rays[:, 0], rays[:, 1])
    hits, _, _ = renderer.trace_listed(scene, directions)
    truth = _truth(case.key, *_true_model(scene))
    if bad := _not_finite(hits):
        return Judgement(FAILS, f"{bad} of {len(rays)} not finite")
    unresolved = np.count_nonzero(hits.fate == UNRESOLVED)
    if unresolved:
        return Judgement(FAILS, f"{unresolved} of {len(rays)} unresolved")
    wrong = np.count_nonzero(hits.fate != truth.fate)
    if wrong and case.fates:
        return Judgement(FAILS, f"{wrong} of {len(rays)} wrong fates")
    both = (hits.fate == ESCAPED) & (truth.fate == ESCAPED)
    angle = np.linalg.norm(hits.direction[both] - truth.direction[both], axis=1)
    shift, lost = _crossing_errors(scene, hits, truth)
    error = max(angle.max(initial=0.0), shift)
    if case.floor >= math.pi:
        return Judgement(FINE, "", error)
    fine, fails = max(HALF_PIXEL, case.floor), max(DEGREE, case.floor)
    if lost:
        return Judgement(FAILS, f"{lost} disk crossings lost or made up", error)
    return Judgement(FINE if error <= fine else DEGRADED if error <= fails else FAILS, "" if error <= fails else "direction or crossing", error)


def _true_model(scene: Scene) -> tuple[str, float]:
    """(twin, a*) of the space-time that the scene's model is meant to show."""
    spin = space_time(scene).spin
    if _is_curved(scene) and scene.camera.observer in observer.FALLING:
        return "kerr", spin
    return ("kerr" if spin else "schwarzschild") if _is_curved(scene) else "flat", spin


def _is_curved(scene: Scene) -> bool:
    """Whether the scene's model is meant to show a hole: all but the one that is exact in flat space."""
    facts = ray_model(scene).traits
    return not (facts.exact and facts.space_time == "flat")


@cache
def _truth(key: str, twin: str, spin: float) -> reference.ReferenceHits:
    """What a case's rays do in truth; the same for every method that is meant to show the same space-time."""
    case = next(case for case in CASES if case.key == key)
    scene = presets.load(["reference"], {**case.values, "rays.model": twin, "hole.spin": spin})
    camera, rays = scene.camera, case.rays_in(scene)
    return reference.trace(
        twin,
        spin=spin,
        distance=camera.distance,
        inclination_deg=camera.inclination_deg,
        azimuth_deg=camera.azimuth_deg,
        observer=camera.observer,
        directions=observer.local_directions(rays[:, 0], rays[:, 1]),
        orders=scene.rays.orders,
    )


def _not_finite(hits: HitArrays) -> int:
    finite = np.isfinite(hits.direction).all(axis=1) & np.isfinite(hits.lambda_) & np.isfinite(hits.crossing).all(axis=(1, 2))
    unit = np.abs(np.linalg.norm(hits.direction, axis=1) - (hits.fate == ESCAPED)) < 1e-4
    return int(np.count_nonzero(~(finite & unit)))


def _crossing_errors(scene: Scene, hits: HitArrays, truth: reference.ReferenceHits) -> tuple[float, int]:
    """(largest displacement over r, crossings lost or made up) of the crossings whose place is well defined."""
    horizon = float(relativity.horizon_radius(space_time(scene).spin))
    low, high = _CROSSING_RANGE[0] * horizon, _CROSSING_RANGE[1]
    found = hits.crossing.astype(float)
    radius = np.hypot(found[..., 0], found[..., 1])
    exact = np.nan_to_num(truth.crossing_r)
    point = exact[..., None] * np.stack([np.cos(truth.crossing_phi), np.sin(truth.crossing_phi)], axis=-1)
    both = (radius > 0.0) & (exact > low) & (exact < high)
    shift = np.linalg.norm(found - np.nan_to_num(point), axis=-1)[both] / exact[both]
    lost = (exact > low) & (exact < high) & (radius == 0.0)
    made_up = (radius > low) & (radius < high) & (exact == 0.0)
    return float(shift.max(initial=0.0)), int(np.count_nonzero(lost | made_up))


def _judge_shadow(renderer: Renderer, scene: Scene) -> Judgement:
    if not _is_curved(scene):
        return Judgement(NOT_APPLICABLE, "flat space has no such shadow")
    found, unresolved = measured_edge(renderer, scene, CHI)
    if unresolved:
        return Judgement(FAILS, f"{unresolved} rays unresolved")
    signed = found / shadow_edge(scene, CHI) - 1.0
    worst = float(signed[np.argmax(np.abs(signed))])
    error = abs(worst)
    if error <= SHADOW_FINE:
        return Judgement(FINE, "", error)
    note = f"{100.0 * error:.2g} % too {'large' if worst > 0.0 else 'small'}"
    return Judgement(DEGRADED if error <= SHADOW_FAILS else FAILS, note, error)


def measured_edge(renderer: Renderer, scene: Scene, chi: np.ndarray) -> tuple[np.ndarray, int]:
    """ψ where the traced fate leaves captured, for each of `chi`, good to 6e-9 rad; and how many trial rays had no fate."""
    low, high = np.zeros_like(chi), np.full_like(chi, np.pi)
    unresolved = 0
    for _ in range(_SHADOW_ROUNDS):
        inner = low[:, None] + (high - low)[:, None] * np.arange(1, _SHADOW_TRIALS + 1) / (_SHADOW_TRIALS + 1)
        hits, _, _ = renderer.trace_listed(scene, observer.local_directions(inner, chi[:, None]).reshape(-1, 3))
        fate = hits.fate.reshape(inner.shape)
        unresolved += int(np.count_nonzero(fate == UNRESOLVED))
        captured = np.sum(fate == CAPTURED, axis=1)
        edges = np.concatenate([low[:, None], inner, high[:, None]], axis=1)
        low, high = (edges[np.arange(len(chi)), captured + k] for k in (0, 1))
    return 0.5 * (low + high), unresolved


OTHER_SWEEP_RAYS = 16_000
"""Rays of a sweep through a method that is not its model's default, on the page and wherever it is checked: another number means other scenes."""


def sweep(renderer: Renderer, method: Combination, rays: int, artistic: bool = False, seed: int = 9) -> Judgement:
    """`rays` random rays in random scenes: all finite, all with a fate; and for exact models the right one, by the closed form of the fate."""
    total = unresolved = bad = wrong = 0
    judged = traits(method).exact and traits(method).space_time != "flat" and not artistic
    for scene, directions in random_scenes(method, rays, artistic, seed):
        hits, _, _ = renderer.trace_listed(scene, directions)
        total += len(directions)
        bad += _not_finite(hits)
        unresolved += int(np.count_nonzero(hits.fate == UNRESOLVED))
        if judged:
            wrong += int(np.count_nonzero((hits.fate == CAPTURED) != _falls_in(scene, directions)))
    if bad:
        return Judgement(FAILS, f"{bad} of {total} not finite")
    if unresolved:
        return Judgement(FAILS if unresolved > 1e-3 * total else DEGRADED, f"{unresolved} of {total} unresolved", unresolved / total)
    if wrong > _FATE_SHARE * total:
        return Judgement(FAILS, f"{wrong} of {total} wrong fates", wrong / total)
    return Judgement(FINE, "", wrong / total if judged else math.nan)


def _falls_in(scene: Scene, directions: np.ndarray) -> np.ndarray:
    camera, seen = scene.camera, observer.observe(scene)
    theta = math.radians(camera.inclination_deg)
    n_r, n_theta, n_phi = directions.T
    return relativity.falls_in(n_r, n_theta, n_phi, camera.distance, theta, seen.spin, seen.kind)


def random_scenes(method: Combination, rays: int, artistic: bool, seed: int) -> Iterator[tuple[Scene, np.ndarray]]:
    """Scenes over the whole range of hole, camera and steps, each with at most 2000 random local directions, `rays` in all."""
    rng = np.random.default_rng(seed)
    base = presets.load(["reference"], chosen(method))
    per_scene = max(1, min(2000, rays // 64))
    for _ in range(-(-rays // per_scene)):
        spin = float(rng.choice([0.0, 0.9999, -0.9999, *rng.uniform(-0.9999, 0.9999, 5)])) if traits(method).spins else 0.0
        inclination = float(rng.choice([0.0, 90.0, 180.0, 89.99, *np.degrees(np.arccos(rng.uniform(-1.0, 1.0, 12)))]))
        innermost = float(relativity.horizon_radius(spin)) if traits(method).space_time == "kerr" else 1.0
        distance = min(1e4, innermost * (1.0 + 10.0 ** rng.uniform(-3.0, 4.0)))
        values = {"hole.spin": spin, "camera.distance": distance, "camera.inclination_deg": inclination, "camera.observer": str(rng.choice(["static", "zamo"]))}
        if artistic:
            values |= {"hole.gravity_strength": 10.0 ** rng.uniform(-1.0, 1.0), "hole.horizon_size": 10.0 ** rng.uniform(-2.0, 0.0)}
        # Half towards the hole, where the picture is; half over the whole sky.
        reach = np.where(np.arange(per_scene) % 2 == 0, min(math.pi, 1.2 * math.atan(15.0 / distance)), math.pi)
        psi = np.arccos(1.0 - rng.uniform(0.0, 1.0, per_scene) * (1.0 - np.cos(reach)))
        yield base.with_values(values), observer.local_directions(psi, rng.uniform(0.0, 2.0 * np.pi, per_scene))
