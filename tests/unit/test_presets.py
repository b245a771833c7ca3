"""Presets: layering, overrides, round trips, and errors that say what to do."""

import math

import numpy as np
import pytest
import tomlkit
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from blackhole_gl.output import png
from blackhole_gl.scene import Scene, SceneError, fields, presets
from blackhole_gl.scene.presets import PresetError


@pytest.fixture(autouse=True)
def user_folder(tmp_path, monkeypatch):
    """Keeps the presets of whoever runs the tests out of them."""
    monkeypatch.setenv("BLACKHOLE_GL_CONFIG_DIR", str(tmp_path / "config"))
    return tmp_path / "config" / "presets"


@pytest.fixture
def preset_file(tmp_path):
    def write(text, name="mine.toml"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


def _values(item):
    if item.kind == "switch":
        return st.booleans()
    if item.kind == "choice":
        return st.sampled_from(item.options)
    if item.kind == "file":
        return st.sampled_from(["", "asset:a" + item.suffixes[0]])
    if item.kind == "int":
        return st.integers(int(item.low), int(item.high))
    numbers = st.floats(item.low, item.high)
    return numbers | st.just(math.inf) if item.allow_infinity else numbers


@st.composite
def scenes(draw):
    chosen = draw(st.lists(st.sampled_from(sorted(fields())), unique=True, max_size=12))
    values = {key: draw(_values(fields()[key])) for key in chosen}
    if "disk.inner_radius" in values:
        values["disk.outer_radius"] = max(values["disk.inner_radius"], values.get("disk.outer_radius", Scene().disk.outer_radius))
    return Scene().with_values(values)


# --- layers and overrides ---


def test_nothing_named_is_the_default_preset():
    assert presets.load().values() == presets.load(["kerr"]).values() == presets.load("kerr").values()


def test_the_later_layer_wins(preset_file):
    first, second = preset_file("[hole]\nspin = 0.1\n[post]\ngamma = 2\n", "a.toml"), preset_file("[hole]\nspin = 0.2\n", "b.toml")
    assert presets.load([first, second]).hole.spin == 0.2
    assert presets.load([second, first]).hole.spin == 0.1
    assert presets.load([first, second], {"hole.spin": "0.3"}).hole.spin == 0.3
    assert presets.load([first, second]).post.gamma == 2.0


def test_look_and_quality_alone_lie_over_the_default_preset():
    scene = presets.load(["fine", "minimal_bloom"])
    assert scene.hole == presets.load(["kerr"]).hole
    assert (scene.rays.tolerance, scene.post.bloom_intensity) == (0.1, 0.30)


def test_a_file_says_all_there_is_to_say(preset_file):
    assert presets.load([preset_file("")]).values() == Scene().values()


def test_a_look_of_the_users_own_lies_over_the_default_preset(preset_file):
    scene = presets.load([preset_file('group = "look"\n[post]\ngamma = 2.0\n')])
    assert scene.hole == presets.load(["kerr"]).hole and scene.post.gamma == 2.0


@pytest.mark.parametrize(
    "key, given, value",
    [
        ("disk.outer_radius", "12", 12.0),
        ("camera.distance", "inf", math.inf),
        ("camera.distance", math.inf, math.inf),
        ("rays.max_steps", "300", 300),
        ("disk.enabled", "off", False),
        ("disk.enabled", False, False),
        ("rays.model", "flat", "flat"),
        ("hole.spin", " -0.5 ", -0.5),
    ],
)
def test_overrides_are_read_by_the_kind_of_their_field(key, given, value):
    found = presets.load([], {key: given}).get(key)
    assert found == value and type(found) is type(value)


@pytest.mark.parametrize("given", ["twelve", "", "nan", "-1", "1e999", True, None, [1], 10**400, math.nan])
def test_a_wrong_override_names_key_and_range(given):
    with pytest.raises(PresetError, match=r"^--set: disk\.outer_radius: .*allowed is a number from 1 to 100 r_s"):
        presets.load([], {"disk.outer_radius": given})


def test_an_unknown_override_names_the_nearest_key():
    with pytest.raises(PresetError, match=r"--set: disk.outer_radus: no such key; did you mean disk.outer_radius\?"):
        presets.load([], {"disk.outer_radus": "3"})


def test_assignments_are_taken_apart():
    assert presets.parse_assignments(["a.b=1", "c.d = x=y", "a.b=2"]) == {"a.b": "2", "c.d": "x=y"}
    for wrong in ("a.b", "=3", ""):
        with pytest.raises(PresetError, match="key=value"):
            presets.parse_assignments([wrong])


# --- names ---


def test_an_unknown_name_lists_the_nearest_and_all():
    with pytest.raises(PresetError, match=r"'shwarzschild'; did you mean schwarzschild\?.*kerr_06.*thin_disk"):
        presets.load(["shwarzschild"])


@pytest.mark.parametrize("name", ["", "\0", "../kerr", "no such", "x" * 5000, "missing.toml", "missing.png", "\0.toml", "x" * 5000 + ".toml"])
def test_names_of_nothing_are_preset_errors(name):
    with pytest.raises(PresetError):
        presets.load([name])


def test_a_users_preset_has_a_name_but_cannot_take_a_shipped_one(user_folder):
    user_folder.mkdir(parents=True)
    (user_folder / "mine.toml").write_text('title = "Mine"\n[hole]\nspin = 0.25\n')
    (user_folder / "kerr.toml").write_text("[hole]\nspin = 0.25\n")
    (user_folder / "broken.toml").write_text("[hole\n")
    own = {info.path.stem: info for info in presets.available() if info.path.parent == user_folder}
    assert (own["mine"].group, own["mine"].title) == ("user", "Mine")
    assert "not TOML" in own["broken"].description
    assert presets.load(["mine"]).hole.spin == 0.25
    assert presets.load(["kerr"]).hole.spin != 0.25
    assert presets.load([own["kerr"].path]).hole.spin == 0.25


# --- errors of files ---


@pytest.mark.parametrize(
    "text, line, says",
    [
        ("[hole]\n\nspin = 3\n", 3, r"hole.spin: got 3; allowed is a number from -0.9999 to 0.9999"),
        ("[hole]\nspin = nan\n", 2, "hole.spin: got nan; allowed is a number"),
        ("[hole]\nspin = '0.5'\n", 2, "hole.spin: got '0.5'; allowed is a number"),
        ("[hole]\nspin = true\n", 2, "hole.spin: got True; allowed is a number"),
        ("[hole]\nspin = [0.5]\n", 2, "hole.spin: got a list; allowed is a number"),
        ("[hole]\nspin = 2001-01-01\n", 2, "hole.spin: got 2001-01-01; allowed is a number"),
        ("[hole]\nspin = {x = 1}\n", 2, "hole.spin: got a table; allowed is a number"),
        ("[hole.spin]\nx = 1\n", 1, "hole.spin: got a table; allowed is a number"),
        ("[[hole]]\nspin = 0.5\n", 1, r"hole: got a list; allowed is a table, \[hole\]"),
        ("hole = 3\n", 1, r"hole: got 3; allowed is a table, \[hole\]"),
        ("[disk]\nenabled = 1\n", 2, "disk.enabled: got 1; allowed is true or false"),
        ("[rays]\nmax_steps = 100.5\n", 2, "rays.max_steps: got 100.5; allowed is a whole number"),
        ("[rays]\nmax_steps = 0x" + "f" * 9000, 2, "rays.max_steps: got a whole number of more than 64 bits; allowed"),
        ("[rays]\nmodel = 'ker'\n", 2, "rays.model: got 'ker'; allowed is one of .*did you mean kerr"),
        ("title = 3\n", 1, "title: got 3; allowed is text"),
        ("group = 'looks'\n", 1, "group: got 'looks'; allowed is one of physics, look"),
        ("time = inf\n", 1, "time: got inf; allowed is a finite number"),
        ("[disk]\nouter_radius = 5.0\ninner_radius = 6.0\n", 2, "disk.outer_radius: got 5; allowed is at least 6, which is disk.inner_radius"),
        ("[disk]\ninner_radius = 16.0\n", 2, "disk.inner_radius: got 16; allowed is at most 10, which is disk.outer_radius"),
        ("[hole]\nspin = '0,5'\n", 2, "hole.spin: got '0,5'; allowed is a number .*; write 0.5, not 0,5"),
    ],
)
def test_a_wrong_entry_names_file_line_key_and_what_is_allowed(preset_file, text, line, says):
    with pytest.raises(PresetError, match=rf"mine\.toml, line {line}: {says}") as caught:
        presets.load([preset_file(text)])
    assert caught.value.line == line and caught.value.key


@pytest.mark.parametrize(
    "text, line, key, hint",
    [
        ("[disk]\nouter_radus = 3\n", 2, "disk.outer_radus", "; did you mean disk.outer_radius?"),
        ("[hoel]\nspin = 0.1\nmass = 3\n", 1, "hoel", "; did you mean hole?"),
        ("spin = 0.1\n", 1, "spin", "; did you mean hole.spin?"),
        ('"hole.spin" = 0.2\n', 1, '"hole.spin"', "; did you mean hole.spin?"),
        ('"" = 0.2\n', 1, '""', ""),
        ("[disk.turbulence]\nxyzzy = 1\n", 2, "disk.turbulence.xyzzy", None),
    ],
)
def test_what_this_version_does_not_know_is_told_and_the_rest_counts(preset_file, text, line, key, hint):
    path = preset_file(f"{text}[post]\ngamma = 2.0\n")
    assert presets.load([path]).values() == Scene().with_values({"post.gamma": 2.0}).values()
    (said,) = presets.skipped(["kerr", path])
    assert said.startswith(f"{path}, line {line}: {key}: skipped, for this version has no such key")
    assert hint is None or said.endswith(f"no such key{hint}")


def test_a_picture_of_a_newer_version_opens(tmp_path):
    text = presets.picture_text(presets.load(["kerr"]), 3.0) + "[wormhole]\nmouths = 2\n"
    png.write(tmp_path / "new.png", np.zeros((2, 3, 3), np.uint8), text.replace("[hole]", "[hole]\ncharge = 0.1"))
    assert presets.from_png(tmp_path / "new.png") == presets.load(["kerr"])
    said = presets.skipped([tmp_path / "new.png"])
    assert len(said) == 2 and "hole.charge: skipped" in said[0] and "wormhole: skipped" in said[1]


@pytest.mark.parametrize(
    "data, says",
    [
        (b"[hole\n", r"not TOML: .*line 1"),
        (b"[hole]\nspin = 0.1\nspin = 0.2\n", r"not TOML: .*line 3"),
        (b"[hole]\n[hole]\n", "not TOML: .*line 2"),
        (b"[hole]\nspin = \xff", "not UTF-8"),
        (b"\xff\xfe[\0h", "not UTF-8"),
        (b"title = " + b"[" * 5000, "not TOML"),
        (b"[rays]\nmax_steps = " + b"9" * 6000, "not TOML"),
        (b"disk" + b".enabled" * 5000 + b" = 1", "got a table|nested too deeply"),
        (b"[hole]\n\nspin = 0,5 # half\n", "not TOML: .*line 3.*; write 0.5, not 0,5"),
    ],
    ids=range(9),
)
def test_a_file_that_is_no_preset_gives_a_sentence(tmp_path, data, says):
    path = tmp_path / "mine.toml"
    path.write_bytes(data)
    with pytest.raises(PresetError, match=rf"mine\.toml.*: .*({says})"):
        presets.load([path])


def test_a_byte_order_mark_and_windows_line_ends_are_no_mistake(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xef\xbb\xbf[hole]\r\nspin = 0.5\r\n")
    assert presets.load([path]).hole.spin == 0.5


def test_a_folder_is_not_a_preset(tmp_path):
    (tmp_path / "x.toml").mkdir()
    with pytest.raises(PresetError, match="x.toml: cannot be read"):
        presets.load([tmp_path / "x.toml"])


# --- any text at all ---

_words = st.sampled_from(sorted({part for key in fields() for part in key.split(".")} | {"title", "group", "time", "enabled"})) | st.text(max_size=4)
_scalars = st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.sampled_from(["kerr", "look", "flat"]) | st.datetimes()
_trees = st.recursive(_scalars, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(_words, inner, max_size=4), max_leaves=12)


def _load_or_explain(text):
    try:
        preset = presets.parse(text)
    except SceneError as error:
        assert str(error)
        if "not TOML" not in str(error):
            assert error.key and error.key in str(error) and "llowed" in str(error)
    else:
        assert isinstance(Scene().with_values(preset.values), Scene)


@settings(max_examples=300, deadline=None)
@given(st.dictionaries(_words, _trees, max_size=5))
def test_any_tree_is_a_scene_or_a_clear_error(tree):
    try:
        text = tomlkit.dumps(tree)
    except Exception:
        assume(False)  # not every tree can be said in TOML
    _load_or_explain(text)


@settings(max_examples=300, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(sorted(fields())), _scalars | st.none()), max_size=6))
def test_any_values_for_known_keys_are_a_scene_or_a_clear_error(entries):
    lines = [f"{key} = {_toml(value)}" for key, value in entries]
    _load_or_explain("\n".join(lines))


