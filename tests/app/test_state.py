"""What commands, presets and files do to the window's state, without a window."""

import math

import numpy as np
import pytest

from blackhole_gl.app import commands, preset_switch, scene_files
from blackhole_gl.app.camera_control import range_by_hand, shadow_angle
from blackhole_gl.app.commands import Hand, advance
from blackhole_gl.app.history import LONGEST
from blackhole_gl.app.state import NOTICE_SECONDS, WindowState
from blackhole_gl.scene import Scene, presets


@pytest.fixture
def state(tmp_path, monkeypatch):
    monkeypatch.setenv("BLACKHOLE_GL_CONFIG_DIR", str(tmp_path))
    return WindowState.start(presets.load(["kerr"]), {"physics": "kerr"})


def test_spin_key_goes_to_schwarzschild_and_back(state):
    state.change({"hole.spin": -0.3, "rays.model": "kerr_like"})
    commands.toggle_spin(state)
    assert state.scene.hole.spin == 0.0
    commands.toggle_spin(state)
    assert state.scene.hole.spin == -0.3 and state.scene.rays.model == "kerr_like"


def test_spin_key_leaves_a_model_that_cannot_spin():
    state = WindowState.start(Scene().with_values({"rays.model": "schwarzschild"}))
    commands.toggle_spin(state)
    assert state.scene.hole.spin > 0 and state.scene.rays.model == "auto"
    commands.toggle_spin(state)
    assert state.scene.rays.model == "schwarzschild"


def test_refused_value_is_a_notice(state):
    before = state.scene
    state.change({"hole.spin": 7.0})
    assert state.scene == before
    assert state.notice.is_error and "hole.spin" in state.notice.text
    advance(state, Hand(), 10 * NOTICE_SECONDS)
    assert state.notice is not None, "an error stays"


def test_word_of_success_leaves(state):
    state.say("Saved")
    advance(state, Hand(), 0.9 * NOTICE_SECONDS)
    assert state.notice is not None
    advance(state, Hand(), 0.2 * NOTICE_SECONDS)
    assert state.notice is None


def test_word_of_success_leaves_while_the_window_sleeps(state):
    state.say("Saved")
    advance(state, Hand(), 1 / 60, slept=NOTICE_SECONDS)
    assert state.notice is None
    assert state.time == pytest.approx(state.scene.playback.rate / 60), "nothing else has gone on meanwhile"


def test_reset_brings_back_everything_of_the_camera(state):
    away = {"camera.yaw_deg": 30.0, "camera.pitch_deg": -5.0, "camera.roll_deg": 12.0, "camera.fov_deg": 20.0, "camera.observer": "zamo"}
    state.change({**away, "camera.distance": 40.0})
    commands.reset_camera(state)
    for _ in range(200):
        advance(state, Hand(), 0.05)
    assert state.scene.camera == state.home.camera


def test_reset_goes_the_short_way_round(state):
    state.change({"camera.azimuth_deg": 170.0})
    advance(state, Hand(held=("orbit_right",)), 1.0)
    commands.reset_camera(state)
    assert abs(state.motion.target.azimuth - state.motion.current.azimuth) <= 180.0
    for _ in range(300):
        advance(state, Hand(), 1 / 60)
    assert state.scene.camera == state.home.camera


def test_reset_from_infinity(state):
    state.change({"camera.distance": math.inf})
    commands.reset_camera(state)
    assert state.scene.camera == state.home.camera


def test_pause_stops_time(state):
    advance(state, Hand(), 0.5)
    assert state.time == pytest.approx(0.5 * state.scene.playback.rate)
    commands.toggle_pause(state)
    advance(state, Hand(), 0.5)
    assert state.time == pytest.approx(0.5 * state.scene.playback.rate)


def test_look_keeps_camera_and_hand_made_changes(state):
    state.change({"camera.inclination_deg": 33.0, "disk.outer_radius": 14.0})
    preset_switch.pick(state, "look", "particle_storm")
    assert state.scene.camera.inclination_deg == 33.0 and state.scene.disk.outer_radius == 14.0
    assert state.scene.disk.noise_scale == 1.10
    assert state.home.camera.inclination_deg != 33.0


def test_what_only_the_old_look_said_goes_with_it(state, tmp_path):
    folder = presets.user_presets_dir()
    folder.mkdir(parents=True)
    (folder / "odd.toml").write_text('group = "look"\n[post]\nexposure = 3.0\n')
    before = state.scene.post.exposure
    preset_switch.pick(state, "look", "odd")
    assert state.scene.post.exposure == 3.0
    preset_switch.pick(state, "look", "minimal_bloom")
    assert state.scene.post.exposure == before


