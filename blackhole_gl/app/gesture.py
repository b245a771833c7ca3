"""When the hand is at something, which counts as one step however many values it passes through."""

from __future__ import annotations

from imgui_bundle import imgui

from ..scene import Scene
from .commands import Hand

_PAUSE_S = 0.35  # between the notches of a turning wheel, or the clicks of a double click
_BUTTONS = (imgui.MouseButton_.left, imgui.MouseButton_.right, imgui.MouseButton_.middle)


class Gesture:
    """Remembers what the hand is at, and until when it may go on with it."""

    def __init__(self) -> None:
        self._until = 0.0
        self._drags = False

    def lasts(self, hand: Hand, now: float) -> bool:
        """Whether a gesture goes on at `now`, in seconds. Call once in each frame."""
        presses = imgui.is_any_item_active() or imgui.is_any_mouse_down()
        self._drags = presses and (self._drags or any(imgui.is_mouse_dragging(button) for button in _BUTTONS))
        if self._drags or hand.held or any((*hand.stick, *hand.look)):
            self._until = now  # what ends with these ends with them
            return True
        if presses or hand.wheel:
            self._until = now + _PAUSE_S
        return now < self._until


class Editing:
    """Whether a slider is being dragged: from its first change until the button is let go.

    Args:
        scene: the one shown first.
    """

    def __init__(self, scene: Scene):
        self._lasts = False
        self._scene = scene

    def lasts(self, scene: Scene) -> bool:
        """Whether it goes on in the frame that shows `scene`. Call once in each frame."""
        if not imgui.is_mouse_down(imgui.MouseButton_.left):
            self._lasts = False
        elif imgui.is_any_item_active() and scene is not self._scene:
            self._lasts = True
        self._scene = scene
        return self._lasts
