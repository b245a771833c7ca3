"""Rays in fields: the shader against the float64 twins, what they meet inside and outside the sphere, and what becomes of them. `-rP` shows the figures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl import listed_rays
from blackhole_gl.glsl.declared import Fate
from blackhole_gl.measure.errors import compare
from blackhole_gl.measure.scenes import ChartScene
from blackhole_gl.planning import hardness, plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, SceneError, catalogue, met, presets

FIELDS = [key for key, model in catalogue.plug_ins("ray_model").items() if model.traits.field]
RADIUS = 10.0  # r_s, of the sphere

WITHIN = 1e-4  # of place (over the sphere's radius) and direction at exit, at 99 % of the rays

# r in r_s and inclination: far and near, inside the sphere, in the disk's plane and over it; parallel rays.
CAMERAS = [(25.0, 80.0), (4.0, 40.0), (300.0, 17.0), (12.0, 90.0), (8.0, 0.0), (math.inf, 70.0)]

# What the shipped fields are beside as they come.
VARIANTS = [
    ("potential", {"law": "yukawa", "x": 2.0}),
    ("potential", {"law": "compact", "strength": 0.05}),
    ("potential", {"strength": -0.5, "z": 1.0}),
    ("refraction", {"medium": "mirage", "size": 1.0}),
    ("refraction", {"medium": "luneburg", "size": 10.0}),
    ("refraction", {"medium": "fish_eye", "size": 10.0}),
    ("refraction", {"medium": "linear", "strength": 0.05}),
]


def scene_of(model: str, distance: float = 25.0, inclination: float = 80.0, **changes) -> Scene:
    values = {"rays.model": model, "camera.distance": distance, "camera.inclination_deg": inclination, "camera.azimuth_deg": 25.0}
    values |= {"rays.integrator": "rk4", "rays.step_control": "fixed", "rays.step_length": 0.1, "rays.max_steps": 20000}  # shorter steps add rounding
    return presets.load(["kerr"], values | {key.replace("__", "."): value for key, value in changes.items()})


def rays_of(distance: float, count: int, seed: int) -> np.ndarray:
    """(count, 2) rays that come into the sphere, and some that pass it by."""
    rng = np.random.default_rng(seed)
    turn = rng.uniform(0.0, 2.0 * math.pi, count)
    if math.isinf(distance):
        b = 2.2 * RADIUS * np.sqrt(rng.uniform(0.0, 1.0, count))  # M
        return np.stack([b * np.cos(turn), b * np.sin(turn)], axis=-1)
    widest = 1.1 * math.asin(RADIUS / distance) if distance > RADIUS else math.pi
    return np.stack([np.arccos(rng.uniform(math.cos(widest), 1.0, count)), turn], axis=-1)


@pytest.mark.parametrize("distance, inclination", CAMERAS[:2])
@pytest.mark.parametrize("model", FIELDS)
def test_listed_rays_against_the_twin(renderer: Renderer, model: str, distance: float, inclination: float) -> None:
    agree(renderer, scene_of(model, distance, inclination), 200)


@pytest.mark.slow
@pytest.mark.parametrize("distance, inclination", CAMERAS)
@pytest.mark.parametrize("model, values", [*((model, {}) for model in FIELDS), *VARIANTS])
def test_a_thousand_rays_against_the_twin(renderer: Renderer, model: str, values: dict, distance: float, inclination: float) -> None:
    agree(renderer, scene_of(model, distance, inclination, **{f"rays__{model}__{name}": value for name, value in values.items()}), 1000)


def agree(renderer: Renderer, scene: Scene, count: int) -> None:
    """Whether shader and twin agree on `count` rays of `scene`."""
    model, distance, inclination = scene.rays.model, scene.camera.distance, scene.camera.inclination_deg
    rays = rays_of(distance, count, seed=7)
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    # A ray that only just leaves the sphere, or is only just held, may do the other.
    same = found.fate == twin.fate
    assert np.mean(~same) <= 0.01
    escaped = same & (twin.fate == Fate.ESCAPED)
    off = np.linalg.norm(found.direction - twin.direction, axis=1)[escaped]
    crosses = ~np.isnan(twin.crossing_r[escaped])
    assert np.mean(np.isnan(found.crossing_r[escaped]) == crosses) <= 0.005  # of crossings: where a way runs along the plane
    both = crosses & ~np.isnan(found.crossing_r[escaped]) & (twin.crossing_r[escaped] < 20.0)  # r_s: within the largest disk
    apart = np.abs(found.crossing_r[escaped] * np.exp(1j * found.crossing_phi[escaped]) - twin.crossing_r[escaped] * np.exp(1j * twin.crossing_phi[escaped]))
    off_99, apart_99 = np.quantile(off, 0.99), np.quantile(apart[both], 0.99)
    print(f"{model}, r = {distance:g}, i = {inclination:g}°: direction 99 % {off_99:.1e} rad, crossing 99 % {apart_99:.1e} r_s")
    # In its own plane a camera sees crossings only where rays run nearly along it.
    assert off_99 <= WITHIN and apart_99 <= WITHIN * RADIUS * (10.0 if inclination == 90.0 else 1.0)


@pytest.mark.parametrize("model", FIELDS)
def test_straight_rays_without_lensing_meet_no_ball(renderer: Renderer, model: str) -> None:
    scene = scene_of(model, rays__lensing=False)
    assert plan(scene).model.key == "flat"
    found = listed_rays.trace_by_shader(renderer, scene, np.array([[0.0, 0.0], [0.01, 1.0]]))
    assert np.all(found.fate == Fate.ESCAPED)


def test_a_field_of_no_strength_leaves_rays_straight(renderer: Renderer) -> None:
    rays = rays_of(25.0, 100, seed=1)
    found = listed_rays.trace_by_shader(renderer, scene_of("lorenz", rays__lorenz__strength=0.0), rays)
    straight = listed_rays.trace_by_shader(renderer, scene_of("lorenz", rays__lensing=False), rays)
    np.testing.assert_allclose(found.direction, straight.direction, atol=1e-6)  # float32
    np.testing.assert_allclose(found.crossing_r, straight.crossing_r, rtol=2e-5)  # over 200 steps


def test_a_ray_that_stays_too_long_is_held(renderer: Renderer) -> None:
    rays = rays_of(4.0, 100, seed=2)
    for way in (1.0, 5.0):
        scene = scene_of("lorenz", 4.0, rays__field_way=way)
        found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
        assert np.mean(found.fate != twin.fate) <= 0.01 and np.all(found.fate != Fate.UNRESOLVED)  # a step's length decides
        assert np.any(found.fate == Fate.CAPTURED)


def test_steps_reach_to_where_a_ray_is_held() -> None:
    made = plan(scene_of("lorenz", rays__max_steps=1000))
    assert made.step_length * made.max_steps == pytest.approx(made.scene.rays.field_way) and made.warnings


def test_a_field_has_no_hole() -> None:
    for model in FIELDS:
        where = plan(scene_of(model)).space_time
        assert not where.has_hole and where.horizon_radius == 0.0 and where.kind == "flat"


# Where the ring lies: before the sphere as the camera sees it, within, and behind it.
@pytest.mark.parametrize("inner, outer", [(12.0, 18.0), (4.0, 8.0)])
def test_things_are_met_inside_and_outside_the_sphere_and_hide_the_disk(renderer: Renderer, inner: float, outer: float) -> None:
    """A ring in the plane z = 0 is met exactly where the disk's plane is crossed."""
    scene = scene_of("lorenz", 25.0, 70.0)
    ring = {"things.ring.kind": "annulus", "things.ring.inner_radius": inner, "things.ring.outer_radius": outer, "things.ring.tilt_deg": 0.0}
    renderer.render(scene.with_values(ring | {"disk.enabled": False}), 0.0, (72, 40))
    met = renderer.hits()
    renderer.render(scene, 0.0, (72, 40))
    plain = renderer.hits()
    r = np.hypot(plain.crossing[..., 0], plain.crossing[..., 1])
    on_ring = np.any((r > 1.01 * inner) & (r < 0.99 * outer), axis=-1)
    off_ring = ~np.any((r > 0.99 * inner) & (r < 1.01 * outer), axis=-1)
    assert np.count_nonzero(on_ring) > 50
    assert np.all(met.fate[on_ring] == Fate.MET) and np.all(met.fate[off_ring] == plain.fate[off_ring])


