"""Plug-ins are what their headers say; what a header says wrongly is named with file and entry."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from blackhole_gl.resources import shaders_dir
from blackhole_gl.scene import catalogue, fields, sections
from blackhole_gl.scene.catalogue import SLOTS, CatalogueError
from blackhole_gl.scene.traits import DiskLayerTraits, IntegratorTraits, ThingTraits

HEADER = '''/*---
label = "Ripple"
summary = "Rings."
source = "none"
slot = "{slot}"
{more}
---*/
'''

MODEL = """kind = "differential"
space_time = "kerr"
spins = true
exact = true
marches_in = "mino"
step_control = "even"
"""


SIZE = """[parameters.size]
default = 2.0
range = [1, 9]
help = 'H.'
"""


WITH_SIZE = f"""reach = ['size']
{SIZE}[parameters.soft]
default = true
help = 'H.'
"""


SIZES = """reach = ['large']
increasing = ['small', 'large']
[parameters.small]
default = 2.0
range = [1, 9]
help = 'H.'
[parameters.large]
default = 3.0
range = [1, 9]
help = 'H.'
"""


@pytest.fixture
def folders(tmp_path):
    """An empty shader folder of ours, but for one step control, and one of the user's."""
    put(tmp_path / "shipped", "step_control", "even", "")
    (tmp_path / "own").mkdir()
    return tmp_path / "shipped", tmp_path / "own"


def put(root: Path, slot: str, key: str, more: str, text: str = "") -> Path:
    path = root / SLOTS[slot].folder / f"{key}.glsl"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text or HEADER.format(slot=slot, more=more), encoding="utf-8")
    return path


def made(folders, more: str, slot: str = "disk_layer", text: str = ""):
    """The plug-in ``ripple`` of ours."""
    put(folders[0], slot, "ripple", more, text)
    return catalogue.read(*folders).plug_ins[slot]["ripple"]


# --- what is shipped ---


@pytest.mark.parametrize("slot", [key for key, slot in SLOTS.items() if not slot.of_kinds])
def test_every_shipped_plug_in_is_whole(slot):
    found = catalogue.plug_ins(slot)
    assert found
    for key, plug_in in found.items():
        assert plug_in.key == key and plug_in.slot == slot
        assert plug_in.label and plug_in.source and plug_in.summary.endswith(".")
        assert (shaders_dir() / plug_in.path).is_file() and "\\" not in plug_in.path
        for name, item in plug_in.parameters.items():
            assert name.startswith(f"{SLOTS[slot].section}.{key}.")
            assert item.help.endswith(".")


def test_a_marched_models_own_step_control_fits_it():
    marched = [plug_in for plug_in in catalogue.plug_ins("ray_model").values() if plug_in.traits.kind == "differential"]
    assert marched
    for plug_in in marched:
        assert catalogue.reasons_against(plug_in.key, "rk4", plug_in.traits.step_control) == []


def test_traits_are_what_the_shipped_headers_say():
    drag, flat = (catalogue.plug_ins("ray_model")[key].traits for key in ("post_newtonian_drag", "flat"))
    curvature = catalogue.plug_ins("step_control")["curvature"].traits
    assert (drag.march_bound, drag.spins, drag.exact, drag.second_order, drag.field) == (120.0, True, False, False, False)
    assert (curvature.shortest, curvature.adapts, curvature.fits) == (0.4, False, ("cartesian", "mino"))
    assert (flat.marches_in, flat.step_control, flat.march_bound) == (None, None, None)
    assert catalogue.plug_ins("integrator")["dopri5"].traits == IntegratorTraits(order=5, evaluations=6, pair_evaluations=7)


def test_plug_ins_come_in_the_order_of_their_rank():
    for slot in SLOTS:
        ranks = [plug_in.rank for plug_in in catalogue.plug_ins(slot).values()]
        assert ranks == sorted(ranks)


def test_what_does_not_fit_is_said_in_a_sentence():
    (reason,) = catalogue.reasons_against("kerr", "rk4", "radius")
    assert "radius" in reason and "kerr" in reason and "mino" in reason
    assert catalogue.reasons_against("flat", "rk4", "mino") == []


