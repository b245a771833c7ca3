"""Rendering without a window loads neither the panel's library nor the window's, and nothing that the picture does not need."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

RENDER_ONE_FRAME = """
import json, sys
from blackhole_gl.scene import presets
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer

renderer = Renderer(create_headless("egl"))
renderer.render(presets.load(["schwarzschild"], {}), time=0.0, size=(32, 18))
picture = renderer.read_rgb8()
print(json.dumps({"shape": picture.shape, "brightest": int(picture.max()), "modules": sorted(sys.modules)}))
"""


def test_headless_frame_loads_no_window_library(tmp_path: Path) -> None:
    run = subprocess.run([sys.executable, "-c", RENDER_ONE_FRAME], cwd=tmp_path, capture_output=True, text=True, timeout=240)
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout.splitlines()[-1])
    assert found["shape"] == [18, 32, 3]
    assert found["brightest"] > 0
    assert not {"imgui_bundle", "glfw", "blackhole_gl.app", "jaxtyping"} & set(found["modules"])


# Each takes a hundredth of the time of a first picture, or more.
OURS = {"blackhole_gl.rendering.labels", "blackhole_gl.rendering.pixel_values", "blackhole_gl.rendering.recording"}
DEAR = {"pydantic", "typer", "click", "rich", "scipy", "pyrr", "trimesh", "PIL", "importlib.metadata", "difflib", *OURS}


def test_a_command_loads_nothing_dear_that_its_picture_does_not_need(tmp_path: Path) -> None:
    look = """
import json, sys
from blackhole_gl import cli
cli.run(["render", "kerr", "draft", "--size", "32x18", "-o", "x.png"])
print(json.dumps(sorted(sys.modules)))
"""
    run = subprocess.run([sys.executable, "-c", look], cwd=tmp_path, capture_output=True, text=True, timeout=240)
    assert run.returncode == 0, run.stderr
    assert not DEAR & set(json.loads(run.stdout.splitlines()[-1]))
