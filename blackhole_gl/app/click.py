"""A click on the picture: a press and a release in one place. What moves between them is a drag, which orbits."""

from __future__ import annotations

import math

from imgui_bundle import hello_imgui, imgui

from . import theme

_STILL = 3.0  # in units of a 96 dpi screen: a click during which the mouse moves farther is a drag

Corner = tuple[float, float]


class Click:
    """Remembers where the left button was pressed."""

    def __init__(self) -> None:
        self._pressed: Corner | None = None

    def forget(self) -> None:
        """What was pressed is no click any more."""
        self._pressed = None

    def poll(self, left_top: Corner, size: Corner) -> Corner | None:
        """The place that was clicked in this frame, the picture's width and height counted 0…1 from its bottom left. Call once in each frame.

        Args:
            left_top, size: of the picture, in imgui's units.
        """
        io = imgui.get_io()
        here = io.mouse_pos.x, io.mouse_pos.y
        if imgui.is_mouse_clicked(imgui.MouseButton_.left):
            self._pressed = None if io.want_capture_mouse else here
        if self._pressed is None or not imgui.is_mouse_released(imgui.MouseButton_.left):
            return None
        still = math.dist(self._pressed, here) <= _STILL * hello_imgui.em_size() / theme.FONT_SIZE
        self._pressed = None
        x, y = (here[0] - left_top[0]) / size[0], 1.0 - (here[1] - left_top[1]) / size[1]
        return (x, y) if still and 0.0 <= x < 1.0 and 0.0 < y <= 1.0 else None