def test_a_layers_switch_stands_among_the_disks_values_and_is_what_its_header_says():
    keys = list(fields())
    layers = [f"disk.{key}" for key in catalogue.keys("disk_layer")]
    first = keys.index(layers[0])
    assert keys[first : first + len(layers)] == layers
    assert keys[first - 1].startswith("disk.") and not keys[first + len(layers)].startswith("disk.")
    assert {key for key in layers if fields()[key].default} == {"disk.turbulence"}
    assert {key for key in layers if fields()[key].physical is False} == {"disk.relativistic_lanes", "disk.lensing_flare", "disk.beaming_boost"}


# --- what headers may say ---


def test_a_parameter_becomes_a_field(folders):
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
    parameters = made(folders, more).parameters
    assert {key: item.kind for key, item in parameters.items()} == {"disk.ripple.depth": "float", "disk.ripple.count": "int", "disk.ripple.soft": "switch"}
    assert parameters["disk.ripple.depth"].allowed() == "a number from 0 to 1 r_s"
    assert parameters["disk.ripple.depth"].glsl_name == "disk_ripple_depth"


def test_the_type_of_the_default_is_the_parameters(folders):
    more = """
reach = ["size"]
[parameters.size]
default = 2
range = [1, 9]
help = "H."
[parameters.pattern]
default = "plain"
options = ["plain", "chequered"]
help = "H."
[parameters.caption]
default = ""
length = 80
help = "H."
[parameters.image]
default = ""
suffixes = [".png", ".jpg"]
help = "H."
[parameters.radii]
default = [1.0]
length = [0, 4]
element = { default = 1.0, range = [0.0, 9.0], unit = "r_s" }
help = "H."
[parameters.path]
default = []
length = [0, 100]
help = "H."
columns.time = { default = 0.0, range = [0.0, 1e6], help = "When." }
columns.ease = { default = "smooth", options = ["smooth", "linear"], help = "How." }
"""
    parameters = made(folders, more, "thing").parameters
    assert {name: item.kind for name, item in parameters.items()} == dict(size="int", pattern="choice", caption="text", image="file", radii="list", path="list")
    allowed = {name: item.allowed() for name, item in parameters.items()}
    assert allowed["pattern"] == "one of plain, chequered"
    assert allowed["caption"] == "text of at most 80 characters"
    assert allowed["image"] == "the path of a file that ends in .png or .jpg"
    assert allowed["radii"] == "a list of 0 to 4 entries, each a number from 0 to 9 r_s"
    assert allowed["path"] == "a list of 0 to 100 entries, each a table with time, ease"
    assert parameters["radii"].default == (1.0,)


@pytest.mark.parametrize(
    "text, words",
    [
        ("void f() {}", "ripple.glsl: no header"),
        ("/*---\nlabel = \n---*/", "ripple.glsl: the header is not TOML"),
        ('/*---\nlabel = "*/"\n---*/', "ripple.glsl: the header holds .*, which ends the GLSL comment"),
        ('/*---\nlabel = "Ripple"\nslot = "disk_layer"\n---*/', "ripple.glsl: the header lacks 'summary'; allowed is text in quotes"),
        (HEADER.format(slot="sky", more=""), "ripple.glsl: slot is 'sky', but its folder holds 'disk_layer'"),
    ],
)
def test_a_file_without_a_whole_header_is_named(folders, text, words):
    with pytest.raises(CatalogueError, match=words):
        made(folders, "", text=text)


