"""Every function, constant and macro that the shaders define is used by one of them: what is dead is text that readers take for live."""

from __future__ import annotations

import re
from collections import Counter

from blackhole_gl.rendering import instances
from blackhole_gl.resources import shaders_dir
from blackhole_gl.scene import catalogue, met

COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
FUNCTION = re.compile(r"^[ \t]*\w+[ \t]+(\w+)[ \t]*\([^;{})]*\)\s*\{", re.M)
CONSTANT = re.compile(r"^[ \t]*const[ \t]+\w+[ \t]+(\w+)", re.M)
MACRO = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)", re.M)
EACH = re.compile(r"(\w+_)\$key")
"""How a call begins that the composer writes once for every plug-in of a slot."""


def unused(texts: dict[str, str], written: str = "") -> list[str]:
    """``path: name`` of what is defined in `texts` (path → GLSL) and named nowhere but in definitions, and not in what is `written` by Python."""
    plain = {path: COMMENT.sub(" ", text) for path, text in texts.items()}
    defined = [(path, name) for path, text in plain.items() for kind in (FUNCTION, CONSTANT, MACRO) for name in kind.findall(text)]
    definitions = Counter(name for _, name in defined)
    named = Counter(word for text in (*plain.values(), written) for word in re.findall(r"\w+", text))
    called = tuple({prefix for text in plain.values() for prefix in EACH.findall(text)})
    dead = [(path, name) for path, name in defined if named[name] <= definitions[name] and name != "main" and not name.startswith(called)]
    return sorted(f"{path}: {name}" for path, name in dead)


def test_nothing_in_the_shaders_is_dead() -> None:
    root = shaders_dir()
    texts = {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8") for path in root.rglob("*") if path.suffix in (".glsl", ".frag", ".vert")}
    assert len(texts) > 50
    assert unused(texts, instances.glsl(kind for slot in met.SLOTS for kind in catalogue.plug_ins(slot).values())) == []


def test_what_is_dead_is_found() -> None:
    text = "const float HALF = 0.5;\n#define TWICE 2\nfloat used(float x) {\n    return x;\n}\nvoid dead() {\n}\nvoid main() {\n    used(1.0); // dead()\n}\n"
    assert unused({"a.frag": text}) == ["a.frag: HALF", "a.frag: TWICE", "a.frag: dead"]
