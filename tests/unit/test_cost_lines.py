"""Costs on a line: chance goes, what is not straight stays as it was measured."""

from __future__ import annotations

import math
from dataclasses import fields, replace

import numpy as np
import pytest

from studies.cost_lines import by_work
from studies.measure import Row

EMPTY = Row(**{item.name: "" if item.type == "str" else 0 if item.type == "int" else math.nan for item in fields(Row)})


def _rows(integrator: str, start: float, each: float, evaluations: list[float], rng: np.random.Generator, noise: float = 0.1) -> list[Row]:
    """A method's rows in four scenes; costs are `start` + `each` for each evaluation, and chance."""
    kind = replace(EMPTY, model="kerr", integrator=integrator, step_control="mino")
    costs = [(f"scene {n}", work, (start + each * work) * float(np.exp(rng.normal(0.0, noise)))) for n in range(4) for work in evaluations]
    return [replace(kind, scene=name, evaluations=work, cost_flat_ratio=cost) for name, work, cost in costs]


def test_the_cheaper_method_is_the_cheaper_in_every_scene() -> None:
    """Measured one by one, the dearer one is now and then the cheaper one."""
    rng = np.random.default_rng(3)
    lucky = 0
    for _ in range(50):
        rows = _rows("nystrom5", 2.3, 0.033, [20.0, 31.0, 44.0, 62.0, 124.0], rng) + _rows("rk4", 2.2, 0.028, [29.0, 41.0, 61.0, 85.0, 170.0], rng)
        even = by_work(rows)
        for place, (measured, found) in enumerate(zip(rows, even)):
            if measured.integrator == "nystrom5" and measured.evaluations == 31.0:
                rival = 20 + place + 1  # rk4 with 61 evaluations in the same scene
                assert (rows[rival].scene, rows[rival].evaluations) == (measured.scene, 61.0)
                lucky += rows[rival].cost_flat_ratio < measured.cost_flat_ratio
                assert found.cost_flat_ratio == pytest.approx(2.3 + 0.033 * 31.0, rel=0.12)
                assert found.cost_flat_ratio < even[rival].cost_flat_ratio
    assert lucky > 5


def test_only_costs_change() -> None:
    rows = _rows("rk4", 2.0, 0.03, [10.0, 20.0, 40.0], np.random.default_rng(0))
    assert [repr(replace(row, cost_flat_ratio=0.0)) for row in by_work(rows)] == [repr(replace(row, cost_flat_ratio=0.0)) for row in rows]


def test_one_outlier_does_not_move_the_line() -> None:
    rows = _rows("rk4", 2.0, 0.03, [10.0, 20.0, 40.0, 80.0], np.random.default_rng(1), noise=0.0)
    rows[5] = replace(rows[5], cost_flat_ratio=10.0 * rows[5].cost_flat_ratio)
    assert by_work(rows)[5].cost_flat_ratio == pytest.approx(2.0 + 0.03 * 20.0, rel=0.02)


def test_what_lies_on_no_line_stays_as_measured() -> None:
    kind = _rows("dopri5", 1.0, 0.0, [10.0, 20.0, 40.0, 80.0], np.random.default_rng(2), noise=0.0)
    bent = [replace(row, cost_flat_ratio=cost) for row, cost in zip(kind, [3.0, 9.0, 2.0, 30.0] * 4)]
    assert repr(by_work(bent)) == repr(bent)


def test_few_rows_and_refined_ones_stay_as_measured() -> None:
    few = _rows("rk4", 2.0, 0.03, [10.0], np.random.default_rng(4))
    assert repr(by_work(few)) == repr(few)
    refined = [replace(row, refined=1) for row in _rows("rk4", 2.0, 0.03, [10.0, 20.0, 40.0], np.random.default_rng(5))]
    assert repr(by_work(refined)) == repr(refined)


def test_a_method_without_steps_costs_the_same_everywhere() -> None:
    rows = _rows("", 1.5, 0.0, [0.0, 0.0, 0.0], np.random.default_rng(6))
    assert len({row.cost_flat_ratio for row in by_work(rows)}) == 1
