"""What the mouse's buttons and wheel do over the picture."""

from __future__ import annotations

from imgui_bundle import imgui

_BUTTONS = (imgui.MouseButton_.left, imgui.MouseButton_.right, imgui.MouseButton_.middle)
Way = tuple[float, float]
"""Right and down, over the picture's height."""


class Mouse:
    """Remembers which button began its drag over the picture: wherever it goes from there, the drag is the picture's."""

    def __init__(self) -> None:
        self._button: imgui.MouseButton_ | None = None
        self._moved = False

    @property
    def drags(self) -> bool:
        """Whether the picture is being dragged, by whichever button: one that is pressed and let go in one place moves nothing."""
        return self._button is not None and self._moved

    @property
    def looks(self) -> bool:
        """Whether the right button is held from the picture on, moved or not."""
        return self._button == imgui.MouseButton_.right

    def poll(self, height: float) -> tuple[Way, Way, Way, float]:
        """The ways dragged in this frame with the left, the right and the middle button, and the wheel's notches. Call once in each frame.

        Args:
            height: of the picture, in imgui's units.
        """
        io = imgui.get_io()
        over_picture = not io.want_capture_mouse
        dragged = self._button  # also up to where it is let go: at a few frames a second a flick of the hand begins in one and is over in the next
        if dragged is not None and not imgui.is_mouse_down(dragged):
            self._button = None
        begun = next((button for button in _BUTTONS if imgui.is_mouse_clicked(button)), None) if over_picture and self._button is None else None
        if begun is not None:
            self._button, self._moved = begun, False
        # In the frame of the click the mouse may have come from anywhere.
        moves = dragged is not None and height >= 1.0
        way = (io.mouse_delta.x / height, io.mouse_delta.y / height) if moves else (0.0, 0.0)
        self._moved |= begun is None and any(way)
        left, right, middle = (way if button == dragged else (0.0, 0.0) for button in _BUTTONS)
        return left, right, middle, io.mouse_wheel if over_picture else 0.0
