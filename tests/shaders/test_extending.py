"""The examples in docs/extending.md, put into a copy of the project, work as they stand there."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
SHADERS = re.findall(r"`(shaders/\S+\.glsl)`\n\n```glsl\n(.*?)```", PAGE, re.DOTALL)
PYTHON = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
TOML = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)

DRAW = """
import sys
import numpy as np
from blackhole_gl.scene import presets
from blackhole_gl.render.context import create_headless
from blackhole_gl.render.frame import Renderer

renderer = Renderer(create_headless())

def drawn(names, changes):
    renderer.render(presets.load(names, changes), 5.0, (64, 36))
    hits = renderer.hits()
    assert not np.any(hits.fate == 0), changes
    assert np.all(np.isfinite(renderer.radiance())), changes
    return renderer.read_rgb8().astype(int)

plain = drawn(["kerr"], {})
for changes in (
    {"sky.model": "graticule", "sky.graticule.spacing": 10.0},
    {"disk.spiral": True, "disk.turbulence": False},
    {"rays.model": "kink"},
    {"rays.model": "kink", "camera.distance": float("inf")},
    {"rays.integrator": "midpoint"},
    {"disk.temperature_law": "constant"},
):
    assert np.abs(drawn(["kerr"], changes) - plain).max() > 8, changes
drawn([sys.argv[1]], {})
"""


@pytest.fixture
def extended(tmp_path: Path) -> Path:
    """A copy of the project with every example of the page in it."""
    for folder in ("blackhole_gl", "shaders", "presets", "assets"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    for path, text in SHADERS:
        assert not (tmp_path / path).exists(), f"{path} is there already: the example needs another name"
        (tmp_path / path).write_text(text, encoding="utf-8")
    layer, law = PYTHON
    scene = tmp_path / "blackhole_gl" / "scene" / "records.py"
    text = scene.read_text(encoding="utf-8")
    text, layers = re.subn(r"^(    turbulence: bool = .*\n)", lambda match: match[1] + layer, text, flags=re.MULTILINE)
    text, laws = re.subn(r'"shakura_sunyaev", ', '"shakura_sunyaev", "constant", ', text)
    assert (layers, laws) == (1, 1)
    scene.write_text(text, encoding="utf-8")
    profile = tmp_path / "blackhole_gl" / "physics" / "disk_profile.py"
    profile.write_text(profile.read_text(encoding="utf-8") + "\n\n" + law, encoding="utf-8")
    (tmp_path / "preset.toml").write_text(TOML[0], encoding="utf-8")
    return tmp_path


def test_the_page_has_an_example_of_each_slot() -> None:
    assert {Path(path).parent.name for path, _ in SHADERS} == {"skies", "disks", "ray_models", "integrators"}
    assert len(PYTHON) == 2 and len(TOML) == 1


def test_every_example_draws(extended: Path) -> None:
    done = subprocess.run([sys.executable, "-c", DRAW, "preset.toml"], cwd=extended, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