def test_media_in_a_field_shine_as_by_straight_rays_where_it_has_no_strength(renderer: Renderer) -> None:
    """Within its sphere: beyond it rays are lines that gather nothing, and media that reach so far are refused."""
    fog = {"media.fog.kind": "ball", "media.fog.radius": 3.0, "media.fog.x": 4.0, "media.fog.y": 0.0, "media.fog.z": 0.0}
    field = {"hole.spin": 0.0, "rays.model": "lorenz", "rays.lorenz.strength": 0.0, "rays.field_radius": 8.0, "camera.distance": 14.0}
    field |= {"rays.edges": 1, "sky.enabled": False, "disk.enabled": False}
    scene = presets.load(["kerr"], fog | field)
    found = []
    for lensing in (True, False):
        renderer.render(scene.with_values({"rays.lensing": lensing}), 0.0, (72, 40))
        found.append(renderer.radiance()[..., :3].astype(float))
    assert found[1].max() > 0.1
    assert np.abs(found[0] - found[1]).max() < 1e-3, "half floats have 5e-4 of what is nearly 1"
    with pytest.raises(SceneError, match=r"rays.field_radius: got 6 r_s, and media reach 7 r_s from the middle"):
        plan(scene.with_values({"rays.field_radius": 6.0}))


def test_a_ray_that_grazes_a_field_in_one_step_leaves_it_bent(renderer: Renderer) -> None:
    """The step begins on the sphere, and the root beside that is no end: such rays kept their direction, 12 pixels of a moving picture off."""
    scene = scene_of("potential", 14.0, rays__integrator="nystrom5", rays__step_control="radius")
    rim = math.asin(scene.rays.field_radius / scene.camera.distance)
    rays = np.column_stack([np.repeat(rim * np.array([0.96, 0.98, 0.995]), 5), np.tile(np.linspace(0.3, 6.0, 5), 3)])
    fine, long = (listed_rays.trace_by_shader(renderer, scene.with_values({"rays.step_length": step}), rays) for step in (0.1, 1.8))
    straight = listed_rays.trace_by_shader(renderer, scene.with_values({"rays.lensing": False}), rays)
    assert (long.steps == 1).all() and (fine.steps > 1).all()
    off, bent = (np.linalg.norm(fine.direction - other.direction, axis=1) for other in (long, straight))
    assert np.all(off < 0.01 * bent)


