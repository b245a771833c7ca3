"""The stability page: verdicts as a CSV table, their explanations, and docs/stability.md made from both."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping

from blackhole_gl.measure.methods import Method
from blackhole_gl.scene import catalogue
from studies.stability import DEGRADED, FAILS, FINE, NOT_APPLICABLE, Outcome, is_default, methods, traits
from studies.stability_cases import CASES, DEGREE, FLOOR, HALF_PIXEL, SHADOW_FAILS, SHADOW_FINE, Case
from studies.stability_viewer import VIEWER_CASES

Verdicts = Mapping[tuple[str, str], Outcome]
"""(case's key, method's name, or ``viewer``) → outcome."""

VIEWER = "viewer"

EXPLANATIONS: Mapping[str, str] = {
    "m": "The model is an approximation, and this is where it ends: no integrator helps. The line above the model's own tables says what it is.",
    "c": "The case asks for steps 7 to 14 times as long as the reference quality's (16 times in angle): longer than what they are to resolve.",
    "o": "Truncation: at these steps an integrator of first to third order errs by more than the bound. Shorter steps or a higher order mend it.",
    "f": "A Cartesian step of fixed length is as long beside the horizon as far away.",
    "t": "The step control's tolerance, at its default, allows an error above the bound in one step or sums it up over several turns.",
    "h": "Beside the horizon of a fast spinning hole Kerr–Schild's momenta reach 1/Δ before a ray changes its chart: more than float32 holds.",
    "r": "Rounding beyond the bound: a Cartesian march of many evaluations a step near the critical curve. Its order is no help against float32.",
}
"""Why a cell is not fine, by the letter that stands in it."""


def explanation(case: Case, method: Method) -> str:
    """The letter of `EXPLANATIONS` for a cell that is not fine; empty when there is none."""
    facts = traits(method)
    # Without spin `kerr_like` is Schwarzschild: what fails there is its method.
    is_approximate = not facts.exact and (facts.kind == "closed" or facts.space_time == "flat" or case.needs == "spin")
    if is_approximate:
        return "m"
    if case.entry == "9.4":
        return "c"
    if not method.integrator:
        return ""
    if catalogue.plug_ins("integrator")[method.integrator].traits.order <= 3:
        return "o"
    if method.step_control == "fixed":
        return "f"
    if method.model == "kerr_schild" and case.key in ("spin-limit", "spin-limit-reversed", "sweep"):
        return "h"
    if case.entry == "9.6" and facts.marches_in == "cartesian":
        return "r"
    return "t" if catalogue.plug_ins("step_control")[method.step_control].traits.adapts else ""


def dumps(verdicts: Verdicts) -> str:
    """The verdicts as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("case", "method", "verdict", "error", "note"))
    for (case, method), outcome in verdicts.items():
        writer.writerow((case, method, outcome.verdict, "" if math.isnan(outcome.error) else f"{outcome.error:.1e}", outcome.note))
    return text.getvalue()


def loads(text: str) -> dict[tuple[str, str], Outcome]:
    """The verdicts that `dumps` wrote."""
    rows = csv.DictReader(io.StringIO(text))
    return {(row["case"], row["method"]): Outcome(row["verdict"], row["note"], float(row["error"] or "nan")) for row in rows}


def page(verdicts: Verdicts) -> str:
    """docs/stability.md."""
    found = methods()
    parts = [_head(verdicts, found), _defaults(verdicts, found), _cases(), _viewer(verdicts), _counts(verdicts, found)]
    for model in dict.fromkeys(method.model for method in found):
        own = [method for method in found if method.model == model]
        if len(own) > 1:
            parts.append(_model_section(verdicts, model, own))
    return "\n\n".join(parts) + "\n"


