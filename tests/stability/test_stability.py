"""The stability page is what the shaders do: stored verdicts against a new run, exact models without an unlisted failure, every failure explained."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from blackhole_gl import planning
from blackhole_gl.physics import observer, relativity
from blackhole_gl.planning import steps
from blackhole_gl.rendering.frame import Renderer
from studies import stability, stability_page
from studies.stability_case import Topic, impact
from studies.stability_cases import CASES
from studies.stability_viewer import VIEWER_CASES
from tests.sampled import sampled

ROOT = Path(__file__).resolve().parents[2]
TABLE = (ROOT / "docs" / "data" / "stability.csv").read_text(encoding="utf-8")
STORED = stability_page.loads(TABLE)
METHODS = {method.name: method for method in stability.methods()}
DEFAULTS = [method for method in METHODS.values() if stability.is_default(method)]
RENEW = "run make stability"

# Where the default methods of models called exact fail or are degraded. Everything else that applies to them is fine.
KNOWN_FAILURES = {
    # Steps of 1 r_s, or of 0.8 rad, are too long for a ray this near the critical curve, and in Kerr–Schild's coupled
    # form for crossings to better than 0.1 r.
    ("false-capture", "schwarzschild, rk4, radius"),
    ("false-capture", "kerr_schild, rk4, mino"),
    ("disk-jump", "kerr_schild, rk4, mino"),
    # Cameras beside the horizon of |a*| > 0.99: fewer than one random ray in a thousand has no fate.
    ("sweep", "kerr_schild, rk4, mino"),
}

# A full run of all methods is `make stability`; the suite runs the default methods through every case, and these through a few.
FEW_CASES = ("shadow-15", "tunnel-1.5", "critical-1e-3", "far-camera", "horizon")
OTHER_MODELS = ("kerr", "schwarzschild")

SWEEP_RAYS = 4000


def test_every_cell_is_there() -> None:
    wanted = {(case.key, name) for case in CASES for name in METHODS} | {(case.key, stability_page.VIEWER) for case in VIEWER_CASES}
    assert set(STORED) == wanted, RENEW


def test_every_topic_has_a_case() -> None:
    assert {case.topic for case in CASES} == set(get_args(Topic))


def test_the_table_says_why_as_the_page_does() -> None:
    assert stability_page.dumps(STORED) == TABLE, RENEW


def test_the_page_is_made_from_the_table_and_short_enough_to_read() -> None:
    assert (ROOT / "docs" / "stability.md").read_text(encoding="utf-8") == stability_page.page(STORED), RENEW
    assert len(stability_page.page(STORED).splitlines()) < 250


def test_exact_models_pass_all_that_applies() -> None:
    exact = [method for method in DEFAULTS if stability.traits(method).exact]
    failed = {(case.key, method.name) for case in CASES for method in exact if STORED[case.key, method.name].verdict in (stability.FAILS, stability.DEGRADED)}
    assert failed == KNOWN_FAILURES


def test_every_failure_is_explained() -> None:
    bad = [(case, method) for case in CASES for method in METHODS.values() if STORED[case.key, method.name].verdict in (stability.FAILS, stability.DEGRADED)]
    assert [(case.key, method.name) for case, method in bad if not stability_page.explanation(case, method)] == []


def test_nothing_is_ever_not_finite() -> None:
    assert [cell for cell, judgement in STORED.items() if "not finite" in judgement.note] == []


@pytest.mark.parametrize("method", DEFAULTS, ids=lambda method: method.model)
def test_default_methods_do_what_the_page_says(renderer: Renderer, method: stability.Combination) -> None:
    differing = [line for case in CASES if (line := _difference(renderer, case, method))]
    assert differing == [], RENEW


@pytest.mark.parametrize("key", FEW_CASES)
@pytest.mark.parametrize("model", OTHER_MODELS)
def test_other_integrators_do_what_the_page_says(renderer: Renderer, model: str, key: str) -> None:
    case = next(case for case in CASES if case.key == key)
    own = [method for method in METHODS.values() if method.model == model and method.step_control == stability.traits(method).step_control]
    assert [line for method in own if (line := _difference(renderer, case, method))] == [], RENEW


# Every switch and choice is drawn by test_compose.py; here again, turned while a picture stands.
QUICK_CASES = [case for case in VIEWER_CASES if case.key != "switches"]


@pytest.mark.parametrize("case", sampled(VIEWER_CASES, QUICK_CASES), ids=lambda case: case.key)
def test_the_viewer_does_what_the_page_says(renderer: Renderer, case) -> None:
    judgement = case.run(renderer, False)
    assert judgement.verdict == STORED[case.key, stability_page.VIEWER].verdict, judgement


@pytest.mark.slow
@pytest.mark.parametrize("method", [method for method in METHODS.values() if method not in DEFAULTS], ids=lambda method: method.name)
def test_every_other_method_does_what_the_page_says(renderer: Renderer, method: stability.Combination) -> None:
    assert [line for case in CASES if (line := _difference(renderer, case, method))] == [], RENEW


@pytest.mark.slow
@pytest.mark.parametrize("case", [case for case in VIEWER_CASES if case.key in ("sizes", "tiles")], ids=lambda case: case.key)
def test_the_largest_pictures(renderer: Renderer, case) -> None:
    """4096×4096 in one piece and 7680×4320 in tiles."""
    judgement = case.run(renderer, True)
    assert judgement.verdict == stability.FINE, judgement


@pytest.mark.slow
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("method", DEFAULTS, ids=lambda method: method.model)
def test_a_million_random_rays(renderer: Renderer, method: stability.Combination) -> None:
    """Whole sky, whole range of holes and cameras: no more is unresolved than the page states, and nothing is not finite."""
    judgement = stability.sweep(renderer, method, 1_000_000)
    assert judgement.verdict == STORED["sweep", method.name].verdict, judgement


@pytest.mark.parametrize("bound", [8.0, 40.0])
def test_escape_directions_do_not_depend_on_the_stop_radius(renderer: Renderer, monkeypatch: pytest.MonkeyPatch, bound: float) -> None:
    """Left uncorrected, stopping at 8 r_s instead of 40 would turn these rays by up to 0.2 rad."""
    case = next(case for case in CASES if case.key == "stop-radius")
    scene = stability.scene_of(case, METHODS["schwarzschild, rk4, radius"])
    rays = impact(3.0, 5.0, 7.0)(scene)
    directions = observer.local_directions(rays[:, 0], rays[:, 1])
    usual, _, _ = renderer.trace_listed(scene, directions)
    with monkeypatch.context() as changed:
        changed.setattr(steps, "MARCH_BOUND", bound)
        planning.plan.cache_clear()
        moved, _, _ = renderer.trace_listed(scene, directions)
        planning.plan.cache_clear()
    assert np.any(moved.steps != usual.steps)
    assert np.linalg.norm(moved.direction - usual.direction, axis=1).max() < 2e-5


@pytest.mark.parametrize("distance, excess", [(15.0, 0.034), (3.0, 0.13)])
def test_what_skipping_the_observers_frame_would_cost(distance: float, excess: float) -> None:
    """With u' = −u cot ψ instead of √(1 − u) of it, the ray at ψ has 1/b² = u²(1/sin²ψ − u)."""
    u = 1.0 / distance
    skipped = np.arcsin(1.0 / np.sqrt(1.0 / (u * relativity.CRITICAL_IMPACT) ** 2 + u))
    assert skipped / relativity.schwarzschild_shadow_angle(distance) - 1.0 == pytest.approx(excess, rel=0.05)


def _difference(renderer: Renderer, case, method: stability.Combination) -> str:
    """How a new run of a cell differs from the stored one; empty when it does not. Degraded and failed count alike: drivers round in their own ways."""
    stored = STORED[case.key, method.name]
    found = stability.run(renderer, case, method, SWEEP_RAYS if stability.is_default(method) else stability.OTHER_SWEEP_RAYS)
    if stability.NOT_APPLICABLE in (stored.verdict, found.verdict):
        same = stored.verdict == found.verdict
    elif case.measure == "sweep" and stored.verdict != stability.FINE:
        same = True  # a small sweep need not meet the few rays that the full one met
    else:
        same = (stored.verdict == stability.FINE) == (found.verdict == stability.FINE)
    return "" if same else f"{case.key}, {method.name}: stored {stored}, found {found}"
