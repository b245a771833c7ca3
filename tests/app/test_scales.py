"""The window opens with every label of the panel whole, whatever the screen's scale and however late the window gets its size. Needs Xvfb and xprop."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.app import virtual_display
from tests.app.blind import BLIND

pytestmark = pytest.mark.display

SCRIPT = Path(__file__).resolve().parent / "labels_at_start.py"
DPI = {1.0: 96, 1.5: 144, 2.0: 192}


def labels(environment: dict, folder: Path, *words: str) -> dict:
    """What labels_at_start.py says."""
    environment = environment | BLIND | {"BLACKHOLE_GL_CONFIG_DIR": str(folder)}
    done = subprocess.run([sys.executable, str(SCRIPT), *words], env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def cut(found: dict) -> list[str]:
    """The labels that had too little room."""
    assert len(found["labels"]) > 10, "the panel shows its first groups"
    return [label for label, (width, room) in found["labels"].items() if width > room]


@pytest.fixture(scope="module", params=DPI, ids=str)
def screen(request):
    with virtual_display.opened(["Xvfb", "xprop"], "2800x1800", DPI[request.param]) as environment:
        yield request.param, environment


@pytest.mark.parametrize("words", [(), ("late",)], ids=["at once", "late"])
def test_no_label_is_cut(words, screen, tmp_path):
    scale, environment = screen
    found = labels(environment, tmp_path, *words)
    assert found["scale"] == scale
    assert not cut(found)


@pytest.mark.slow
@pytest.mark.parametrize("start", range(10))
def test_no_label_is_cut_while_others_use_the_processors(start, screen, tmp_path):
    """Starts of which three in five were cut, before the panel's width followed the window."""
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(os.cpu_count() or 1)]
    try:
        assert not cut(labels(screen[1], tmp_path))
    finally:
        for process in busy:
            process.kill()
            process.wait()
