"""The window without a display: each scenario of ``scenarios.py`` in a process of its own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
# Read as text: importing scenarios.py would load imgui into the test process, where a later test may want another GLFW.
SCENARIOS = [line.split()[1].partition("(")[0] for line in (HERE / "scenarios.py").read_text(encoding="utf-8").splitlines() if line.startswith("def ")]


@pytest.mark.parametrize("scenario", SCENARIOS)
def test_scenario(scenario, tmp_path):
    """Checks one scenario.

    Args:
        scenario: name of a function in ``scenarios.py``.
        tmp_path: stands for the user's configuration folder.
    """
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    environment["BLACKHOLE_GL_CONFIG_DIR"] = str(tmp_path)
    done = subprocess.run([sys.executable, str(HERE / "drive.py"), scenario], env=environment, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stdout + done.stderr
