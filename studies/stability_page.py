"""The judgements as a table of data, why a cell is not fine, and docs/stability.md made from both."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterable, Mapping, Sequence

from blackhole_gl.measure.methods import Combination
from blackhole_gl.scene import catalogue
from studies.stability import DEGRADED, FAILS, FINE, NOT_APPLICABLE, Judgement, is_default, methods, traits
from studies.stability_case import DEGREE, FLOOR, HALF_PIXEL, SHADOW_FAILS, SHADOW_FINE, Case
from studies.stability_cases import CASES
from studies.stability_viewer import VIEWER_CASES

Judgements = Mapping[tuple[str, str], Judgement]
"""(case's key, method's name, or ``viewer``) → how it did."""

VIEWER = "viewer"

EXPLANATIONS: Mapping[str, str] = {
    "m": "The model is an approximation, and this is where it ends: no integrator helps.",
    "c": "The case asks for steps 7 to 14 times as long as the preset `reference`'s (16 times in angle): longer than what they are to resolve.",
    "o": "Truncation: at these steps an integrator of first to third order errs by more than the bound. Shorter steps or a higher order mend it.",
    "f": "A Cartesian step of fixed length is as long beside the horizon as far away.",
    "t": "The step control's tolerance, at its default, allows an error above the bound in one step or sums it up over several turns.",
    "h": "Beside the horizon of a fast spinning hole Kerr–Schild's momenta reach 1/Δ before a ray changes its chart: more than float32 holds.",
    "r": "Rounding beyond the bound: a Cartesian march of many evaluations a step near the critical curve. Its order is no help against float32.",
}
"""Why a cell is not fine, by the letter that stands in it."""


def explanation(case: Case, method: Combination) -> str:
    """The letter of `EXPLANATIONS` for a cell that is not fine; empty when there is none."""
    facts = traits(method)
    # Without spin `kerr_like` is Schwarzschild: what fails there is its method.
    is_approximate = not facts.exact and (facts.kind == "closed" or facts.space_time == "flat" or case.needs == "spin")
    if is_approximate:
        return "m"
    if case.topic == "long steps":
        return "c"
    if not method.integrator:
        return ""
    if catalogue.plug_ins("integrator")[method.integrator].traits.order <= 3:
        return "o"
    if method.step_control == "fixed":
        return "f"
    if method.model == "kerr_schild" and case.key in ("spin-limit", "spin-limit-reversed", "sweep"):
        return "h"
    if case.topic == "critical curve" and facts.marches_in == "cartesian":
        return "r"
    return "t" if catalogue.plug_ins("step_control")[method.step_control].traits.adapts else ""


def dumps(judgements: Judgements) -> str:
    """The judgements as CSV; ``why`` is a letter of `EXPLANATIONS`."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("case", "method", "verdict", "error", "note", "why"))
    letters = {(case.key, method.name): explanation(case, method) for case in CASES for method in methods()}
    for cell, found in judgements.items():
        why = letters.get(cell, "") if found.verdict in (DEGRADED, FAILS) else ""
        writer.writerow((*cell, found.verdict, "" if math.isnan(found.error) else f"{found.error:.1e}", found.note, why))
    return text.getvalue()


def loads(text: str) -> dict[tuple[str, str], Judgement]:
    """The judgements that `dumps` wrote."""
    rows = csv.DictReader(io.StringIO(text))
    return {(row["case"], row["method"]): Judgement(row["verdict"], row["note"], float(row["error"] or "nan")) for row in rows}


def page(judgements: Judgements) -> str:
    """docs/stability.md."""
    parts = [_head(), _defaults(judgements), _what_fails(judgements), _cases(), _viewer(judgements), _integrators(judgements), _step_controls(judgements)]
    return "\n\n".join(parts) + "\n"


def _head() -> str:
    return f"""# Stability: where methods fail

*Made by `make stability`; do not edit. Every cell, with its error and how it fails, is in [data/stability.csv](data/stability.csv); the tests in
`tests/stability` fail when this page, that table and what the shaders do part ways.*

{len(CASES)} cases × {len(methods())} methods. Each case has its own hole, camera and rays; each method traces them with the shader that pictures use,
at the steps of the preset `reference` (κ = 0.05 in Mino time, Δt₀ = 0.14 r_s in Cartesian space) unless the case says otherwise.
Judged against the float64 twin of the true space-time, and against closed forms for shadows and for the fates of random rays. `flat` is
judged against flat space.

| | |
| --- | --- |
| {_SIGNS[FINE]} | fine: every ray has its true fate, no disk crossing is lost or made up, the worst direction errs by no more than {HALF_PIXEL:g} rad \
(half a pixel of a picture 1080 pixels and 45° high), the worst crossing by no more than that share of its radius; \
a shadow's angle is within {100 * SHADOW_FINE:g} % |
| {_SIGNS[DEGRADED]} | degraded: the fates are right, the worst error is at most {DEGREE:g} (about a degree); a shadow within {100 * SHADOW_FAILS:g} % |
| {_SIGNS[FAILS]} | fails |
| {_SIGNS[NOT_APPLICABLE]} | does not apply: the model has no spin, no steps, no horizon, or no artistic gravity |

Near the critical curve rounding alone grows as 1/ε. There the bound is {FLOOR:g}/ε for the worst ray; in Mino time the worst is a tenth of that,
the typical ray 1e-7/ε. Steps finer than the reference's make it worse in every method. At ε = 1e-6 fates alone are judged; at 1e-7, where float32
numbers lie as far apart, only that a ray has one."""


