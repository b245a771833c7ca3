"""Steps in media: what a scene leaves open comes from the table of media, what it states is kept, and why is said."""

from __future__ import annotations

import csv

import pytest

from blackhole_gl import planning, resources
from blackhole_gl.planning import media_steps
from blackhole_gl.scene import Scene, catalogue, presets

FOG_AND_TORUS = {"media.fog.kind": "ball", "media.ring.kind": "torus"}


def table() -> list[dict[str, str]]:
    with open(resources.assets_dir() / "measurements_media.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def longest(allowed: float, *kinds: str) -> float:
    """Read from the table anew, without the code under test."""
    rows = [row for row in table() if row["kind"] in kinds]
    return max(step for step in {float(row["step"]) for row in rows} if all(float(row["light_99"]) <= allowed for row in rows if float(row["step"]) == step))


@pytest.mark.parametrize("name, kinds", [("jet", ["jet"]), ("polish_doughnut", ["torus"]), ("cloudy_slab", ["slab"]), ("gold_1", ["analytic_plasma"])])
@pytest.mark.parametrize("allowed", [0.01, 0.001, 0.0005])
def test_the_longest_step_within_the_tolerance_is_taken(name: str, kinds: list[str], allowed: float) -> None:
    made = planning.plan(presets.load([name], {"rays.light_tolerance": allowed}))
    assert made.scene.rays.medium_step == longest(allowed, *kinds)
    assert any("of the brightest where it is worst" in reason for reason in made.reasons) and not made.warnings


def test_of_several_kinds_the_worst_counts() -> None:
    made = planning.plan(presets.load(["kerr"], FOG_AND_TORUS))
    assert made.scene.rays.medium_step == longest(0.001, "ball", "torus") < longest(0.001, "ball")


def test_a_step_that_is_stated_is_kept_and_told_where_it_errs_more_than_allowed() -> None:
    fine, coarse = (planning.plan(presets.load(["gold_1"], {"rays.medium_step": step})) for step in (0.25, 1.0))
    assert (fine.scene.rays.medium_step, coarse.scene.rays.medium_step) == (0.25, 1.0)
    assert not fine.warnings and "more than the 0.001 allowed" in coarse.warnings[-1]


def test_a_tolerance_that_no_step_meets_is_told() -> None:
    made = planning.plan(presets.load(["jet"], {"rays.light_tolerance": 1e-5}))
    assert made.scene.rays.medium_step == min(float(row["step"]) for row in table()) and "cannot be met in media" in made.warnings[-1]


def test_kinds_of_which_nothing_was_measured_have_plain_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = [row for row in media_steps.measurements() if row.kind != "torus"]
    monkeypatch.setattr(media_steps, "measurements", lambda: rows)
    media_steps._by_step.cache_clear()
    found = media_steps.chosen(presets.load(["kerr"], FOG_AND_TORUS))
    media_steps._by_step.cache_clear()
    assert found.scene.rays.medium_step == media_steps.PLAIN_STEP and "nothing was measured" in found.reasons[0]


def test_without_media_nothing_is_said() -> None:
    assert media_steps.chosen(Scene()) == media_steps.MediumStep(Scene())


def test_every_shipped_kind_was_measured() -> None:
    assert {row["kind"] for row in table()} == {key for key, kind in catalogue.plug_ins("medium").items() if kind.shipped}
