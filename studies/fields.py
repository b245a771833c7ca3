"""Measures the error and the cost of every method in every field, as it comes and as the shipped scenes have it, against the field's own float64 twin: a
table for the plan, and a page. A quarter of an hour.

    python -m studies.fields [--out docs] [--plan-table assets/measurements_fields.csv]
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from statistics import median

import numpy as np

from blackhole_gl import listed_rays, planning
from blackhole_gl.measure import timing
from blackhole_gl.measure.errors import compare
from blackhole_gl.measure.methods import MAX_STEPS, Combination, sensible
from blackhole_gl.measure.scenes import ChartScene
from blackhole_gl.output.files import write_whole
from blackhole_gl.output.progress import Progress
from blackhole_gl.physics.space_time import is_field
from blackhole_gl.planning import hardness
from blackhole_gl.planning.measured import COLUMNS, Measured
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, catalogue, met, presets
from studies.table import Origin, origin, short, write_records

_RAYS = 400
_SIZE = (256, 144)  # pixels of a timed frame
_ROUNDS = 9
_LONGEST = (2.0,)  # r_s: weak fields let steps be longer than holes do
_OPEN = {"rays.integrator": "auto", "rays.step_control": "auto", "rays.step_length": 0.0}
# Harder than what is shipped, so that its sliders may be moved up as well as down without a march that judges its steps.
_HARDER: Mapping[str, tuple[str, Mapping[str, float]]] = {
    "ragged_shock_wave": ("objects_refraction", {"rays.refraction.width": 1.0, "rays.refraction.grain": 4.0, "rays.refraction.strength": 0.35}),
    "ragged_explosion": ("explosion", {"rays.refraction.width": 1.0, "rays.refraction.grain": 3.0}),
    "strong_lorenz": ("objects_lorenz", {"rays.lorenz.strength": 0.002}),
    "strong_roessler": ("objects_roessler", {"rays.roessler.strength": 0.015}),
    "strong_potential": ("objects_potential", {"rays.potential.strength": 1.5}),
}
_CAMERA = {"camera.distance": 25.0, "camera.inclination_deg": 75.0, "camera.azimuth_deg": 20.0, "camera.fov_deg": 45.0}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, default=Path("accuracy"), help="folder for fields.md")
    parser.add_argument("--plan-table", type=Path, help="also write the table that the plan chooses by")
    asked = parser.parse_args()
    renderer = Renderer(create_headless())
    scenes = list(_scenes())
    with Progress("measuring") as progress:
        rows = []
        for done, item in enumerate(scenes):
            rows += list(_rows(renderer, item))
            progress((done + 1) / len(scenes))
    where = origin(renderer.ctx.info["GL_RENDERER"])
    asked.out.mkdir(parents=True, exist_ok=True)
    write_whole(asked.out / "fields.md", page(rows, scenes, where).encode())
    if asked.plan_table:
        write_records(asked.plan_table, COLUMNS, ([getattr(row, name) for name in COLUMNS] for row in rows), where)


def _scenes() -> Iterator[ChartScene]:
    """Every shipped field as it comes, every shipped scene's, and those that are harder."""
    models = [key for key, model in catalogue.plug_ins("ray_model").items() if model.traits.field and model.shipped]
    found = {key: Scene().with_values({"rays.model": key, **_CAMERA}) for key in models}
    shipped = {info.name: presets.load([info.name]) for info in presets.available() if info.group == "scene"}
    shipped |= {name: presets.load([scene], values) for name, (scene, values) in _HARDER.items()}
    found |= {name: met.without_any(scene).with_values(_OPEN) for name, scene in shipped.items() if is_field(scene) and scene.rays.lensing}
    yield from (ChartScene(name, scene, _RAYS) for name, scene in found.items())


def _rows(renderer: Renderer, item: ChartScene) -> Iterator[Measured]:
    for method in sensible(item.scene):
        for setting in (*_LONGEST, *method.settings()) if method.knob == "length" else method.settings():
            if method.knob == "tolerance" or setting >= item.scene.rays.field_way / MAX_STEPS:  # no step is stretched
                yield _row(renderer, item, method, setting)


