"""The plan fits its parts together, gives a ray the steps it needs and says why."""

from __future__ import annotations

import math

import pytest

from blackhole_gl import planning
from blackhole_gl.physics import relativity
from blackhole_gl.planning import choice
from blackhole_gl.scene import Scene, SceneError, catalogue

STATED = {
    "rays.model": "kerr",
    "rays.integrator": "rk4",
    "rays.step_control": "radius",
    "rays.step_length": 0.1,
    "rays.step_angle": 0.2,
    "rays.max_steps": 192,
}
"""A method stated in full, so that nothing is left for the plan to choose."""


def planned(keep_crossings: bool = False, **changes) -> planning.Plan:
    stated = {**STATED, **{key.replace("__", "."): value for key, value in changes.items()}}
    return planning.plan(Scene().with_values(stated), keep_crossings=keep_crossings)


def test_lensing_off_is_flat_space():
    made = planned(rays__lensing=False)
    assert made.model.key == "flat" and made.integrator is None and made.evaluations_per_step == 0
    assert any("lensing is off" in reason for reason in made.reasons)
    assert made.method == "flat"


def test_a_step_control_that_does_not_fit_gives_way_and_says_so():
    made = planned(rays__model="kerr", rays__step_control="fixed")
    assert made.step_control.key == "mino"
    assert any("fixed" in reason and "kerr" in reason for reason in made.reasons)
    assert planned(rays__model="schwarzschild", rays__step_control="fixed").step_control.key == "fixed"


def test_orders_follow_the_disk():
    assert planned(rays__orders=2).orders == 2
    off = planned(disk__enabled=False, rays__orders=2)
    assert off.orders == 0 and any("disk is off" in reason for reason in off.reasons)
    assert planned(True, disk__enabled=False, rays__orders=2).orders == 2


@pytest.mark.parametrize("model", ["kerr", "schwarzschild"])
def test_steps_are_stretched_where_too_few_are_allowed(model):
    made = planned(rays__model=model, rays__max_steps=8, rays__step_angle=0.05, rays__step_length=0.05)
    assert made.max_steps == 8
    assert made.step_angle > 0.05 and made.step_length > 0.05
    assert any("times longer than asked" in warning for warning in made.warnings)
    roomy = planned(rays__model=model, rays__max_steps=30000)
    assert (roomy.step_angle, roomy.step_length) == (0.2, 0.1)


@pytest.mark.parametrize("distance", [1.001, 20.0, 1e4, math.inf])
@pytest.mark.parametrize("gravity", [0.1, 1.0, 10.0])
def test_every_camera_gets_a_plan(distance, gravity):
    for model in catalogue.keys("ray_model"):
        for control in catalogue.keys("step_control"):
            made = planned(rays__model=model, rays__step_control=control, camera__distance=distance, hole__gravity_strength=gravity)
            assert 0.0 < made.step_length < math.inf and 0.0 < made.step_angle < math.inf


def test_the_method_is_named_in_a_few_words():
    assert planned(rays__model="kerr").method == "kerr, rk4, κ = 0.2"
    assert planned(rays__model="schwarzschild", rays__step_length=0.5).method == "schwarzschild, rk4, radius, Δt₀ = 0.5"
    assert planned().evaluations_per_step == 4


def test_parts_that_cannot_be_combined_are_refused(monkeypatch):
    monkeypatch.setattr(catalogue, "reasons_against", lambda *_: ["these do not go together"])
    with pytest.raises(SceneError, match="rays.integrator: these do not go together"):
        planned()


@pytest.mark.parametrize("spin, orbit", [(0.0, "prograde"), (0.9, "prograde"), (0.9, "retrograde"), (-0.9, "prograde")])
def test_the_disk_never_reaches_inside_the_isco(spin, orbit):
    scene = Scene().with_values({"hole.spin": spin, "disk.orbit": orbit, "disk.inner_radius": 0.5})
    assert planning.plan(scene).disk_inner == pytest.approx(float(relativity.isco_radius(spin, orbit)))
    assert planning.plan(scene.with_values({"disk.inner_radius": 9.0})).disk_inner == 9.0


def test_the_outer_edge_is_never_inside_the_inner_one():
    made = planning.plan(Scene().with_values({"disk.outer_radius": 1.0}))
    inner, outer = made.disk_inner, made.disk_outer
    assert outer > inner == 3.0


def test_far_rays_are_finished_in_closed_form_farther_out_where_gravity_is_stronger():
    assert planning.plan(Scene()).march_bound == planning.MARCH_BOUND
    assert planning.plan(Scene().with_values({"hole.gravity_strength": 4.0})).march_bound == 4.0 * planning.MARCH_BOUND


