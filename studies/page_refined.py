"""The section of docs/accuracy.md on refined hit maps."""

from __future__ import annotations

import math
from collections.abc import Sequence

from blackhole_gl.measure.scenes import ChartScene
from blackhole_gl.planning import REFINE_STEP
from blackhole_gl.planning.choice import REFINED_SIZE, REFINED_TOLERANCE
from studies.measure import Row
from studies.table import short


def refined_section(rows: Sequence[Row], scenes: Sequence[ChartScene]) -> str:
    """Each scene's cheapest refined method that keeps the tolerance, beside the same with a ray for every pixel, as Markdown."""
    width, height = REFINED_SIZE
    lines = [
        "## Refined maps: while the camera moves",
        "",
        f"*Refined* means: exact rays go through every {REFINE_STEP}th pixel each way; where these agree in fate and crossings and bend little",
        "from one to the next, the pixels between them are interpolated, and all others get exact rays of their own",
        "([performance.md](performance.md#refinement-under-a-moving-camera)).",
        "So a refined method is the method itself with an error of interpolation on top, held below a share of the scene's tolerance. Both error and",
        f"cost depend on the picture's size: these are of {width}×{height} pixels and a tolerance of {REFINED_TOLERANCE:g} px, a pixel is 1/{height}",
        "of the angle of view, and the flat frame is of that size too. In a picture of 320×180, the size of all other costs here, far more of the",
        "pixels could not be interpolated. Evaluations are the mean over all pixels, interpolated ones included.",
        "Crossings count where the disk is, and the error of a refined one is relative to the disk's outer radius.",
        "",
        f"Of each scene, the cheapest refined method within {REFINED_TOLERANCE:g} px; behind each figure in brackets the same method with",
        "a ray for every pixel.",
        "",
        "| scene | method | step | 99 % [pixels] | worst [pixels] | crossing r 99 % | wrong fates | evaluations a pixel | cost / flat |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for item in scenes:
        pixel = math.radians(item.scene.camera.fov_deg) / height
        good = [row for row in rows if row.scene == item.name and row.refined and row.direction_99 <= REFINED_TOLERANCE * pixel]
        if good:
            best = min(good, key=lambda row: row.cost_flat_ratio)
            cells = item.name, best.method.removesuffix(", refined"), short(best.setting), *_cells(best, _unrefined(rows, best), pixel)
            lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _unrefined(rows: Sequence[Row], refined: Row) -> Row | None:
    """The row of the same method and step with a ray for every pixel."""
    wanted = refined.scene, refined.method.removesuffix(", refined"), short(refined.setting)
    return next((row for row in rows if (row.scene, row.method, short(row.setting)) == wanted), None)


def _cells(refined: Row, alone: Row | None, pixel: float) -> list[str]:
    costs = f"{short(refined.cost_flat_ratio)} ({short(refined.cost_unrefined)})"
    own = _figures(refined, pixel)
    if alone is None:
        return [*map(short, own), costs]
    return [*(f"{short(value)} ({short(other)})" for value, other in zip(own, _figures(alone, pixel))), costs]


def _figures(row: Row, pixel: float) -> tuple[float, ...]:
    return row.direction_99 / pixel, row.direction_worst / pixel, row.crossing_r_99, row.wrong_fates, row.evaluations
