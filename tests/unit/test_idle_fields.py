"""What moves nothing is not offered: every number is read by a shader or by the program."""

import re
from functools import cache
from pathlib import Path

import pytest

import blackhole_gl
from blackhole_gl.app.panel import Panel
from blackhole_gl.resources import shaders_dir
from blackhole_gl.scene import Scene, fields

NUMBERS = [key for key, item in fields().items() if key.count(".") == 1 and item.kind in ("float", "int")]


@cache
def sources() -> str:
    programs = Path(next(iter(blackhole_gl.__path__))).rglob("*.py")
    files = [*shaders_dir().rglob("*.glsl"), *shaders_dir().rglob("*.frag"), *programs]
    return "\n".join(path.read_text(encoding="utf-8") for path in files if path.name != "sections.py")


@pytest.mark.parametrize("key", NUMBERS)
def test_a_number_is_read(key: str) -> None:
    assert re.search(rf"\b{key.replace('.', '[._]')}\b", sources()) is not None


@pytest.mark.parametrize(
    "key, choice, option",
    [
        ("camera.fov_deg", "camera.projection", "perspective"),
        ("camera.eye_separation", "camera.projection", "stereo"),
        ("camera.dome_tilt_deg", "camera.projection", "dome"),
        ("camera.fall_from", "camera.observer", "fall"),
        ("post.beam_uas", "post.beam", True),
        ("post.key_light", "post.exposure_mode", "automatic"),
    ],
)
def test_the_panel_has_a_row_where_it_moves_something(key: str, choice: str, option: object) -> None:
    panel, item = Panel(), fields()[choice]
    for chosen in item.options or (False, True):
        rows = {row.key for row in panel.shown_fields(Scene().with_values({choice: chosen}))}
        assert (key in rows) == (chosen == option), chosen
