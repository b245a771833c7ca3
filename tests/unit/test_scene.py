"""Scenes hold what their fields allow, and say so when they are given something else."""

from __future__ import annotations

import dataclasses
import math
import pickle

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from blackhole_gl.physics.flight_files import FlightError
from blackhole_gl.scene import Scene, SceneError, fields, frozen
from blackhole_gl.scene.presets import PresetError
from blackhole_gl.scene.schema import Field

NUMBERS = [item for item in fields().values() if item.kind in ("float", "int")]


def test_defaults_are_in_range_and_physical_where_there_is_physics():
    scene = Scene()
    for key, item in fields().items():
        assert item.check(scene.get(key)) == item.default
        if item.physical is not None:
            assert item.default == item.physical, f"{key}: the bare scene is to be physics"


def test_every_field_explains_itself():
    for key, item in fields().items():
        assert item.key == key and item.help.endswith("."), key
        assert item.glsl_name == key.replace(".", "_")
        if item.kind == "choice":
            assert len(item.options) >= 1 and item.default in item.options
        if item.kind in ("float", "int"):
            assert item.low < item.high


def test_names_that_scripts_rely_on():
    """People's presets and command lines name these keys: none may go."""
    promised = {
        "hole.spin", "camera.distance", "camera.inclination_deg", "camera.azimuth_deg", "camera.fov_deg", "camera.observer",
        "rays.model", "disk.enabled", "disk.outer_radius",
    }  # fmt: skip
    assert promised <= set(fields())
    assert {"static", "zamo"} <= set(fields()["camera.observer"].options)
    assert {"flat", "schwarzschild", "kerr_like", "kerr"} <= set(fields()["rays.model"].options)


def test_ranges_reach_what_was_asked_for():
    spin, inclination, distance = (fields()[key] for key in ("hole.spin", "camera.inclination_deg", "camera.distance"))
    assert (spin.low, spin.high) == (-0.9999, 0.9999)
    assert (inclination.low, inclination.high) == (0.0, 180.0)
    assert distance.high == 1e4 and distance.allow_infinity
    assert distance.low < 0.54, "just outside the horizon of a hole with spin 0.998 is 0.532 r_s"


def test_a_disk_moves_where_a_layer_of_it_does():
    still = Scene().with_values({"disk.turbulence": False, "disk.lensing_flare": True, "disk.beaming_boost": True})
    assert Scene().disk_moves and still.with_values({"disk.lanes": True}).disk_moves
    assert not still.disk_moves and not Scene().with_values({"disk.enabled": False}).disk_moves


def test_values_go_in_and_come_out():
    scene = Scene().with_values({"hole.spin": 0.5, "disk.outer_radius": 12, "camera.observer": "zamo", "disk.turbulence.contrast": 1.5})
    assert scene.hole.spin == 0.5
    assert scene.disk.outer_radius == 12.0 and isinstance(scene.disk.outer_radius, float)
    assert scene.get("disk.turbulence.contrast") == 1.5
    assert scene != Scene()
    back = scene.with_values({key: item.default for key, item in fields().items()})
    assert back == Scene() and dict(back.parameters) == {}


def test_scenes_are_frozen_hashable_and_travel():
    scene = Scene().with_values({"hole.spin": 0.5, "disk.turbulence.contrast": 1.5})
    with pytest.raises(AttributeError):
        scene.hole.spin = 0.1
    with pytest.raises(TypeError):
        scene.parameters["disk.turbulence.contrast"] = 2.0
    assert hash(scene) == hash(scene.with_values({}))
    assert pickle.loads(pickle.dumps(scene)) == scene


