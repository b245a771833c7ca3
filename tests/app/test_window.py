"""The window without a display: the scenarios of ``scenarios.py``, driven by the ImGui test engine."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import matplotlib
import pytest

from tests.app.blind import BLIND
from tests.unit import kinds

HERE = Path(__file__).resolve().parent
# Read as text: importing scenarios.py would load imgui into the test process, where a later test may want another GLFW.
TEXT = "".join((HERE / f"{name}.py").read_text(encoding="utf-8") for name in ("scenarios", "scenarios_entry", "scenarios_flight", "scenarios_things"))
HELPERS = ("save_picture", "press_bar", "goes_to", "click_the_picture")
SCENARIOS = [name for name in re.findall(r"^def ([a-z]\w*)", TEXT, re.MULTILINE) if name not in HELPERS]
REAL = re.findall(r"\w+", " ".join(re.findall(r"^WITH_THE_REAL_RENDERER = \(([^)]*)\)", TEXT, re.MULTILINE)))
WITH_KINDS = re.findall(r"\w+", re.search(r"^WITH_KINDS = \((.*)\)", TEXT, re.MULTILINE)[1])
LOOKING = re.findall(r"\w+", re.search(r"^LOOKING = \((.*)\)", TEXT, re.MULTILINE)[1])
FIRST_DAY = [name for name in REAL if name.endswith("preset_switches_never_freeze")]  # the driver's cache is empty then
TOGETHER = [name for name in REAL if name not in FIRST_DAY]
PRETENDED = [name for name in SCENARIOS if name not in REAL + WITH_KINDS + LOOKING]


def pretended_dialog(folder: Path) -> Path:
    """The folder of a `zenity` that chooses, in place of a user, what the file ``answer`` beside the keys says."""
    program = folder / "bin" / "zenity"
    program.parent.mkdir()
    program.write_text(f"#!/bin/sh\ncat '{folder}/answer'\n", encoding="utf-8")
    program.chmod(0o755)
    return program.parent


def run(names: list[str], folder: Path, seconds: float = 250.0, **variables: str) -> None:
    """Runs scenarios in one process, in so many seconds, with environment `variables`; `folder` stands for the user's configuration folder."""
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")} | variables
    environment["BLACKHOLE_GL_CONFIG_DIR"] = str(folder)
    environment["PATH"] = os.pathsep.join([str(pretended_dialog(folder)), environment["PATH"]])
    (folder / "fonts").mkdir()
    shutil.copy(Path(matplotlib.get_data_path(), "fonts", "ttf", "DejaVuSans.ttf"), folder / "fonts")
    (folder / "fonts" / "broken.ttf").write_bytes(b"no font at all")
    done = subprocess.run([sys.executable, str(HERE / "drive.py"), *names], env=environment, cwd=folder, capture_output=True, text=True, timeout=seconds)
    assert done.returncode == 0, done.stdout + done.stderr


# A process takes seconds to start, and compiles what it draws with, so each runs a few; two parts keep two workers busy.
@pytest.mark.parametrize("names", [PRETENDED[0::2], PRETENDED[1::2]], ids=["even", "odd"])
def test_scenarios_with_a_pretended_renderer(names, tmp_path):
    run(names, tmp_path, **BLIND)


def test_scenarios_that_look_at_pixels(tmp_path):
    run(LOOKING, tmp_path)


def test_scenarios_with_kinds_of_the_users_own(tmp_path):
    shaders = kinds.put(tmp_path)
    (shaders / "skies").mkdir()
    (shaders / "skies" / "wrong.glsl").write_text(kinds.CLOUD.replace("medium", "sky").replace("reach = []", "colour = 3"), encoding="utf-8")
    run(WITH_KINDS, tmp_path, **BLIND)


@pytest.mark.parametrize("names", [TOGETHER[0::3], TOGETHER[1::3], TOGETHER[2::3]], ids=["first", "second", "third"])
@pytest.mark.timeout(600)  # four scenarios that compile, on a busy machine
def test_scenarios_with_the_real_renderer(names, tmp_path):
    run(names, tmp_path, seconds=550.0)


@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow) if name.startswith("all_") else name for name in FIRST_DAY])
def test_switches_with_nothing_compiled(name, tmp_path):
    run([name], tmp_path, MESA_SHADER_CACHE_DIR=str(tmp_path / "compiled"))
