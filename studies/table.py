"""The measurements as CSV: the whole table for readers, and the part of it that the plan reads."""

from __future__ import annotations

import csv
import io
import math
import os
import platform
import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path

from blackhole_gl.output.files import write_whole
from blackhole_gl.planning import measured
from studies.measure import COLUMNS, Row

_DIGITS = 5


@dataclass(frozen=True)
class Origin:
    """Where and with what a table was measured."""

    machine: str
    renderer: str
    commit: str
    day: str

    @property
    def text(self) -> str:
        """One line for the head of a table."""
        return f"{self.machine}; {self.renderer}; commit {self.commit}; {self.day}"


def origin(renderer_name: str) -> Origin:
    """This machine, this commit, today."""
    processor = _processor()
    machine = f"{processor}, {os.cpu_count()} logical cores, {platform.system()} {platform.machine()}, Python {platform.python_version()}"
    return Origin(machine, renderer_name, _commit(), date.today().isoformat())


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or "unknown processor"


def _commit() -> str:
    """The checkout's commit, with a + where the code that is measured has uncommitted changes; "unknown" outside a checkout."""
    here = Path(__file__).resolve().parents[1]
    try:
        commit = subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=here, capture_output=True, text=True, check=True, timeout=20).stdout.strip()
        changed = subprocess.run(
            ["git", "status", "--porcelain", "--", "blackhole_gl", "shaders"], cwd=here, capture_output=True, text=True, check=True, timeout=20
        ).stdout
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return commit + ("+" if changed.strip() else "")


def write(path: Path, rows: Sequence[Row], where: Origin, columns: Sequence[str] = COLUMNS) -> None:
    """Writes `rows` as CSV under a comment line that says where they were measured; what there is not is left empty."""
    write_records(path, columns, ([getattr(row, name) for name in columns] for row in rows), where)


def write_contract(path: Path, rows: Sequence[Row], where: Origin) -> None:
    """Writes the columns that the plan reads. Variants of closed models are left out: the plan knows their plain form."""
    write(path, [row for row in rows if not row.variant], where, measured.COLUMNS)


def write_records(path: Path, header: Sequence[str], records: Iterable[Sequence[object]], where: Origin) -> None:
    """Writes any table in the same form."""
    text = io.StringIO()
    text.write(f"# {where.text}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    for record in records:
        writer.writerow([_text(value) for value in record])
    write_whole(path, text.getvalue().encode())


def read(path: Path) -> list[dict[str, str]]:
    """The records of a table, as texts by column.

    Raises:
        OSError: the file cannot be read.
    """
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def short(value: float) -> str:
    """A number for people: two digits, a dash where there is none."""
    if math.isnan(value):
        return "–"
    return f"{value:.2g}" if value < 99.5 else f"{value:.0f}"


def _text(value: object) -> str:
    if isinstance(value, float):
        return "" if value != value else f"{value:.{_DIGITS}g}"
    return str(value)
