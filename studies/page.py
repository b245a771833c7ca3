"""docs/accuracy.md: what was measured, in words and tables."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from blackhole_gl.measure.scenes import SHOWN, ChartScene
from blackhole_gl.scene import catalogue
from studies.critical import Point
from studies.finest import AWAY, BOUNDS, CLOSE, Finest
from studies.lens_by_distance import LensError
from studies.measure import Row
from studies.page_lens import lens_section
from studies.page_refined import refined_section
from studies.pareto import front
from studies.sizes import Cost
from studies.table import Origin, short
from studies.validation import DRIFT_LENGTH, DRIFT_STEPS, Validation


@dataclass(frozen=True)
class Findings:
    """All that the page tells of.

    Attributes:
        chosen: the row that the plan chooses, by scene.
        outside: records of the comparison with public codes (tools/compare_public_code.py); empty when it was not made.
    """

    scenes: Sequence[ChartScene]
    rows: Sequence[Row]
    points: Sequence[Point]
    costs: Sequence[Cost]
    validation: Validation
    finest: Sequence[Finest]
    chosen: Mapping[str, Row]
    lens: Sequence[LensError]
    outside: Sequence[Mapping[str, str]]


def page(found: Findings, where: Origin, command: str) -> str:
    """The page as Markdown."""
    parts = [_head(found, where, command), _methods(found), refined_section(found.rows, found.scenes), _floors(found)]
    parts += [_finest(found.finest), _best(found), _critical(), lens_section(found.lens)]
    return "\n".join([*parts, _sizes(found), _validation(found.validation), _outside(found.outside)])


def _head(found: Findings, where: Origin, command: str) -> str:
    methods, moving = ({row.method for row in found.rows if row.refined == refined} for refined in (0, 1))
    scenes = "\n".join(_scene_line(item) for item in found.scenes)
    return f"""# Accuracy and cost

Made by `{command}`; do not edit. Measured on: {where.text}. The numbers behind it: [data/accuracy.csv](data/accuracy.csv),
[data/accuracy_critical.csv](data/accuracy_critical.csv), [data/accuracy_sizes.csv](data/accuracy_sizes.csv), [data/accuracy_lens.csv](data/accuracy_lens.csv).

