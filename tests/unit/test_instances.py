"""A scene's named instances: made by their kind, changed by key, layered, written and read back."""

from __future__ import annotations

import math
import os
import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomlkit
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from blackhole_gl.output import png
from blackhole_gl.scene import FrozenMap, Instance, Scene, SceneError, catalogue, fields, instances, presets
from blackhole_gl.scene.instances import Place
from blackhole_gl.scene.presets import PresetError
from tests.unit.kinds import known_kinds  # noqa: F401

pytestmark = pytest.mark.usefixtures("known_kinds")

MOON = {"things.moon.kind": "globe"}


def moon(**values) -> Scene:
    return Scene().with_values(MOON | {f"things.moon.{name}": value for name, value in values.items()})


# --- values ---


def test_a_kind_makes_an_instance_with_its_defaults():
    scene = moon()
    assert scene.get("things.moon.kind") == "globe" and scene.get("things.moon.radius") == 1.0
    made = scene.things["moon"]
    assert isinstance(made, Instance) and made.kind == "globe"
    assert made.values["radii"] == (1.0, 2.0) and made.values["path"] == ()
    assert list(made.values) == ["radius", "number", "glows", "pattern", "caption", "image", "radii", "path"]
    assert Scene().things == {} and Scene() != scene


def test_the_kind_comes_first_however_the_values_are_ordered():
    assert Scene().with_values({"things.moon.radius": 2, **MOON}) == moon(radius=2.0)


def test_another_kind_keeps_what_both_have_and_can_take():
    scene = moon(radius=0.75, glows=True).with_values({"things.moon.kind": "cube"})
    assert dict(scene.things["moon"].values) == {"edge": 2.0, "radius": 0.75, "glows": True}
    assert moon(radius=30.0).with_values({"things.moon.kind": "cube"}).get("things.moon.radius") == 0.5, "a cube's corners are no larger than 3"


def test_parameters_that_have_an_order_keep_it():
    """A cube's radius is that of its corners, which its edge bounds."""
    cube = Scene().with_values({"things.box.kind": "cube", "things.box.edge": 0.6})
    assert cube.with_values({"things.box.edge": 0.8, "things.box.radius": 0.7}).get("things.box.radius") == 0.7, "one of them alone could not be so"
    with pytest.raises(SceneError, match=r"^things\.box\.radius: got 0\.7; allowed is at most 0\.6, which is things\.box\.edge$"):
        cube.with_values({"things.box.radius": 0.7})
    with pytest.raises(SceneError, match=r"^things\.box\.edge: got 0\.3; allowed is at least 0\.5, which is things\.box\.radius$"):
        cube.with_values({"things.box.edge": 0.3})
    assert presets.load([], {"things.box.kind": "cube", "things.box.radius": "0.7", "things.box.edge": "0.8"}).get("things.box.edge") == 0.8
    with pytest.raises(PresetError, match="^--set: things.box.edge: got 0.3; allowed is at least 0.5"):
        presets.load([], {"things.box.edge": "0.3", "things.box.kind": "cube"})


def test_another_kind_begins_with_its_own_values_where_the_old_ones_would_be_out_of_order():
    made = moon(radius=2.5, glows=True).with_values({"things.moon.kind": "cube"}).things["moon"]
    assert (made.values["edge"], made.values["radius"]) == (2.0, 0.5)


def test_things_and_media_are_told_apart_and_keep_their_order():
    scene = Scene().with_values({"media.haze.kind": "cloud", "things.b.kind": "cube", "things.a.kind": "globe"})
    assert list(scene.things) == ["b", "a"] and list(scene.media) == ["haze"]
    assert list(scene.with_values({"things.b.edge": 3.0}).things) == ["b", "a"]
    assert scene.get("media.haze.density") == 1.0