def test_options_that_do_not_fit_are_named_with_the_reason():
    kerr = Scene().with_values(STATED)
    controls = planning.unfit_options("rays.step_control", kerr)
    assert "marches in mino" in controls["radius"] and "mino" not in controls
    assert "error estimate" in controls["embedded"]
    assert set(planning.unfit_options("rays.integrator", kerr.with_values({"rays.model": "flat"}))) == set(catalogue.keys("integrator"))
    assert planning.unfit_options("rays.model", kerr) == {}


SPINNING = Scene().with_values({"hole.spin": 0.9})
"""A scene that the plan marches."""


def _moving(reasons: tuple[str, ...]) -> str:
    (found,) = [reason for reason in reasons if reason.startswith("moving:")]
    return found


def test_refinement_that_pays_is_used_and_says_what_it_costs(monkeypatch):
    monkeypatch.setattr(choice, "refinement", lambda scene: choice.Refinement(0.45, 2.1, 4.4))
    made = planning.plan(SPINNING)
    assert made.refine_px == pytest.approx(0.4)
    assert _moving(made.reasons) == "moving: refined, 0.45 px at 2.1 flat frames of 1280×720 against 4.4 for every pixel"
    off = planning.plan(SPINNING.with_values({"rays.refine": False}))
    assert off.refine_px == 0.0 and "rays.refine is off" in _moving(off.reasons)
    assert off.method == made.method, "at rest and moving rays are traced by one method"


@pytest.mark.parametrize("found", [choice.Refinement(0.45, 4.5, 4.4), choice.Refinement(0.55, 2.1, 4.4)])
def test_refinement_that_is_dearer_or_too_coarse_is_not_used(monkeypatch, found):
    monkeypatch.setattr(choice, "refinement", lambda scene: found)
    made = planning.plan(SPINNING)
    assert made.refine_px == 0.0
    assert _moving(made.reasons) == f"moving: a ray for every pixel; refined would be {found}"


def test_steps_stated_by_hand_that_miss_the_tolerance_are_refined_all_the_same(monkeypatch):
    monkeypatch.setattr(choice, "refinement", lambda scene: choice.Refinement(5.0, 2.1, 4.4))
    assert planned(rays__model="kerr", rays__step_control="mino", rays__step_angle=0.8).refine_px > 0.0
    assert planning.plan(SPINNING.with_values({"rays.tolerance": 0.001})).refine_px > 0.0, "no method meets it"


def test_what_was_not_measured_is_refined_unless_its_rays_cost_nothing(monkeypatch):
    monkeypatch.setattr(choice, "refinement", lambda scene: None)
    made = planned()
    assert made.refine_px == pytest.approx(0.4) and "not measured" in _moving(made.reasons)
    assert planned(rays__model="schwarzschild_table", hole__spin=0.0).refine_px == pytest.approx(0.4)
    for model in ("weak_field", "screen_lens", "flat"):
        cheap = planned(rays__model=model, hole__spin=0.0)
        assert cheap.refine_px == 0.0 and "no more than interpolating" in _moving(cheap.reasons)


def test_a_step_control_that_gave_way_is_not_the_one_looked_up(monkeypatch):
    """Presets of published steps state one for models that march in Cartesian steps."""
    monkeypatch.setattr(choice, "refinement", lambda scene: choice.Refinement(0.1, 2.1, 4.4) if scene.rays.step_control == "mino" else None)
    assert "2.1 flat frames" in _moving(planned(rays__model="kerr", rays__step_control="fixed").reasons)


def test_steps_that_err_more_than_is_allowed_are_told():
    stated = dict(rays__model="kerr", rays__integrator="rk4", rays__step_control="mino", rays__max_steps=8192, hole__spin=0.9)
    (warning,) = planned(**stated, rays__step_angle=0.4).warnings
    assert warning.startswith("the steps stated err by") and "0.5 px allowed" in warning
    assert not planned(**stated, rays__step_angle=0.05).warnings
    assert not planned(**stated, rays__step_angle=0.4, rays__tolerance=50.0).warnings
    assert not planned(rays__model="weak_field").warnings, "a look, and marked as one"
    assert not planned(rays__model="flat").warnings, "straight rays are what was asked for"


def test_a_tolerance_that_cannot_be_met_is_told():
    open_ = {"rays.tolerance": 0.001, "hole.spin": 0.9, "camera.distance": 1.5}
    (warning,) = planning.plan(Scene().with_values(open_)).warnings
    assert "0.001 px of error cannot be met here" in warning