@pytest.mark.parametrize(
    "entry, words",
    [
        ("default = 0.5", "the header lacks 'range'"),
        ("default = 0.5\nrange = [0, 1]", "the header lacks 'help'"),
        ('help = "H."', "the header lacks 'default'"),
        ('default = 2.0\nrange = [0, 1]\nhelp = "H."', "default or physical: got 2.0; allowed is a number from 0 to 1"),
        ('default = 0.5\nphysical = 3.0\nrange = [0, 1]\nhelp = "H."', "default or physical: got 3.0"),
        ('default = 0.5\nrange = [1, 0]\nhelp = "H."', r"range: got \[1, 0\]; allowed is range = \[least, most\]"),
        ('default = 0.5\nrnage = [0, 1]\nhelp = "H."', "got the entry 'rnage'; allowed are .*; did you mean range"),
        ('default = "a"\nhelp = "H."', "a default in quotes needs one of options, suffixes, length"),
        ('default = "a"\noptions = ["a b"]\nhelp = "H."', "options: got 'a b'; allowed are names of letters"),
        ('default = ""\nsuffixes = ["png"]\nhelp = "H."', r"suffixes: got \['png'\]; allowed is a list like"),
        ('default = []\nlength = [0, 3]\nhelp = "H."', "a list needs either an element"),
        ('default = []\nlength = [0, 3]\nhelp = "H."\nelement = { default = 1.0 }', "element: the header lacks 'range'"),
        ('default = []\nlength = [0, 3]\nhelp = "H."\ncolumns.at = { default = 1.0, range = [0, 1] }', "at: the header lacks 'help'"),
        ('default = [2.0]\nlength = [0, 3]\nhelp = "H."\nelement = { default = 1.0, range = [0, 1] }', "entry 1: got 2.0; allowed is a number from 0 to 1"),
        ('default = []\nlength = [0, 3]\nhelp = "H."\nelement = { default = [], length = [0, 1], element = { default = true } }', "got a list in a list"),
        ("default = 1979-05-27\nhelp = 'H.'\nrange = [0, 1]", "default: got .*; allowed is a whole number or a number"),
    ],
)
def test_a_wrong_parameter_names_file_entry_and_what_is_allowed(folders, entry, words):
    with pytest.raises(CatalogueError, match=f"ripple.glsl: parameters.depth.*{words}"):
        made(folders, f"[parameters.depth]\n{entry}")


@pytest.mark.parametrize(
    "slot, more, words",
    [
        ("disk_layer", "[parameters]\ndepth = 3", "parameters.depth: got 3; allowed is a table"),
        ("disk_layer", '[parameters."a b"]', "parameters: got 'a b'; allowed are names of letters"),
        ("disk_layer", "[parameters.enabled]\ndefault = true\nhelp = 'H.'", "parameters.enabled: 'enabled' has another meaning here"),
        ("thing", "opaque = true", r"the header lacks 'reach'; allowed is a list"),
        ("medium", "reach = ['size']", "reach: got 'size'; allowed are its parameters that are numbers: "),
        ("thing", WITH_SIZE.replace("'size'", "'sise'"), r"reach: got 'sise'; allowed are its parameters that are numbers: size; did you mean size\?"),
        ("thing", WITH_SIZE.replace("'size'", "'soft'"), "reach: got 'soft'; allowed are its parameters that are numbers: size"),
        ("thing", "increasing = ['size', 'sise']\n" + WITH_SIZE, r"increasing: got 'sise'; .*did you mean size\?"),
        ("medium", "parts = ['sise']\n" + WITH_SIZE, r"parts: got 'sise'; .*did you mean size\?"),
        ("medium", SIZES.replace("default = 2.0", "default = 3.5"), "increasing: the default of 'small' is larger than that of 'large'"),
        ("thing", "reach = []\n[parameters.light]\ndefault = true\nhelp = 'H.'", "parameters.light: 'light' has another meaning here"),
        ("thing", "centre = ['size', 'sise', 'size']\n" + WITH_SIZE, r"centre: got 'sise'; .*did you mean size\?"),
        ("thing", "centre = ['size']\n" + WITH_SIZE, "centre: got 1 names; allowed are three, or none for the hole"),
        ("thing", "moves = true\ncentre = ['size', 'size', 'size']\n" + WITH_SIZE, "centre: a kind that moves has a centre already; allowed is one"),
        ("thing", "moves = true\n" + WITH_SIZE.replace("size", "orbit_radius"), "parameters.orbit_radius: a kind with moves = true has"),
        ("thing", "reach = []\n[parameters.kind]\ndefault = true\nhelp = 'H.'", "parameters.kind: 'kind' has another meaning here"),
        ("disk_layer", "enabled = 1", "enabled: got 1; allowed is true or false"),
        ("disk_layer", "opaque = true", "got the entry 'opaque'; allowed are label"),
        ("disk_layer", "[tables]\nhue = 3", "tables.hue: got 3; allowed is a table"),
        ("disk_layer", "[tables.hue]", "hue: the header lacks 'make'; allowed is text in quotes"),
        ("disk_layer", '[tables.hue]\nmake = "a:b"\nfilter = "liner"', "hue: filter: got 'liner'; allowed is one of .*, mipmap; did you mean linear"),
        ("disk_layer", '[tables.hue]\nmake = "a:b"\nname = "tint"', "hue: got the entry 'name'; allowed are make, of, filter, repeat_x, constants"),
        ("disk_layer", '[numbers.hue]\nmake = "a:b"\ntype = "vec3"', "hue: type: got 'vec3'; allowed is one of float, int, vec2, vec4, mat4"),
        ("integrator", "order = 2\nevaluations = 2\nfits = ['polar']", "fits: got .*; allowed is a list, each of it one of cartesian, mino"),
        ("integrator", "order = 2\nevaluations = 2\nfits = 'mino'", "fits: got 'mino'; allowed is a list"),
        ("integrator", "order = 0\nevaluations = 2", "order: got 0; allowed is a whole number from 1 to 20"),
        ("ray_model", MODEL + "harder_with = ['sise']\n" + SIZE, r"harder_with: got 'sise'; .*did you mean size\?"),
        ("ray_model", MODEL + "harder_with = ['size']\nmilder_with = ['size']\n" + SIZE, "milder_with: got 'size', which is in harder_with too"),
        ("ray_model", MODEL.replace("exact", "exakt"), r"got the entry 'exakt'; allowed are label, .*; did you mean exact\?"),
        ("ray_model", MODEL.replace("exact = true\n", ""), "the header lacks 'exact'; allowed is true or false"),
        ("ray_model", MODEL.replace("exact = true", "exact = 1"), "exact: got 1; allowed is true or false"),
        ("ray_model", MODEL.replace('"kerr"', '"ker"'), r"space_time: got 'ker'; allowed is one of flat, schwarzschild, kerr; did you mean kerr\?"),
        ("ray_model", MODEL.replace('"differential"', "true"), "kind: got True; allowed is one of closed, differential"),
        ("ray_model", MODEL.replace('marches_in = "mino"\n', ""), "the header lacks 'marches_in', which a model of kind differential"),
        ("ray_model", MODEL.replace('"differential"', '"closed"'), "marches_in: a model of kind closed takes no steps"),
        ("ray_model", MODEL.replace('"even"', '"evan"'), r"step_control: got 'evan'; allowed is one of even; did you mean even\?"),
        ("ray_model", MODEL + "march_bound = 0.5", "march_bound: got 0.5; allowed is a number from 1 to 10000"),
        ("ray_model", MODEL + "rank = '1'", "rank: got '1'; allowed is a number"),
        ("ray_model", MODEL + "parameters = 3", "parameters: got 3; allowed is a table"),
    ],
)
def test_a_wrong_entry_names_file_entry_what_was_given_and_what_is_allowed(folders, slot, more, words):
    with pytest.raises(CatalogueError, match=f"ripple.glsl: {words}"):
        made(folders, more, slot)


