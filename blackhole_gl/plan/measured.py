"""What the chart measured, as the plan reads it and studies/ writes it: one record a row of assets/measurements.csv."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any


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

    @cached_property
    def stated(self) -> Method:
        """What tells methods apart, refinement left aside."""
        steps = (0.0 if math.isnan(step) else step for step in (self.step_length, self.step_angle, self.step_tolerance))
        return Method(self.model, self.integrator, self.step_control, *steps)


COLUMNS = tuple(item.name for item in fields(Measured))
"""The table's columns."""


def read(path: Path) -> tuple[Measured, ...]:
    """The rows of the table at `path` that a choice can go by: those with an error and a cost. A column that is not there is one left empty: tables from
    before there was refinement lack the last two.

    Raises:
        OSError: the file cannot be read.
        ValueError: a row is no row of numbers.
    """
    with open(path, newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(line for line in file if not line.startswith("#"))
    error, cost = header.index("direction_99"), header.index("cost_flat_ratio")
    texts = dict(zip(header, zip(*(row for row in rows if row[error] and row[cost]))))
    number = len(next(iter(texts.values()), ()))
    return tuple(map(Measured, *(_column(str(item.type), texts.get(item.name, ("",) * number)) for item in fields(Measured))))


def _column(kind: str, texts: Sequence[str]) -> Iterable[Any]:
    read, absent = _READ[kind]
    return map(read, texts if all(texts) else (text or absent for text in texts))


_READ: Mapping[str, tuple[Callable[[str], Any], str]] = {"str": (str, ""), "float": (float, "nan"), "int": (int, "0")}
"""By the names of the columns' types, what reads them and what stands where they are empty: by columns that takes a third of the time that rows take."""