_SIGNS = {FINE: "·", DEGRADED: "~", FAILS: "✗", NOT_APPLICABLE: "–"}


def _defaults(judgements: Judgements) -> str:
    chosen = [method for method in methods() if is_default(method)]
    lines = ["## Every model by its default method", "", _row("case", (f"`{method.model}`" for method in chosen)), _row("---", [":---:"] * len(chosen))]
    lines += [_row(case.key, (_SIGNS[judgements[case.key, method.name].verdict] for method in chosen)) for case in CASES]
    return "\n".join(lines)


def _row(first: str, cells: Iterable[str]) -> str:
    return f"| {first} | {' | '.join(cells)} |"


def _what_fails(judgements: Judgements) -> str:
    lines = ["## What fails, and why", "", "| model, by its default method | case | what comes out | why |", "| --- | --- | --- | --- |"]
    for method in filter(is_default, methods()):
        bad = [case for case in CASES if judgements[case.key, method.name].verdict in (DEGRADED, FAILS)]
        if not traits(method).exact:
            if bad:
                lines.append(f"| `{method.model}` | {len(bad)} of {_count(judgements, method)} | in the table above | **m** |")
            continue
        lines += [f"| `{method.model}` | {case.key} | {_told(judgements[case.key, method.name])} | **{explanation(case, method)}** |" for case in bad]
    letters = [f"- **{letter}** {text}" for letter, text in EXPLANATIONS.items()]
    return "\n".join([*lines, "", "The letters, which the data has for every cell that is not fine:", "", *letters])


def _told(found: Judgement) -> str:
    error = "" if math.isnan(found.error) or found.note not in ("", "direction or crossing") else f"{found.error:.0e}"
    return " ".join(part for part in (found.note, error) if part)


def _count(judgements: Judgements, method: Combination) -> int:
    """How many cases apply to it."""
    return sum(judgements[case.key, method.name].verdict != NOT_APPLICABLE for case in CASES)


def _share(judgements: Judgements, method: Combination) -> str:
    fine = sum(judgements[case.key, method.name].verdict == FINE for case in CASES)
    return f"{fine} of {_count(judgements, method)}"


def _cases() -> str:
    lines = ["## The cases", "", "| case | about | what is asked | what goes wrong |", "| --- | --- | --- | --- |"]
    lines += [f"| {case.key} | {case.topic} | {case.title} | {case.why} |" for case in CASES]
    return "\n".join(lines)


def _viewer(judgements: Judgements) -> str:
    lines = ["## The whole viewer", "", "Cases that depend on no ray method, drawn with the default one.", ""]
    lines += ["| case | what is asked | what goes wrong | verdict | measured |", "| --- | --- | --- | --- | --- |"]
    for case in VIEWER_CASES:
        found = judgements[case.key, VIEWER]
        verdict = FINE if found.verdict == FINE else f"✗ {found.note}"
        lines.append(f"| {case.key} | {case.title} | {case.why} | {verdict} | {found.error:.3g} {case.unit} |")
    return "\n".join(lines)


def _integrators(judgements: Judgements) -> str:
    text = "Cases that are fine of those that apply, for marched models with their own step control. Where a model is an approximation no integrator helps."

    def by_own_control(model: str, integrator: str) -> Combination:
        return Combination(model, integrator, traits(Combination(model)).step_control or "")

    return _grid(judgements, "Integrators", text, catalogue.keys("integrator"), by_own_control)


def _step_controls(judgements: Judgements) -> str:
    text = "The same with the integrator `dopri5`, which has the error estimate that `embedded` needs."
    return _grid(judgements, "Step controls", text, catalogue.keys("step_control"), lambda model, key: Combination(model, "dopri5", key))


def _grid(judgements: Judgements, title: str, text: str, keys: Sequence[str], method_of: Callable[[str, str], Combination]) -> str:
    """How many cases are fine for every marched model with every one of `keys`; a dash where the two do not fit."""
    every = methods()
    lines = [f"## {title}", "", text, "", _row("model", (f"`{key}`" for key in keys)), _row("---", ["---:"] * len(keys))]
    for model in dict.fromkeys(method.model for method in every if method.integrator):
        lines.append(_row(f"`{model}`", (_share(judgements, method) if method in every else "–" for method in (method_of(model, key) for key in keys))))
    return "\n".join(lines)
