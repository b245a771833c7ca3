"""Plug-ins are what their headers say."""

from __future__ import annotations

import pytest

from blackhole_gl.resources import shaders_dir
from blackhole_gl.scene import catalogue

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
            assert name.startswith(f"{catalogue.SLOTS[slot][1]}.{key}.")
            assert item.help.endswith(".")


def test_ray_models_say_what_the_plan_and_the_observer_ask():
    for plug_in in catalogue.plug_ins("ray_model").values():
        traits = plug_in.traits
        assert traits["kind"] in ("closed", "differential")
        assert traits["space_time"] in ("flat", "schwarzschild", "kerr")
        assert isinstance(traits["spins"], bool) and isinstance(traits["exact"], bool)
        if traits["kind"] == "differential":
            assert traits["step_control"] in catalogue.plug_ins("step_control")
            assert catalogue.reasons_against(plug_in.key, "rk4", traits["step_control"]) == []


def test_integrators_say_what_a_step_costs():
    for plug_in in catalogue.plug_ins("integrator").values():
        assert plug_in.traits["order"] >= 1 and plug_in.traits["evaluations"] >= 1


def test_plug_ins_come_in_the_order_of_their_rank():
    for slot in catalogue.SLOTS:
        ranks = [plug_in.traits.get("rank", 100) for plug_in in catalogue.plug_ins(slot).values()]
        assert ranks == sorted(ranks)


def test_what_does_not_fit_is_said_in_a_sentence():
    (reason,) = catalogue.reasons_against("kerr", "rk4", "radius")
    assert "radius" in reason and "kerr" in reason and "mino" in reason
    assert catalogue.reasons_against("flat", "rk4", "mino") == []


def made(tmp_path, text):
    path = tmp_path / "ripple.glsl"
    path.write_text(text, encoding="utf-8")
    return catalogue._read(path, "disk_layer", "disk")


def test_a_parameter_becomes_a_field(tmp_path, monkeypatch):
    monkeypatch.setattr(catalogue, "shaders_dir", lambda: tmp_path)
    more = '[parameters.depth]\ndefault = 0.5\nrange = [0, 1]\nunit = "r_s"\nhelp = "How deep."\n[parameters.count]\ndefault = 3\nrange = [1, 9]\nhelp = "How many."\n[parameters.soft]\ndefault = true\nhelp = "Whether."'
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
