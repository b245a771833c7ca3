"""The choice: what a scene leaves open comes from the chart's table, what it states is kept, and why is said."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace

import pytest

from blackhole_gl import planning, resources
from blackhole_gl.measure.scenes import is_charted, view_of
from blackhole_gl.physics.space_time import is_inside
from blackhole_gl.planning import choice, measured, nearest
from blackhole_gl.scene import Scene, presets

# From inside the horizon steps are stated.
CHARTED = {info.name: presets.load([info.name]) for info in presets.available() if info.group in ("physics", "scene")}
PHYSICAL = [name for name, scene in CHARTED.items() if is_charted(scene) and not is_inside(scene)]


def table() -> list[dict[str, str]]:
    with open(resources.assets_dir() / "measurements.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


MEASURED = sorted({row["scene"] for row in table()} & set(PHYSICAL))


@pytest.mark.parametrize("name", MEASURED)
def test_no_measured_method_that_meets_the_tolerance_is_a_quarter_cheaper(name):
    """Read from the table anew, without the code under test."""
    scene = presets.load([name])
    chosen = choice.choose(scene).chosen
    pixel = math.radians(scene.camera.fov_deg) / 1080.0
    alike = {other for other in PHYSICAL if view_of(presets.load([other])) == view_of(scene)}
    costs = []
    for row in table():
        if row["scene"] not in alike or row.get("refined") == "1" or not row["direction_99"] or float(row["wrong_fates"] or 0.0) > 0.01:
            continue
        disk = 0.0
        if scene.disk.enabled and math.isfinite(scene.camera.distance):
            disk = float(row["crossing_r_99"] or 0.0) * scene.disk.outer_radius / max(scene.camera.distance, scene.disk.outer_radius)
        if max(float(row["direction_99"]), disk) / pixel <= scene.rays.tolerance:
            costs.append(float(row["cost_flat_ratio"]))
    assert min(costs) >= 0.75 * chosen.cost


@pytest.mark.parametrize("name", MEASURED)
def test_a_preset_that_nobody_has_measured_goes_by_those_that_are_like_it(name, monkeypatch):
    """As one that was just written: with the rows of a shipped one left out, its like have it traced by the same method, and expect much the same of it."""
    scene, table_of_all = presets.load([name]), nearest.measurements()
    with_its_own = choice.choose(scene).chosen
    monkeypatch.setattr(nearest, "measurements", lambda: {other: rows for other, rows in table_of_all.items() if other != name})
    planning.forget_measurements()
    made = choice.choose(scene)
    planning.forget_measurements()
    assert made.meets and made.chosen.method.kind == with_its_own.method.kind
    assert made.chosen.cost == pytest.approx(with_its_own.cost, rel=0.3)


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
    made = planning.plan(Scene().with_values({"rays.step_angle": 0.1, "rays.step_length": 0.1}))
    assert made.model.key == "kerr" and made.step_angle == 0.1
    assert "by hand" in made.reasons[0]


def test_artistic_gravity_is_marched_and_says_that_nothing_measures_it():
    made = planning.plan(Scene().with_values({"hole.gravity_strength": 3.0}))
    assert made.model.key == "schwarzschild" and "artistic" in made.reasons[0]


def test_thin_rings_are_not_traced():
    near, far = (planning.plan(Scene().with_values({"camera.distance": d, "camera.fov_deg": 90.0})) for d in (20.0, 9000.0))
    assert near.orders == 3 and far.orders < 3
    assert any("too thin" in reason for reason in far.reasons)


def test_without_a_table_steps_are_plain(monkeypatch):
    monkeypatch.setattr(nearest, "measurements", dict)
    planning.forget_measurements()
    made = choice.choose(Scene())
    planning.forget_measurements()
    assert made.chosen is None and "no measurements" in made.reasons[0] and made.scene.rays.step_angle == 0.2


KERR = presets.load(["kerr"])
CAMERA = KERR.camera

PIXEL = math.radians(CAMERA.fov_deg) / 720.0
"""Of `choice.REFINED_SIZE` in that scene, rad."""

MARCHED = measured.Measured(
    **{"scene": "here", "spin": KERR.hole.spin, "distance": CAMERA.distance, "inclination_deg": CAMERA.inclination_deg, "fov_deg": CAMERA.fov_deg},
    **{"model": "kerr", "integrator": "rk4", "step_control": "mino", "step_length": math.nan, "step_angle": 0.2, "step_tolerance": math.nan},
    **{"direction_median": 0.0, "direction_99": 0.1 * PIXEL, "direction_worst": 0.0, "crossing_r_99": 0.0, "g_99": 0.0, "wrong_fates": 0.0},
    **{"evaluations": 80.0, "cost_flat_ratio": 5.0, "refined": 0, "cost_unrefined": math.nan},
)
REFINED = replace(MARCHED, direction_99=0.3 * PIXEL, evaluations=13.0, cost_flat_ratio=3.0, refined=1, cost_unrefined=10.0)


def test_a_choice_reads_the_rows_of_scenes_that_are_near_and_one_of_each_other(monkeypatch):
    """A start spends 20 ms on reading all of them."""
    read = []
    monkeypatch.setattr(measured, "_row", lambda texts, row=measured._row: read.append(texts["scene"]) or row(texts))
    nearest.measurements.cache_clear()
    planning.forget_measurements()
    choice.choose(KERR)
    assert read.count("kerr") > 20 and all(read.count(name) == 1 for name in set(read) - {"kerr"})


@pytest.fixture
def stored(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., None]]:
    """A call that puts rows in the place of the stored table."""

    def put(*rows: measured.Measured) -> None:
        by_scene = {name: [row for row in rows if row.scene == name] for name in dict.fromkeys(row.scene for row in rows)}
        monkeypatch.setattr(nearest, "measurements", lambda: by_scene)
        planning.forget_measurements()

    yield put
    monkeypatch.undo()
    planning.forget_measurements()


def test_a_refined_method_is_no_other_method_for_a_picture_at_rest(stored):
    stored(MARCHED, replace(REFINED, cost_flat_ratio=0.1, direction_99=0.0))
    made = choice.choose(KERR)
    assert made.chosen.cost == MARCHED.cost_flat_ratio and made.chosen.error_px == pytest.approx(0.15)  # a pixel of 1080 is two thirds of one of 720
    assert made.runner_up is None


def test_what_refinement_costs_and_errs_is_that_of_the_chosen_method(stored):
    stored(MARCHED, REFINED, replace(REFINED, integrator="dopri5", cost_flat_ratio=0.1))
    found = choice.refinement(choice.choose(KERR).scene)
    assert (found.cost, found.cost_unrefined) == (3.0, 10.0) and found.error_px == pytest.approx(0.3)
    assert str(found) == "0.3 px at 3 flat frames of 1280×720 against 10 for every pixel"


def test_a_tighter_tolerance_interpolates_less(stored):
    """The march's 0.1 px stay; of interpolation's 0.2 a fifth is left, and more pixels have rays of their own."""
    stored(MARCHED, REFINED)
    scene = choice.choose(KERR.with_values({"rays.tolerance": 0.1})).scene
    found = choice.refinement(scene)
    assert found.error_px == pytest.approx(0.14)
    assert found.cost == pytest.approx(1.0 + 2.0 * math.sqrt(5.0)) and found.cost_unrefined == 10.0
    loose = choice.refinement(choice.choose(KERR.with_values({"rays.tolerance": 1.0})).scene)
    assert loose.cost == 3.0, "what was not measured is not hoped for"


def test_between_two_measured_scenes_the_worse_is_believed(stored):
    """There a pixel is half as large: the march's angle is twice as many of them, which is no matter here, and interpolation adds 0.4 px."""
    there = {"scene": "there", "distance": 60.0, "fov_deg": 0.5 * CAMERA.fov_deg}
    stored(MARCHED, REFINED, replace(MARCHED, **there), replace(REFINED, **there, cost_flat_ratio=4.0))
    scene = KERR.with_values({"camera.distance": 24.0})
    assert nearest.nearest_scenes(scene) == ("here", "there")
    found = choice.refinement(choice.choose(scene).scene)
    assert found.error_px == pytest.approx(0.1 + 0.4) and found.cost == 3.0
    stored(MARCHED, REFINED, replace(MARCHED, **there))
    assert choice.refinement(choice.choose(scene).scene) is None, "measured in one of the two only"