@pytest.mark.parametrize("name, group", [(info.name, info.group) for info in presets.available() if info.group in ("quality", "steps")])
def test_any_quality_can_be_left_again(state, name, group):
    rays, coarsest = state.scene.rays, state.scene.playback.coarsest
    preset_switch.pick(state, group, name)
    assert preset_switch.chosen_among(["kerr", name]) == {"physics": "kerr", group: name}
    preset_switch.pick(state, "quality", "automatic")
    assert (state.scene.rays, state.scene.playback.coarsest) == (rays, coarsest)
    assert state.chosen["quality"] == "automatic" and "steps" not in state.chosen


def test_steps_stated_by_hand_take_the_place_of_a_level(state):
    preset_switch.pick(state, "quality", "finest")
    preset_switch.pick(state, "steps", "blackholegpu_low")
    assert state.scene.rays.tolerance == 0.5 and state.scene.rays.max_steps == 128
    assert "quality" not in state.chosen


def test_automatic_is_there_where_nothing_says_otherwise():
    assert preset_switch.chosen_among(["kerr"]) == {"physics": "kerr", "quality": "automatic"}
    assert preset_switch.chosen_among(["kerr", "low"]) == {"physics": "kerr", "steps": "blackholegpu_low"}
    assert preset_switch.chosen_among(["kerr", "mine.png"]) == {"physics": "kerr"}


def test_every_shipped_preset_can_be_picked(state):
    for info in presets.available():
        preset_switch.pick(state, info.group, info.name)
        assert state.notice is None or not state.notice.is_error, state.notice
        assert state.chosen[info.group] == info.name


def test_a_whole_scene_replaces_all(state):
    state.change({"post.exposure": 2.0})
    preset_switch.pick(state, "scene", "luminet_1979")
    assert state.scene == presets.load(["luminet_1979"]) == state.home
    assert state.chosen == {"scene": "luminet_1979", "quality": "automatic"}


def test_physics_picked_leaves_nothing_of_a_whole_scene(state):
    state.change({"post.exposure": 2.0})
    preset_switch.pick(state, "scene", "luminet_1979")
    preset_switch.pick(state, "look", "particle_storm")
    preset_switch.pick(state, "physics", "kerr")
    assert state.chosen == {"physics": "kerr", "look": "particle_storm", "quality": "automatic"}
    assert state.scene == state.home == presets.load(["kerr", "particle_storm", "automatic"])


def test_look_and_quality_lie_over_a_whole_scene(state):
    preset_switch.pick(state, "scene", "luminet_1979")
    preset_switch.pick(state, "look", "particle_storm")
    preset_switch.pick(state, "quality", "draft")
    assert state.scene == state.home == presets.load(["luminet_1979", "particle_storm", "draft"])
    assert remarks(state) == {"scene": "", "look": "", "quality": ""}
    preset_switch.pick(state, "look", "smooth")
    assert state.scene == presets.load(["luminet_1979", "smooth", "draft"]), "what the first look said and the second does not is Luminet's again"
    state.change({"sky.enabled": True})
    assert remarks(state) == {"scene": " · modified", "look": "", "quality": ""}


def test_missing_preset_is_a_notice(state):
    preset_switch.pick(state, "look", "no_such_look")
    assert state.notice.is_error and "no_such_look" in state.notice.text


def newer(path, says='[hole]\nspin = 0.25\ncharge = 0.1\n'):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(says)
    return path


def test_what_a_newer_presets_file_has_more_is_told_and_the_rest_is_shown(state, tmp_path):
    state.file = str(newer(tmp_path / "new.toml"))
    newer(presets.user_presets_dir() / "later.toml")
    ways_in = {
        "loaded": lambda: scene_files.load(state),
        "picked": lambda: preset_switch.pick(state, presets.USER_GROUP, "later"),
        "pasted": lambda: scene_files.take(state, (tmp_path / "new.toml").read_text()),
    }
    for how, show in ways_in.items():
        state.show(Scene())
        state.say("nothing yet")
        show()
        assert state.scene.hole.spin == 0.25, how
        assert state.notice.is_error and "line 3: hole.charge: skipped" in state.notice.text, how
    opened = preset_switch.start(presets.load([state.file]), [state.file])
    assert opened.scene.hole.spin == 0.25 and "hole.charge: skipped" in opened.notice.text
    assert preset_switch.start(Scene(), ["kerr"]).notice is None


def test_a_notice_of_much_that_was_skipped_stays_short(state, tmp_path):
    state.file = str(newer(tmp_path / "new.toml", "".join(f"new{n} = 1\n" for n in range(40))))
    scene_files.load(state)
    assert state.notice.text.count("\n") == 6 and "and 35 more" in state.notice.text


