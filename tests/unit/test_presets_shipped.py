"""The presets that come with the program: each loads, and the tables they were made from are in them."""

import math
from pathlib import Path

import pytest

from blackhole_gl.planning import choice, plan
from blackhole_gl.resources import assets_dir, presets_dir
from blackhole_gl.scene import Scene, catalogue, fields, presets

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

S1_LAYERS = ("turbulence", "lanes", "micro_turbulence", "relativistic_lanes", "lensing_flare", "beaming_boost")

# BlackHoleGPU's quality presets (steps, length, adaptive or not); the angular steps are ours.
S1_STEPS = {
    "low": (128, 0.15, "fixed", 0.4),
    "medium": (192, 0.12, "radius", 0.2),
    "high": (256, 0.10, "radius", 0.1),
    "ultra": (512, 0.08, "radius", 0.05),
}

LEVELS = [info.name for info in SHIPPED if info.group == "quality"]
WHOLE = [info.name for info in SHIPPED if info.group in ("physics", "scene") and presets.load([info.name]).rays.lensing]

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
    assert groups["automatic"] == "quality" and groups["reference"] == "steps"


def test_lists_are_in_order_of_rank():
    assert LEVELS == ["automatic", "draft", "light", "fine", "finest"]
    assert [info.name for info in SHIPPED if info.group == "steps"] == [*(f"blackholegpu_{name}" for name in S1_STEPS), "reference"]
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


@pytest.mark.parametrize("name", [info.name for info in SHIPPED if info.group == "look"])
def test_a_look_says_of_every_layer_whether_it_is_on(name):
    """So that picking one leaves no layer of what was there before."""
    said = presets.read(name).values
    assert {f"disk.{layer}" for layer in catalogue.keys("disk_layer")} <= set(said)
    if name in S1_LOOKS:
        assert all(said[f"disk.{layer}"] for layer in S1_LAYERS)


@pytest.mark.parametrize("name", S1_STEPS)
def test_steps_of_s1_are_found_by_their_former_names_too(name):
    rays = presets.load([f"blackholegpu_{name}"]).rays
    assert (rays.max_steps, rays.step_length, rays.step_control, rays.step_angle) == S1_STEPS[name]
    assert presets.load([name]).rays == rays
    assert presets.renamed(["kerr", name, "automatic", Path("low"), "low.toml"]) == {name: f"blackholegpu_{name}"}


def test_automatic_is_what_a_scene_has_that_says_nothing_of_quality():
    bare = Scene()
    assert {key: bare.get(key) for key in presets.read("automatic").values} == presets.read("automatic").values


def test_every_level_says_what_the_others_and_the_presets_of_steps_say():
    """So that picking one leaves nothing of what was there before."""
    said = {name: set(presets.read(name).values) for name in LEVELS}
    steps = {key for info in SHIPPED if info.group == "steps" for key in presets.read(info.name).values}
    assert all(keys == said["automatic"] and steps <= keys for keys in said.values())


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("name", WHOLE)
def test_no_level_of_quality_is_beaten_by_automatic(name, level):
    """In error and in cost at once, by what the chart measured; where it measured nothing, all levels take the same steps."""
    scene, automatic = presets.load([name, level]), presets.load([name])
    assert choice.is_open(scene)
    made, other = choice.choose(scene), choice.choose(automatic)
    if other.chosen is None:
        assert plan(scene).method == plan(automatic).method
        return
    assert made.meets and made.chosen.error_px <= scene.rays.tolerance
    assert made.chosen.error_px <= other.chosen.error_px or made.chosen.cost <= other.chosen.cost
    assert not plan(scene).warnings


def test_levels_cost_more_and_err_less_from_draft_to_finest():
    rays = [presets.load(["kerr", name]).rays for name in ("draft", "light", "automatic", "fine", "finest")]
    assert [level.tolerance for level in rays] == sorted((level.tolerance for level in rays), reverse=True)
    for spent in ("at_rest", "in_stills"):
        assert [getattr(level, spent) for level in rays] == sorted(getattr(level, spent) for level in rays)


@pytest.mark.parametrize("name", PHYSICAL)
def test_physical_presets_are_physics(name):
    scene = presets.load([name])
    spin, inclination = PHYSICAL[name]
    assert scene.hole.spin == spin
    assert inclination is None or scene.camera.inclination_deg == inclination
    assert all(item.physical is None or scene.get(key) == item.physical for key, item in fields().items())


@pytest.mark.parametrize("group, sections", [("look", {"disk", "post", "sky"}), ("quality", {"rays", "playback"}), ("steps", {"rays"})])
def test_looks_qualities_and_steps_leave_the_physics_alone(group, sections):
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


def test_every_mesh_that_ships_is_in_a_scene_that_ships() -> None:
    shown = {str(thing.values.get("file")) for info in SHIPPED for thing in presets.load([info.name]).things.values()}
    meshes = sorted(path.name for path in (assets_dir() / "meshes").iterdir())
    assert meshes and all(f"asset:meshes/{name}" in shown for name in meshes)