def test_refined_maps_with_wrong_fates_keep_no_tolerance(stored):
    stored(MARCHED, replace(REFINED, wrong_fates=0.02))
    assert choice.refinement(choice.choose(KERR).scene).error_px == math.inf


@pytest.mark.parametrize("values", [{"rays.step_angle": 0.1}, {"hole.gravity_strength": 2.0}, {"rays.model": "schwarzschild_table", "hole.spin": 0.0}])
def test_refinement_that_was_not_measured_is_not_made_up(stored, values):
    stored(MARCHED, REFINED)
    assert choice.refinement(choice.choose(KERR.with_values(values)).scene) is None


def test_tables_without_refinement_are_read_as_such(tmp_path):
    def read_back(row, columns=measured.COLUMNS):
        values = asdict(row)
        texts = ("" if values[name] != values[name] else str(values[name]) for name in columns)
        path = tmp_path / "table.csv"
        path.write_text("# measured somewhere\n" + ",".join(columns) + "\n" + ",".join(texts) + "\n", encoding="utf-8")
        ((found,),) = measured.read(path, [row.model]).values()
        return found

    old = [name for name in measured.COLUMNS if name not in ("refined", "cost_unrefined")]
    assert repr(read_back(MARCHED, old)) == repr(MARCHED)
    assert repr(read_back(MARCHED)) == repr(MARCHED)
    new = read_back(replace(MARCHED, refined=1, cost_unrefined=10.0))
    assert new.refined and new.cost_unrefined == 10.0 and new.stated == MARCHED.stated