def test_names_in_the_file_field(state, tmp_path):
    assert scene_files.path_of("mine") == presets.user_presets_dir() / "mine.toml"
    assert scene_files.path_of(str(tmp_path / "a.png")) == tmp_path / "a.png"
    state.file = "  "
    scene_files.save(state)
    assert state.notice.is_error
    state.file = "nowhere"
    scene_files.load(state)
    assert state.notice.is_error and "nowhere" in state.notice.text


def test_undo_and_redo_go_through_values_presets_and_the_camera(state):
    start = state.scene
    state.change({"post.exposure": -8.0})
    state.record()
    preset_switch.pick(state, "look", "particle_storm")
    stormy = state.scene
    advance(state, Hand(drag=(0.2, 0.1)), 1 / 60)
    state.record()
    for _ in range(200):
        advance(state, Hand(), 1 / 60)
        state.record()
    turned = state.scene
    assert len(state.history.past) == 3, "a camera that follows the hand is one step"
    state.undo()
    assert state.scene == stormy and state.motion.at_rest
    state.undo()
    assert state.scene.post.exposure == -8.0 and "look" not in state.chosen
    state.undo()
    state.undo()
    assert state.scene == start
    for _ in range(3):
        state.redo()
    assert state.scene == turned and state.chosen["look"] == "particle_storm"
    state.undo()
    state.change({"post.exposure": 1.0})
    state.redo()
    assert state.scene.post.exposure == 1.0, "what is changed after an undo ends what could be redone"


def test_history_is_bounded(state):
    for number in range(LONGEST + 50):
        state.change({"post.exposure": number / 100.0})
        state.record()
    assert len(state.history.past) == LONGEST


def test_everything_goes_back_to_the_presets_in_force(state):
    preset_switch.pick(state, "look", "particle_storm")
    in_force = state.scene
    state.change({"post.exposure": -8.0, "camera.distance": 55.0, "hole.spin": 0.1, "camera.yaw_deg": 4.0})
    preset_switch.pick(state, "look", "minimal_bloom")
    assert state.scene.post.exposure == -8.0, "a preset that says nothing of it leaves it"
    preset_switch.pick(state, "look", "particle_storm")
    commands.reset_all(state)
    assert state.scene == in_force == presets.load(["kerr", "particle_storm"])


def test_what_was_set_on_the_command_line_is_no_preset():
    scene = presets.load(["kerr"], {"hole.spin": 0.2})
    state = preset_switch.start(scene, ["kerr"])
    assert state.scene == scene and state.home == presets.load(["kerr"])
    assert preset_switch.start(presets.load(["smooth"]), ["smooth"]).chosen == {"physics": "kerr", "look": "smooth", "quality": "automatic"}


def test_a_lower_layer_leaves_what_an_upper_one_sets(state):
    preset_switch.pick(state, "look", "particle_storm")
    preset_switch.pick(state, "physics", "thin_disk")
    assert state.scene == presets.load(["thin_disk", "particle_storm"])


def test_a_hole_that_grows_moves_the_camera_out(state):
    state.change({"camera.distance": 0.9})
    assert state.notice is None
    commands.toggle_spin(state)
    out = state.scene.camera.distance
    assert state.scene.hole.spin == 0.0 and out == pytest.approx(range_by_hand(state.scene)[0], rel=1e-5)
    assert f"moved out to {out:.4g} r_s" in state.notice.text
    for _ in range(10):
        advance(state, Hand(), 1 / 60)
    assert state.scene.camera.distance == out


def notches(state, direction):
    count = 0
    while state.notice is None:
        advance(state, Hand(wheel=direction), 1 / 60)
        count += 1
    for _ in range(200):
        advance(state, Hand(), 1 / 60)
    return count


@pytest.mark.parametrize("spin", [0.0, 0.9, -0.9999])
def test_the_wheel_ends_where_the_hole_is_still_seen(state, spin):
    state.change({"hole.spin": spin})
    assert notches(state, 1.0) < 20
    camera = state.scene.camera
    side = math.atan(math.tan(math.radians(0.5 * camera.fov_deg)) * 4.0 / 3.0)
    assert shadow_angle(state.scene) == pytest.approx(side, rel=1e-6), "the hole is as wide as a picture, and no wider"
    state.notice = None
    notches(state, -1.0)
    camera = state.scene.camera
    shadow = 2.0 * math.degrees(math.sqrt(27.0) / 2.0 / camera.distance)
    assert 0.009 < shadow / camera.fov_deg < 0.011, "a hundredth of the picture's height"


def test_a_camera_beyond_the_hands_reach_may_stay_and_come_back(state):
    state.change({"camera.distance": 5000.0})
    advance(state, Hand(wheel=-1.0), 1 / 60)
    assert state.motion.target == state.motion.current
    advance(state, Hand(wheel=1.0), 1 / 60)
    assert state.motion.target.reach < state.motion.current.reach


