"""Full screen on whatever monitor the window is on, and back to where it was."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from imgui_bundle import hello_imgui  # before glfw: on Linux the first GLFW that is loaded is the one used

# isort: split
import glfw

_NO_MONITOR: Any = None  # glfw's stubs do not know that a window may be on none


@dataclass(frozen=True)
class Rectangle:
    """A part of the desktop, in screen coordinates."""

    x: int
    y: int
    width: int
    height: int

    def overlap(self, other: Rectangle) -> int:
        """The area that both cover."""
        across = min(self.x + self.width, other.x + other.width) - max(self.x, other.x)
        down = min(self.y + self.height, other.y + other.height) - max(self.y, other.y)
        return max(across, 0) * max(down, 0)


def most_covered(window: Rectangle, monitors: Sequence[Rectangle]) -> int:
    """Index of the monitor that shows the largest part of `window`; the first of equals."""
    return max(range(len(monitors)), key=lambda index: window.overlap(monitors[index]))


class FullScreen:
    """Remembers where a window was.

    Args:
        window: glfw's window.
    """

    def __init__(self, window: Any):
        self._window = window
        self._before: Rectangle | None = None

    @property
    def size(self) -> tuple[int, int]:
        """Of the window that is no full screen, in units of a 96 dpi screen."""
        width, height = (self._before.width, self._before.height) if self._before else glfw.get_window_size(self._window)
        scale = hello_imgui.dpi_window_size_factor()
        return round(width / scale), round(height / scale)

    def set(self, on: bool) -> None:
        """Fills the monitor that the window is on, or puts the window back. Without a monitor nothing happens."""
        before = self._before
        if on == (before is not None):
            return
        if before is not None:
            self._before = None
            glfw.set_window_monitor(self._window, _NO_MONITOR, before.x, before.y, before.width, before.height, glfw.DONT_CARE)
            return
        monitors = glfw.get_monitors()
        if not monitors:
            return
        self._before = Rectangle(*glfw.get_window_pos(self._window), *glfw.get_window_size(self._window))
        monitor = monitors[most_covered(self._before, [_area(item) for item in monitors])]
        mode = glfw.get_video_mode(monitor)
        glfw.set_window_monitor(self._window, monitor, 0, 0, mode.size.width, mode.size.height, mode.refresh_rate)


def _area(monitor: Any) -> Rectangle:
    mode = glfw.get_video_mode(monitor)
    return Rectangle(*glfw.get_monitor_pos(monitor), mode.size.width, mode.size.height)