@settings(max_examples=300, deadline=None)
@given(st.text() | st.text(alphabet='[]{}"\'=.,#\n abchole123-+:TZ_\\'))
def test_any_text_is_a_scene_or_a_clear_error(text):
    _load_or_explain(text)


@settings(max_examples=100, deadline=None)
@given(st.dictionaries(st.sampled_from(sorted(fields())) | st.text(), _trees | st.none() | st.complex_numbers(), max_size=4))
def test_any_overrides_are_a_scene_or_a_clear_error(overrides):
    try:
        presets.load([], overrides)
    except SceneError as error:
        assert error.key in overrides and "llowed" in str(error)


def _toml(value):
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value) if isinstance(value, (int, float, str)) else str(value)


# --- round trips ---


@settings(max_examples=200, deadline=None)
@given(scenes(), st.booleans(), st.text(st.characters(codec="utf-8")), st.text(st.characters(codec="utf-8")))
def test_what_is_written_is_read_back_exactly(scene, full, title, description):
    preset = presets.parse(presets.dumps(scene, full, title=title, description=description, group="look"))
    assert Scene().with_values(preset.values).values() == scene.values()
    assert (preset.title, preset.description, preset.group) == (title, description, "look")
    assert set(preset.values) == set(fields()) or not full


def test_defaults_are_not_written():
    assert presets.dumps(Scene()) == ""
    assert presets.dumps(Scene().with_values({"hole.spin": 0.5})) == "[hole]\nspin = 0.5\n"