def test_fields_of_a_scene_are_the_fixed_ones_and_those_of_its_instances():
    assert Scene().fields() is fields()
    scene = moon(radius=2.0)
    known = scene.fields()
    assert list(known)[: len(fields())] == list(fields())
    assert [key for key in known if key not in fields()] == [f"things.moon.{name}" for name in ("kind", *scene.things["moon"].values)]
    assert scene.keys() == tuple(known) and list(scene.values()) == list(known)
    item = known["things.moon.radius"]
    assert (item.key, item.unit, item.high) == ("things.moon.radius", "r_s", 50.0) and scene.field("things.moon.radius") == item
    assert known["things.moon.kind"].options == ("cube", "globe")
    assert Scene().with_values(scene.values()) == scene


def test_instances_are_taken_out_and_renamed_at_their_place():
    scene = Scene().with_values({"things.a.kind": "cube", "things.b.kind": "globe", "things.b.radius": 2.0, "things.c.kind": "cube"})
    assert list(scene.without("things.b").things) == ["a", "c"]
    renamed = scene.renamed("things.b", "sun")
    assert list(renamed.things) == ["a", "sun", "c"] and renamed.get("things.sun.radius") == 2.0
    assert scene.renamed("things.b", "b") == scene


def test_scenes_with_instances_are_frozen_hashable_and_travel():
    scene = moon(radii=[1, 2, 3], path=[{"time": 1.0}])
    with pytest.raises(TypeError):
        scene.things["moon"] = None
    with pytest.raises(AttributeError):
        scene.things["moon"].kind = "cube"
    same = moon(radii=(1.0, 2.0, 3.0), path=({"time": 1, "ease": "smooth", "image": ""},))
    assert scene == same and hash(scene) == hash(same) and len({scene, same, moon()}) == 2
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert scene.get("things.moon.path")[0]["ease"] == "smooth"


def test_the_order_of_a_frozen_map_counts_and_a_plain_dictionary_is_compared_by_content():
    one, other = FrozenMap({"a": 1, "b": 2}), FrozenMap({"b": 2, "a": 1})
    assert one != other and one == {"b": 2, "a": 1} and one.updated({"c": 3}).without("a") == {"b": 2, "c": 3}
    assert pickle.loads(pickle.dumps(one)) == one and hash(FrozenMap(one)) == hash(one)
    third, fourth = FrozenMap(one), FrozenMap(one)
    for pair in ((one, third), (third, fourth), (fourth, one), (one, third)):  # the last comparison is remembered
        assert pair[0] == pair[1] and pair[0] != other and other != pair[1] and pair[0] != {"a": 1}


