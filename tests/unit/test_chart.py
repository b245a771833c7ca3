"""The chart: its scenes, methods, errors, tables and pictures. What it measures is checked against closed forms elsewhere."""

from __future__ import annotations

import math
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from blackhole_gl import listed_rays, planning
from blackhole_gl.app.live_chart import room_for
from blackhole_gl.listed_rays import TracedRays
from blackhole_gl.measure import bench, errors, live, refined, timing
from blackhole_gl.measure import methods as chart_methods
from blackhole_gl.measure.methods import Combination, exact_for, sensible
from blackhole_gl.measure.scenes import SHOWN, ChartScene, chart_scenes, critical_radius, true_scene
from blackhole_gl.physics import lensed_circles, observer, relativity
from blackhole_gl.planning import choice, measured
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import catalogue, presets
from studies import critical, finest, lens_by_distance, measure, page, pareto, pictures, run, sizes, table, validation
from studies.survey import own_twin
from studies.work import Kept, key_of

WHERE = table.Origin("a machine", "a renderer", "abc", "2026-01-01")
TINY = measure.Timings((32, 18), 1, 1)


@pytest.fixture(scope="module")
def near() -> ChartScene:
    """The near camera without spin, with few rays."""
    return replace(next(item for item in chart_scenes(quick=True) if item.name == "a0_near"), count=100)


@pytest.fixture(scope="module")
def row(renderer: Renderer, near: ChartScene) -> measure.Row:
    """One measured row."""
    return measure.measure(renderer, near, Combination("kerr", "rk4", "mino"), (0.1,), TINY, None)[0]


@pytest.fixture(scope="module")
def refined_row(renderer: Renderer, near: ChartScene) -> measure.Row:
    """The same with a refined map."""
    return measure.measure(renderer, near, Combination("kerr", "rk4", "mino", refined=True), (0.1,), TINY, None)[0]


def test_issue_3_asks_for_twelve_methods_five_settings_and_four_scenes() -> None:
    scenes = chart_scenes()
    assert {0.0, 0.6, 0.95, 0.998} <= {item.scene.hole.spin for item in scenes}
    for item in scenes:
        if item.name in SHOWN:
            assert len(sensible(item.scene)) >= 12
    for method in sensible(scenes[0].scene):
        for quick in (False, True):
            assert method.knob == "none" or len(method.settings(quick)) >= 5


def test_every_marched_method_is_planned_as_it_was_asked_for() -> None:
    """No fallback, no stretched step: what the table names is what is measured."""
    for item in chart_scenes(quick=True):
        for method in sensible(item.scene):
            for setting in method.settings():
                scene = method.applied(item.scene, setting)
                made = planning.plan(scene)
                assert made.model.key == method.model
                if method.integrator:
                    assert (made.integrator.key, made.step_control.key) == (method.integrator, method.step_control)
                    assert scene.get(method.knob_key) == setting
                    assert {"angle": made.step_angle, "length": made.step_length, "tolerance": setting}[method.knob] == setting


def test_models_that_ignore_the_spin_are_not_exact_for_a_spinning_hole() -> None:
    models = catalogue.plug_ins("ray_model")
    still, spinning = presets.load(["schwarzschild"]), presets.load(["kerr"])
    assert exact_for(models["schwarzschild"], still) and not exact_for(models["schwarzschild"], spinning)
    assert exact_for(models["kerr"], spinning) and not exact_for(models["flat"], still)
    assert not exact_for(models["kerr_like"], spinning)


def test_every_shipped_preset_with_a_hole_as_it_is_is_measured() -> None:
    names = {item.name for item in chart_scenes()}
    assert {"schwarzschild", "kerr", "kerr_06", "kerr_0998_85", "m87_like", "gargantua_as_filmed", "luminet_1979"} <= names
    assert not {"gargantua_s1", "extreme_gravity", "thin_disk"} & names  # art: there is no truth to compare with