def test_a_full_preset_says_its_units():
    assert "outer_radius = 10.0 # r_s" in presets.dumps(Scene(), full=True)


def test_a_switch_with_parameters_below_it_is_their_tables_entry():
    key = next(key for key, item in fields().items() if key.rsplit(".", 1)[0] in fields() and -math.inf < item.low != item.default)
    section, layer, name = key.split(".")
    scene = Scene().with_values({f"{section}.{layer}": True, key: fields()[key].low})
    assert presets.parse(f"[{section}.{layer}]\nenabled = true\n{name} = {fields()[key].low}").values == {f"{section}.{layer}": True, key: fields()[key].low}
    assert Scene().with_values(presets.parse(presets.dumps(scene, full=True)).values).values() == scene.values()
    assert presets.parse(f"{section}.{layer} = true").values == {f"{section}.{layer}": True}


def test_no_plug_in_calls_a_parameter_what_stands_for_its_switch():
    assert not [key for key in fields() if key.count(".") == 2 and key.endswith(".enabled")]


def test_save_and_load(tmp_path):
    scene = presets.load(["m87_like", "particle_storm"], {"camera.distance": "inf"})
    path = presets.save(scene, tmp_path / "deep" / "mine.toml", title="Mine", group="scene")
    assert presets.load([str(path)]).values() == scene.values()
    assert presets.read(path).title == "Mine"
    assert [item.name for item in path.parent.iterdir()] == ["mine.toml"]


