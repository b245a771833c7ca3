"""The set-up explains what is missing, and stops."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the set-up looks for GL libraries on Linux only")


def run_setup(folder: Path, python: str, level: str = "run") -> subprocess.CompletedProcess[str]:
    """tools/setup.sh with a Python that answers as `python` says, on a machine where apt-get and sudo are of no help."""
    bin_dir = folder / "bin"
    bin_dir.mkdir()
    for name, text in {"python3": python, "apt-get": "echo 'no such package' >&2; exit 100", "sudo": "exit 1"}.items():
        (bin_dir / name).write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        (bin_dir / name).chmod(0o755)
    environment = {**os.environ, "PATH": f"{bin_dir}{os.pathsep}{os.environ['PATH']}", "PYTHON": str(bin_dir / "python3"), "VENV": str(folder / "venv")}
    command = [shutil.which("sh") or "sh", str(ROOT / "tools" / "setup.sh"), level]
    return subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)


def test_missing_gl_stops_with_the_line_that_mends_it(tmp_path: Path) -> None:
    run = run_setup(tmp_path, f'case "$*" in *libEGL*) exit 1 ;; esac; exec "{sys.executable}" "$@"')
    assert run.returncode != 0
    assert "libEGL.so.1" in run.stderr
    assert "apt-get install -y --no-install-recommends libegl1 libgl1\n" in run.stderr
    assert not (tmp_path / "venv").exists()


def test_missing_venv_module_is_asked_for_in_the_same_line(tmp_path: Path) -> None:
    run = run_setup(tmp_path, f'case "$*" in *libEGL* | *ensurepip*) exit 1 ;; esac; exec "{sys.executable}" "$@"')
    assert run.returncode != 0
    assert "-venv libegl1 libgl1\n" in run.stderr


def test_old_python_is_refused(tmp_path: Path) -> None:
    run = run_setup(tmp_path, "exit 1")
    assert run.returncode != 0
    assert "Python 3.11 or newer" in run.stderr


def test_unknown_level_is_refused(tmp_path: Path) -> None:
    run = run_setup(tmp_path, f'exec "{sys.executable}" "$@"', level="everything")
    assert run.returncode != 0
    assert "run, test, chart, site, tools" in run.stderr