@pytest.mark.parametrize(
    "key, value, words",
    [
        ("hole.spin", 1.0, ["hole.spin", "1.0", "-0.9999", "0.9999"]),
        ("hole.spin", math.nan, ["hole.spin", "nan"]),
        ("hole.spin", "fast", ["'fast'", "a number from"]),
        ("hole.spin", True, ["True"]),
        ("hole.spin", math.inf, ["inf"]),
        ("camera.distance", -math.inf, ["-inf", "or inf"]),
        ("camera.distance", 10**400, ["camera.distance"]),
        ("rays.max_steps", 100.5, ["100.5", "a whole number"]),
        ("disk.enabled", 1, ["true or false"]),
        ("rays.model", "ker", ["did you mean kerr?"]),
        ("disk.outer_radios", 3.0, ["did you mean disk.outer_radius?"]),
        ("spin", 0.5, ["did you mean hole.spin?"]),
        ("nonsense", 0.5, ["no such key"]),
        ("disk.inner_radius", 12.0, ["got 12; allowed is at most 10, which is disk.outer_radius"]),
    ],
)
def test_errors_name_key_value_and_what_is_allowed(key, value, words):
    with pytest.raises(SceneError) as caught:
        Scene().with_values({key: value})
    assert caught.value.key == key
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    "error", [SceneError("things", "got 5; allowed is 4", 2), PresetError("no such key", key="a.b", source="x.toml", line=3), FlightError("x.toml", "no keys")]
)
def test_errors_reach_another_process_whole(error: SceneError):
    found = pickle.loads(pickle.dumps(error))
    assert type(found) is type(error) and str(found) == str(error) and vars(found) == vars(error)


def test_the_disks_inner_edge_is_not_beyond_its_outer_one():
    scene = Scene().with_values({"disk.inner_radius": 12.0, "disk.outer_radius": 14.0})
    assert scene.with_values({"disk.outer_radius": 12.0}).disk.outer_radius == 12.0
    with pytest.raises(SceneError, match="^disk.outer_radius: got 11.5; allowed is at least 12, which is disk.inner_radius"):
        scene.with_values({"disk.outer_radius": 11.5})
    with pytest.raises(SceneError, match="^disk.outer_radius: got 5; allowed is at least 6, which is disk.inner_radius"):
        Scene().with_values({"disk.inner_radius": 6.0, "disk.outer_radius": 5.0})


@given(st.sampled_from(NUMBERS), st.floats(0.0, 1.0))
def test_every_value_in_range_is_taken(item: Field, share: float):
    value = min(item.low + share * (item.high - item.low), item.high)
    if item.kind == "int":
        value = round(value)
    others = {"disk.outer_radius": 20.0} if item.key == "disk.inner_radius" else {}
    assert Scene().with_values({**others, item.key: value}).get(item.key) == value


@settings(max_examples=200)
@given(
    st.sampled_from(list(fields())), st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8), st.lists(st.integers(), max_size=2))
)
def test_whatever_is_given_is_taken_whole_or_refused_with_a_sentence(key: str, value):
    try:
        scene = Scene().with_values({key: value})
    except SceneError as error:
        assert key in str(error)
    else:
        assert fields()[key].check(scene.get(key)) == value


@pytest.mark.parametrize(
    "key, text, value",
    [
        ("hole.spin", " 0.5 ", 0.5),
        ("camera.distance", "inf", math.inf),
        ("rays.max_steps", "300", 300),
        ("disk.enabled", "off", False),
        ("disk.enabled", "TRUE", True),
        ("rays.model", "flat", "flat"),
    ],
)
def test_text_of_a_command_line(key, text, value):
    assert fields()[key].parse(text) == value


@pytest.mark.parametrize("key, text", [("hole.spin", "half"), ("hole.spin", "nan"), ("rays.max_steps", "1e99"), ("disk.enabled", "maybe"), ("rays.model", "")])
def test_text_that_says_no_value(key, text):
    with pytest.raises(SceneError, match=key):
        fields()[key].parse(text)


def test_a_record_with_other_values_is_as_if_made_with_them() -> None:
    plain = Scene()
    hash(plain)
    made = frozen.changed(plain.camera, distance=9.0, fov_deg=30.0)
    assert made == dataclasses.replace(plain.camera, distance=9.0, fov_deg=30.0) and made != plain.camera == Scene().camera
    assert hash(made) == hash(dataclasses.replace(plain.camera, distance=9.0, fov_deg=30.0))
    with pytest.raises(TypeError, match="Camera has no distanse"):
        frozen.changed(plain.camera, distanse=9.0)
    kept = plain.with_values({"camera.distance": 9.0})
    assert kept.hole is plain.hole and kept.parameters is plain.parameters, "what is compared next is found by its identity"