def test_a_save_that_fails_keeps_the_old_file(tmp_path):
    path = presets.save(Scene(), tmp_path / "mine.toml", title="old")
    for wrong in (dict(title="\ud800"), dict(group="nonsense")):
        with pytest.raises(PresetError):
            presets.save(Scene(), path, **wrong)
    assert presets.read(path).title == "old" and len(list(tmp_path.glob("*.toml*"))) == 1
    with pytest.raises(PresetError, match="ends in .toml"):
        presets.save(Scene(), tmp_path / "mine.txt")
    with pytest.raises(PresetError, match="cannot be written"):
        presets.save(Scene(), path / "inside.toml")


@settings(max_examples=25, deadline=None)
@given(scenes(), st.floats(0, 1e9))
def test_a_picture_is_a_preset(tmp_path_factory, scene, time):
    path = tmp_path_factory.getbasetemp() / "picture.png"
    png.write(path, np.zeros((2, 3, 3), np.uint8), presets.picture_text(scene, time))
    assert presets.from_png(path).values() == presets.load([str(path)]).values() == scene.values()
    assert presets.read(path).time == time and presets.read(path).version


def test_a_strange_picture_is_a_preset_error(tmp_path):
    (tmp_path / "a.png").write_bytes(b"GIF89a")
    with pytest.raises(PresetError, match="a.png: not a PNG"):
        presets.load([tmp_path / "a.png"])


def test_preset_errors_are_scene_errors():
    with pytest.raises(SceneError):
        presets.parse("hole = 1")
