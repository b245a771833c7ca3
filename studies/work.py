"""A measurement that was broken off goes on where it stopped: finished groups of rows are kept in a file, a line each.

A group is one method in one scene. Its key holds the text of all that it was measured with, so that a changed shader is measured anew.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

from blackhole_gl.measure.methods import Combination
from blackhole_gl.measure.scenes import ChartScene
from blackhole_gl.resources import shaders_dir
from blackhole_gl.scene import catalogue
from studies.measure import Row, Timings

_FILE = "rows.jsonl"


class Kept:
    """The groups of rows kept in `folder`; with no folder, in memory."""

    def __init__(self, folder: Path | None):
        self._path = folder / _FILE if folder else None
        self._groups: dict[str, list[Row]] = {}
        if self._path and self._path.exists():
            for line in self._path.read_text(encoding="utf-8").splitlines():
                self._take(line)

    def _take(self, line: str) -> None:
        try:
            entry = json.loads(line)
            self._groups[entry["key"]] = [Row(**row) for row in entry["rows"]]
        except (ValueError, TypeError, KeyError):
            pass  # a line cut short by the break, or rows of an older version: measured again

    def get(self, key: str) -> list[Row] | None:
        """The rows kept under `key`, or None."""
        return self._groups.get(key)

    def put(self, key: str, rows: Iterable[Row]) -> None:
        """Keeps `rows` under `key`."""
        self._groups[key] = list(rows)
        if self._path is None:
            return
        self._path.parent.mkdir(parents=True, exist_ok=True)
        with open(self._path, "a", encoding="utf-8") as file:
            file.write(json.dumps({"key": key, "rows": [asdict(row) for row in self._groups[key]]}) + "\n")


def key_of(chart_scene: ChartScene, method: Combination, settings: tuple[float, ...], timings: Timings) -> str:
    """What the group's rows depend on, as a short text."""
    parts = [chart_scene.name, chart_scene.count, sorted(chart_scene.scene.values().items()), method, settings, timings, _shader_text(method)]
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:24]


def _shader_text(method: Combination) -> str:
    files = [shaders_dir() / "trace.frag", *sorted((shaders_dir() / "common").glob("*.glsl"))]
    for slot, key in (("ray_model", method.model), ("integrator", method.integrator), ("step_control", method.step_control)):
        if key:
            files.append(catalogue.plug_ins(slot)[key].file)
    if method.refined:
        files += sorted(shaders_dir().glob("refine_*.frag"))
    return "\n".join(path.read_text(encoding="utf-8") for path in files)