{len(methods)} methods (a ray model, an integrator, a step control), {len(moving)} of them also refined, {len(found.rows)} rows, {len(found.scenes)}
scenes: the chart's own and, in a full run, every shipped preset that shows a hole as it is. In each, {found.scenes[0].count:,} rays
through the centres of random pixels (fixed seed) go through the pictures' own shader in 32-bit numbers, and through the float64 twin of the
*true* space-time: `schwarzschild` where a* = 0, `kerr` elsewhere and inside the horizon, whatever the method believes in.
A wrong force law therefore shows as a floor that no finer step lowers. Rays closer than ε = 1e-3 to the critical curve (the shadow's edge) are
counted apart: there every method's error grows without bound. Cost is the shortest of the interleaved frame times over that of the same scene in flat space;
evaluations of the right-hand side are counted too, and no noise moves those. A pixel is 1/1080 of the angle of view. For cameras inside the horizon the flat
frame is that from just outside.

| scene | a* | distance [r_s] | inclination | angle of view | observer |
| --- | --- | --- | --- | --- | --- |
{scenes}
"""


def _scene_line(item: ChartScene) -> str:
    hole, camera = item.scene.hole, item.scene.camera
    view = f"{camera.field_m:g} M high" if math.isinf(camera.distance) else f"{camera.fov_deg:g}°"
    return f"| {item.name} | {hole.spin:g} | {camera.distance:g} | {camera.inclination_deg:g}° | {view} | {camera.observer} |"


def _methods(found: Findings) -> str:
    lines = [
        "## Error against cost",
        "",
        "![Error against cost, one curve a method](pictures/accuracy_methods.png)",
        "",
        "Down and to the left is better. Finer steps go right; where a curve turns up again, rounding has taken over. "
        "L, M, H, U are the presets of BlackHoleGPU's steps.",
        "Open marks are refined maps, as while the camera moves; their costs are of larger pictures, see below.",
        "",
        "What 99 % of the rays keep within half a pixel at 1080p, and at what cost at least: the cheapest three methods a scene.",
        "",
        "| scene | pixel [rad] | method | step | 99 % [rad] | [pixels] | crossing r 99 % | g 99 % | evaluations a ray | cost / flat |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for chart_scene in found.scenes:
        for row in _cheapest(found.rows, chart_scene, 3):
            lines.append(
                f"| {row.scene} | {chart_scene.pixel:.2g} | {row.method} | {short(row.setting)} | {short(row.direction_99)} | "
                f"{short(row.direction_99 / chart_scene.pixel)} | "
                f"{short(row.crossing_r_99)} | {short(row.g_99)} | {row.evaluations:.0f} | {short(row.cost_flat_ratio)} |"
            )
    if found.chosen:
        lines += [
            "",
            "The plan's own choice, from the stored table. Costs there lie on each method's line of cost against evaluations, as single ones scatter by",
            "a tenth and more; below stand those measured:",
            "",
            "| scene | method | step | 99 % [pixels] | cost / flat |",
            "| --- | --- | --- | --- | --- |",
        ]
        pixel = {item.name: item.pixel for item in found.scenes}
        for name, row in found.chosen.items():
            lines.append(f"| {name} | {row.method} | {short(row.setting)} | {short(row.direction_99 / pixel[name])} | {short(row.cost_flat_ratio)} |")
    return "\n".join(lines) + "\n"


def _cheapest(rows: Sequence[Row], chart_scene: ChartScene, count: int) -> list[Row]:
    """The cheapest row that is within half a pixel of each of the cheapest `count` methods."""
    own = [row for row in rows if row.scene == chart_scene.name and not row.refined]
    good = [row for row in own if row.direction_99 <= 0.5 * chart_scene.pixel and row.wrong_fates <= 0.001]
    found: dict[str, Row] = {}
    for row in sorted(good, key=lambda row: row.cost_flat_ratio):
        found.setdefault(row.method, row)
    return list(found.values())[:count]


def _floors(found: Findings) -> str:
    lines = [
        "## Floors: what no step lowers",
        "",
        "The lowest error that each model reaches in each of the four scenes, in radians (99 %, any integrator and step).",
        "In brackets: against the model's own twin.",
        "",
        "| model | " + " | ".join(SHOWN) + " |",
        "| --- |" + " --- |" * len(SHOWN),
    ]
    for model in catalogue.keys("ray_model"):
        cells = []
        for scene in SHOWN:
            rows = [row for row in found.rows if (row.model, row.scene) == (model, scene) and not row.refined]
            own = [row.own_direction_99 for row in rows if not math.isnan(row.own_direction_99)]
            lowest = min((row.direction_99 for row in rows if not math.isnan(row.direction_99)), default=math.nan)
            cells.append(short(lowest) + (f" ({short(min(own))})" if own and min(own) < 0.5 * lowest else ""))
        if any(cell != "–" for cell in cells):
            lines.append(f"| {model} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + """

**The post-Newtonian floor.** `post_newtonian` adds a relativistic term to Newton's force on a slow mass. Light is not slow: the relativistic term alone
is its whole bending, 4M/b far away, and Newton's term adds another 2M/b, half as much again. The error does not shrink with the step, because the integrator
solves the wrong equation exactly. It is there at every distance: see the deflections below, and near the hole the shadow is about 30 % too large.

**Ignoring the spin** (`schwarzschild`, `schwarzschild_binet` where a* ≠ 0) has a floor as well: dragging changes the deflection by about 4 a* M²/b²
on either side (Edery & Godin 2006). `kerr_like` twists the whole orbit by the far rate and comes no nearer.

**The float32 floor.** A ray is a few dozen steps; each rounds at 6e-8. Shorter steps mean more of them: below a certain length they add rounding and take away
nothing. In Cartesian space that is near Δt₀ = 0.15 r_s for `rk4` (the table's minima are there), in Mino time near κ = 0.05. What is left is
some 1e-6 to 1e-5 rad at 99 %, about a hundredth of a pixel. Adaptive controls are told an error for each step: below a tolerance of 1e-6 rad what they measure
is rounding, and they shorten steps to no end.
"""


def _finest(found: Sequence[Finest]) -> str:
    names = {"direction_median": "direction median", "direction_99": "99 %", "crossing_r_median": "crossing r median", "crossing_r_99": "99 %"}
    names |= {"g_99": "g 99 %", "wrong_fates": "wrong fates"}
    lines = [
        "## The finest steps against their bounds",
        "",
        f"Errors of rays at ε ≥ {AWAY:g}; fates at ε ≥ {CLOSE:g}. A value in bold misses its bound.",
        "",
        "| scene | method | step | " + " | ".join(names.values()) + " |",
        "| --- | --- | --- |" + " --- |" * len(names),
        "| bound | | | " + " | ".join(short(bound) for bound in BOUNDS.values()) + " |",
    ]
    for item in found:
        cells = [short(getattr(item, name)) if getattr(item, name) <= bound else f"**{short(getattr(item, name))}**" for name, bound in BOUNDS.items()]
        lines.append(f"| {item.scene} | {item.method} | {item.setting:g} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n" + _FINEST_REMARK


_FINEST_REMARK = """
What is left is rounding. The list of rays itself is in 32-bit numbers, so that a ray starts 6e-8 rad off, which the way magnifies by 1/ε; then come some fifty
steps, each rounded. Close to the critical curve a ray's fate is that of its rounded start.
"""


def _best(found: Findings) -> str:
    lines = [
        "## The Pareto front",
        "",
        "Methods that no other beats in both cost and error, by scene, from cheap to exact.",
        "",
        "| scene | method | step | median [rad] | 99 % [rad] | worst [rad] | wrong fates | near-critical: median [rad] | cost / flat |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for scene in SHOWN:
        rows = [row for row in found.rows if row.scene == scene and not row.refined]
        for index in front([row.cost_flat_ratio for row in rows], [row.direction_99 for row in rows]):
            row = rows[index]
            errors = (row.direction_median, row.direction_99, row.direction_worst, row.wrong_fates, row.near_direction_median)
            numbers = (row.setting, *errors, row.cost_flat_ratio)
            lines.append(f"| {scene} | {row.method} | " + " | ".join(short(value) for value in numbers) + " |")
    return "\n".join(lines) + "\n"


def _critical() -> str:
    return """## Near the critical curve

![Error against distance from the critical curve](pictures/accuracy_critical.png)

A ray at relative distance ε from the critical curve winds round the photon sphere about ln(1/ε)/2π times, and every half turn multiplies what was
wrong before by e^π. What rounding the start takes away, some 1e-7, is 1e-7/ε at the end: the grey line. No method in 32-bit numbers gets below it, and
coarse steps stay above it by their own error times the same 1/ε. Where the shadow's radius is 200 pixels, ε = 1e-3 is a fifth of a pixel from its edge.
"""


def _sizes(found: Findings) -> str:
    sizes = sorted({(cost.width, cost.height) for cost in found.costs})
    lines = [
        "## Cost against pixels",
        "",
        "![Trace time against the number of pixels](pictures/accuracy_sizes.png)",
        "",
        "Trace time in milliseconds, and in brackets as a ratio to the flat frame of the same size.",
        "",
        "| method | " + " | ".join(f"{width}×{height}" for width, height in sizes) + " |",
        "| --- |" + " --- |" * len(sizes),
    ]
    for method in dict.fromkeys(cost.method for cost in found.costs):
        by_size = {(cost.width, cost.height): cost for cost in found.costs if cost.method == method}
        lines.append(f"| {method} | " + " | ".join(f"{by_size[size].milliseconds:.1f} ({by_size[size].flat_ratio:.1f})" for size in sizes) + " |")
    return "\n".join(lines) + """

Time grows with the pixels; the ratio is lower in small frames, where what a frame costs in any case weighs more in the flat one.
Refinement is worth more the larger the picture: what cannot be interpolated is a strip a few cells wide along edges and creases, and its share falls as
the number of cells grows.
"""


def _validation(found: Validation) -> str:
    lines = [
        "## BlackHoleGPU's validation, made again",
        "",
        "The report of [BlackHoleGPU](sources.md) (October 2025) states three checks: drift of conserved quantities under 1 % over 1,000 steps, the",
        "photon sphere to 0.1 %, and deflection against 4GM/c²b.",
        "",
        f"Drift over {DRIFT_STEPS:,} steps of {DRIFT_LENGTH} r_s of x'' = −(3/2) h² x/r⁵ in float32 (NumPy), largest of 64 rays that come from",
        "20 r_s with b = 2.7 to 10 r_s:",
        "",
        "| integrator | energy | angular momentum |",
        "| --- | --- | --- |",
        *(f"| {drift.integrator} | {drift.energy:.1e} | {drift.angular_momentum:.1e} |" for drift in found.drifts),
        "",
        "Photon sphere, from the edge of the shadow that the shader draws, r = b_c/√3; 3/2 r_s is exact:",
        "",
        "| model | r [r_s] | off by |",
        "| --- | --- | --- |",
        *(f"| {sphere.model} | {sphere.radius:.7f} | {abs(sphere.radius / 1.5 - 1.0):.1e} |" for sphere in found.photon_spheres),
        "",
        "Deflection in radians of parallel rays from infinity, by the shader; first order is 4GM/c²b = 2/b, exact is a complete elliptic integral:",
        "",
    ]
    models = list(found.deflections[0].by_model)
    lines += ["| b [r_s] | first order | exact | " + " | ".join(models) + " | post_newtonian / first order |", "| --- |" + " --- |" * (3 + len(models))]
    for item in found.deflections:
        cells = [_deflection(value) for value in (item.weak, item.exact, *item.by_model.values())]
        ratio = item.by_model.get("post_newtonian", math.nan) / item.weak
        lines.append(f"| {item.b:g} | " + " | ".join(cells) + f" | {'captured' if math.isnan(ratio) else f'{ratio:.3f}'} |")
    return "\n".join(lines) + """

The last column tends to 3/2: light bends half as much again as it should. The first-order formula itself is 15 % low at b = 10 r_s; pictures
near a hole need the exact one.
"""


_OUTSIDE_REMARK = """kerrz takes spins below 0.001 for 0.001. Its azimuth at infinity departs from ours for some of the rays that have passed a turning
point in θ, while θ itself agrees for every ray, and so does everything at the first crossing. On those azimuths our two independent forms,
Mino time and Kerr–Schild coordinates, agree with each other; we take the difference to be kerrz's."""


def _outside(records: Sequence[Mapping[str, str]]) -> str:
    lines = ["## Against independent public codes", ""]
    if not records:
        return "\n".join([*lines, "`tools/compare_public_code.py` makes this comparison; it has not been run here."]) + "\n"
    header = list(records[0])
    lines += [
        "Made by `tools/compare_public_code.py`, with the code installed apart from this project: parallel rays over a disc of 25 M, off the",
        "critical curve (ε ≥ 1e-2).",
        "Relative differences of r and g at the first crossing, within 40 M; angles in radians. Number of rays, 99 %, largest.",
        "",
    ]
    lines += ["| " + " | ".join(header) + " |", "| --- " * len(header) + "|"]
    lines += ["| " + " | ".join(record.values()) + " |" for record in records]
    lines += ["", _OUTSIDE_REMARK]
    return "\n".join(lines) + "\n"


def _deflection(value: float) -> str:
    return "captured" if math.isnan(value) else f"{value:.6f}"
