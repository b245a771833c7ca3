"""GLFW's own window under Hello ImGui's, and what it tells of its keyboard."""

from __future__ import annotations

from typing import Any

from imgui_bundle import hello_imgui  # noqa: F401  # before glfw: on Linux the first GLFW that is loaded is the one used

# isort: split
import glfw


def handle() -> Any:
    """What GLFW's calls take for the window in use."""
    from imgui_bundle.glfw_utils import glfw_window_hello_imgui

    return glfw_window_hello_imgui()


def is_minimised() -> bool:
    """Whether nothing of the window is on the screen."""
    return bool(glfw.get_window_attrib(handle(), glfw.ICONIFIED))


def key_name(key: int) -> str | None:
    """What the keyboard's layout writes by GLFW's `key`; None for keys that write nothing."""
    return glfw.get_key_name(key, 0) if glfw.get_key_scancode(key) >= 0 else None  # asked for a key that the keyboard lacks, it complains on the terminal


def is_key_down(key: int) -> bool:
    """Whether GLFW's `key` is held in the window."""
    return glfw.get_key(handle(), key) == glfw.PRESS