def test_traits_have_defaults_where_a_header_need_not_say(folders):
    assert made(folders, "").traits == DiskLayerTraits(enabled=False)
    assert made(folders, WITH_SIZE, "thing").traits == ThingTraits(reach=("size",), opaque=True)
    integrator = made(folders, 'order = 2\nevaluations = 2\nfits = ["cartesian"]', "integrator").traits
    assert integrator == IntegratorTraits(order=2, evaluations=2, fits=("cartesian",))


def test_an_integrator_for_one_way_to_march_keeps_to_it(monkeypatch):
    shipped = catalogue._catalogue()
    rk4 = shipped.plug_ins["integrator"]["rk4"]
    narrow = {**shipped.plug_ins, "integrator": {"rk4": replace(rk4, traits=replace(rk4.traits, fits=("cartesian",)))}}
    monkeypatch.setattr(catalogue, "_catalogue", lambda: catalogue.Catalogue(narrow, ()))
    assert catalogue.reasons_against("schwarzschild", "rk4", "radius") == []
    assert catalogue.reasons_against("kerr", "rk4", "mino") == ["rk4 fits models that march in cartesian; kerr marches in mino"]


# --- the user's own ---


def test_plug_ins_of_the_users_stand_beside_the_shipped_ones(folders):
    put(folders[0], "sky", "stars", "rank = 10")
    own = put(folders[1], "sky", "ripple", "rank = 5")
    found = catalogue.read(*folders)
    assert list(found.plug_ins["sky"]) == ["ripple", "stars"] and found.mistakes == ()
    ripple = found.plug_ins["sky"]["ripple"]
    assert (ripple.file, ripple.path) == (own, "skies/ripple.glsl")