def test_rays_are_the_same_each_time_and_lie_in_the_picture(near: ChartScene) -> None:
    again = replace(near)
    np.testing.assert_array_equal(near.rays, again.rays)
    assert len(near.rays) == 110
    assert near.rays[:100, 0].max() <= math.atan(math.hypot(16.0 / 9.0, 1.0) * math.tan(math.radians(45.0)))
    assert np.all(near.epsilon[100:] < 1.001e-3)


@pytest.mark.parametrize("distance, exact", [(6.0, None), (math.inf, 2.0 * relativity.CRITICAL_IMPACT)])
def test_critical_radius_in_schwarzschild(distance: float, exact: float | None) -> None:
    scene = presets.load(["schwarzschild"], {"camera.distance": distance})
    exact = exact or float(relativity.schwarzschild_shadow_angle(distance))
    np.testing.assert_allclose(critical_radius(scene, np.linspace(-3.0, 3.0, 7)), exact, rtol=1e-9)


@pytest.mark.parametrize("name", ["a0_inside", "a09_deep", "orbit_at_isco"])
def test_rays_close_to_the_critical_curve_of_a_moving_camera_part_there(name: str) -> None:
    """Where the hole's centre is seen aside of straight inwards, and from inside the horizon, too. The curve is known within 3e-5."""
    scene = next(item for item in chart_scenes() if item.name == name).scene
    angles = np.repeat(np.linspace(0.2, 6.0, 7), 2)
    away = critical_radius(scene, angles) * np.tile([1.0 - 1e-4, 1.0 + 1e-4], 7)
    seen = observer.observe(true_scene(scene))
    rays = np.column_stack(observer.screen_angles(lensed_circles.directions(seen, away, angles)))
    np.testing.assert_array_equal(listed_rays.trace_by_reference(true_scene(scene), rays).fate, [2, 1] * 7)
    assert ChartScene(name, scene, 20).epsilon[20:].max() < 1.04e-3


@pytest.mark.parametrize(
    "name, distance", [("orbit_at_isco", None), ("hover", None), ("inside_the_horizon", None), ("luminet_1979", None), ("kerr", 0.8)]
)
def test_every_camera_has_frames_to_be_timed_against(name: str, distance: float | None) -> None:
    """In flat space nothing falls or circles, and a black ball has no inside; without spin the last one would be inside the horizon: `bench` and the window's
    figures stopped with an error there."""
    scene = presets.load([name], {} if distance is None else {"camera.distance": distance})
    compared = bench.scenes(scene)
    assert {bench.YARDSTICK, "as given"} <= set(compared)
    for item in compared.values():
        observer.observe(planning.plan(item).scene)
    observer.observe(timing.euler_plan(scene).scene)


def _rays(direction: list, fate: list[int], r: list[float], g: list[float]) -> TracedRays:
    count = len(fate)
    crossing_r, crossing_g = np.full((2, count, 3), np.nan)
    crossing_r[:, 0], crossing_g[:, 0] = r, g
    ends = {"fate": np.array(fate), "direction": np.array(direction, float), "steps": np.ones(count, int), "evaluations": np.ones(count, int)}
    return replace(listed_rays.unknown(count), **ends, crossing_r=crossing_r, crossing_g=crossing_g)


def test_errors_of_rays_made_up_by_hand() -> None:
    nowhere = [np.nan] * 3
    truth = _rays([[1, 0, 0], [0, 1, 0], nowhere, nowhere], [1, 1, 2, 2], [4.0, np.nan, 30.0, 5.0], [0.5, np.nan, 0.5, 0.5])
    found = _rays([[math.cos(1e-3), math.sin(1e-3), 0], [0, 1, 0], nowhere, [1, 0, 0]], [1, 1, 2, 1], [4.4, 6.0, 33.0, np.nan], [0.5, 0.5, 0.5, 0.5])
    got = errors.compare(found, truth, np.ones(4, bool))
    assert got.direction_worst == pytest.approx(1e-3, rel=1e-6)
    assert got.direction_median == pytest.approx(5e-4, rel=1e-6)
    assert got.crossing_r_99 == pytest.approx(0.1)  # the crossing at 30 r_s lies outside any disk
    assert got.g_99 == 0.0
    assert got.wrong_fates == 0.25
    assert got.lost_crossings == pytest.approx(2 / 3)
    assert math.isnan(errors.compare(found, truth, np.zeros(4, bool)).direction_99)


