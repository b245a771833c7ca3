"""What the chart measured, as the plan reads it and studies/ writes it: one record a row of assets/measurements.csv."""

from __future__ import annotations

import csv
import dataclasses
import math
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any

from ..physics import relativity


@dataclass(frozen=True)
class Method:
    """A way to trace. Steps it does not have are 0: Δt₀ in r_s, κ in radians, tolerance of an adaptive control in radians a step."""

    model: str
    integrator: str
    step_control: str
    step_length: float
    step_angle: float
    step_tolerance: float

    def __str__(self) -> str:
        settings = [f"{name} = {value:.3g}" for name, value in (("Δt₀", self.step_length), ("κ", self.step_angle), ("tolerance", self.step_tolerance)) if value]
        return ", ".join([name for name in (self.model, self.integrator, self.step_control) if name] + settings)

    @property
    def kind(self) -> tuple[str, str, str]:
        """The method but for its step."""
        return self.model, self.integrator, self.step_control


@dataclass(frozen=True)
class Measured:
    """A method in a scene: one row of the table, whose columns are these fields in this order. What there is not is NaN, and left empty in the table.

    Attributes:
        spin, distance, inclination_deg, fov_deg: of the measured scene.
        step_length, step_angle, step_tolerance: as in `Method`; NaN for those it does not have.
        direction_median, direction_99, direction_worst: error of the escape direction in radians, of rays off the critical curve.
        crossing_r_99, g_99: relative errors of the crossing radii and of g at 99 %.
        wrong_fates: share of rays.
        evaluations: of the right-hand side, mean over the rays.
        cost_flat_ratio: trace time as a ratio to the flat frame of the same size.
        refined: 1 for a refined hit map, as it is while the camera moves: rays are the pixels of a picture of `choice.REFINED_SIZE`, traced with
            `choice.REFINED_TOLERANCE`, and that is what is timed. Its crossing_r_99 is relative to the disk's outer radius.
        cost_unrefined: of a refined row: what a ray for every pixel costs at that size.
        field: what is not as it comes in the field measured, as `hardness.field_text` has it; empty for holes.
    """

    scene: str
    spin: float
    distance: float
    inclination_deg: float
    fov_deg: float
    model: str
    integrator: str
    step_control: str
    step_length: float
    step_angle: float
    direction_median: float
    direction_99: float
    direction_worst: float
    crossing_r_99: float
    g_99: float
    wrong_fates: float
    evaluations: float
    cost_flat_ratio: float
    step_tolerance: float
    refined: int
    cost_unrefined: float
    field: str = dataclasses.field(default="", kw_only=True)

    @cached_property
    def from_inside(self) -> bool:
        """Whether the camera is inside the hole's horizon."""
        return self.distance <= float(relativity.horizon_radius(self.spin))

    @cached_property
    def stated(self) -> Method:
        """What tells methods apart, refinement left aside."""
        steps = (0.0 if math.isnan(step) else step for step in (self.step_length, self.step_angle, self.step_tolerance))
        return Method(self.model, self.integrator, self.step_control, *steps)


COLUMNS = tuple(item.name for item in fields(Measured))
"""The table's columns."""


class Rows(Sequence[Measured]):
    """The rows of one scene, each read when it is first asked for: a choice asks for all of one or two scenes, and for the first of the others.

    Args:
        columns: names of the columns that there are.
        lines: of the table, one at least that fits.
        fits: whether a line's entries are a row that a choice can go by.
    """

    def __init__(self, columns: Sequence[str], lines: Sequence[str], fits: Callable[[Sequence[str]], bool]):
        self._columns, self._lines, self._fits = columns, lines, fits
        self._read: dict[int, Measured] = {}

    @cached_property
    def first(self) -> Sequence[str] | None:
        """The entries of the first that fits; None where there is none."""
        return next(filter(self._fits, csv.reader(self._lines)), None)

    @cached_property
    def _texts(self) -> list[Sequence[str]]:
        return list(filter(self._fits, csv.reader(self._lines)))

    def __len__(self) -> int:
        return len(self._texts)

    def __getitem__(self, index: Any) -> Any:
        found = self._read.get(index)
        if found is None:
            texts = self.first if index == 0 else self._texts[index]
            found = self._read[index] = _row(dict(zip(self._columns, texts or ())))
        return found


def read(path: Path, models: Container[str]) -> dict[str, Rows]:
    """The rows of `models` in the table at `path` that a choice can go by, those with an error and a cost, by their scenes. A column that is not there is one
    left empty: tables from before there was refinement lack the last three, one of holes may lack the last. A row that is no row of numbers is a ValueError
    when it is asked for.

    Raises:
        OSError: the file cannot be read.
    """
    with open(path, newline="", encoding="utf-8") as file:
        head, *lines = (line for line in file if not line.startswith("#"))
    header = next(csv.reader([head]))
    model, error, cost = (header.index(name) for name in ("model", "direction_99", "cost_flat_ratio"))
    by_scene: dict[str, list[str]] = {}
    for line in lines:
        by_scene.setdefault(line[: line.index(",")], []).append(line)
    found = {name: Rows(header, of, lambda row: bool(row[error] and row[cost]) and row[model] in models) for name, of in by_scene.items()}
    return {name: rows for name, rows in found.items() if rows.first is not None}


def _row(texts: Mapping[str, str]) -> Measured:
    return Measured(**{name: read_as(texts.get(name) or absent) for name, read_as, absent in _READ})


_AS: Mapping[str, tuple[Callable[[str], Any], str]] = {"str": (str, ""), "float": (float, "nan"), "int": (int, "0")}
_READ = tuple((item.name, *_AS[str(item.type)]) for item in fields(Measured))
"""Of each column what reads it, and what stands where it is empty."""
