"""The examples in docs/extending.md work as they stand there: the GLSL in a configuration folder, the Python in a copy of the project."""

from __future__ import annotations

import os
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
TWINS = re.findall(r"`(blackhole_gl/reference/\S+\.py)`\n\n```python\n(.*?)```", PAGE, re.DOTALL)
*_, LAW_TEXT = PYTHON
TOML = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)

DRAW = """
import os, sys
from pathlib import Path
import numpy as np
from blackhole_gl.scene import catalogue, presets
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer

assert not catalogue.mistakes(), catalogue.mistakes()
renderer = Renderer(create_headless())

def drawn(names, changes):
    renderer.render(presets.load(names, changes), 5.0, (64, 36))
    hits = renderer.hits()
    assert not np.any(hits.fate == 0), changes
    assert np.all(np.isfinite(renderer.radiance())), changes
    return renderer.read_rgb8().astype(int)

plain = drawn(["kerr"], {})
"""

OWN = """
for changes in (
    {"sky.model": "graticule", "sky.graticule.spacing": 10.0},
    {"sky.model": "star_chart"},
    {"disk.spiral": True, "disk.turbulence": False},
    {"rays.model": "kink"},
    {"rays.model": "kink", "camera.distance": float("inf")},
    {"rays.model": "whirl", "rays.field_radius": 8.0},
    {"things.moon.kind": "ball"},
    {"media.haze.kind": "fog"},
    {"rays.integrator": "midpoint"},
):
    assert np.abs(drawn(["kerr"], changes) - plain).max() > 8, changes
assert np.array_equal(drawn(["kerr"], {"sky.model": "procedural"}), plain)
drawn(["preset.toml"], {})

chart = drawn(["kerr"], {"sky.model": "star_chart", "disk.enabled": False})
assert {0.8, 0.02} == {round(float(x), 2) for x in np.unique(renderer.radiance()[:6, :6])}, "it reads the table that it declares"

# A running window takes up what is edited there, and names the file of a mistake.
file = Path(os.environ["BLACKHOLE_GL_CONFIG_DIR"]) / "shaders" / "skies" / "star_chart.glsl"
text = file.read_text()

def edit(new):
    file.write_text(new)
    later = file.stat().st_mtime_ns + 10**9
    os.utime(file, ns=(later, later))
    return renderer.programs.reload()

(error,) = edit(text.replace("vec2 place", "vec3 place"))
assert error.file == str(file) and error.line == text[: text.index("vec2 place")].count(chr(10)) + 1, error
assert edit(text.replace("0.8 : 0.02", "0.5 : 0.5")) == []
assert np.abs(drawn(["kerr"], {"sky.model": "star_chart", "disk.enabled": False}) - chart).max() > 8
"""

TWIN = """
from blackhole_gl import listed_rays
rays = np.stack([np.linspace(0.05, 2.5, 200), np.linspace(-3.0, 3.0, 200)], axis=-1)
for model, fates in (("kink", {1, 2}), ("whirl", {1})):
    scene = presets.load(["kerr"], {"rays.model": model, "rays.step_length": 0.1})
    found, twin = listed_rays.trace_by_shader(renderer, scene, rays), listed_rays.trace_by_reference(scene, rays)
    assert np.array_equal(found.fate, twin.fate) and fates == set(twin.fate.tolist()), model
    assert np.nanmax(np.abs(found.direction - twin.direction)) < 5e-6, "float32, over 250 steps"
"""

LAW = """
assert np.abs(drawn(["kerr"], {"disk.temperature_law": "constant"}) - plain).max() > 8
"""


def run(script: str, folder: Path, own: Path) -> None:
    """Runs `script` in `folder`, with the project from there or else from here, and `own` as the configuration folder."""
    environment = {**os.environ, "BLACKHOLE_GL_CONFIG_DIR": str(own), "PYTHONPATH": os.pathsep.join([str(folder), str(ROOT)])}
    done = subprocess.run([sys.executable, "-c", script], cwd=folder, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr


def test_the_page_has_an_example_of_each_slot() -> None:
    assert {Path(path).parent.name for path, _ in SHADERS} == {"skies", "disks", "ray_models", "things", "media", "integrators"}
    assert len(PYTHON) == 3 and len(TWINS) == 2 and len(TOML) == 1


def test_every_shader_on_the_page_draws_from_the_configuration_folder(tmp_path: Path) -> None:
    for path, text in SHADERS:
        file = tmp_path / "config" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    (tmp_path / "preset.toml").write_text(TOML[0], encoding="utf-8")
    run(DRAW + OWN, tmp_path, tmp_path / "config")


@pytest.fixture
def changed(tmp_path: Path) -> Path:
    """A copy of the project with the page's temperature law in it."""
    for folder in ("blackhole_gl", "shaders", "presets", "assets"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    sections = tmp_path / "blackhole_gl" / "scene" / "sections.py"
    text, laws = re.subn(r'"shakura_sunyaev", ', '"shakura_sunyaev", "constant", ', sections.read_text(encoding="utf-8"))
    assert laws == 1
    sections.write_text(text, encoding="utf-8")
    profile = tmp_path / "blackhole_gl" / "physics" / "disk_profile.py"
    profile.write_text(profile.read_text(encoding="utf-8") + "\n\n" + LAW_TEXT, encoding="utf-8")
    return tmp_path


def test_the_twins_on_the_page_are_one_file_of_the_project_each(changed: Path) -> None:
    for file, text in TWINS:
        (changed / file).write_text(text, encoding="utf-8")
    for path, text in SHADERS:
        if Path(path).parent.name == "ray_models":
            (changed / path).write_text(text, encoding="utf-8")
    run(DRAW + TWIN, changed, changed / "config")


def test_every_kind_on_the_page_takes_less_than_forty_lines() -> None:
    assert all(text.count("\n") < 40 for path, text in SHADERS if Path(path).parent.name in ("things", "media"))


def test_a_field_and_its_twin_take_less_than_forty_lines_each() -> None:
    texts = [text for path, text in (*SHADERS, *TWINS) if Path(path).stem == "whirl"]
    assert len(texts) == 2 and all(text.count("\n") < 40 for text in texts)


def test_the_temperature_law_on_the_page_is_two_places_of_the_project(changed: Path) -> None:
    run(DRAW + LAW, changed, changed / "config")
