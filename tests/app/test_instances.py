"""What presets, files and the clipboard do to a scene's instances, without a window."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from blackhole_gl.app import preset_switch, scene_files
from blackhole_gl.app.state import WindowState
from blackhole_gl.scene import Scene, presets
from tests.unit.kinds import known_kinds  # noqa: F401


@pytest.fixture
def state(known_kinds: Path) -> WindowState:  # noqa: F811
    """A window on the preset kerr; looks of the user's: one with a moon and a sun, one with a moon of another size, one with none."""
    folder = known_kinds / "presets"
    folder.mkdir()
    for name, text in {
        "lit": "[things.moon]\nkind = 'globe'\nradius = 2.0\nnumber = 5\n[things.sun]\nkind = 'globe'\n",
        "dim": "[things.moon]\nkind = 'globe'\nradius = 3.0\n",
        "bare": "[post]\ngamma = 2.0\n",
    }.items():
        (folder / f"{name}.toml").write_text(f'group = "look"\n{text}', encoding="utf-8")
    return WindowState.start(presets.load(["kerr"]), {"physics": "kerr"})


def test_a_preset_brings_its_instances_and_takes_them_along_when_another_is_picked(state: WindowState) -> None:
    preset_switch.pick(state, "look", "lit")
    assert list(state.scene.things) == ["moon", "sun"] and state.scene.get("things.moon.number") == 5
    preset_switch.pick(state, "look", "dim")
    assert list(state.scene.things) == ["moon"], "the sun was the other look's alone"
    assert state.scene.get("things.moon.radius") == 3.0
    preset_switch.pick(state, "look", "bare")
    assert state.scene.things == {} and state.scene.post.gamma == 2.0


def test_what_the_hand_has_made_stays(state: WindowState) -> None:
    preset_switch.pick(state, "look", "lit")
    state.change({"things.own.kind": "cube"})
    state.edit(lambda scene: scene.without("things.sun"))
    preset_switch.pick(state, "look", "bare")
    assert list(state.scene.things) == ["own"]


def test_a_refused_edit_is_a_notice_and_changes_nothing(state: WindowState) -> None:
    before = state.scene
    assert not state.edit(lambda scene: scene.without("things.moon"))
    assert state.scene is before and state.notice.is_error and "things.moon" in state.notice.text


def test_files_pictures_and_the_clipboard_carry_instances(state: WindowState, tmp_path: Path) -> None:
    picture = tmp_path / "painted.png"
    state.change({"things.moon.kind": "globe", "things.moon.image": str(picture), "things.moon.path": [{"time": 2.0}]})
    scene = state.scene
    text = scene_files.text_of(state)
    state.file = str(tmp_path / "mine.toml")
    scene_files.save(state)
    scene_files.save_picture(state, np.zeros((2, 3, 3), np.uint8), None, tmp_path)
    assert 'image = "painted.png"' in Path(state.file).read_text(encoding="utf-8")
    (saved,) = tmp_path.glob("blackhole-*.png")
    state.show(Scene())
    scene_files.load(state)
    assert state.scene == scene
    state.show(Scene())
    scene_files.take(state, text)
    assert state.scene == scene.with_values({"things.moon.image": ""}) and "painted.png" in state.notice.text, "text from anywhere opens no file"
    scene_files.take(state, text)
    assert state.scene == scene, "and does when it is pasted again"
    assert presets.from_png(saved) == scene


def test_a_disk_with_a_layer_moves_and_one_without_does_not(state: WindowState) -> None:
    assert state.is_playing
    state.change({"disk.turbulence": False})
    assert not state.is_playing
    state.change({"disk.point_field": True})
    assert state.is_playing
