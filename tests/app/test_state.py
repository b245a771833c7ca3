"""What commands, presets and files do to the window's state, without a window."""

import math

import pytest

from blackhole_gl.app import commands, preset_switch, scene_files
from blackhole_gl.app.commands import Hand, advance
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