def test_crossings_of_refined_maps_err_by_a_length_on_the_disk() -> None:
    nowhere = [[np.nan] * 3] * 2
    truth, found = (_rays(nowhere, [2, 2], r, [0.5, 0.5]) for r in ([4.0, 8.0], [4.2, 8.2]))
    assert errors.compare(found, truth, np.ones(2, bool), disk_edge=10.0).crossing_r_99 == pytest.approx(0.02)


def test_opposite_directions_are_half_a_turn_apart() -> None:
    one = _rays([[1, 0, 0]], [1], [np.nan], [np.nan])
    other = _rays([[-1, 0, 0]], [1], [np.nan], [np.nan])
    assert errors.angles_between(one, other)[0] == pytest.approx(math.pi)


def test_pareto_front_keeps_what_nothing_beats() -> None:
    assert pareto.front([1, 2, 3, 4, 2], [9, 5, 7, 1, 5]) == [0, 1, 3]
    assert pareto.front([math.nan, 2], [1, math.nan]) == []


def test_a_row_of_exact_kerr(row: measure.Row, near: ChartScene) -> None:
    assert row.direction_99 < 1e-4 and row.wrong_fates == 0.0 and row.unresolved == 0
    assert row.own_direction_99 == pytest.approx(row.direction_99, rel=0.5)  # no twin given: the truth itself
    assert row.evaluations > 40.0 and row.cost_flat_ratio > 0.0
    assert row.setting == row.step_angle == 0.1 and math.isnan(row.step_length)


def test_a_wrong_force_law_shows_against_the_truth_and_not_against_its_own_twin(renderer: Renderer, near: ChartScene) -> None:
    method = Combination("post_newtonian", "rk4", "radius")
    twin = own_twin(near, method)
    coarse, fine = measure.measure(renderer, near, method, (0.3, 0.15), TINY, twin)
    assert coarse.direction_median == pytest.approx(fine.direction_median, rel=0.05)
    assert fine.direction_median > 0.1 and fine.wrong_fates > 0.05
    if np.any(twin.fate):  # the catalogue may hold models whose twin is still to come
        assert fine.own_direction_median < 1e-4


def test_broken_off_measurements_go_on(tmp_path: Path, row: measure.Row, near: ChartScene) -> None:
    method = Combination("kerr", "rk4", "mino")
    key = key_of(near, method, (0.1,), TINY)
    Kept(tmp_path).put(key, [row])
    with open(tmp_path / "rows.jsonl", "a", encoding="utf-8") as file:
        file.write('{"key": "cut sh')
    kept = Kept(tmp_path).get(key)
    assert kept is not None and repr(kept) == repr([row])  # repr: NaN is not equal to itself
    assert Kept(tmp_path).get(key_of(near, method, (0.2,), TINY)) is None
    assert Kept(None).get(key) is None


def test_tables_survive_the_way_through_a_file(tmp_path: Path, row: measure.Row) -> None:
    table.write_contract(tmp_path / "m.csv", [row, replace(row, variant="second_order off")], WHERE)
    (record,) = table.read(tmp_path / "m.csv")
    assert tuple(record) == measured.COLUMNS
    assert record["model"] == "kerr" and record["step_length"] == "" and float(record["step_angle"]) == 0.1
    assert float(record["direction_99"]) == pytest.approx(row.direction_99, rel=1e-4)
    assert (tmp_path / "m.csv").read_text().startswith("# a machine; a renderer; commit abc")


