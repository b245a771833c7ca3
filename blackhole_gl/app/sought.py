"""The setting that a search has found, shown in the panel: its group opens, the panel scrolls to it, and its row is marked for a while."""

from __future__ import annotations

from collections.abc import Iterable

from imgui_bundle import imgui

from . import theme
from .state import Sought, WindowState

_MARKED_S = 4.0


def seek(state: WindowState, key: str, *, reveal: bool = True) -> None:
    """Has the panel show the setting `key`.

    Args:
        reveal: where the panel is put away, have it come back; else it shows the setting whenever it does.
    """
    state.sought, state.show_panel = Sought(key), state.show_panel or reveal


def open_group(state: WindowState, keys: Iterable[str]) -> None:
    """Opens the group that is drawn next, if what is sought is among its `keys`."""
    if state.sought is not None and state.sought.until is None and state.sought.key in keys:
        imgui.set_next_item_open(True)


def mark(state: WindowState, key: str) -> None:
    """Marks the row of the table that was just drawn, if it is that of what is sought."""
    found = state.sought
    if found is None or found.key != key:
        return
    now = imgui.get_time()
    if found.until is None:
        imgui.set_scroll_here_y(0.4)
        state.sought = found = Sought(key, now + _MARKED_S)
    if found.until is not None and now > found.until:
        state.sought = None
        return
    colour = theme.ACCENT
    imgui.table_set_bg_color(imgui.TableBgTarget_.row_bg1.value, imgui.color_convert_float4_to_u32((colour.x, colour.y, colour.z, 0.35)))