_OF_A_SHELL = {"refraction.strength": (0.3, 1.0), "refraction.raggedness": (0.5, 1.0), "refraction.width": (1.0, 2.0), "refraction.grain": (1.0, 2.0)}

MILDER = {  # parts of what a shipped scene has, or more of it, between which fields are drawn
    "objects_lorenz": {"lorenz.strength": (0.3, 1.0)},
    "objects_roessler": {"roessler.strength": (0.3, 1.0)},
    "objects_potential": {"potential.strength": (0.3, 1.0), "potential.core": (1.0, 3.0)},
    "objects_refraction": _OF_A_SHELL,
    "explosion": _OF_A_SHELL,
    "mirage": {"refraction.strength": (0.3, 1.0)},
    "fish_eye": {"refraction.index": (0.6, 1.0)},
}


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(1, 9))])
@pytest.mark.parametrize("name", MILDER)
def test_milder_fields_keep_the_tolerance_by_the_steps_of_harder_ones(renderer: Renderer, name: str, seed: int) -> None:
    """At 99 % of the rays, as where they were measured."""
    rng = np.random.default_rng(seed)
    shipped = presets.load([name])
    scene = shipped.with_values({f"rays.{key}": shipped.get(f"rays.{key}") * rng.uniform(*parts) for key, parts in MILDER[name].items()})
    made = plan(scene)
    assert made.step_control is not None and made.integrator is not None and not made.step_control.traits.adapts
    steps = {"rays.integrator": made.integrator.key, "rays.step_control": made.step_control.key, "rays.step_length": made.step_length}
    item = ChartScene(name, met.without_any(scene).with_values(steps), 200)
    errors = compare(listed_rays.trace_by_shader(renderer, item.scene, item.rays), item.truth, np.ones(len(item.rays), bool))
    print(f"{name}: {hardness.field_text(scene)}: {errors.direction_99 / item.pixel:.3f} px by {made.method}")
    assert errors.direction_99 <= scene.rays.tolerance * item.pixel
