"""Plug-ins are what their headers say."""

from __future__ import annotations

from dataclasses import replace

import pytest

from blackhole_gl.resources import shaders_dir
from blackhole_gl.scene import catalogue
from blackhole_gl.scene.traits import IntegratorTraits

HEADER = '''/*---
label = "Ripple"
summary = "Rings."
source = "none"
slot = "disk_layer"
{more}
---*/
'''


@pytest.mark.parametrize("slot", catalogue.SLOTS)
def test_every_shipped_plug_in_is_whole(slot):
    found = catalogue.plug_ins(slot)
    assert found
    for key, plug_in in found.items():
        assert plug_in.key == key and plug_in.slot == slot
        assert plug_in.label and plug_in.source and plug_in.summary.endswith(".")
        assert (shaders_dir() / plug_in.path).is_file() and "\\" not in plug_in.path
        for name, item in plug_in.parameters.items():
            assert name.startswith(f"{catalogue.SLOTS[slot].section}.{key}.")
            assert item.help.endswith(".")


def test_a_marched_models_own_step_control_fits_it():
    marched = [plug_in for plug_in in catalogue.plug_ins("ray_model").values() if plug_in.traits.kind == "differential"]
    assert marched
    for plug_in in marched:
        assert catalogue.reasons_against(plug_in.key, "rk4", plug_in.traits.step_control) == []


def test_traits_are_what_the_shipped_headers_say():
    drag, flat = (catalogue.plug_ins("ray_model")[key].traits for key in ("post_newtonian_drag", "flat"))
    curvature = catalogue.plug_ins("step_control")["curvature"].traits
    assert (drag.march_bound, drag.spins, drag.exact, drag.second_order, drag.charted) == (120.0, True, False, False, True)
    assert (curvature.shortest, curvature.adapts, curvature.fits) == (0.4, False, ("cartesian", "mino"))
    assert (flat.marches_in, flat.step_control, flat.march_bound) == (None, None, None)
    assert catalogue.plug_ins("integrator")["dopri5"].traits == IntegratorTraits(order=5, evaluations=6, pair_evaluations=7)


def test_plug_ins_come_in_the_order_of_their_rank():
    for slot in catalogue.SLOTS:
        ranks = [plug_in.rank for plug_in in catalogue.plug_ins(slot).values()]
        assert ranks == sorted(ranks)


def test_what_does_not_fit_is_said_in_a_sentence():
    (reason,) = catalogue.reasons_against("kerr", "rk4", "radius")
    assert "radius" in reason and "kerr" in reason and "mino" in reason
    assert catalogue.reasons_against("flat", "rk4", "mino") == []


def made(tmp_path, text, slot="disk_layer"):
    path = tmp_path / "ripple.glsl"
    path.write_text(text, encoding="utf-8")
    return catalogue._read(path, slot)


def test_a_parameter_becomes_a_field(tmp_path, monkeypatch):
    monkeypatch.setattr(catalogue, "shaders_dir", lambda: tmp_path)
    more = """
[parameters.depth]
default = 0.5
range = [0, 1]
unit = "r_s"
help = "How deep."
[parameters.count]
default = 3
range = [1, 9]
help = "How many."
[parameters.soft]
default = true
help = "Whether."
"""
    parameters = made(tmp_path, HEADER.format(more=more)).parameters
    assert {key: item.kind for key, item in parameters.items()} == {"disk.ripple.depth": "float", "disk.ripple.count": "int", "disk.ripple.soft": "switch"}
    assert parameters["disk.ripple.depth"].allowed() == "a number from 0 to 1 r_s"
    assert parameters["disk.ripple.depth"].glsl_name == "disk_ripple_depth"


@pytest.mark.parametrize(
    "text, words",
    [
        ("void f() {}", "no header"),
        ("/*---\nlabel = \n---*/", "not TOML"),
        ('/*---\nlabel = "*/"\n---*/', "ends the GLSL comment"),
        ('/*---\nlabel = "Ripple"\nslot = "disk_layer"\n---*/', "lacks"),
        (HEADER.replace("disk_layer", "sky").format(more=""), "its folder holds 'disk_layer'"),
        (HEADER.format(more="[parameters.depth]\ndefault = 0.5"), "lacks 'help'"),
        (HEADER.format(more='[parameters.depth]\ndefault = 0.5\nhelp = "H."'), "needs range"),
        (HEADER.format(more='[parameters.depth]\ndefault = 2.0\nrange = [0, 1]\nhelp = "H."'), "disk.ripple.depth"),
    ],
)
def test_a_wrong_header_is_named_with_its_file(tmp_path, monkeypatch, text, words):
    monkeypatch.setattr(catalogue, "shaders_dir", lambda: tmp_path)
    with pytest.raises(ValueError) as caught:
        made(tmp_path, text)
    assert words in str(caught.value)
    assert "ripple" in str(caught.value)


