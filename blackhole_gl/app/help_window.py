"""The window that lists keys and mouse, made from the bindings, and says what words mean."""

from __future__ import annotations

from pathlib import Path

from imgui_bundle import hello_imgui, imgui

from ..output.files import write_whole
from . import theme, tool_window
from .keys import ACTIONS, Bindings, shown, template
from .state import WindowState
from .words import WORDS

_WIDTH_EM = 46.0
_MOUSE = (
    ("Drag", "Orbit"),
    ("Wheel, two fingers", "Move closer or away"),
    ("Middle drag", "Move closer (up) or away (down)"),
    ("Right drag", "Look around; with W, A, S, D, Q, E fly"),
    ("Gamepad", "Left stick and triggers fly, the right stick looks"),
    ("Click on a thing", "Pick it: the panel shows it, DELETE removes it"),
    ("Click, with the path view open", "Show the ray of that pixel"),
    ("Drag the divider", "More of one side"),
    ("Double-click a value", "Back to the preset's"),
    ("Right-click a name", "More ways to reset"),
    ("Ctrl+click a slider", "Type the value"),
    ("Click an orange dot", "Back to physics"),
    ("Drag or click the time", "Set the scene's time"),
    ("Drag the panel's edge", "Make the panel wider or narrower"),
    ("ESC", "Leave a field, a list, a window, the panel's keys, what is picked, full screen"),
)


def draw(state: WindowState, bindings: Bindings, key_file: Path) -> None:
    """Draws the window when it is wanted; its close button puts it away.

    Args:
        key_file: where the user's own keys are read from.
    """
    if not state.show_help:
        return
    em = hello_imgui.em_size()
    tool_window.appears_in_the_middle()
    screen = imgui.get_main_viewport().size
    width = min(_WIDTH_EM * em, 0.95 * screen.x)
    imgui.set_next_window_size_constraints((width, 0.0), (width, screen.y))
    state.show_help = tool_window.draw("Help", lambda: _contents(state, bindings, key_file), imgui.WindowFlags_.always_auto_resize)


def _contents(state: WindowState, bindings: Bindings, key_file: Path) -> None:
    _table("keys", [(shown(bindings[action.name]) or "no key", action.help) for action in ACTIONS])
    imgui.separator()
    _table("mouse", _MOUSE)
    imgui.separator()
    _table("words", tuple(WORDS.items()))
    imgui.separator()
    _file(state, key_file)


def _table(name: str, rows: list[tuple[str, str]] | tuple[tuple[str, str], ...]) -> None:
    if imgui.begin_table(name, 2):
        imgui.table_setup_column("left", imgui.TableColumnFlags_.width_fixed.value)
        imgui.table_setup_column("right", imgui.TableColumnFlags_.width_stretch.value)
        for left, right in rows:
            imgui.table_next_row()
            imgui.table_next_column()
            imgui.text_colored(theme.ACCENT, left)
            imgui.table_next_column()
            imgui.text_wrapped(right)
        imgui.end_table()


def _file(state: WindowState, key_file: Path) -> None:
    imgui.text_colored(theme.DIM, f"Keys can be changed in\n{key_file}")
    if key_file.exists() or not imgui.button("Write that file with the keys as they are"):
        return
    try:
        write_whole(key_file, template().encode("utf-8"))
    except OSError as error:
        state.complain(f"{key_file}: cannot be written: {error.strerror or error}")
        return
    state.say(f"Wrote {key_file}; it is read when the viewer starts.")
