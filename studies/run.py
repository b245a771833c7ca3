"""The whole chart: measure, then write tables, pictures and the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from blackhole_gl import planning
from blackhole_gl.measure.methods import Combination
from blackhole_gl.measure.scenes import ChartScene, chart_scenes
from blackhole_gl.output.files import write_whole
from blackhole_gl.planning import choice, nearest
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets
from studies import critical, lens_by_distance, page, pictures, sizes, table
from studies.cost_lines import by_work
from studies.finest import finest
from studies.measure import Row
from studies.survey import survey
from studies.validation import validate
from studies.work import Kept

_OUTSIDE = "accuracy_outside.csv"

# The survey takes nearly all of the time; what follows it gets the rest of the bar.
_SURVEY_SHARE = 0.92


def make(
    renderer: Renderer, out: Path, work: Path | None, *, quick: bool, command: str, progress: Callable[[float, str], None], plan_table: Path | None = None
) -> list[Path]:
    """Measures and writes everything; returns the files written.

    Args:
        out: the folder that gets accuracy.md, pictures/ and data/.
        work: the folder that finished measurements are kept in, so that a broken-off run goes on; None keeps none.
        command: what the page says it was made by.
        progress: called with the share done (0…1) and what is being done.
        plan_table: where to write the table that the plan goes by; None for not at all.

    Raises:
        MatplotlibMissing: before anything is measured.
        OSError: a file cannot be written.
    """
    pictures.library()
    where = table.origin(renderer.ctx.info["GL_RENDERER"])
    scenes = chart_scenes(quick)
    rows = survey(renderer, Kept(work), quick, lambda share, text: progress(_SURVEY_SHARE * share, text))
    progress(0.92, "error near the critical curve")
    points = critical.near_critical(renderer, scenes, quick)
    progress(0.95, "cost against pixels")
    costs = sizes.costs(renderer, presets.load(["kerr"]), quick)
    progress(0.98, "BlackHoleGPU's validation")
    validation = validate(renderer)
    best = finest(renderer, scenes)
    lens = lens_by_distance.by_distance(quick)
    progress(0.99, "pictures and page")
    if plan_table is not None:
        table.write_contract(plan_table, by_work(rows), where)
        nearest.measurements.cache_clear()  # what is marked is what the new table makes the plan choose
        planning.forget_measurements()
    chosen = plan_choices(rows, scenes)
    outside = out / "data" / _OUTSIDE
    found = page.Findings(scenes, rows, points, costs, validation, best, chosen, lens, table.read(outside) if outside.exists() else [])
    files = {
        "data/accuracy.csv": lambda path: table.write(path, rows, where),
        "data/accuracy_critical.csv": lambda path: table.write_records(path, critical.COLUMNS, _records(points, critical.COLUMNS), where),
        "data/accuracy_sizes.csv": lambda path: table.write_records(path, sizes.COLUMNS, _records(costs, sizes.COLUMNS), where),
        "data/accuracy_lens.csv": lambda path: table.write_records(path, lens_by_distance.COLUMNS, _records(lens, lens_by_distance.COLUMNS), where),
        "pictures/accuracy_methods.png": lambda path: pictures.draw_methods(path, rows, scenes, chosen),
        "pictures/accuracy_critical.png": lambda path: pictures.draw_critical(path, points),
        "pictures/accuracy_sizes.png": lambda path: pictures.draw_sizes(path, costs),
        "accuracy.md": lambda path: write_whole(path, page.page(found, where, command).encode()),
    }
    for name, put in files.items():
        put(out / name)
    return [out / name for name in files] + ([plan_table] if plan_table else [])


def plan_choices(rows: Sequence[Row], scenes: Sequence[ChartScene]) -> dict[str, Row]:
    """The row that the plan chooses, by scene; scenes that leave nothing to choose, and choices that were not measured, are left out."""
    found: dict[str, Row] = {}
    for chart_scene in scenes:
        if choice.is_open(chart_scene.scene):
            chosen = planning.plan(chart_scene.scene).scene
            found |= {row.scene: row for row in rows if row.scene == chart_scene.name and _is_method_of(row, chosen)}
    return found


def _is_method_of(row: Row, scene: Scene) -> bool:
    if row.model != scene.rays.model or row.variant or row.refined:
        return False
    method = Combination(row.model, row.integrator, row.step_control)
    same = (row.integrator, row.step_control) == (scene.rays.integrator, scene.rays.step_control)
    return method.knob == "none" or (same and row.setting == scene.get(method.knob_key))


def _records(items: Sequence[object], columns: Sequence[str]) -> list[list[object]]:
    return [[getattr(item, name) for name in columns] for item in items]
