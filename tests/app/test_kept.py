"""What the window keeps from one run to the next."""

import pytest

from blackhole_gl import cli, self_check
from blackhole_gl.app import kept
from blackhole_gl.app.kept import Kept
from blackhole_gl.scene import presets


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("BLACKHOLE_GL_CONFIG_DIR", str(tmp_path))
    return tmp_path


def test_without_a_file_window_and_panel_are_kept_and_the_scene_is_not():
    found, told = kept.load()
    assert (found.keep_window, found.keep_panel, found.keep_scene, told) == (True, True, False, "")


def test_what_is_saved_is_loaded():
    saved = Kept(keep_scene=True, start_line=False, text_size=1.5, window_size=(800, 600), panel_shown=False, panel_em=30.5)
    kept.save(saved)
    assert kept.load() == (saved, "")


@pytest.mark.parametrize(
    "text, says",
    [
        (b"text_size = ", "cannot be read"),
        (b"\xff\xfe\x00", "cannot be read"),
        (b"text_size = 90", "text_size: got 90; allowed is a number from 0.6 to 3"),
        (b"text_size = nan", "text_size: got nan"),
        (b"window_size = [0, 5]", "window_size: got [0, 5]; allowed is [width, height]"),
        (b"keep_scene = 1", "keep_scene: got 1; allowed is true or false"),
        (b'panel_em = "wide"', "panel_em: got 'wide'"),
    ],
)
def test_a_damaged_file_is_told_and_set_aside(text, says, folder):
    kept.file().write_bytes(text)
    found, told = kept.load()
    assert found == Kept() and says in told and str(kept.file()) in told
    assert not kept.file().exists() and (folder / "window.toml.damaged").read_bytes() == text


def test_what_a_newer_version_wrote_is_left_out_and_told():
    kept.file().write_text("text_size = 1.3\nfringe = 'red'\n", encoding="utf-8")
    found, told = kept.load()
    assert found == Kept(text_size=1.3) and "fringe" in told


def test_the_last_scene_is_kept_with_its_time():
    scene = presets.load(["kerr"]).with_values({"hole.spin": 0.3})
    kept.save_scene(scene, 2.5)
    preset = presets.read(kept.last_scene_file())
    assert presets.load([kept.last_scene_file()]) == scene and preset.time == 2.5


@pytest.fixture
def shown(monkeypatch):
    """What `view` shows where it can open no window, instead of rendering it: scene, size, time, …"""
    found = []
    monkeypatch.setattr(self_check, "display_present", lambda: False)
    monkeypatch.setattr(cli, "_render", lambda *given: found.append(given))
    return found


def test_view_begins_with_the_last_scene_where_it_was_kept(shown):
    scene = presets.load(["kerr"]).with_values({"hole.spin": 0.3})
    cli.view()
    assert shown[-1][0] == presets.load(["kerr"])
    kept.save_scene(scene, 2.5)
    cli.view()
    assert (shown[-1][0], shown[-1][2]) == (scene, 2.5)
    cli.view(time=7.0)
    assert (shown[-1][0], shown[-1][2]) == (scene, 7.0)
    cli.view(["schwarzschild"])
    assert (shown[-1][0], shown[-1][2]) == (presets.load(["schwarzschild"]), 0.0)


def test_a_last_scene_that_is_none_is_told_and_left_out(shown, capsys):
    kept.last_scene_file().write_text("[hole]\nspin = 7\n", encoding="utf-8")
    cli.view()
    assert shown[-1][0] == presets.load(["kerr"]) and "last_scene.toml" in capsys.readouterr().err
