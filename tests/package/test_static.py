"""What can be seen without running anything: ruff finds no mistake and pyrefly no type that does not fit, by the settings in pyproject.toml."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from jaxtyping import TypeCheckError

from blackhole_gl.reference.observers import Place, momenta

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("command", [("ruff", "check", "."), ("pyrefly", "check", "--python-interpreter-path", sys.executable)], ids=["ruff", "pyrefly"])
def test_it_finds_nothing(command: tuple[str, ...]) -> None:
    run = subprocess.run([sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True, timeout=280)
    assert run.returncode == 0, run.stdout + run.stderr


def test_a_wrong_shape_is_refused_while_tests_run() -> None:
    """Directions in two components: NumPy would say something of it, but not what is asked for.
    The shapes in array types are checked (tests/shape_checks.py)."""
    with pytest.raises(TypeCheckError, match="N 3"):
        momenta(np.zeros((5, 2)), Place.from_degrees(20.0, 80.0, 0.0), 0.5, "zamo")
