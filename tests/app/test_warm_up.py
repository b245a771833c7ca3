"""The other process: that it ends with the window, and without a word."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import blackhole_gl
from blackhole_gl.app.warm_up import WarmUp
from blackhole_gl.scene import presets

_SCRIPT = """
import multiprocessing, sys, time
from blackhole_gl.app.warm_up import WarmUp
from blackhole_gl.scene import Scene

if __name__ == "__main__":
    warm_up = WarmUp()
    warm_up.start()
    future = warm_up.submit(Scene(), (72, 40))
    time.sleep(float(sys.argv[1]))
    began = time.perf_counter()
    warm_up.close()
    assert time.perf_counter() - began < 2.0, "closing waits for nothing; 2 s are for a busy machine"
    assert future.done() and not multiprocessing.active_children()
"""


def test_closing_in_the_middle_of_its_work_ends_it_quietly(tmp_path):
    """In a process of its own: what an executor left to itself complains of comes when the interpreter ends."""
    script = tmp_path / "close.py"
    script.write_text(_SCRIPT)
    environment = {**os.environ, "PYTHONPATH": str(Path(blackhole_gl.__file__).parents[1])}
    for seconds in ("0", "0.5"):
        done = subprocess.run([sys.executable, str(script), seconds], capture_output=True, text=True, timeout=60, env=environment)
        assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("name", ["kerr", "orbiting_star"])
def test_it_draws_all_that_a_window_does(name: str) -> None:
    """Where it fails the window goes on without it, compiles by itself and stands still meanwhile."""
    warm_up = WarmUp()
    assert warm_up.submit(presets.load([name]), (72, 40)).exception(timeout=100.0) is None
    assert warm_up.look_ahead(presets.load([name]), (72, 40)).exception(timeout=100.0) is None
    warm_up.close()