def _row(renderer: Renderer, item: ChartScene, method: Combination, setting: float) -> Measured:
    scene, camera = method.applied(item.scene, setting), item.scene.camera
    made, flat = planning.plan(scene), planning.plan(timing.flat_scene(item.scene))
    found = listed_rays.trace_by_shader(renderer, scene, item.rays)
    errors = compare(found, item.truth, np.ones(len(item.rays), bool))
    for uncounted in (flat, made):
        _seconds(renderer, uncounted)
    cost = median(_seconds(renderer, made) / _seconds(renderer, flat) for _ in range(_ROUNDS))
    steps = {"length": math.nan, "tolerance": math.nan, method.knob: setting}
    return Measured(
        scene=f"field_{item.name}", spin=0.0, distance=camera.distance, inclination_deg=camera.inclination_deg, fov_deg=camera.fov_deg,
        model=method.model, integrator=method.integrator, step_control=method.step_control, step_length=steps["length"], step_angle=math.nan,
        direction_median=errors.direction_median, direction_99=errors.direction_99, direction_worst=errors.direction_worst,
        crossing_r_99=errors.crossing_r_99, g_99=errors.g_99, wrong_fates=errors.wrong_fates, evaluations=float(np.mean(found.evaluations)),
        cost_flat_ratio=cost, step_tolerance=steps["tolerance"], refined=0, cost_unrefined=math.nan,
        field=hardness.field_text(item.scene),
    )  # fmt: skip


def _seconds(renderer: Renderer, made: planning.Plan) -> float:
    """Processor time of one trace, which other work on the machine disturbs less than the clock on the wall."""
    renderer.hit_map.forget()
    start = time.process_time()
    renderer.time_trace(made, _SIZE)
    return time.process_time() - start


def page(rows: Sequence[Measured], scenes: Sequence[ChartScene], where: Origin) -> str:
    """The page as Markdown."""
    lines = [
        "# Accuracy and cost in fields",
        "",
        f"Made by `make fields`; do not edit. Measured on: {where.text}. The plan chooses by the same table, `assets/measurements_fields.csv`.",
        "",
        "Every field with the parameters that it comes with, seen from 25 r_s, as the shipped scenes have it, by their cameras and without their things, and",
        f"some that are harder; {_RAYS} rays through random pixels, in the pictures' own shader, against the field's own float64 twin.",
        "Cost is the processor time of a trace over that of straight rays right after, the median of nine. Where a field has parameters that are not here, the",
        "plan goes by those here that are as hard to march through: what the ray model's header says is `harder_with` no smaller and of the same sign, what is",
        "`milder_with` no larger, and all else equal. Where there is none, it takes step controls that judge their steps alone, by what was measured of the",
        "field as it comes.",
        "",
        "## The cheapest within half a pixel of a picture 1080 high, at 99 % of the rays",
        "",
        "| field | method | step | 99 % [rad] | [pixels] | evaluations a ray | cost / flat |",
        "| --- | --- | --- | ---: | ---: | ---: | ---: |",
    ]
    for item in scenes:
        own = _of(item, rows)
        good = sorted((row for row in own if row.direction_99 <= 0.5 * item.pixel and row.wrong_fates <= 0.01), key=lambda row: row.cost_flat_ratio)
        lines += [_line(row, item) for row in good[:3]]
    lines += ["", "## The least error", "", "| field | method | step | 99 % [rad] | [pixels] | evaluations a ray | cost / flat |"]
    lines.append("| --- | --- | --- | ---: | ---: | ---: | ---: |")
    for item in scenes:
        lines.append(_line(min(_of(item, rows), key=lambda row: row.direction_99), item))
    return "\n".join(lines) + "\n"


def _of(item: ChartScene, rows: Sequence[Measured]) -> list[Measured]:
    return [row for row in rows if row.scene == f"field_{item.name}"]


def _line(row: Measured, item: ChartScene) -> str:
    step = row.step_tolerance if math.isnan(row.step_length) else row.step_length
    cells = [item.name, f"{row.integrator}, {row.step_control}", short(step), short(row.direction_99), short(row.direction_99 / item.pixel)]
    return f"| {' | '.join([*cells, f'{row.evaluations:.0f}', short(row.cost_flat_ratio)])} |"


if __name__ == "__main__":
    main()