def test_the_contract_with_the_plan() -> None:
    stated = "scene,spin,distance,inclination_deg,fov_deg,model,integrator,step_control,step_length,step_angle,direction_median,direction_99,direction_worst,"
    stated += "crossing_r_99,g_99,wrong_fates,evaluations,cost_flat_ratio"
    assert ",".join(measured.COLUMNS).startswith(stated)


def test_validation_of_s1_holds(renderer: Renderer) -> None:
    found = validation.validate(renderer)
    drift = {item.integrator: item for item in found.drifts}
    assert drift["verlet"].energy < 0.01 and drift["rk4"].angular_momentum < 0.01  # the report's 1 %
    assert drift["euler"].energy > 0.01
    assert all(abs(item.radius / 1.5 - 1.0) < 1e-5 for item in found.photon_spheres)  # the report's 0.1 %, and what float32 can do
    for item in found.deflections:
        assert item.by_model["kerr"] == pytest.approx(item.exact, abs=1e-6 / (item.b / relativity.CRITICAL_IMPACT - 1.0) + 1e-6)
    assert found.deflections[-1].by_model["post_newtonian"] / found.deflections[-1].weak == pytest.approx(1.5, abs=0.01)


def test_the_finest_steps_meet_their_bounds(renderer: Renderer) -> None:
    measured = finest.finest(renderer, chart_scenes(quick=True))
    assert {item.scene for item in measured} == set(SHOWN)
    for item in measured:
        for name, bound in finest.BOUNDS.items():
            assert getattr(item, name) <= bound, f"{item.scene}, {item.method}: {name}"


def test_near_the_critical_curve_errors_grow(renderer: Renderer, near: ChartScene) -> None:
    curve = [p for p in critical.near_critical(renderer, [near], quick=True) if p.method == "kerr, rk4, mino" and p.setting == 0.05]
    assert len(curve) == 15
    assert curve[0].epsilon == pytest.approx(1e-7) and curve[0].direction_median > 1e-3
    assert curve[-1].direction_median < 1e-6


def test_the_chart_s_rays_are_those_of_pixels(renderer: Renderer, near: ChartScene) -> None:
    """Of the picture that refined maps are measured in, so that both share one truth."""
    scene = Combination("kerr", "rk4", "mino").applied(near.scene, 0.1)
    width, height = choice.REFINED_SIZE
    assert near.pixels.min() >= 0 and np.all(near.pixels < (width, height)) and len(np.unique(near.pixels, axis=0)) > 90
    renderer.time_trace(planning.plan(scene), choice.REFINED_SIZE)
    x, y = near.pixels.T
    listed = listed_rays.trace_by_shader(renderer, scene, near.rays[: near.count])
    renderer.time_trace(planning.plan(scene), choice.REFINED_SIZE)
    found = renderer.hits()
    np.testing.assert_array_equal(found.fate[y, x], listed.fate)
    escaped = (listed.fate == 1) & (near.epsilon[: near.count] > 1e-2)
    # float32 starts differ by 1e-7 and are magnified up to a hundredfold; the next pixel lies 2e-3 rad off
    assert np.abs(found.direction[y, x] - listed.direction)[escaped].max() < 1e-4


def test_a_refined_row_holds_the_tolerance_and_spares_rays(row: measure.Row, refined_row: measure.Row, near: ChartScene) -> None:
    pixel = math.radians(near.scene.camera.fov_deg) / choice.REFINED_SIZE[1]
    assert row.direction_99 < refined_row.direction_99 <= choice.REFINED_TOLERANCE * pixel
    assert refined_row.wrong_fates <= 0.01 and refined_row.crossing_r_99 < 0.01 and refined_row.g_99 < 0.01
    assert row.evaluations / 16 < refined_row.evaluations < 0.4 * row.evaluations  # the grid alone is a sixteenth
    assert refined_row.method == f"{row.method}, refined" and refined_row.setting == row.setting
    assert (row.refined, refined_row.refined) == (0, 1)
    assert math.isnan(row.cost_unrefined) and refined_row.cost_unrefined > 0.0


