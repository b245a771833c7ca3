"""Fields against closed forms: where lenses focus, parabolas of a linear medium, places of exit, the order of every integrator. `-rP` shows the figures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.glsl.declared import Fate
from blackhole_gl.physics import observer
from blackhole_gl.reference import dynamical_fields, potential, refraction
from blackhole_gl.reference.field_form import FieldTraced, through_field
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.recording import RayPath, Recorder
from blackhole_gl.scene import Scene, catalogue
from tests.shaders.test_fields import FIELDS, RADIUS, VARIANTS, WITHIN, rays_of, scene_of


@pytest.fixture(scope="module")
def recorder(renderer: Renderer):
    made = Recorder(renderer.ctx, renderer.programs)
    yield made
    made.release()


def exit_place(path: RayPath) -> np.ndarray:
    """Where (3,) the ray leaves the sphere: the last point of its march."""
    assert path.fate == Fate.ESCAPED
    place = path.points[path.step > 0][-1]
    assert np.linalg.norm(place) == pytest.approx(RADIUS, rel=1e-5)  # the root is a rounding or two off
    return place


def medium(name: str, distance: float, **changes) -> Scene:
    return scene_of("refraction", distance, 70.0, rays__refraction__medium=name, rays__refraction__size=RADIUS, **changes)


def test_luneburg_s_lens_focuses_parallel_rays_in_the_point_opposite(recorder: Recorder) -> None:
    scene = medium("luneburg", math.inf)
    focus = -RADIUS * observer.observe(scene).n
    rng = np.random.default_rng(1)
    b, turn = 2.0 * RADIUS * np.sqrt(rng.uniform(0.0, 0.95, 12)), rng.uniform(0.0, 2.0 * math.pi, 12)  # M
    off = [np.linalg.norm(exit_place(recorder.record(scene, local)) - focus) for local in observer.parallel_rays(b * np.cos(turn), b * np.sin(turn))]
    print(f"Luneburg: {max(off) / RADIUS:.1e} R")
    assert max(off) <= 1e-4 * RADIUS


def test_maxwell_s_fish_eye_focuses_every_ray_from_a_point_of_its_rim_in_the_one_opposite(recorder: Recorder) -> None:
    # The camera stands on the rim to a rounding within, so that every ray into the lens begins there.
    scene = medium("fish_eye", RADIUS * (1.0 - 1e-6))
    focus = -RADIUS * observer.observe(scene).n
    rng = np.random.default_rng(2)
    rays = observer.local_directions(np.arccos(rng.uniform(0.15, 1.0, 12)), rng.uniform(0.0, 2.0 * math.pi, 12))
    off = [np.linalg.norm(exit_place(recorder.record(scene, local)) - focus) for local in rays]
    print(f"fish-eye: {max(off) / RADIUS:.1e} R")
    assert max(off) <= 1e-4 * RADIUS


def test_rays_in_a_linear_medium_are_parabolas(renderer: Renderer) -> None:
    """Crossings of z = 0 of rays that begin within at height z₀ with n² = 1 + S z: x = x₀ + n₀ t σ, z = z₀ + n₀ t_z σ + S σ²/4."""
    strength = 0.05
    scene = medium("linear", 6.0, rays__refraction__strength=strength)
    seen = observer.observe(scene)
    rays = rays_of(6.0, 200, seed=4)
    start = 6.0 * seen.n
    v = math.sqrt(1.0 + strength * start[2]) * observer.local_directions(rays[:, 0], rays[:, 1]) @ np.stack([seen.n, seen.e_theta, seen.e_phi])
    with np.errstate(invalid="ignore"):
        sigma = (-v[:, 2] - np.sqrt(v[:, 2] ** 2 - strength * start[2])) / (0.5 * strength)  # down through the plane: z'' > 0
    point = start[:2] + sigma[:, None] * v[:, :2]
    within = (sigma > 0.0) & (np.hypot(point[:, 0], point[:, 1]) < 0.99 * RADIUS)
    found = listed_rays.trace_by_shader(renderer, scene, rays)
    at = found.crossing_r[:, 0] * np.exp(1j * found.crossing_phi[:, 0])
    assert within.sum() > 40
    assert np.max(np.abs(at - (point[:, 0] + 1j * point[:, 1]))[within]) <= 1e-4 * RADIUS


TWINS = {"lorenz": dynamical_fields, "roessler": dynamical_fields, "potential": potential, "refraction": refraction}


@pytest.mark.parametrize("model, values", [*((model, {}) for model in FIELDS), *(pytest.param(*variant, marks=pytest.mark.slow) for variant in VARIANTS)])
def test_places_of_exit_are_the_twin_s(recorder: Recorder, monkeypatch: pytest.MonkeyPatch, model: str, values: dict) -> None:
    """Of every field that ships, as it comes and as the media and laws have it that it does not come with."""
    found: list[FieldTraced] = []
    monkeypatch.setattr(TWINS[model], "follow_field", lambda view, field: found.append(through_field(view, field)) or found[-1].traced)
    scene, rays = scene_of(model, 25.0, **{f"rays__{model}__{name}": value for name, value in values.items()}), rays_of(25.0, 40, seed=5)
    listed_rays.trace_by_reference(scene, rays)
    places, local = found[0].places, observer.local_directions(rays[:, 0], rays[:, 1])
    bent = ~np.isnan(places[:, 0])
    off = [np.linalg.norm(exit_place(recorder.record(scene, ray)) - place) for ray, place in zip(local[bent], places[bent])]
    print(f"{model} {values}: places of exit, 99 % {np.quantile(off, 0.99) / RADIUS:.1e} R, worst {max(off) / RADIUS:.1e} R of {len(off)}")
    assert len(off) > 25 and np.quantile(off, 0.99) <= WITHIN * RADIUS


SETTINGS = {"euler": (0.2, 0.1, 0.05), "verlet": (0.8, 0.4, 0.2), "bs3": (1.2, 0.8, 0.4), "rk4": (1.6, 1.2, 0.8), "nystrom4": (1.6, 1.2, 0.8)}
FLOOR = 1.5e-6  # rad: what rounding may leave
STRONG = {"rays__lorenz__strength": 0.01, "rays__field_radius": 6.0}


def central_rays() -> np.ndarray:
    """Rays (N, 2) that pass so near that the longest steps do not pass over the small sphere's rim."""
    rays = rays_of(25.0, 400, seed=6)
    return rays[25.0 * np.sin(rays[:, 0]) < 3.0]