MODEL = '''/*---
label = "Ripple"
summary = "Rings."
source = "none"
slot = "ray_model"
kind = "differential"
space_time = "kerr"
spins = true
exact = true
marches_in = "mino"
step_control = "mino"
---*/
'''


@pytest.mark.parametrize(
    "old, new, words",
    [
        ("exact = true", "exakt = true", "ripple.glsl: got the entry 'exakt'; allowed are label, .*; did you mean exact\\?"),
        ("exact = true\n", "", "ripple.glsl: the header lacks 'exact'; allowed is true or false"),
        ("exact = true", "exact = 1", "ripple.glsl: exact: got 1; allowed is true or false"),
        ('"kerr"', '"ker"', "ripple.glsl: space_time: got 'ker'; allowed is one of flat, schwarzschild, kerr; did you mean kerr\\?"),
        ('kind = "differential"', "kind = true", "ripple.glsl: kind: got True; allowed is one of closed, differential"),
        ('marches_in = "mino"\n', "", "ripple.glsl: the header lacks 'marches_in', which a model of kind differential"),
        ('"differential"', '"closed"', "ripple.glsl: marches_in: a model of kind closed takes no steps"),
        ('step_control = "mino"', 'step_control = "minos"', "ripple.glsl: step_control: got 'minos'; allowed is one of .*; did you mean mino\\?"),
        ("exact = true", "exact = true\nmarch_bound = 0.5", "ripple.glsl: march_bound: got 0.5; allowed is a number from 1 to 10000"),
        ("exact = true", "exact = true\nrank = '1'", "ripple.glsl: rank: got '1'; allowed is a number"),
        ("exact = true", "exact = true\nparameters = 3", "ripple.glsl: parameters: got 3; allowed is a table"),
    ],
)
def test_a_wrong_trait_names_file_entry_what_was_given_and_what_is_allowed(tmp_path, monkeypatch, old, new, words):
    monkeypatch.setattr(catalogue, "shaders_dir", lambda: tmp_path)
    assert old in MODEL
    with pytest.raises(catalogue.CatalogueError, match=words):
        made(tmp_path, MODEL.replace(old, new), "ray_model")


def test_lists_of_traits_are_checked_word_by_word(tmp_path, monkeypatch):
    monkeypatch.setattr(catalogue, "shaders_dir", lambda: tmp_path)
    header = HEADER.replace("disk_layer", "integrator").format(more='order = 2\nevaluations = 2\nfits = ["cartesian"]')
    assert made(tmp_path, header, "integrator").traits == IntegratorTraits(order=2, evaluations=2, fits=("cartesian",))
    for wrong in ('["cartesian", "polar"]', '"cartesian"', "[3]"):
        with pytest.raises(catalogue.CatalogueError, match="fits: got .*; allowed is a list, each of it one of cartesian, mino"):
            made(tmp_path, header.replace('["cartesian"]', wrong), "integrator")


def test_an_integrator_for_one_way_to_march_keeps_to_it(monkeypatch):
    shipped = catalogue.plug_ins("integrator")["rk4"]
    narrow = replace(shipped, traits=replace(shipped.traits, fits=("cartesian",)))
    others = {slot: catalogue.plug_ins(slot) for slot in ("ray_model", "step_control")}
    monkeypatch.setattr(catalogue, "_plug_ins", {"integrator": {"rk4": narrow}, **others}.get)
    assert catalogue.reasons_against("schwarzschild", "rk4", "radius") == []
    assert catalogue.reasons_against("kerr", "rk4", "mino") == ["rk4 fits models that march in cartesian; kerr marches in mino"]


@pytest.mark.parametrize(
    "more, words",
    [
        ("[tables]\nhue = 3", "ripple.glsl: tables.hue: got 3; allowed is a table"),
        ("[tables.hue]", "ripple.glsl: hue: the header lacks 'make'; allowed is text in quotes"),
        ('[tables.hue]\nmake = "a:b"\nfilter = "liner"', "ripple.glsl: hue: filter: got 'liner'; allowed is one of .*, mipmap; did you mean linear"),
        ('[tables.hue]\nmake = "a:b"\nname = "tint"', "ripple.glsl: hue: got the entry 'name'; allowed are make, of, filter, repeat_x, constants"),
        ('[numbers.hue]\nmake = "a:b"\ntype = "vec3"', "ripple.glsl: hue: type: got 'vec3'; allowed is one of float, int, vec2, vec4, mat4"),
    ],
)
def test_a_wrong_declaration_of_a_table_names_file_and_entry(tmp_path, monkeypatch, more, words):
    monkeypatch.setattr(catalogue, "shaders_dir", lambda: tmp_path)
    with pytest.raises(catalogue.CatalogueError, match=words):
        made(tmp_path, HEADER.format(more=more))
