"""The bench: every row there, moving frames traced and still ones not, ratios to the flat frame of the same kind."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from blackhole_gl import cli
from blackhole_gl.measure import bench
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets


def test_still_frames_keep_the_hit_map_and_moving_ones_trace(renderer: Renderer) -> None:
    found = bench.measure(renderer, presets.load(["schwarzschild"]), [(64, 36), (96, 54)], rounds=1, euler=False)
    names = list(bench.scenes(presets.load(["schwarzschild"])))
    assert [(row.width, row.motion, row.scene) for row in found.rows] == [
        (w, motion, name) for w in (64, 96) for motion in ("still", "moving") for name in names
    ]
    assert all(row.ratio == 1.0 for row in found.rows if row.scene == bench.YARDSTICK)
    assert all(row.milliseconds > 0.0 and row.processor_ms > 0.0 for row in found.rows)
    assert found.euler_ms is None and all(row.trace_in_e is None for row in found.rows)
    assert bench.text(found).count("\n| ") == 1 + len(found.rows) + 1


def test_the_command_prints_a_table_and_writes_json(
    tmp_path: Path, renderer: Renderer, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(cli, "renderer_by", lambda backend: renderer)  # a second context would take the place of the tests' own
    out = tmp_path / "bench.json"
    cli.run(["bench", "--size", "32x18", "--rounds", "1", "--no-euler", "--json", str(out)])
    said = capsys.readouterr().out
    assert "| 32×18 | still | table | schwarzschild_table |" in said and "| 32×18 | moving | table | schwarzschild_table" in said
    assert len(json.loads(out.read_text(encoding="utf-8"))["rows"]) == 2 * len(bench.scenes(presets.load(["kerr"])))
