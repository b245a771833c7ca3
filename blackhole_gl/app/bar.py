"""The slim bar above picture and panel: the commands a newcomer looks for, and the scene's time.

Items are named by command, ``###bar pause``; the time is ``##time``.
"""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import hello_imgui, imgui

from . import theme
from .keys import ACTIONS, Bindings, shown
from .state import WindowState

_HEIGHT_EM = 2.1
_PADDING_EM = 0.35
_TIME_EM = 9.0
_TIME_SPEED = 0.1  # r_s/c for a pixel of drag
_HELP = {action.name: action.help for action in ACTIONS}
_BUTTONS = (
    ("open", "Open …"),
    ("picture_window", "Picture …"),
    ("record", "Record"),
    ("values", "Values"),
    ("paths", "Paths of light"),
    ("sides", "Side by side"),
    ("timeline", "Flight"),
    ("search", "Search …"),
    ("help", "Help"),
    ("full_screen", "Full screen"),
)


def toolbar(draw: Callable[[], None]) -> hello_imgui.EdgeToolbar:
    """The bar as the runner takes it."""
    options = hello_imgui.EdgeToolbarOptions(_HEIGHT_EM, (_PADDING_EM, _PADDING_EM), theme.BAR)
    return hello_imgui.EdgeToolbar(draw, options)


def draw(state: WindowState, bindings: Bindings, do: Callable[[str], None]) -> None:
    """Draws its contents. `do`: does what the key of an action does."""
    _button("pause", "Go on" if state.paused else "Pause", bindings, do)
    imgui.same_line()
    _time(state)
    for action, label in _BUTTONS:
        imgui.same_line()
        _button(action, "Stop recording" if action == "record" and state.recording else label, bindings, do)


def _button(action: str, label: str, bindings: Bindings, do: Callable[[str], None]) -> None:
    if imgui.button(f"{label}###bar {action}"):
        do(action)
    keys = shown(bindings[action])
    imgui.set_item_tooltip(f"{_HELP[action]}: {keys}" if keys else _HELP[action])


def _time(state: WindowState) -> None:
    imgui.set_next_item_width(_TIME_EM * hello_imgui.em_size())
    edited, time = imgui.drag_float("##time", state.time, _TIME_SPEED, 0.0, 0.0, "time %.2f r_s/c")
    if edited:
        state.time = float(f"{time:.7g}")  # the widget works in float32
    imgui.set_item_tooltip("Scene time. Drag to move through it, click to type one.")