def test_a_header_with_a_byte_order_mark_is_read(folders):
    path = put(folders[1], "sky", "ripple", "rank = 5")
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    found = catalogue.read(*folders)
    assert found.plug_ins["sky"]["ripple"].rank == 5 and found.mistakes == ()


def test_a_folder_that_is_not_there_holds_nothing(folders, tmp_path):
    assert catalogue.read(folders[0], tmp_path / "nowhere").mistakes == ()


def test_a_mistake_of_the_users_leaves_that_plug_in_out_and_is_told(folders):
    wrong, good = put(folders[1], "sky", "ripple", "exact = true"), put(folders[1], "sky", "graticule", "")
    binary = folders[1] / "skies" / "binary.glsl"
    binary.write_bytes(b"\xff")
    nowhere = folders[1] / "skies" / "nowhere.glsl"
    nowhere.symlink_to(folders[1] / "skies" / "gone.glsl")
    found = catalogue.read(*folders)
    assert list(found.plug_ins["sky"]) == [good.stem]
    first, second, third = map(str, found.mistakes)
    assert first.startswith(f"{binary}: not UTF-8 text")
    assert second.startswith(f"{nowhere}: cannot be read: ") and second.count("nowhere") == 1
    assert third.startswith(f"{wrong}: got the entry 'exact'; allowed are label")


def test_a_mistake_of_ours_is_raised(folders):
    put(folders[0], "sky", "ripple", "exact = true")
    with pytest.raises(CatalogueError, match="^ripple.glsl: got the entry 'exact'"):
        catalogue.read(*folders)


def test_a_key_that_is_taken_names_both_files(folders):
    ours, own = put(folders[0], "sky", "ripple", ""), put(folders[1], "sky", "ripple", "")
    (mistake,) = catalogue.read(*folders).mistakes
    assert str(mistake).startswith(f"{own}: sky 'ripple' is there already, in {ours}")


@pytest.mark.parametrize(
    "slot, key, more, words",
    [
        ("disk_layer", "opacity", "", "its name disk_opacity in GLSL is that of the scene's disk.opacity"),
        ("disk_layer", "noise", "[parameters.scale]\ndefault = true\nhelp = 'H.'", "disk_noise_scale in GLSL is that of the scene's disk.noise_scale"),
        ("disk_layer", "wave_long", "[parameters.crest]\ndefault = true\nhelp = 'H.'", "disk_wave_long_crest in GLSL is that of disk_layer 'wave', "),
        ("sky", "model", "", "its name sky_model in GLSL is that of the scene's sky.model"),
        ("ray_model", "auto", MODEL, "the file's name is the plug-in's key; allowed are names of letters"),
        ("sky", "my sky", "", "the file's name is the plug-in's key; allowed are names of letters"),
        ("ray_model", "even", MODEL, "its name rays_even in GLSL is that of step_control 'even'"),
    ],
)
def test_names_that_would_mean_two_things_are_refused(folders, slot, key, more, words):
    put(folders[0], "disk_layer", "wave", "[parameters.long_crest]\ndefault = true\nhelp = 'H.'")
    path = put(folders[1], slot, key, more)
    (mistake,) = catalogue.read(*folders).mistakes
    assert str(mistake).startswith(f"{path}: ") and words in str(mistake)


def test_a_users_ray_model_may_be_marched_by_a_control_of_the_users(folders):
    put(folders[1], "step_control", "odd", "")
    put(folders[1], "ray_model", "ripple", MODEL.replace("even", "odd"))
    found = catalogue.read(*folders)
    assert found.mistakes == () and list(found.plug_ins["ray_model"]) == ["ripple"]


def test_the_program_starts_and_says_what_it_left_out(tmp_path, monkeypatch):
    path = put(tmp_path / "shaders", "sky", "ripple", "colour = 3")
    monkeypatch.setenv("BLACKHOLE_GL_CONFIG_DIR", str(tmp_path))
    run = subprocess.run([sys.executable, "-m", "blackhole_gl", "presets", "kerr"], capture_output=True, text=True, timeout=60)
    assert run.returncode == 0 and "[hole]" in run.stdout
    assert run.stderr.startswith(f"blackhole-gl: left out: {path}: got the entry 'colour'")


def test_every_slots_section_is_one_of_the_scene():
    assert {slot.section for slot in SLOTS.values() if not slot.of_kinds} <= set(sections.SECTIONS)
