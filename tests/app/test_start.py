"""How long the window takes to its first picture."""

import json
import os
import subprocess
import sys
from pathlib import Path

SCRIPT = Path(__file__).resolve().parent / "first_picture.py"
MOST_SECONDS = 3.0
"""Of processor time. 2 s by the wall are promised on two idle cores; where others share a core, its processor time counts up to double."""

MOST_PROGRAMS = 8
"""As many as a picture with a ray for every pixel has. Those of other views and scenes, and of interpolated maps, are compiled when they are wanted."""

NOT_NEEDED = ("matplotlib", "scipy", "PIL.ImageShow", "blackhole_gl.measure.bench", "studies", "blackhole_gl.self_check")


def first_picture(folder: Path) -> dict:
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    environment |= {"BLACKHOLE_GL_CONFIG_DIR": str(folder), "MESA_SHADER_CACHE_DIR": str(folder / "compiled")}
    done = subprocess.run([sys.executable, str(SCRIPT)], env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def test_the_first_picture_is_early(tmp_path):
    """The third start: the first two fill the driver's cache, as they do in life."""
    found = [first_picture(tmp_path) for _ in range(3)][-1]
    assert found["processor"] < MOST_SECONDS
    assert found["programs"] <= MOST_PROGRAMS
    assert not set(NOT_NEEDED) & set(found["modules"])
