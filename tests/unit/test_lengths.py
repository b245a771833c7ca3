"""Lengths in M: a file has one unit, and every scene comes back from either exactly."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import pytest

from blackhole_gl import research
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, catalogue, instances, lengths, presets
from blackhole_gl.scene.lengths import UNITS


def every_kind() -> Scene:
    """The default scene with an instance of each kind."""
    return Scene().with_values({f"{section}.an_{kind}.kind": kind for section, slot in instances.SLOTS.items() for kind in catalogue.plug_ins(slot)})


@pytest.mark.parametrize("name", ["kerr", "particle_storm", "objects_black_hole", "cloudy_slab", "gold_3", "mirage"])
@pytest.mark.parametrize("full", [False, True])
def test_scenes_come_back_from_m_exactly(name: str, full: bool) -> None:
    scene = presets.load([name])
    text = presets.dumps(scene, full, time=3.5, unit="M")
    read = presets.parse(text)
    assert read.over(Scene()) == scene and read.time == 3.5 and read.skipped == ()
    assert text.startswith('lengths = "M"\ntime = 7.0\n') and not re.search("# .*r_s", text)


def test_every_length_that_there_is_can_be_told_in_m() -> None:
    scene = every_kind()
    fields = scene.fields()
    assert all(lengths.field_in(item, "M").unit.count("r_s") == 0 for item in fields.values())
    scaled = [key for key, item in fields.items() if lengths.field_in(item, "M") != item]
    assert {"disk.outer_radius", "camera.distance", "disk.noise_scale", "playback.rate", "things.an_sphere.radius"} <= set(scaled)
    assert not {"hole.spin", "camera.field_m", "camera.inclination_deg", "disk.noise_speed"} & set(scaled)
    assert presets.parse(presets.dumps(scene, full=True, unit="M")).over(Scene()) == scene


def test_values_are_those_of_the_unit(tmp_path: Path) -> None:
    path = tmp_path / "m.toml"
    said = 'time = 10\nlengths = "M"\n[camera]\ndistance = 60\n[disk]\nnoise_scale = 0.5\nouter_radius = 12\n'
    path.write_text(said + '[things.moon]\nkind = "sphere"\nradius = 3\n')
    scene = presets.load([path])
    assert (scene.camera.distance, scene.disk.noise_scale, scene.disk.outer_radius, scene.get("things.moon.radius")) == (30.0, 1.0, 6.0, 1.5)
    assert presets.read(path).time == 5.0
    assert presets.load([path, "particle_storm"]).camera.distance == 30.0


WRONG = (
    ('lengths = "km"\n', "lengths: got 'km'; allowed is one of r_s, M"),
    ('lengths = "M"\n[camera]\ndistance = 1e5\n', "line 3: camera.distance: got 100000.0; allowed is a number from 0.2 to 20000 M, or inf"),
    ('lengths = "M"\n[things.moon]\nradius = 3\n', "things.moon: no kind; with lengths = \"M\" one file has to say both kind and values of it"),
    ('lengths = "M"\n[things.moon]\nkind = "sphere"\nradius = 1e9\n', "things.moon.radius: got 1000000000.0; allowed is a number from"),
)


@pytest.mark.parametrize("text, words", WRONG, ids=lambda value: value.split("\n")[-2] if "\n" in value else "")
def test_mistakes_are_told_in_the_files_own_unit(text: str, words: str) -> None:
    with pytest.raises(presets.PresetError) as told:
        presets.parse(text, "x.toml")
    assert words in str(told.value) and "r_s," not in str(told.value).replace("one of r_s,", "")


def test_infinity_and_a_unit_that_is_not_known() -> None:
    scene = Scene().with_values({"camera.distance": float("inf")})
    assert presets.parse(presets.dumps(scene, unit="M")).over(Scene()) == scene
    odd = Scene().field("camera.distance")
    with pytest.raises(ValueError, match="cannot be told in M"):
        lengths.field_in(type(odd)("x", "float", 1.0, unit="r_s³"), "M")
    assert UNITS == ("r_s", "M")


def test_tables_have_one_unit_where_that_is_asked_for(renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Radii and delays are twice as many M, momenta and places on the screen half as many r_s; all else is what it was."""
    monkeypatch.setattr(research, "renderer_by", lambda backend: renderer)
    rays = {"M": "alpha,beta\n-7,3\n9,1\n", "r_s": "alpha,beta\n-3.5,1.5\n4.5,0.5\n"}
    tables = {}
    for unit in (None, *UNITS):
        (tmp_path / "rays.csv").write_text(rays[unit or "M"])
        research.trace(tmp_path / "rays.csv", tmp_path / "x.csv", names=["kerr"], set_=["camera.distance=inf"], lengths=unit)
        tables[unit] = list(csv.DictReader((tmp_path / "x.csv").open()))
    for usual, in_m, in_rs in zip(*(tables[unit] for unit in (None, "M", "r_s"))):
        for name, value in usual.items():
            if name in ("alpha", "beta", "fate") or value == "":  # the list's own, and what has no unit
                continue
            doubled, halved = (2.0 if re.fullmatch(r"[rt]\d", name) else 1.0), (0.5 if re.fullmatch(r"lambda|k_theta\d", name) else 1.0)
            # 9 digits are written.
            assert float(in_m[name]) == pytest.approx(doubled * float(value), rel=1e-8), name
            assert float(in_rs[name]) == pytest.approx(halved * float(value), rel=1e-8), name
    for unit, radius, names in ((None, "3", ("radius_rs", "alpha_m")), ("M", "6", ("radius_m", "alpha_m")), ("r_s", "3", ("radius_rs", "alpha_rs"))):
        research.curve(tmp_path / "c.csv", names=["kerr"], radii=radius, orders="0", samples=8, lengths=unit)
        row = list(csv.DictReader((tmp_path / "c.csv").open()))[-1]
        assert row[names[0]] == radius
        tables[unit] = float(row[names[1]])
    assert tables["M"] == tables[None] == pytest.approx(2.0 * tables["r_s"])
    with pytest.raises(ValueError, match="--lengths: got 'km'; allowed is one of r_s, M"):
        research.curve(tmp_path / "c.csv", names=["kerr"], lengths="km")