def test_refinement_is_measured_whether_or_not_the_plan_uses_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(choice, "refinement", lambda scene: choice.Refinement(9.0, 9.0, 1.0))
    scene = presets.load(["kerr"])
    assert planning.plan(scene).refine_px == 0.0 and refined.refined_plan(scene).refine_px == planning.refine_px(scene) > 0.0


def test_what_the_plan_may_choose_is_also_measured_refined() -> None:
    for item in chart_scenes():
        found = chart_methods.worth_refining(item.scene)
        made = choice.choose(item.scene).chosen
        if made is not None and (chosen := made.method).step_angle and not item.whole:  # marched; in the others any integrator is tried
            assert Combination(chosen.model, chosen.integrator, chosen.step_control, refined=True) in found
            assert chosen.step_angle in found[0].settings()
        for method in found:
            assert exact_for(catalogue.plug_ins("ray_model")[method.model], item.scene) and method.refined
            assert replace(method, refined=False) in sensible(item.scene, item.whole), "its own rays are measured too"
            assert set(method.settings()) <= set(replace(method, refined=False).settings())
            assert method.knob == "none" or min(method.settings()) == 0.1
            assert method.applied(item.scene, 0.1).rays.tolerance == choice.REFINED_TOLERANCE


LENS = [lens_by_distance.LensError(30.0, 40.0, 73.0, 1630.0, math.inf), lens_by_distance.LensError(10000.0, 40.0, 0.14, 0.19, 0.2)]


def test_page_and_pictures_are_written(tmp_path: Path, renderer: Renderer, row: measure.Row, refined_row: measure.Row, near: ChartScene) -> None:
    rows = [row, refined_row, replace(row, step_angle=0.2, direction_99=1e-3, cost_flat_ratio=0.5 * row.cost_flat_ratio)]
    points = [critical.Point("a0_near", "kerr, rk4, mino", 0.2, e, 1e-7 / e, 1e-6 / e, 0.0) for e in (1e-3, 1e-2)]
    costs = [sizes.Cost("kerr", *size, 1.0, 2.0) for size in sizes.SIZES]
    pictures.draw_methods(tmp_path / "a.png", rows, [near], {"a0_near": row})
    pictures.draw_critical(tmp_path / "b.png", points)
    pictures.draw_sizes(tmp_path / "c.png", costs)
    for name in "abc":
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    found = page.Findings([near], rows, points, costs, validation.validate(renderer), finest.finest(renderer, [near]), {"a0_near": row}, LENS, [])
    text = page.page(found, WHERE, "a test")
    assert "nan" not in text and "a machine" in text
    assert "| 30 | 73 | 1630 (–) |" in text and "| 10000 | 0.14 | 0.19 (0.2) |" in text
    assert "1 methods" in text and "1 of them also refined" in text and "| a0_near | kerr, rk4, mino | 0.1 |" in text
    table_values = {"model": "schwarzschild_table", "integrator": "", "step_control": "", "step_angle": math.nan, "cost_flat_ratio": 0.1}
    closed = [replace(item, **table_values) for item in (row, refined_row)]
    section = page.refined_section([*rows, *closed], [near]).splitlines()[-1]
    assert section.startswith("| a0_near | schwarzschild_table | – |") and section.count("(") == 6, "each figure has its fellow"
    widths: dict[int, int] = {}
    for number, line in enumerate(text.splitlines()):
        if line.startswith("|"):
            widths[number] = line.count("|")
            assert widths[number] == widths.get(number - 1, widths[number]), f"a table's row has another number of cells: {line}"


