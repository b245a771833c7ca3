"""Kinds of things and media in a shader folder of the user's, for tests: no shipped one has every kind of value."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from blackhole_gl.resources import shaders_dir
from blackhole_gl.scene import catalogue, instances, met

GLOBE = '''/*---
label = "Globe"
summary = "A ball."
source = "own"
slot = "thing"
reach = ["radius"]

[parameters.radius]
default = 1.0
range = [0.1, 50.0]
unit = "r_s"
help = "Its radius."

[parameters.number]
default = 3
range = [1, 9]
help = "How many."

[parameters.glows]
default = false
help = "Whether it gives light."

[parameters.pattern]
default = "plain"
options = ["plain", "chequered"]
help = "What is painted on it."

[parameters.caption]
default = ""
length = 20
help = "What stands beside it."

[parameters.image]
default = ""
suffixes = [".png", ".jpg"]
help = "What is painted on it."

[parameters.radii]
default = [1.0, 2.0]
length = [0, 4]
element = { default = 1.0, range = [0.0, 9.0], unit = "r_s" }
help = "Rings."

[parameters.path]
default = []
length = [0, 10]
help = "Where it goes."
columns.time = { default = 0.0, range = [0.0, 1e6], unit = "r_s/c", help = "When." }
columns.ease = { default = "smooth", options = ["smooth", "linear"], help = "How." }
columns.image = { default = "", suffixes = [".png"], help = "What is shown from then on." }
---*/
'''

CUBE = '''/*---
label = "Cube"
summary = "A box."
source = "own"
slot = "thing"
reach = ["edge"]
opaque = false
increasing = ["radius", "edge"]

[parameters.edge]
default = 2.0
range = [0.1, 50.0]
help = "Its edge."

[parameters.radius]
default = 0.5
range = [0.0, 3.0]
help = "Of its corners."

[parameters.glows]
default = false
help = "Whether it gives light."
---*/
'''

CLOUD = '''/*---
label = "Cloud"
summary = "A haze."
source = "own"
slot = "medium"
reach = []

[parameters.density]
default = 1.0
range = [0.0, 10.0]
help = "How much there is."
---*/
'''


def put(folder: Path) -> Path:
    """Writes the kinds below the configuration folder `folder`; returns its shader folder."""
    for path, text in (("things/globe.glsl", GLOBE), ("things/cube.glsl", CUBE), ("media/cloud.glsl", CLOUD)):
        file = folder / "shaders" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return folder / "shaders"


@pytest.fixture
def known_kinds(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Globe, cube and cloud, and no other kinds, are known while a test runs; the configuration folder that they lie in."""
    folder = tmp_path_factory.mktemp("config")
    monkeypatch.setenv("BLACKHOLE_GL_CONFIG_DIR", str(folder))
    found = catalogue.read(shaders_dir(), put(folder))
    assert found.mistakes == ()
    own = {slot: {key: kind for key, kind in found.plug_ins[slot].items() if kind.file.is_relative_to(folder)} for slot in ("thing", "medium")}
    known = catalogue.Catalogue({**found.plug_ins, **own}, ())
    monkeypatch.setattr(catalogue, "_catalogue", lambda: known)
    _forget()
    yield folder
    _forget()


def _forget() -> None:
    """What is kept of kinds by their names must not outlive them."""
    instances._fields_of.cache_clear()
    met._kinds.cache_clear()