FAR_SKY = Scene().with_values({"disk.enabled": False, "camera.distance": 10000.0, "camera.fov_deg": 40.0})


def test_far_from_a_hole_before_its_sky_alone_a_thin_lens_is_enough():
    made = choice.choose(FAR_SKY)
    assert made.chosen.method.model == "screen_lens" and made.chosen.error_px == pytest.approx(0.2, rel=0.05)
    assert made.chosen.cost <= 1.05 * min(p.cost for p in choice.predictions(FAR_SKY)), "the cheapest of all, as far as costs of closed forms are known"
    assert choice.choose(FAR_SKY.with_values({"hole.spin": 0.9})).chosen.method.model == "screen_lens", "which it is off by too little"


@pytest.mark.parametrize(
    "changes",
    [
        {"camera.distance": 100.0},
        {"camera.distance": 100.0, "rays.tolerance": 100.0, "camera.fov_deg": 90.0},
        {"camera.distance": 3000.0},
        {"rays.tolerance": 0.1},
        {"camera.fov_deg": 5.0},
        {"disk.enabled": True},
        {"things.ball.kind": "sphere"},
        {"rays.screen_lens.radius": 2.0},
        {"hole.gravity_strength": 2.0},
        {"rays.model": "schwarzschild"},
    ],
)
def test_the_thin_lens_is_not_taken_where_it_shows_something_wrong(changes):
    assert choice.choose(FAR_SKY.with_values(changes)).scene.rays.model != "screen_lens"


def test_crossings_that_are_asked_for_are_not_a_thin_lens_s():
    assert planning.plan(FAR_SKY).model.key == "screen_lens"
    assert planning.plan(FAR_SKY, keep_crossings=True).model.key != "screen_lens"
