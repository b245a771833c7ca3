"""Films of what the window shows: a frame for every thirtieth of a second of its clock, whatever its own rate."""

from __future__ import annotations

from pathlib import Path

import av
import numpy as np

from blackhole_gl.app.area import Area
from blackhole_gl.app.recorder import FPS, Recorder
from blackhole_gl.app.state import WindowState
from blackhole_gl.scene import Scene, presets


class Shown:
    """A window that is as grey as `level`."""

    level = 0

    def read(self, viewport: tuple[int, int, int, int], components: int, alignment: int) -> bytes:
        return np.full((viewport[3], viewport[2], components), self.level, np.uint8).tobytes()


def levels_of(path: Path) -> list[float]:
    with av.open(str(path)) as container:
        frames = list(container.decode(video=0))
        np.testing.assert_allclose([float(frame.pts * frame.time_base) for frame in frames], np.arange(len(frames)) / FPS, atol=1e-3)
        assert container.streams.video[0].average_rate == FPS
        return [float(frame.to_ndarray(format="rgb24").mean()) for frame in frames]


def recorded(tmp_path: Path, action: str, passed: list[float]) -> tuple[WindowState, list[float]]:
    """Takes a picture after each of these seconds, one a tenth brighter than the other."""
    state, recorder, window = WindowState.start(Scene()), Recorder(tmp_path), Shown()
    recorder.do(action, state)
    for seconds in passed:
        state.clock += recorder.dt(seconds)
        recorder.take(state, window, Area(0, 0, 65, 33))
        assert "frames" in state.recording
        window.level += 20
    recorder.do(action, state)
    assert not recorder.busy and not recorder.exact and state.recording == ""
    (path,) = tmp_path.iterdir()
    assert state.notice is not None and state.notice.text == f"Saved {path}"
    return state, levels_of(path)


def test_at_the_windows_rate_a_slow_picture_is_repeated(tmp_path: Path) -> None:
    """A clock's rounding aside: 0, 2 and 1 thirtieths on. Two levels: the packing's."""
    _, levels = recorded(tmp_path, "record", [0.0, 2.0 / FPS, 1.0 / FPS])
    np.testing.assert_allclose(levels, [0.0, 20.0, 20.0, 40.0], atol=2.0)


def test_frame_by_frame_each_picture_is_one_frame_however_long_it_took(tmp_path: Path) -> None:
    state, levels = recorded(tmp_path, "record_exact", [0.0, 3.0, 0.001, 0.2])
    np.testing.assert_allclose(levels, [0.0, 20.0, 40.0, 60.0], atol=2.0)
    assert abs(state.clock - 3.0 / FPS) < 1e-9


def test_a_window_that_changes_its_size_ends_the_film_and_says_so(tmp_path: Path) -> None:
    state, recorder, window = WindowState.start(presets.load(["kerr"])), Recorder(tmp_path), Shown()
    recorder.do("record", state)
    recorder.take(state, window, Area(0, 0, 64, 32))
    state.clock += 0.1
    recorder.take(state, window, Area(0, 0, 96, 32))
    assert not recorder.busy and state.notice is not None and "size changed from (64, 32) to (96, 32)" in state.notice.text
    (path,) = tmp_path.iterdir()
    assert len(levels_of(path)) == 1
