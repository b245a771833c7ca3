"""What a drag over the picture comes to, frame by frame, without a window."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from imgui_bundle import imgui

from blackhole_gl.app import mouse
from blackhole_gl.app.mouse import Mouse

LEFT, RIGHT = imgui.MouseButton_.left, imgui.MouseButton_.right


class Frames:
    """The library's mouse: what is held, what was pressed in this frame, and how far it came."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch):
        self.held: set[imgui.MouseButton_] = set()
        self.pressed: set[imgui.MouseButton_] = set()
        self.mouse, self._delta = Mouse(), (0.0, 0.0)
        library = SimpleNamespace(
            MouseButton_=imgui.MouseButton_,
            get_io=lambda: SimpleNamespace(want_capture_mouse=False, mouse_delta=SimpleNamespace(x=self._delta[0], y=self._delta[1]), mouse_wheel=0.0),
            is_mouse_down=lambda button: button in self.held,
            is_mouse_clicked=lambda button: button in self.pressed,
        )
        monkeypatch.setattr(mouse, "imgui", library)

    def frame(self, held: set[imgui.MouseButton_], delta: tuple[float, float]) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ways with the left and the right button, of a picture 100 high."""
        self.pressed, self.held, self._delta = held - self.held, held, delta
        left, right, _, _ = self.mouse.poll(100.0)
        return left, right


def test_a_flick_that_is_over_in_the_next_frame_is_a_drag(monkeypatch: pytest.MonkeyPatch) -> None:
    """What came in the frame in which the button is let go was lost: all of a flick, where frames are slow."""
    frames = Frames(monkeypatch)
    assert frames.frame({LEFT}, (500.0, 0.0)) == ((0.0, 0.0), (0.0, 0.0)), "the mouse may have come from anywhere"
    assert frames.frame(set(), (50.0, -20.0)) == ((0.5, -0.2), (0.0, 0.0))
    assert not frames.mouse.drags
    assert frames.frame(set(), (50.0, 0.0)) == ((0.0, 0.0), (0.0, 0.0))


def test_another_button_pressed_as_one_is_let_go_begins_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    frames = Frames(monkeypatch)
    frames.frame({RIGHT}, (0.0, 0.0))
    assert frames.mouse.looks
    assert frames.frame({LEFT}, (10.0, 0.0)) == ((0.0, 0.0), (0.1, 0.0))
    assert not frames.mouse.looks and not frames.mouse.drags, "it has not moved yet"
    assert frames.frame({LEFT}, (0.0, 30.0)) == ((0.0, 0.3), (0.0, 0.0))
    assert frames.mouse.drags
