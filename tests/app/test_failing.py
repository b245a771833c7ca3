"""What is said where no window can be opened, or one fails: one sentence, no traceback, and by `check` the truth."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import moderngl
import pytest

ROOT = Path(__file__).resolve().parents[2]
NOWHERE = ":7654"  # no X server has this number
PLAIN = [sys.executable, "-m", "blackhole_gl"]
WITHOUT_DISPLAY = [sys.executable, str(ROOT / "tests" / "app" / "ended.py")]


def run(command: list[str], folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    known = {**os.environ, "PYTHONPATH": str(ROOT), "BLACKHOLE_GL_CONFIG_DIR": str(folder), **environment}
    return subprocess.run(command, env=known, cwd=folder, capture_output=True, text=True, timeout=120)


@pytest.mark.parametrize(
    "command, environment, reason",
    [
        (PLAIN, {"DISPLAY": NOWHERE}, "Failed to open display"),
        ([*PLAIN, "view"], {"DISPLAY": NOWHERE}, "Failed to open display"),
        ([*WITHOUT_DISPLAY, "view"], {"MESA_GL_VERSION_OVERRIDE": "2.1"}, "OpenGL 3.3"),
        ([*WITHOUT_DISPLAY, "view"], {"MESA_GL_VERSION_OVERRIDE": "3.2"}, "OpenGL 3.3"),
    ],
)
def test_a_window_that_cannot_be_opened_is_one_sentence(tmp_path: Path, command: list[str], environment: dict[str, str], reason: str) -> None:
    done = run(command, tmp_path, **environment)
    assert (done.returncode, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line.startswith("blackhole-gl: no window") and reason in line


FAILS_IN_A_FRAME = """
import functools, os, sys
from blackhole_gl import cli
from blackhole_gl.app import help_window, panel, window
from imgui_bundle import imgui

where, part, frames = *sys.argv.pop(1).split("."), []
owner = {"Window": window.Window, "Panel": panel.Panel, "help_window": help_window}[where]
whole = getattr(owner, part)

def failing(*args, **named):
    frames.append(None)
    if len(frames) == 10:
        if part != "before_frame":
            imgui.push_id("begun")
        raise ValueError("some slip")
    return whole(*args, **named)

setattr(owner, part, failing)
window.run = functools.partial(window.run, null_platform=True)
cli.main()
"""


@pytest.mark.parametrize("where", ["Window.before_frame", "Window.frame", "Window.draw_bar", "Window.draw_picture", "Panel.draw", "help_window.draw"])
def test_a_mistake_in_a_frame_is_one_sentence_and_what_the_window_keeps_is_kept(tmp_path: Path, where: str) -> None:
    done = run([sys.executable, "-c", FAILS_IN_A_FRAME, where, "view", "--size", "410x320"], tmp_path, DISPLAY=":0")  # the null platform looks at none
    (line,) = done.stderr.splitlines()
    assert (done.returncode, done.stdout) == (2, "")
    details = tmp_path / "window_failure.txt"
    place = f"<string>, line {1 + FAILS_IN_A_FRAME[: FAILS_IN_A_FRAME.index('raise')].count(chr(10))}"
    assert line == f"blackhole-gl: the window had to close, by a mistake of the program's: ValueError: some slip ({place}); the details are in {details}"
    assert "in failing" in details.read_text(encoding="utf-8")
    assert "window_size = [410, 320]" in (tmp_path / "window.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize("desktop", ["x11", "wayland"])
def test_check_opens_a_window_and_tells_when_it_cannot(tmp_path: Path, desktop: str) -> None:
    """On a Wayland desktop another build of GLFW is loaded where the first to ask for it is not the viewer."""
    done = run([*PLAIN, "check"], tmp_path, DISPLAY=NOWHERE, XDG_SESSION_TYPE=desktop)
    (line,) = (line for line in done.stdout.splitlines() if " window " in line)
    assert line.startswith("FAIL") and f"Failed to open display {NOWHERE}" in line
    assert done.returncode == 1 and "Traceback" not in done.stderr


def test_a_way_to_draw_that_is_not_needed_does_not_fail_the_check(ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> None:
    from blackhole_gl import self_check
    from blackhole_gl.rendering import context

    def only_egl(backend: str):
        if backend == "osmesa":
            raise context.ContextError("OSMesa cannot be loaded")
        return ctx

    monkeypatch.setattr(context, "create_headless", only_egl)
    monkeypatch.delenv("DISPLAY", raising=False)
    found = {finding.name: finding for finding in self_check.findings()}
    assert found["osmesa"].works is None and "not needed" in found["osmesa"].text
    assert found["self test"].works