def errors_by_step(renderer: Renderer, integrator: str, steps: tuple[float, ...]) -> np.ndarray:
    """Root mean squares of the errors of escape directions from Lorenz's field, strong and small, which conserves nothing: no error cancels."""
    rays = central_rays()
    twin = listed_rays.trace_by_reference(scene_of("lorenz", **STRONG), rays)
    found = [listed_rays.trace_by_shader(renderer, scene_of("lorenz", rays__integrator=integrator, rays__step_length=step, **STRONG), rays) for step in steps]
    errors = np.array([np.linalg.norm(rays.direction - twin.direction) / np.sqrt(len(twin.fate)) for rays in found])
    print(f"{integrator}: " + ", ".join(f"{step:g} → {error:.1e} rad" for step, error in zip(steps, errors)))
    return errors


@pytest.mark.parametrize("integrator", SETTINGS)
def test_order_in_a_field(renderer: Renderer, integrator: str) -> None:
    """Ends of the march are found as accurately as it steps."""
    errors = errors_by_step(renderer, integrator, SETTINGS[integrator])
    order = float(np.polyfit(np.log(SETTINGS[integrator]), np.log(errors), 1)[0])
    print(f"order {order:.2f}")
    assert abs(order - catalogue.plug_ins("integrator")[integrator].traits.order) <= 0.3


@pytest.mark.parametrize("integrator", sorted(set(catalogue.keys("integrator")) - set(SETTINGS)))
def test_the_fifth_orders_fall_onto_the_floor(renderer: Renderer, integrator: str) -> None:
    assert catalogue.plug_ins("integrator")[integrator].traits.order == 5
    errors = errors_by_step(renderer, integrator, (1.6, 1.2, 0.8))
    assert np.log(errors[0] / errors[1]) / np.log(1.6 / 1.2) >= 4.7 and errors[2] <= FLOOR


@pytest.mark.parametrize("control, integrator", [("embedded", "dopri5"), ("doubling", "rk4")])
def test_a_tolerance_is_kept(renderer: Renderer, control: str, integrator: str) -> None:
    rays = central_rays()
    twin = listed_rays.trace_by_reference(scene_of("lorenz", **STRONG), rays)
    errors = []
    for tolerance in (1e-3, 1e-5):
        changes = {"rays__integrator": integrator, "rays__step_control": control, f"rays__{control}__tolerance": tolerance, "rays__step_length": 0.5}
        found = listed_rays.trace_by_shader(renderer, scene_of("lorenz", **STRONG, **changes), rays)
        errors.append(np.median(np.linalg.norm(found.direction - twin.direction, axis=1)))
        assert errors[-1] <= 10.0 * tolerance
    print(errors)
    assert errors[0] > 3.0 * errors[1]
