"""A flight in the window, without a window: it plays, is scrubbed, and is made of keys taken from the view."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from blackhole_gl.app import timeline
from blackhole_gl.app.commands import Hand, advance
from blackhole_gl.app.state import WindowState
from blackhole_gl.scene import presets

PATH = "title = 'In'\nrate = 2.0\n[[keys]]\nat = 0\ncamera.distance = 20.0\n[[keys]]\nat = 2\ncamera.distance = 10.0\n"


@pytest.fixture
def state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> WindowState:
    monkeypatch.setenv("BLACKHOLE_GL_CONFIG_DIR", str(tmp_path / "config"))
    return WindowState.start(presets.load(["kerr"]), {"physics": "kerr"})


def opened(state: WindowState, folder: Path, text: str = PATH) -> WindowState:
    (folder / "in.toml").write_text(text, encoding="utf-8")
    timeline.open_file(state, str(folder / "in.toml"))
    return state


def run(state: WindowState, seconds: float) -> None:
    for _ in range(round(seconds / 0.05)):
        advance(state, Hand(), 0.05)


def test_it_plays_to_its_end_and_again_from_the_start(state: WindowState, tmp_path: Path) -> None:
    opened(state, tmp_path)
    assert state.notice.text == "Flight: In" and not state.camera_moves
    timeline.play(state)
    run(state, 1.0)
    assert state.camera_moves and state.scene.camera.distance == pytest.approx(15.0, abs=0.5) and state.time == pytest.approx(2.0, abs=0.2)
    run(state, 2.0)
    assert not state.timeline.plays and state.scene.camera.distance == 10.0 and state.timeline.seconds == 2.0
    timeline.play(state)
    run(state, 0.1)
    assert state.scene.camera.distance > 19.0
    state.timeline = replace(state.timeline, loops=True)
    run(state, 2.0)
    assert state.timeline.plays and state.timeline.seconds == pytest.approx(0.1, abs=0.06)


def test_the_hand_takes_over(state: WindowState, tmp_path: Path) -> None:
    opened(state, tmp_path)
    timeline.play(state)
    run(state, 0.5)
    advance(state, Hand(drag=(0.1, 0.0)), 0.05)
    assert not state.timeline.plays
    before = state.scene.camera.azimuth_deg
    run(state, 1.0)
    assert state.scene.camera.azimuth_deg < before, "the camera follows it"


def test_keys_are_taken_from_the_view_saved_and_opened(state: WindowState, tmp_path: Path) -> None:
    timeline.take_key(state)
    state.timeline = replace(state.timeline, seconds=3.0)
    state.change({"camera.distance": 8.0, "camera.yaw_deg": 5.0})
    timeline.take_key(state)
    state.change({"camera.distance": 9.0})
    timeline.take_key(state)
    assert [key.at for key in state.timeline.flight.keys] == [0.0, 3.0], "at the same second it takes the other's place"
    timeline.save(state, str(tmp_path / "out.toml"))
    kept = state.timeline.flight
    timeline.open_file(state, str(tmp_path / "out.toml"))
    assert state.timeline.flight.keys == kept.keys and state.timeline.length == 3.0
    timeline.seek(state, 3.0)
    assert (state.scene.camera.distance, state.scene.camera.yaw_deg) == (9.0, 5.0)


def test_a_fall_reads_its_clocks_and_goes_through_the_horizon(state: WindowState, tmp_path: Path) -> None:
    state.change({"hole.spin": 0.0, "camera.distance": 4.0})
    opened(state, tmp_path, "[way]\nkind = 'rain'\n")
    timeline.seek(state, 1.0)
    told = timeline.reading(state.timeline.moment)
    assert told.startswith("own clock 1.00, far away 1.") and "falls at 0.5" in told
    timeline.seek(state, state.timeline.length)
    told = timeline.reading(state.timeline.moment)
    assert state.scene.camera.distance < 0.2 and "far away no more" in told and told.endswith("nothing stands still here")
    timeline.save(state, str(tmp_path / "never.toml"))
    assert state.notice.text == "There are no keys to save." and not (tmp_path / "never.toml").exists()


def test_mistakes_are_notices(state: WindowState, tmp_path: Path) -> None:
    opened(state, tmp_path, "rate = 3")
    assert state.notice.is_error and "neither [[keys]] nor a [way]" in state.notice.text and state.timeline.flight is None
    timeline.play(state)
    timeline.seek(state, 1.0)
    assert state.timeline.flight is None and state.timeline.length == 0.0
    timeline.take_key(state)
    timeline.save(state, str(tmp_path / "in.toml" / "below a file.toml"))
    assert state.notice.is_error


def test_a_flight_that_nothing_ends_has_a_minute_of_slider(state: WindowState, tmp_path: Path) -> None:
    opened(state, tmp_path, "[way]\nkind = 'orbit'\ndistance = 8.0\n")
    assert state.timeline.flight.seconds == math.inf and state.timeline.length == 60.0