def test_the_wheel_keeps_a_far_cameras_hole_in_sight(state):
    state.change({"camera.distance": math.inf})
    notches(state, 1.0)
    assert 4.0 < state.scene.camera.field_m < 6.0
    state.notice = None
    notches(state, -1.0)
    assert 1000.0 < state.scene.camera.field_m < 1100.0


def test_what_is_saved_is_in_force_at_once(state):
    state.change({"disk.outer_radius": 7.0})
    state.file, state.time, state.paused = "mine", 12.5, True
    scene_files.save(state)
    assert state.chosen == {"physics": "kerr", "user": "mine"} and state.home == state.scene
    state.file = "kerr"
    scene_files.save(state)
    assert state.notice.is_error and "comes with the program" in state.notice.text
    saved = state.scene
    preset_switch.pick(state, "scene", "luminet_1979")
    state.time, state.paused = 0.0, False
    preset_switch.pick(state, "user", "mine")
    assert state.scene == saved and (state.time, state.paused) == (12.5, True)


@pytest.mark.parametrize("by", ["toml", "png", "clipboard"])
def test_scene_and_time_open_as_they_were(state, tmp_path, by):
    state.change({"camera.yaw_deg": 3.25, "camera.pitch_deg": -1.5, "camera.roll_deg": 7.0, "playback.rate": 2.5, "sky.brightness": 0.1 + 0.2})
    state.time, state.paused = 17.123456789012345, True
    as_it_was = state.scene, state.time, state.paused
    if by == "png":
        scene_files.save_picture(state, np.zeros((2, 3, 3), np.uint8), None, tmp_path)
        state.file = str(next(tmp_path.glob("*.png")))
    elif by == "toml":
        state.file = str(tmp_path / "a.toml")
        scene_files.save(state)
    text = scene_files.text_of(state)
    state.change({"camera.yaw_deg": 0.0, "playback.rate": 1.0})
    state.time, state.paused = 0.0, False
    if by == "clipboard":
        scene_files.take(state, text)
    else:
        scene_files.load(state)
    assert (state.scene, state.time, state.paused) == as_it_was


@pytest.mark.parametrize("by", ["file", "clipboard", "picker"])
def test_files_outside_a_presets_folder_are_opened_when_it_is_taken_a_second_time(state, tmp_path, by):
    (presets.user_presets_dir()).mkdir(parents=True, exist_ok=True)
    path = presets.user_presets_dir() / "mine.toml"
    path.write_text(f"[sky]\nmodel = 'picture'\n[sky.picture]\nfile = '{tmp_path / 'far.png'}'\n")
    state.file = str(path)
    ways = {
        "file": lambda: scene_files.load(state),
        "clipboard": lambda: scene_files.take(state, path.read_text()),
        "picker": lambda: preset_switch.pick(state, "user", "mine"),
    }
    ways[by]()
    assert state.scene.sky.model == "picture" and state.scene.get("sky.picture.file") == ""
    assert state.notice.is_error and f"left out: the file {tmp_path / 'far.png'}" in state.notice.text and "again to have them opened" in state.notice.text
    ways[by]()
    assert state.scene.get("sky.picture.file") == str(tmp_path / "far.png") and not state.notice.is_error
    ways[by]()
    assert state.scene.get("sky.picture.file") == "", "it is asked for each time anew"


def remarks(state):
    in_force = {group: presets.read(name) for group, name in state.chosen.items()}
    return {group: preset_switch.remark(keys) for group, keys in preset_switch.left(state.scene, in_force).items()}


def test_a_preset_that_the_scene_has_left_is_called_modified(state):
    preset_switch.pick(state, "look", "smooth")
    assert remarks(state) == {"physics": "", "look": ""}
    state.change({"camera.inclination_deg": 20.0})
    assert remarks(state) == {"physics": " · moved", "look": ""}
    commands.toggle_spin(state)
    assert remarks(state) == {"physics": " · modified", "look": ""}
    commands.toggle_spin(state)
    commands.reset_camera(state)
    for _ in range(300):
        advance(state, Hand(), 1 / 60)
    assert remarks(state) == {"physics": "", "look": ""}, "it says what is so, whatever has been in between"
    preset_switch.pick(state, "scene", "luminet_1979")
    state.change({"post.exposure": 1.0})
    assert remarks(state) == {"scene": " · modified", "quality": ""}, "a whole scene says everything"


def test_a_value_from_the_command_line_is_a_modification():
    state = preset_switch.start(presets.load(["kerr"], {"hole.spin": 0.2}), ["kerr"])
    assert remarks(state) == {"physics": " · modified", "quality": ""}
