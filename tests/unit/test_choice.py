"""The choice: what a scene leaves open comes from the chart's table, what it states is kept, and why is said."""

from __future__ import annotations

import csv
import math

import pytest

from blackhole_gl import choice, plan, presets, resources
from blackhole_gl.scene import Scene

PHYSICAL = [info.name for info in presets.available() if info.group in ("physics", "scene") and presets.load([info.name]).hole.gravity_strength == 1.0]


def table() -> list[dict[str, str]]:
    with open(resources.assets_dir() / "measurements.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


@pytest.mark.parametrize("name", PHYSICAL)
def test_no_measured_method_that_meets_the_tolerance_is_a_quarter_cheaper(name):
    """Read from the table anew, without the code under test."""
    scene = presets.load([name])
    chosen = choice.choose(scene).chosen
    pixel = math.radians(scene.camera.fov_deg) / 1080.0
    costs = []
    for row in table():
        if row["scene"] != name or not row["direction_99"] or float(row["wrong_fates"] or 0.0) > 0.01:
            continue
        disk = 0.0
        if scene.disk.enabled and math.isfinite(scene.camera.distance):
            disk = float(row["crossing_r_99"] or 0.0) * scene.disk.outer_radius / max(scene.camera.distance, scene.disk.outer_radius)
        if max(float(row["direction_99"]), disk) / pixel <= scene.rays.tolerance:
            costs.append(float(row["cost_flat_ratio"]))
    assert costs, f"{name} is not in the table: run make chart"
    assert min(costs) >= 0.75 * chosen.cost


@pytest.mark.parametrize("name", PHYSICAL)
def test_every_shipped_scene_is_expected_within_its_tolerance(name):
    made = choice.choose(presets.load([name]))
    assert made.meets and made.chosen.error_px <= 0.5
    assert made.chosen.error_px >= made.floor_px
    assert str(made.chosen.method) in made.reasons[0]


def test_a_finer_tolerance_never_costs_less():
    kerr = presets.load(["kerr"])
    costs = [choice.choose(kerr.with_values({"rays.tolerance": px})).chosen.cost for px in (10.0, 1.0, 0.1, 0.01)]
    assert costs == sorted(costs) and costs[0] < costs[-1]


def test_a_tolerance_below_the_floor_is_not_met_and_the_floor_is_named():
    made = choice.choose(presets.load(["kerr"]).with_values({"rays.tolerance": 0.001}))
    assert not made.meets and made.floor_px > 0.001
    assert f"{made.floor_px:.2g} px" in made.reasons[0]
    assert made.chosen.error_px == made.floor_px


def test_no_spin_needs_no_kerr_and_spin_is_never_dropped():
    spinning = choice.choose(Scene().with_values({"hole.spin": 0.3}))
    assert spinning.chosen.method.model in ("kerr", "kerr_schild")
    flat = {p.method.model for p in choice.predictions(Scene().with_values({"hole.spin": 0.3}))}
    assert "schwarzschild" not in flat and "flat" not in flat


@pytest.mark.parametrize("stated", [{"rays.model": "schwarzschild"}, {"rays.integrator": "dopri5"}, {"rays.model": "kerr", "rays.step_angle": 0.1}])
def test_what_is_stated_is_kept(stated):
    found = choice.choose(Scene().with_values(stated)).scene
    assert {key: found.get(key) for key in stated} == stated
    assert choice.AUTO not in (found.rays.model, found.rays.integrator, found.rays.step_control)
    assert found.rays.step_length > 0.0 and found.rays.step_angle > 0.0


def test_steps_by_hand_take_the_exact_model():
    made = plan.plan(Scene().with_values({"rays.step_angle": 0.1, "rays.step_length": 0.1}))
    assert made.model.key == "kerr" and made.step_angle == 0.1
    assert "by hand" in made.reasons[0]


def test_artistic_gravity_is_marched_and_says_that_nothing_measures_it():
    made = plan.plan(Scene().with_values({"hole.gravity_strength": 3.0}))
    assert made.model.key == "schwarzschild" and "artistic" in made.reasons[0]


def test_thin_rings_are_not_traced():
    near, far = (plan.plan(Scene().with_values({"camera.distance": d, "camera.fov_deg": 90.0})) for d in (20.0, 9000.0))
    assert near.orders == 3 and far.orders < 3
    assert any("too thin" in reason for reason in far.reasons)


def test_without_a_table_steps_are_plain(monkeypatch):
    monkeypatch.setattr(choice, "measurements", lambda: ())
    choice.choose.cache_clear()
    made = choice.choose(Scene())
    choice.choose.cache_clear()
    assert made.chosen is None and "no measurements" in made.reasons[0] and made.scene.rays.step_angle == 0.2