def _head(verdicts: Verdicts, found: list[Method]) -> str:
    letters = "\n".join(f"- **{letter}** {text}" for letter, text in EXPLANATIONS.items())
    return f"""# Stability: where methods fail

*Made by `make stability`; do not edit. The verdicts are also in [tests/stability/verdicts.csv](../tests/stability/verdicts.csv), and the tests beside it
fail when this page and what the shaders do part ways.*

{len(CASES)} cases × {len(found)} methods. Each case has its own hole, camera and rays; each method traces them with the shader that pictures use,
at the steps of the quality preset `reference` (κ = 0.05 in Mino time, Δt₀ = 0.14 r_s in Cartesian space) unless the case says otherwise.
Judged against the float64 twin of the true space-time, and against closed forms for shadows and for the fates of random rays. `flat` is
judged against flat space.

- **fine**: every ray has its true fate, no disk crossing is lost or made up, the worst direction errs by no more than {HALF_PIXEL:g} rad (half
  a pixel of a picture 1080 pixels and 45° high) and the worst crossing by no more than that share of its radius; a shadow's angle is within {100 * SHADOW_FINE:g} %.
- **~ 2e-03**, degraded: the fates are right, the worst error is the one given and at most {DEGREE:g} (about a degree); a shadow
  within {100 * SHADOW_FAILS:g} %.
- **✗**: fails, and how.
- **–**: does not apply, and why.

Near the critical curve rounding alone grows as 1/ε. There the bound is {FLOOR:g}/ε for the worst ray; in Mino time the worst is a tenth of that,
the typical ray 1e-7/ε. Steps finer than the reference's make it worse in every method. At ε = 1e-6 fates alone are judged; at 1e-7, where float32 numbers lie as far apart,
only that a ray has one.

A letter says why a cell is not fine:

{letters}"""


def _defaults(verdicts: Verdicts, found: list[Method]) -> str:
    chosen = [method for method in found if is_default(method)]
    return "## Every model by its default method\n\n" + _table(verdicts, chosen, [method.model for method in chosen])


def _cases() -> str:
    lines = ["## The cases", "", "| case | §9 | what is asked | what goes wrong |", "| --- | --- | --- | --- |"]
    lines += [f"| {case.key} | {case.entry} | {case.title} | {case.why} |" for case in CASES]
    return "\n".join(lines)


def _viewer(verdicts: Verdicts) -> str:
    lines = ["## The whole viewer", "", "Cases that depend on no ray method, drawn with the default one.", ""]
    lines += ["| case | §9 | what is asked | what goes wrong | verdict | measured |", "| --- | --- | --- | --- | --- | --- |"]
    for case in VIEWER_CASES:
        outcome = verdicts[case.key, VIEWER]
        verdict = FINE if outcome.verdict == FINE else f"✗ {outcome.note}"
        lines.append(f"| {case.key} | {case.entry} | {case.title} | {case.why} | {verdict} | {outcome.error:.3g} {case.unit} |")
    return "\n".join(lines)


def _counts(verdicts: Verdicts, found: list[Method]) -> str:
    kinds = (FINE, DEGRADED, FAILS, NOT_APPLICABLE)
    lines = ["## All methods at a glance", "", "| method | " + " | ".join(kinds) + " |", "| --- |" + " ---: |" * len(kinds)]
    for method in found:
        counts = [sum(verdicts[case.key, method.name].verdict == kind for case in CASES) for kind in kinds]
        lines.append(f"| {method.name} | " + " | ".join(map(str, counts)) + " |")
    return "\n".join(lines)


def _model_section(verdicts: Verdicts, model: str, own: list[Method]) -> str:
    plug_in = catalogue.plug_ins("ray_model")[model]
    tables = []
    for integrator in dict.fromkeys(method.integrator for method in own):
        columns = [method for method in own if method.integrator == integrator]
        heads = [", ".join([integrator, method.step_control] if integrator else [method.name]) for method in columns]
        tables.append(_table(verdicts, columns, heads))
    return "\n\n".join([f"## {plug_in.label} (`{model}`)", plug_in.summary, *tables])


def _table(verdicts: Verdicts, columns: list[Method], heads: list[str]) -> str:
    lines = ["| case | " + " | ".join(heads) + " |", "| --- |" + " --- |" * len(heads)]
    for case in CASES:
        lines.append(f"| {case.key} | " + " | ".join(_cell(case, method, verdicts[case.key, method.name]) for method in columns) + " |")
    return "\n".join(lines)


def _cell(case: Case, method: Method, outcome: Outcome) -> str:
    if outcome.verdict == FINE:
        return "fine"
    if outcome.verdict == NOT_APPLICABLE:
        return f"– {outcome.note}"
    letter = f" **{explanation(case, method)}**"
    error = "" if math.isnan(outcome.error) else f"{outcome.error:.0e}"
    if outcome.verdict == DEGRADED:
        return f"~ {outcome.note or error}{letter}"
    return f"✗ {outcome.note}" + (f" {error}" if outcome.note == "direction or crossing" else "") + letter
