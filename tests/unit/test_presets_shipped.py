"""The presets that come with the program: each loads, and the tables they were made from are in them."""

import math

import pytest

from blackhole_gl.resources import presets_dir
from blackhole_gl.scene import Scene, fields, presets

SHIPPED = [info for info in presets.available() if info.path.is_relative_to(presets_dir())]


def test_every_entry_of_a_shipped_preset_is_known():
    assert presets.skipped([info.path for info in SHIPPED]) == []


# BlackHoleGPU's physics presets (docs/sources.md); the camera's distance is given for the first only.
S1_PHYSICS = {
    "gargantua_s1": {"hole.gravity_strength": 2.5, "disk.outer_radius": 5.0, "disk.thickness": 0.2, "camera.distance": 8.0},
    "extreme_gravity": {"hole.gravity_strength": 8.0, "disk.outer_radius": 15.0, "disk.thickness": 0.5, "hole.horizon_size": 0.5},
    "thin_disk": {"hole.gravity_strength": 3.0, "disk.outer_radius": 10.0, "disk.thickness": 0.05},
}

# BlackHoleGPU's visual presets.
S1_LOOK_KEYS = (
    "disk.thickness", "disk.density_gain", "disk.noise_scale", "disk.noise_speed", "disk.emission_strength",
    "post.bloom_threshold", "post.bloom_intensity", "post.bloom_spread", "post.gamma",
)  # fmt: skip
S1_LOOKS = {
    "default_look": (0.50, 9200, 0.68, 0.70, 0.18, 0.68, 0.45, 1.00, 1.00),
    "particle_storm": (0.68, 13500, 1.10, 1.25, 0.28, 0.72, 0.58, 1.20, 1.05),
    "minimal_bloom": (0.52, 12000, 0.88, 0.85, 0.22, 0.55, 0.30, 0.85, 0.95),
}

# BlackHoleGPU's quality presets (steps, length, adaptive or not); the angular steps and `reference` are ours.
QUALITIES = {
    "low": (128, 0.15, "fixed", 0.4),
    "medium": (192, 0.12, "radius", 0.2),
    "high": (256, 0.10, "radius", 0.1),
    "ultra": (512, 0.08, "radius", 0.05),
}

# a*, inclination in degrees
PHYSICAL = {"schwarzschild": (0.0, 80.0), "kerr_06": (0.6, None), "kerr_0998_85": (0.998, 85.0), "m87_like": (0.9, 17.0)}


@pytest.mark.parametrize("info", SHIPPED, ids=lambda info: f"{info.group}/{info.name}")
def test_every_shipped_preset_loads_and_introduces_itself(info):
    assert isinstance(presets.load([info.name]), Scene)
    assert info.title != info.name and info.description.endswith(".")
    assert presets.read(info.name).group == info.group == info.path.parent.name


def test_names_are_unique_and_those_that_scripts_rely_on_are_there():
    names = [info.name for info in SHIPPED]
    assert len(set(names)) == len(names)
    groups = {info.name: info.group for info in SHIPPED}
    assert {groups[name] for name in ("schwarzschild", "kerr")} == {"physics"}
    assert {groups[name] for name in ("low", "medium", "high", "ultra", "reference")} == {"quality"}


def test_lists_are_in_order_of_rank():
    assert [info.name for info in SHIPPED if info.group == "quality"] == ["low", "medium", "high", "ultra", "reference"]
    assert [info.group for info in SHIPPED] == sorted((info.group for info in SHIPPED), key=presets.GROUPS.index)


@pytest.mark.parametrize("name", S1_PHYSICS)
def test_physics_of_s1(name):
    scene = presets.load([name])
    assert {key: scene.get(key) for key in S1_PHYSICS[name]} == S1_PHYSICS[name]
    assert scene.rays.model == "schwarzschild"


@pytest.mark.parametrize("name", S1_LOOKS)
def test_looks_of_s1(name):
    said = presets.read(name).values
    assert tuple(said[key] for key in S1_LOOK_KEYS) == S1_LOOKS[name]


@pytest.mark.parametrize("name", QUALITIES)
def test_qualities_of_s1(name):
    rays = presets.load([name]).rays
    assert (rays.max_steps, rays.step_length, rays.step_control, rays.step_angle) == QUALITIES[name]


@pytest.mark.parametrize("name", PHYSICAL)
def test_physical_presets_are_physics(name):
    scene = presets.load([name])
    spin, inclination = PHYSICAL[name]
    assert scene.hole.spin == spin
    assert inclination is None or scene.camera.inclination_deg == inclination
    assert all(item.physical is None or scene.get(key) == item.physical for key, item in fields().items())


@pytest.mark.parametrize("group, sections", [("look", {"disk", "post", "sky"}), ("quality", {"rays"})])
def test_looks_and_qualities_leave_the_physics_alone(group, sections):
    for info in SHIPPED:
        if info.group == group:
            assert {key.split(".")[0] for key in presets.read(info.name).values} <= sections


def test_gargantua_as_filmed_has_no_doppler_effects():
    scene = presets.load(["gargantua_as_filmed"])
    assert scene.hole.spin == 0.6
    assert not (scene.disk.doppler_colour or scene.disk.beaming or scene.disk.redshift)


def test_luminet_is_seen_from_infinity_in_white_light():
    scene = presets.load(["luminet_1979"])
    assert math.isinf(scene.camera.distance)
    assert scene.disk.colour == "white" and not scene.sky.enabled