@pytest.mark.parametrize(
    "key, value, words",
    [
        ("things.mon.radius", 1.0, "things.mon.radius: there is no thing 'mon'; allowed here are moon; did you mean moon?"),
        ("media.mon.density", 1.0, "media.mon.density: there is no medium 'mon'; there is none in this scene. Allowed to make one is its kind: media.mon.kind"),
        ("things.sun.kind", "glbe", "things.sun.kind: got 'glbe'; allowed is one of cube, globe; did you mean globe?"),
        ("things.sun.kind", ["globe"], "things.sun.kind: got a list; allowed is one of cube, globe"),
        ("things.moon.raduis", 1.0, "things.moon.raduis: a globe has no 'raduis'; allowed are kind, radius, number"),
        ("things.moon.raduis", 1.0, "did you mean radius?"),
        ("things.moon.radius", 99.0, "things.moon.radius: got 99.0; allowed is a number from 0.1 to 50 r_s"),
        ("things.moon.pattern", "checkered", "allowed is one of plain, chequered; did you mean chequered?"),
        ("things.moon", 1.0, "things.moon: an instance has no value of its own; allowed are kind, radius"),
        ("things.2nd.kind", "globe", "things.2nd: got the name '2nd'; allowed are letters, digits and _"),
        ("things." + "x" * 33 + ".kind", "globe", "at most 32 of them"),
        ("things..kind", "globe", "got the name ''"),
        ("things.moon.caption", "x" * 21, "allowed is text of at most 20 characters"),
        ("things.moon.caption", "\ud800", "allowed is text"),
        ("things.moon.caption", 3, "got 3; allowed is text"),
        ("things.moon.image", "moon.gif", "got 'moon.gif'; allowed is the path of a file that ends in .png or .jpg"),
        ("things.moon.radii", [1.0] * 5, "got 5 entries; allowed is a list of 0 to 4 entries, each a number from 0 to 9 r_s"),
        ("things.moon.radii", [1.0, -1.0], "things.moon.radii: entry 2: got -1.0; allowed is a number from 0 to 9 r_s"),
        ("things.moon.radii", [10**5000], "entry 1: got a whole number of more than 64 bits"),
        ("things.moon.radii", 3.0, "got 3.0; allowed is a list of 0 to 4 entries"),
        (
            "things.moon.path",
            [{"time": 1.0}, {"tmie": 2.0}],
            "things.moon.path: entry 2: there is no 'tmie'; allowed are time, ease, image; did you mean time?",
        ),
        ("things.moon.path", [{"time": -1.0}], "entry 1, time: got -1.0; allowed is a number from 0"),
        ("things.moon.path", [3.0], "entry 1: got 3.0; allowed is a table with time, ease, image"),
    ],
)
def test_errors_name_the_key_what_was_given_and_what_is_allowed(key, value, words):
    with pytest.raises(SceneError) as caught:
        moon().with_values({key: value})
    assert words in str(caught.value) and str(caught.value).startswith(caught.value.key)
    assert key.startswith(caught.value.key)


@pytest.mark.parametrize(
    "act, words",
    [
        (lambda scene: scene.without("things.sun"), "things.sun: there is no thing 'sun'"),
        (lambda scene: scene.without("hole"), "hole: no instance; allowed are names like things.NAME, media.NAME"),
        (lambda scene: scene.without("things.moon.radius"), "things.moon.radius: no instance"),
        (lambda scene: scene.renamed("things.moon", "a b"), "things.a b: got the name 'a b'"),
        (lambda scene: scene.with_values({"things.sun.kind": "cube"}).renamed("things.moon", "sun"), "things.sun: there is one already"),
        (lambda scene: scene.get("things.moon.edge"), "things.moon.edge: a globe has no 'edge'"),
        (lambda scene: scene.get("things.sun.radius"), "there is no thing 'sun'"),
        (lambda scene: scene.get("things"), "things: no such key"),
    ],
)
def test_what_cannot_be_done_is_said(act, words):
    with pytest.raises(SceneError, match=words):
        act(moon())


def test_without_any_kind_none_can_be_made(monkeypatch):
    bare = catalogue.Catalogue({**catalogue._catalogue().plug_ins, "thing": {}}, ())
    monkeypatch.setattr(catalogue, "_catalogue", lambda: bare)
    with pytest.raises(SceneError, match="things.moon.kind: got 'globe'; allowed is nothing: there is no kind of thing"):
        moon()


# --- presets ---


