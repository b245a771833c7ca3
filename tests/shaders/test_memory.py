"""Memory stays flat while frames are drawn and presets, sizes and cameras change."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from blackhole_gl.scene import presets

SCRIPT = Path(__file__).resolve().parent / "many_frames.py"
KINDS = ("texture", "framebuffer", "buffer", "program", "array")


def run(frames: int, timeout: float, every: int = 1) -> list[dict]:
    """What `many_frames.py` says at each tenth."""
    done = subprocess.run([sys.executable, str(SCRIPT), str(frames), str(every)], capture_output=True, text=True, timeout=timeout)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def check_flat(said: list[dict], warm: int, megabytes: float) -> None:
    """After `warm` tenths no kind of object has more than it had by then, and resident memory has grown by less than `megabytes`."""
    for kind in KINDS:
        assert max(entry[kind] for entry in said[warm:]) <= max(entry[kind] for entry in said[:warm]), kind
    assert said[-1]["mb"] - said[warm - 1]["mb"] < megabytes, said


def test_memory_is_flat():
    """Every sixth preset, five times, of two frames each: a tenth is half a round, and memory is compared where rounds end. After two of them it was not
    seen to grow; a texture lost in each switch would be dozens of objects more."""
    check_flat(run(10 * len(presets.available()[::6]), timeout=280.0, every=6), warm=4, megabytes=3.0)


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_memory_is_flat_over_ten_thousand_frames():
    """From 1,000 frames on: a kilobyte lost in each frame would be 9 MB."""
    check_flat(run(10_000, timeout=1700.0), warm=1, megabytes=5.0)
