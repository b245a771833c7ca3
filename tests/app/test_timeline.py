"""A flight in the window, without a window: it plays, is scrubbed, and is made of keys taken from the view."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from blackhole_gl.app import flight_inset, flight_overlay, shipped_flights, timeline
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


def test_a_shipped_flight_brings_its_scene_and_is_explained_in_a_second_run(state: WindowState) -> None:
    state.change({"post.show_plane_grid": True})
    shipped_flights.fly(state, "dive")
    assert state.timeline.plays and state.scene.hole.spin == 0.0 and not state.scene.post.show_plane_grid and state.chosen["physics"] == "schwarzschild"
    timeline.seek(state, 18.0)
    assert not state.timeline.note and not state.scene.post.labels
    assert flight_overlay.clocks(state.timeline.moment)[1] == ("far away", "never")
    timeline.explain(state, True)
    assert "horizon" in state.timeline.note and state.scene.post.labels and state.scene.post.show_horizon
    timeline.explain(state, False)
    assert not state.timeline.note and not state.scene.post.labels


def test_the_map_of_a_flight_has_its_way_and_the_hole(state: WindowState) -> None:
    shipped_flights.fly(state, "orbit_at_isco")
    shown = flight_inset.of(state.timeline.flight)
    assert shown.hole == pytest.approx(0.5 / shown.reach) and shown.reach == pytest.approx(1.1 * 3.0, rel=0.1)
    timeline.seek(state, 3.0)
    place = shown.place(state.scene)
    assert min(math.dist(place, point) for point in shown.way) < 0.05
    timeline.open_file(state, "")
    shipped_flights.fly(state, "dive")
    way = flight_inset.of(state.timeline.flight).way
    assert math.dist(way[-1], (0.5, 0.5)) < 0.01 < math.dist(way[0], (0.5, 0.5))


def test_every_shipped_flight_has_a_title() -> None:
    assert {"dive", "fly_by", "hover", "orbit_at_isco"} <= shipped_flights.titles().keys()