@pytest.fixture
def preset_file(tmp_path):
    def write(text, name="mine.toml"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    return write


WHOLE = """
[things.moon]
kind = "globe"
radius = 2
glows = true
caption = "Moon"
radii = [3, 4.5]

[[things.moon.path]]
time = 1.0
[[things.moon.path]]
time = 2.0
ease = "linear"

[media.haze]
kind = "cloud"
"""


def test_a_preset_makes_instances(preset_file):
    scene = presets.load([preset_file(WHOLE)])
    path = [{"time": 1.0}, {"time": 2.0, "ease": "linear"}]
    assert scene == moon(radius=2.0, glows=True, caption="Moon", radii=(3.0, 4.5), path=path).with_values({"media.haze.kind": "cloud"})


def test_a_later_preset_merges_into_an_instance(preset_file):
    first = preset_file(WHOLE, "a.toml")
    again = preset_file("[things.moon]\nradius = 5.0\n[things.sun]\nkind = 'cube'\n", "b.toml")
    scene = presets.load([first, again], {"things.sun.edge": "4"})
    assert (scene.get("things.moon.radius"), scene.get("things.moon.caption"), scene.get("things.sun.edge")) == (5.0, "Moon", 4.0)
    other = presets.load([first, preset_file("[things.moon]\nkind = 'cube'\nradius = 0.25\n", "c.toml")])
    assert other.things["moon"] == Instance("cube", FrozenMap({"edge": 2.0, "radius": 0.25, "glows": True}))


@pytest.mark.parametrize(
    "text, line, says",
    [
        ("things = 3\n", 1, r"things: got 3; allowed is a table for each of them, \[things.NAME\]"),
        ("[things]\nmoon = 3\n", 2, r"things.moon: got 3; allowed is a table, \[things.moon\]"),
        ("[[things.moon]]\nkind = 'cube'\n", 1, "things.moon: got a list; allowed is a table"),
        ("[things.'a b']\nkind = 'cube'\n", 1, "things.a b: got the name 'a b'; allowed are letters"),
        ("[things.moon]\n\nkind = 'glbe'\n", 3, "things.moon.kind: got 'glbe'; allowed is one of cube, globe; did you mean globe"),
        ("[things.moon]\nkind = 3\n", 2, "things.moon.kind: got 3; allowed is one of cube, globe"),
        ("[things.moon]\nkind = 'cube'\nedge = '3,5'\n", 3, "things.moon.edge: got '3,5'; .*; write 3.5, not 3,5"),
        ("[things.moon]\nkind = 'cube'\nedge = 3e9\n", 3, "things.moon.edge: got 3000000000.0; allowed is a number from 0.1 to 50"),
        ("[things.moon]\nradius = 1.0\n", 2, "things.moon.radius: there is no thing 'moon'; there is none in this scene. Allowed to make one is its kind"),
        ("[things.moon]\nkind = 'globe'\nradii = [1.0,\n -2.0]\n", 3, "things.moon.radii: entry 2: got -2.0; allowed is a number from 0 to 9"),
        (WHOLE.replace("time = 2.0", "time = -2.0"), 11, "things.moon.path: entry 2, time: got -2.0"),
    ],
)
def test_a_wrong_entry_names_file_line_key_and_what_is_allowed(preset_file, text, line, says):
    with pytest.raises(PresetError, match=rf"mine\.toml, line {line}: {says}") as caught:
        presets.load([preset_file(text)])
    assert caught.value.line == line and caught.value.key


@pytest.mark.parametrize(
    "text, line, says",
    [
        ("\nedje = 3.0\n", 4, "things.moon.edje: skipped, for this version has no such key; did you mean edge?"),
        ("'x.y' = 3\n", 3, 'things.moon."x.y": skipped, for this version has no such key'),
        ("[thing.sun]\nkind = 'cube'\n", 3, "thing: skipped, for this version has no such key; did you mean things?"),
    ],
)
def test_what_this_version_does_not_know_is_told_and_the_rest_counts(preset_file, text, line, says):
    path = preset_file(f"[things.moon]\nkind = 'cube'\n{text}")
    assert presets.load([path]).things == {"moon": Instance("cube", FrozenMap({"edge": 2.0, "radius": 0.5, "glows": False}))}
    assert presets.skipped([path]) == [f"{path}, line {line}: {says}"]


def test_what_this_version_does_not_know_of_a_record_in_a_list_is_told_and_the_rest_counts(preset_file):
    path = preset_file(WHOLE.replace("time = 2.0", "time = 2.0\ntmie = 3.0\nx-y = 1"))
    assert presets.load([path]) == presets.load([preset_file(WHOLE, "whole.toml")])
    told = f"{path}, line 11: things.moon.path: entry 2: {{}} skipped, for this version has no such entry in it"
    assert presets.skipped([path]) == [told.format("tmie") + "; did you mean time?", told.format("x-y")]


def test_a_layer_that_does_not_fit_what_lies_below_is_named_with_its_line(preset_file):
    below, above = preset_file(WHOLE, "a.toml"), preset_file("\n[things.moon]\nedge = 1.0\n", "b.toml")
    with pytest.raises(PresetError, match=r"b\.toml, line 3: things.moon.edge: a globe has no 'edge'"):
        presets.load([below, above])


@pytest.mark.parametrize(
    "overrides, key, value",
    [
        ({"things.moon.radius": "3", "things.moon.kind": "globe"}, "things.moon.radius", 3.0),
        ({**MOON, "things.moon.radii": "[1, 2.5]"}, "things.moon.radii", (1.0, 2.5)),
        ({**MOON, "things.moon.radii": [1, 2.5]}, "things.moon.radii", (1.0, 2.5)),
        ({**MOON, "things.moon.path": "[{time = 3}]"}, "things.moon.path", (FrozenMap({"time": 3.0, "ease": "smooth", "image": ""}),)),
        ({**MOON, "things.moon.caption": "two words"}, "things.moon.caption", "two words"),
        ({**MOON, "things.moon.glows": "on"}, "things.moon.glows", True),
        ({**MOON, "things.moon.image": ""}, "things.moon.image", ""),
    ],
)
def test_overrides_are_read_by_the_kind_of_their_field(overrides, key, value):
    found = presets.load([], overrides).get(key)
    assert found == value and type(found) is type(value)


@pytest.mark.parametrize(
    "overrides, says",
    [
        ({"things.moon.radius": "3"}, "things.moon.radius: there is no thing 'moon'"),
        ({**MOON, "things.moon.radii": "1, 2"}, "things.moon.radii: got '1, 2'; allowed is a list of 0 to 4 entries"),
        ({**MOON, "things.moon.radii": "[1]\nother = 3"}, "things.moon.radii: got .*; allowed is a list"),
        ({**MOON, "things.moon.radii": "[99]"}, "things.moon.radii: entry 1: got 99; allowed"),
        ({"things.moon.kind": "ball"}, "things.moon.kind: got 'ball'; allowed is one of cube, globe"),
        ({"thinks.moon.kind": "cube"}, "thinks.moon.kind: no such key"),
        ({"things": "3"}, r"things: it holds any number of named things; allowed is things.NAME.kind=KIND, which makes one \(kinds: cube, globe\)"),
        ({"hole": "3"}, "hole: it is a table and has no value of its own; allowed here are hole.spin, "),
    ],
)
def test_a_wrong_override_is_named(overrides, says):
    with pytest.raises(PresetError, match=f"^--set: {says}"):
        presets.load([], overrides)


# --- paths ---


def test_a_presets_paths_start_at_its_own_folder(preset_file, tmp_path):
    path = preset_file("[things.moon]\nkind = 'globe'\nimage = 'pictures/moon.png'\npath = [{image = 'later.png'}]\n", "deep/mine.toml")
    scene = presets.load([path])
    assert scene.get("things.moon.image") == str(tmp_path / "deep" / "pictures" / "moon.png")
    assert scene.get("things.moon.path")[0]["image"] == str(tmp_path / "deep" / "later.png")
    other = preset_file("[things.moon]\nimage = '../moon.jpg'\n", "other/b.toml")
    assert os.path.normpath(presets.load([path, other], any_file=True).get("things.moon.image")) == str(tmp_path / "moon.jpg")


@pytest.mark.parametrize("there", ["../moon.png", "/etc/moon.png", "~/moon.png", "pictures/../../moon.png", "//elsewhere/share/moon.png", "link.png"])
def test_a_preset_opens_no_file_outside_its_folder_unless_asked(preset_file, tmp_path, there):
    path = preset_file(f"[things.moon]\nkind = 'globe'\nradius = 2.0\nimage = '{there}'\npath = [{{image = '{there}'}}]\n", "deep/mine.toml")
    (tmp_path / "deep" / "link.png").symlink_to(tmp_path / "moon.png")
    scene = presets.load([path])
    assert (scene.get("things.moon.image"), scene.get("things.moon.path")[0]["image"], scene.get("things.moon.radius")) == ("", "", 2.0)
    told = presets.skipped([path])
    assert len(told) == 2 and told[0].startswith(f"{path}, line 4: things.moon.image: left out: the file ")
    assert told[0].endswith(f"; allowed without asking are files below {path.parent}")
    assert presets.load([path], any_file=True).get("things.moon.image") and not presets.skipped([path], any_file=True)


def test_a_picture_opens_no_file_outside_its_folder_unless_asked(tmp_path):
    text = presets.picture_text(moon(image="/etc/moon.png"), 0.0, tmp_path)
    png.write(tmp_path / "a.png", np.zeros((2, 2, 3), np.uint8), text)
    assert presets.load([tmp_path / "a.png"]).get("things.moon.image") == ""
    assert presets.load([tmp_path / "a.png"], any_file=True).get("things.moon.image") == "/etc/moon.png"


def test_text_of_no_place_names_no_file_but_the_programs():
    text = "[things.moon]\nkind = 'globe'\nimage = '{}'\n"
    assert presets.parse(text.format("moon.png")).over(Scene()).get("things.moon.image") == ""
    assert "allowed without asking are assets of the program" in presets.parse(text.format("moon.png")).refused(Scene())[0]
    assert presets.parse(text.format("asset:moon.png")).over(Scene()).get("things.moon.image") == "asset:moon.png"


def test_an_assets_name_is_written_as_it_is(preset_file, tmp_path):
    scene = moon(image="asset:moon.png")
    path = presets.save(scene, tmp_path / "mine.toml")
    assert "image = \"asset:moon.png\"" in path.read_text(encoding="utf-8") and presets.load([path]) == scene


def test_what_lies_below_a_presets_folder_is_written_relative_to_it(tmp_path):
    scene = moon(image=str(tmp_path / "pictures" / "moon.png"), path=[{"image": str(tmp_path.parent / "far.png")}])
    path = presets.save(scene, tmp_path / "mine.toml")
    text = path.read_text(encoding="utf-8")
    assert 'image = "pictures/moon.png"' in text and str(tmp_path.parent / "far.png") in text
    assert presets.load([path], any_file=True) == scene
    assert str(tmp_path / "pictures" / "moon.png") in presets.dumps(scene), "text of no place has whole paths"


def test_a_path_on_the_command_line_starts_at_the_working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert presets.load([], {**MOON, "things.moon.image": "moon.png"}).get("things.moon.image") == str(tmp_path / "moon.png")


# --- round trips ---

_texts = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=20)
_columns = st.fixed_dictionaries({}, optional={"time": st.floats(0.0, 1e6), "ease": st.sampled_from(["smooth", "linear"])})
_globes = st.fixed_dictionaries(
    {"kind": st.just("globe")},
    optional={
        "radius": st.floats(0.1, 50.0),
        "number": st.integers(1, 9),
        "glows": st.booleans(),
        "pattern": st.sampled_from(["plain", "chequered"]),
        "caption": _texts,
        "image": st.sampled_from(["", "/a/b.png", "/ä ö/c.JPG"]),
        "radii": st.lists(st.floats(0.0, 9.0), max_size=4),
        "path": st.lists(_columns, max_size=10),
    },
)
_cubes = st.fixed_dictionaries({"kind": st.just("cube")}, optional={"edge": st.floats(0.5, 50.0)})  # no smaller than the radius of its corners
_names = st.from_regex(r"\A[A-Za-z][A-Za-z0-9_]{0,31}\Z")
_scenes = st.dictionaries(_names, _globes | _cubes, max_size=3).map(
    lambda things: Scene().with_values({f"things.{name}.{entry}": value for name, values in things.items() for entry, value in values.items()})
)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(_scenes, st.booleans())
def test_what_is_written_is_read_back_exactly(scene, full):
    preset = replace(presets.parse(presets.dumps(scene, full)), any_file=True)
    assert preset.over(Scene()) == scene
    assert set(preset.values) == set(scene.keys()) or not full


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(_scenes)
def test_a_picture_carries_the_instances(tmp_path_factory, scene):
    path = tmp_path_factory.getbasetemp() / "instances.png"
    png.write(path, np.zeros((2, 3, 3), np.uint8), presets.picture_text(scene, 1.0, path.parent))
    assert presets.load([path], any_file=True) == scene


