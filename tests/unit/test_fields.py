"""Fields in what is measured, planned and shown: each is its own truth, has no hole, and asks for steps by what was measured of it."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl import planning
from blackhole_gl.app.panel import Panel
from blackhole_gl.measure.methods import sensible
from blackhole_gl.measure.scenes import ChartScene, is_physical, true_scene
from blackhole_gl.planning import choice, hardness
from blackhole_gl.scene import Scene, catalogue, presets

FIELDS = [key for key, model in catalogue.plug_ins("ray_model").items() if model.traits.field]


def field(model: str, **values) -> Scene:
    return presets.load(["kerr"], {"rays.model": model, "camera.distance": 25.0, **{key.replace("__", "."): value for key, value in values.items()}})


@pytest.mark.parametrize("model", FIELDS)
def test_the_plan_chooses_among_what_was_measured_of_the_field(model: str) -> None:
    made = choice.choose(field(model))
    assert made.chosen is not None and made.chosen.method.model == model
    assert made.meets and made.chosen.error_px <= 0.5
    finer = choice.choose(field(model, rays__tolerance=0.05))
    assert finer.chosen is not None and finer.chosen.cost >= made.chosen.cost


@pytest.mark.parametrize(
    ("model", "values"),
    [
        ("lorenz", {"lorenz.strength": 4e-3}),
        ("lorenz", {"field_radius": 20.0}),
        ("lorenz", {"lorenz.strength": 2e-4, "lorenz.rho": 40.0}),
        ("refraction", {"refraction.strength": -0.2}),
        ("refraction", {"refraction.width": 0.8}),
        ("refraction", {"refraction.grain": 3.0, "refraction.strength": 0.1}),
        ("refraction", {"refraction.medium": "mirage", "refraction.strength": 0.01}),
    ],
)
def test_a_harder_field_or_another_gets_a_control_that_judges_its_steps(model: str, values: dict) -> None:
    made = planning.plan(field(model, **{f"rays__{key.replace('.', '__')}": value for key, value in values.items()}))
    assert made.step_control is not None and made.step_control.traits.adapts


@pytest.mark.parametrize(
    ("model", "values"),
    [
        ("lorenz", {"lorenz.strength": 2e-4}),
        ("roessler", {"roessler.strength": 0.001}),
        ("potential", {"potential.strength": 0.1, "potential.core": 0.5}),
        ("refraction", {"refraction.strength": 0.2, "refraction.width": 1.5, "refraction.grain": 5.0, "refraction.raggedness": 0.1}),
    ],
)
def test_a_milder_field_takes_the_steps_of_one_that_was_measured(model: str, values: dict) -> None:
    """So that its sliders leave the picture as quick as it is."""
    made = planning.plan(field(model, **{f"rays__{key.replace('.', '__')}": value for key, value in values.items()}))
    as_it_comes = planning.plan(field(model))
    assert made.step_control is as_it_comes.step_control and made.step_length == as_it_comes.step_length
    assert made.refine_px > 0.0


def test_a_field_no_harder_than_that_of_a_scene_is_like_it() -> None:
    """Milder than the shock wave and harder than the field as it comes."""
    measured = "refraction.size=5.0;refraction.strength=0.35"
    milder = field("refraction", rays__refraction__size=5.0, rays__refraction__strength=0.32)
    assert hardness.as_hard(milder, frozenset(["", measured])) == {measured}


SHIPPED = [info.name for info in presets.available() if info.group == "scene" and presets.load([info.name]).rays.model in FIELDS]


@pytest.mark.parametrize("name", SHIPPED)
def test_the_fields_of_shipped_scenes_are_among_those_measured(name: str) -> None:
    """By steps of one length, as coarse rays tell by these where things are seen; and what is changed in one is not taken for it."""
    scene = presets.load([name], {"rays.integrator": "auto", "rays.step_control": "auto", "rays.step_length": 0.0})
    if not scene.rays.lensing:
        return
    made = planning.plan(scene)
    assert made.step_control is not None and not made.step_control.traits.adapts
    chosen = choice.choose(scene).chosen
    assert chosen is not None and chosen.error_px <= scene.rays.tolerance
    other = planning.plan(scene.with_values({"rays.field_radius": 1.3 * scene.rays.field_radius}))
    assert other.step_control is not None and other.step_control.traits.adapts


def test_steps_that_are_stated_are_kept() -> None:
    made = planning.plan(field("lorenz", rays__integrator="euler", rays__step_control="fixed", rays__step_length=0.3))
    assert made.method == "lorenz, euler, fixed, Δt₀ = 0.3"


def test_holes_are_not_planned_by_what_was_measured_of_fields() -> None:
    for scene in (presets.load(["kerr"]), presets.load(["schwarzschild"])):
        assert all(found.method.model not in FIELDS for found in choice.predictions(scene))
        assert not any(method.model in FIELDS for method in sensible(scene))


def test_a_field_is_its_own_truth() -> None:
    scene = field("lorenz")
    assert is_physical(scene) and true_scene(scene).rays.model == "lorenz"
    assert {method.model for method in sensible(scene)} == {"lorenz"}
    view = ChartScene("view", scene, 50)
    assert len(view.rays) == 50 and np.all(np.isinf(view.epsilon))


def test_the_panel_shows_a_hole_or_a_field_and_never_both() -> None:
    panel = Panel()
    of_field, of_hole = ({item.key for item in panel.shown_fields(scene)} for scene in (field("lorenz"), presets.load(["kerr"])))
    assert "hole.spin" in of_hole and not any(key.startswith("rays.field_") for key in of_hole)
    assert {"rays.field_radius", "rays.field_way", "rays.lorenz.rho"} <= of_field and not any(key.startswith("hole.") for key in of_field)


def test_steps_in_motion_go_by_how_the_error_was_seen_to_grow() -> None:
    """That of the shock wave grows faster than by the scheme's order and one more: longer steps keep within the tolerance by what was measured."""
    made = planning.plan(presets.load(["objects_refraction"]))
    assert made.integrator is not None and made.error_order > made.integrator.traits.order + 1
    times = planning.steps_in_motion(made, 360)
    assert 1.0 < times < 1.5 and made.error_px * times**made.error_order == pytest.approx(3.0 * made.scene.rays.tolerance)
    assert np.isnan(planning.plan(field("lorenz", rays__lorenz__strength=4e-3, rays__field_radius=20.0)).error_order), "no such field was measured"