def test_the_plans_choice_is_found_by_its_own_step_setting(row: measure.Row, refined_row: measure.Row, near: ChartScene) -> None:
    method = {"rays.model": "kerr", "rays.integrator": "rk4", "rays.step_control": "mino"}
    stated = near.scene.with_values({**method, "rays.step_angle": 0.2, "rays.step_length": 0.1})
    assert not run._is_method_of(row, stated)
    assert run._is_method_of(row, stated.with_values({"rays.step_angle": 0.1}))
    assert not run._is_method_of(refined_row, stated.with_values({"rays.step_angle": 0.1}))


def test_without_matplotlib_the_install_line_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
    with pytest.raises(pictures.MatplotlibMissing, match="pip install"):
        pictures.library()


def test_the_shipped_table_is_one_the_chart_wrote() -> None:
    records = table.read(Path(__file__).resolve().parents[2] / "assets" / "measurements.csv")
    before_refinement = measured.COLUMNS[: measured.COLUMNS.index("refined")]
    assert tuple(records[0]) in (measured.COLUMNS, measured.COLUMNS[:-1], before_refinement)  # the last tells fields apart, which are not in it
    assert set(SHOWN) <= {record["scene"] for record in records}
    assert len({(r["model"], r["integrator"], r["step_control"]) for r in records}) >= 12


class _AtOnce:
    """Stands for the other process: does the work when it is given."""

    def submit(self, work, *given) -> Future:
        done = Future()
        done.set_result(work(*given))
        return done


def test_the_live_chart_measures_a_view_bit_by_bit(renderer: Renderer) -> None:
    measured = live.Live(presets.load(["kerr"]), _AtOnce())
    assert measured.busy and measured.waiting and not measured.points
    for _ in range(200):
        measured.advance(renderer)
        if len(measured.points) >= 2:
            break
    point = measured.points[0]
    assert (point.method, point.setting) == (Combination("kerr", "rk4", "mino"), 0.8)
    assert point.cost > 0.0 and point.pixels == pytest.approx(point.error / math.radians(42.0 / 1080.0))
    assert 0.0 < measured.share < 1.0
    taken = planning.plan(presets.load(["kerr"]).with_values(point.method.values(point.setting)))
    assert (taken.model.key, taken.step_angle) == ("kerr", 0.8)
    measured._left = measured._left[:2]
    while measured.busy:
        measured.advance(renderer)
    assert len(measured.points) == len({(item.method, item.setting) for item in measured.points}) >= 4
    assert not measured.advance(renderer)
    measured.cancel()
    assert not measured.busy


def test_the_live_chart_has_room_before_it_has_points() -> None:
    """Its axes went from 1e-306 to 1 until the first was there."""
    left, right, bottom, top = room_for([])
    assert 0.1 < left < 1.0 < 10.0 < right < 100.0 and 0.1 < bottom < 0.5 < top < 2.0
    point = live.LivePoint(Combination("flat"), 0.0, 1e-3, 30.0, 0.0, 2.0, 1.0)
    left, right, bottom, top = room_for([point])
    assert left < 2.0 < right and bottom < 0.5 and 30.0 < top


def test_the_live_chart_of_a_scene_with_things_is_that_of_its_light() -> None:
    """Things bend no ray, and the float64 twin knows none."""
    assert live.Live(presets.load(["orbiting_star"]), _AtOnce()).scene.things == {}
    assert not {"orbiting_star", "neutron_star"} & {item.name for item in chart_scenes()}


def test_the_live_chart_of_art_says_that_there_is_no_truth() -> None:
    measured = live.Live(presets.load(["gargantua_s1"]), _AtOnce())
    assert "no truth" in measured.failure and not measured.busy


def test_another_method_is_no_other_view() -> None:
    scene = presets.load(["kerr"])
    assert live.view_of(scene) == live.view_of(scene.with_values(Combination("kerr", "euler", "mino").values(0.1)))
    assert live.view_of(scene) != live.view_of(scene.with_values({"camera.distance": 21.0}))