_words = st.sampled_from(["kind", "radius", "radii", "path", "time", "globe", "moon", "caption", "image", "enabled"]) | st.text(max_size=4)
_scalars = st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.sampled_from(["globe", "cube"]) | st.datetimes()
_trees = st.recursive(_scalars, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(_words, inner, max_size=4), max_leaves=12)
_made = st.dictionaries(_words, _trees, max_size=4).map(lambda tree: {"kind": "globe"} | tree)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(["things", "media"]), st.dictionaries(_words, _trees | _made, max_size=3) | _trees)
def test_any_tree_is_a_scene_or_a_clear_error(section, tree):
    try:
        text = tomlkit.dumps({section: tree})
    except Exception:
        assume(False)  # not every tree can be said in TOML
    try:
        presets.parse(text).over(Scene())
    except SceneError as error:
        assert str(error)
        if "not TOML" not in str(error):
            assert error.key and error.key in str(error) and "llowed" in str(error)


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.sampled_from(["radius", "number", "glows", "pattern", "caption", "image", "radii", "path"]),
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8), _trees),
)
def test_whatever_is_given_is_taken_whole_or_refused_with_a_sentence(name, value):
    key = f"things.moon.{name}"
    try:
        scene = moon().with_values({key: value})
    except SceneError as error:
        assert key in str(error)
    else:
        assert scene.field(key).check(scene.get(key)) == scene.get(key) and not (isinstance(value, float) and math.isnan(value))


