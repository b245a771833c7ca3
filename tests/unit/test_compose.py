"""Composed shader text, and the way back from a driver's line to the author's."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from blackhole_gl.glsl.compose import Composed, ShaderError, compose
from blackhole_gl.glsl.live import Words
from blackhole_gl.resources import shaders_dir


@pytest.fixture
def shaders(tmp_path: Path):
    def write(**files: str) -> tuple[Path]:
        for name, text in files.items():
            path = tmp_path / name.replace("__", "/")
            path = path.with_suffix(".glsl") if not path.suffix else path
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return (tmp_path,)

    return write


def test_includes_are_recursive_and_taken_once(shaders):
    root = shaders(main='#include "a.glsl"\n#include "b.glsl"\nvoid main() {}\n', a='#include "b.glsl"\nint a;\n', b="int b;\n")
    made = compose(root, "main.glsl")
    assert made.text == "int b;\nint a;\nvoid main() {}\n"
    assert made.places == (("b.glsl", 1), ("a.glsl", 2), ("main.glsl", 3))


def test_includes_of_each_other_end(shaders):
    root = shaders(a='#include "b.glsl"\nint a;\n', b='#include "a.glsl"\nint b;\n')
    assert compose(root, "a.glsl").text == "int b;\nint a;\n"


def test_directives_in_comments_are_left_alone(shaders):
    text = '/* #include "missing.glsl"\n#include "missing.glsl"\n*/ int a;\n// #include "missing.glsl"\n'
    text += "/* */ /* open\n#slot nothing\n*/\nint b; // /*\nint c;\n"
    assert compose(shaders(main=text), "main.glsl").text == text


def test_slots_take_what_was_chosen(shaders):
    root = shaders(
        main="#slot model\n#slots layer\nvoid f() {\n    #each layer : x = $key(x);\n}\n",
        models__kerr="int kerr;\n",
        layers__one="int one(int x);\n",
        layers__two="int two(int x);\n",
    )
    made = compose(root, "main.glsl", chosen={"model": ["models/kerr.glsl"], "layer": ["layers/one.glsl", "layers/two.glsl"]})
    assert made.text == "int kerr;\nint one(int x);\nint two(int x);\nvoid f() {\nx = one(x);\nx = two(x);\n}\n"
    assert made.place(6) == ("main.glsl", 4)
    assert compose(root, "main.glsl", chosen={"model": [], "layer": []}).text == "void f() {\n}\n"


EACH = "#slots thing\nfloat f(int i) {\n    #each thing : if (i == THING_$KEY) return thing_$key_distance(i, 0.0) + other(thing_$key_count);\n}\n"


@pytest.mark.parametrize(
    "ball, lacks",
    [
        ("float thing_ball_distance(int i, float x) { return x; }\n", False),
        ("const float\nthing_ball_distance (int i, float x) { return x; }\n", False),
        ('#include "things/shared.glsl"\n', False),
        ("float thing_ball_distances(int i, float x) { return x; }\n", True),
        ("float thing_ball_light(int i) {\n    return thing_ball_distance(i, 1.0);\n}\n", True),
    ],
)
def test_a_plug_in_that_lacks_a_function_of_its_slot_is_named(shaders, tmp_path, ball, lacks):
    (shipped,) = shaders(shipped__main=EACH)
    shaders(own__things__ball=ball, own__things__shared="float thing_ball_distance(int i, float x) { return x; }\n")
    roots = shipped / "shipped", tmp_path / "own"
    if not lacks:
        compose(roots, "main.glsl", chosen={"thing": ["things/ball.glsl"]})
        return
    with pytest.raises(ShaderError, match="there is no function thing_ball_distance, which this plug-in has to have") as caught:
        compose(roots, "main.glsl", chosen={"thing": ["things/ball.glsl"]})
    assert (caught.value.file, caught.value.line) == (str(tmp_path / "own" / "things" / "ball.glsl"), 1)


MODEL = "struct State { float x; };\nState ray_init() { return State(0.0); }\n#ifdef SECOND\nState state_push(State s) { return s; }\n#endif\n"
MARCH = """#slot ray_model
#slot integrator
void main() {
    State s = integrator_step(ray_init());
    // ray_end(s)
#if DRIFTS
    ray_drift(s);
#endif
}
"""
EULER = "State integrator_step(State s) {\n    return state_push(s);\n}\n"


@pytest.mark.parametrize(
    "model, integrator, switches, at_fault, says",
    [
        (f"#define SECOND\n{MODEL}", EULER, {}, None, ""),
        (MODEL, EULER, {}, "model", "there is no function state_push, which this plug-in has to have"),
        (MODEL.replace("ray_init", "ray_begin"), EULER, {}, "model", "there are no functions state_push, ray_init, which this plug-in has to have"),
        (f"#define SECOND\n{MODEL}", "", {}, "integrator", "there is no function integrator_step, which"),
        (f"#define SECOND\n{MODEL}", EULER, {"DRIFTS": 1}, "model", "there is no function ray_drift, which"),
        (f"#define SECOND\n{MODEL}void g() {{ ray_nod(); }}\n", EULER, {}, None, ""),  # a slip in the plug-in's own text is the driver's to tell, with its line
    ],
)
def test_a_ray_plug_in_that_lacks_a_function_that_others_call_is_named(shaders, tmp_path, model, integrator, switches, at_fault, says):
    shaders(shipped__main=MARCH, own__model=model, own__integrator=integrator)
    roots, chosen = (tmp_path / "shipped", tmp_path / "own"), {"ray_model": ["model.glsl"], "integrator": ["integrator.glsl"]}
    if at_fault is None:
        compose(roots, "main.glsl", chosen=chosen, switches=switches)
        return
    with pytest.raises(ShaderError, match=says) as caught:
        compose(roots, "main.glsl", chosen=chosen, switches=switches)
    assert (caught.value.file, caught.value.line) == (str(tmp_path / "own" / f"{at_fault}.glsl"), 1)


NOTHING_MET = {name: [] for name in ("thing", "thing_by_distance", "thing_by_crossing", "thing_told_apart", "thing_not_placed", "medium")}
SHIPPED = {"ray_model": "ray_models/schwarzschild_binet.glsl", "integrator": "integrators/rk4.glsl", "step_control": "step_controls/radius.glsl"}


@pytest.mark.parametrize(
    "slot, path, function, main",
    [
        ("ray_model", "ray_models/schwarzschild_binet.glsl", "ray_plane_point", "trace.frag"),
        ("ray_model", "ray_models/flat.glsl", "trace_ray", "trace.frag"),
        ("integrator", "integrators/rk4.glsl", "integrator_step", "trace.frag"),
        ("step_control", "step_controls/radius.glsl", "step_size", "trace.frag"),
        ("step_control", "step_controls/doubling.glsl", "adapted_step", "trace.frag"),
        ("sky", "skies/procedural.glsl", "sky_radiance", "shade_sky.frag"),
    ],
)
def test_each_slot_of_a_picture_knows_its_functions(tmp_path, slot, path, function, main):
    def made(text: str) -> Composed:
        (tmp_path / "mine.glsl").write_text(text, encoding="utf-8")
        chosen = {name: ["mine.glsl" if name == slot else file] for name, file in {**SHIPPED, "sky": ""}.items()}
        switches = {"MARCHED": int("ray_models/flat.glsl" != path), "ORDERS": 3}
        return compose((shaders_dir(), tmp_path), main, chosen={**chosen, **NOTHING_MET}, switches=switches)

    whole = (shaders_dir() / path).read_text(encoding="utf-8")
    made(whole)
    with pytest.raises(ShaderError, match=rf"there is no function {function}, which this plug-in has to have") as caught:
        made(re.sub(rf"\b{function}\b", f"{function}s", whole))
    assert caught.value.file == str(tmp_path / "mine.glsl")


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_files_of_other_editors_are_read(tmp_path, encoding):
    (tmp_path / "main.glsl").write_bytes("int a; // ä\r\nint b;\r\n".encode(encoding))
    assert compose((tmp_path,), "main.glsl").text == "int a; // ä\nint b;\n"


def test_a_file_that_is_no_text_is_named(tmp_path):
    (tmp_path / "main.glsl").write_bytes(b"int a;\n\xff")
    with pytest.raises(ShaderError, match=r"main\.glsl is not UTF-8 text \(byte 7\)"):
        compose((tmp_path,), "main.glsl")


def test_only_switches_that_the_text_mentions_are_written(shaders):
    root = shaders(main="#version 330 core\n#defines\n#if DISK_BEAMING\nint a;\n#endif\n")
    made = compose(root, "main.glsl", switches={"DISK_BEAMING": 1, "DISK_BEAMING_MORE": 1, "SKY_ENABLED": 0})
    assert made.defines == {"DISK_BEAMING": 1}
    assert made.text.splitlines()[1] == "#define DISK_BEAMING 1"
    assert made.place(3) == ("main.glsl", 3)


def test_blocks_are_put_in_and_keep_the_lines_right(shaders):
    made = compose(shaders(main="#blocks\nint a; // aa\n"), "main.glsl", blocks=lambda words: f"uniform B {{\n    float {min(words.compiled)};\n}};")
    assert made.text == "uniform B {\n    float a;\n};\nint a; // aa\n"
    assert made.place(2) == ("main.glsl", 1) and made.place(4) == ("main.glsl", 2)


@pytest.mark.parametrize(
    "text, place, words",
    [
        ('int a;\n#include "missing.glsl"\n', ("main.glsl", 2), "no shader file missing.glsl"),
        ("#include <noise.glsl>\n", ("main.glsl", 1), 'write #include "path'),
        ("#slot sky\n", ("main.glsl", 1), "no slot 'sky'"),
    ],
)
def test_mistakes_in_directives_are_named(shaders, text, place, words):
    with pytest.raises(ShaderError, match=words) as caught:
        compose(shaders(main=text), "main.glsl")
    assert (caught.value.file, caught.value.line) == place
    assert str(caught.value).startswith(f"{place[0]}:{place[1]}: ")


def test_a_second_folder_adds_files_and_replaces_none(tmp_path):
    shipped, own = tmp_path / "shipped", tmp_path / "own"
    shipped.mkdir()
    own.mkdir()
    (shipped / "main.glsl").write_text('#include "a.glsl"\n#include "b.glsl"\n', encoding="utf-8")
    (shipped / "a.glsl").write_text("int a;\n", encoding="utf-8")
    (own / "a.glsl").write_text("int other;\n", encoding="utf-8")
    (own / "b.glsl").write_text('#include "a.glsl"\nint b;\n#include "c.glsl"\n', encoding="utf-8")
    with pytest.raises(ShaderError, match="no shader file c.glsl") as caught:
        compose((shipped, own), "main.glsl")
    assert (caught.value.file, caught.value.line) == (str(own / "b.glsl"), 3), "a file of the user's is named by its whole path"
    (own / "c.glsl").write_text("int c;\n", encoding="utf-8")
    made = compose((shipped, own), "main.glsl")
    assert made.text == "int a;\nint b;\nint c;\n"
    assert [file for file, _ in made.places] == ["a.glsl", str(own / "b.glsl"), str(own / "c.glsl")]


def test_a_missing_main_file_has_no_place(tmp_path):
    with pytest.raises(ShaderError) as caught:
        compose((tmp_path,), "none.frag")
    assert caught.value.file == "" and "none.frag" in str(caught.value)


NONE = Words(frozenset(), frozenset())
COMPOSED = Composed("a\nb\nc\nd\n", (("main.frag", 1), ("common/noise.glsl", 7), ("common/noise.glsl", 8), ("main.frag", 3)), {}, NONE)

# As the drivers write them; Mesa's with and without a trailing space, NVIDIA's with its code, AMD's, Intel's on Windows and Apple's alike.
LOGS = {
    "Mesa": "0:2(14): error: `foo' undeclared\n0:4(1): error: type mismatch\n",
    "NVIDIA": '0(2) : error C1503: undefined variable "foo"\n0(4) : error C0000: syntax error\n',
    "AMD": "ERROR: 0:2: 'foo' : undeclared identifier \nERROR: 0:4: '' : compilation terminated \n",
    "Apple": "ERROR: 0:2: Use of undeclared identifier 'foo'\nERROR: 0:4: Invalid call\n",
    "moderngl's own heading": "GLSL Compiler failed\n\nfragment_shader\n===============\n0:2(14): error: `foo' undeclared\n0:4(1): error: type mismatch\n",
}


@pytest.mark.parametrize("driver", LOGS)
def test_every_drivers_log_leads_back_to_the_author(driver):
    error = COMPOSED.explain(LOGS[driver])
    assert (error.file, error.line) == ("common/noise.glsl", 7)
    first, second = str(error).splitlines()
    assert first.startswith("common/noise.glsl:7: ") and "foo" in first
    assert second.startswith("main.frag:3: ")


def test_a_warning_does_not_hide_the_error():
    error = COMPOSED.explain("0:1(1): warning: `x' used uninitialized\n0:3(2): error: no such thing\n")
    assert (error.file, error.line) == ("common/noise.glsl", 8)
    assert "warning" in str(error)


def test_a_log_without_places_is_handed_on():
    error = COMPOSED.explain("  out of memory\n")
    assert (error.file, error.line, str(error)) == ("", 0, "out of memory")


def test_lines_beyond_the_text_have_no_place():
    assert COMPOSED.place(0) == COMPOSED.place(99) == ("", 0)