def test_defaults_are_not_written_but_the_kind_is():
    assert presets.dumps(moon()) == '[things.moon]\nkind = "globe"\n'
    assert presets.dumps(moon(radius=2.0, path=[{"time": 1.0}])) == (
        '[things.moon]\nkind = "globe"\nradius = 2.0\n\n[[things.moon.path]]\ntime = 1.0\nease = "smooth"\nimage = ""\n'
    )


def _work_of_loading(count: int, folder: Path, monkeypatch: pytest.MonkeyPatch) -> int:
    """How many items go into frozen maps while a file of `count` things is read and put over a scene: what it takes, whatever else the machine does."""
    path = folder / f"{count}.toml"
    path.write_text("".join(f'[things.s{number}]\nkind = "globe"\nradius = {1 + number % 40}.0\n' for number in range(count)))
    work = 0
    plain = FrozenMap.__init__

    def counting(self: FrozenMap, items: Any = ()) -> None:
        nonlocal work
        plain(self, items)
        work += len(self)

    with monkeypatch.context() as patched:
        patched.setattr(FrozenMap, "__init__", counting)
        made = presets.load([path])
    assert len(made.things) == count
    return work


def test_a_scene_of_many_things_is_read_in_a_time_that_grows_as_their_number(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """1,500 spheres took a minute of processor time, as each of them made the mapping of all anew."""
    few, many = (_work_of_loading(count, tmp_path, monkeypatch) for count in (50, 400))
    assert many < 1.2 * 8 * few


def test_the_fields_of_a_thousand_things_are_made_once():
    places = [Place("things", f"s{number}") for number in range(1000)]
    made = [instances.fields_of(place, "globe") for place in places]
    assert all(instances.fields_of(place, "globe") is fields for place, fields in zip(places, made))
