"""What ESC puts away."""

from __future__ import annotations

from imgui_bundle import imgui

from . import widgets
from .state import WindowState

_PUT_AWAY = "panel_keys", "show_search", "show_picture_window", "show_help"
"""Switches of the state, the uppermost first; then comes what is picked, and full screen is the last."""


class Escape:
    """ESC puts away the uppermost thing that can be put away; a field that is typed in leaves by itself."""

    def __init__(self) -> None:
        self._had_popup = False

    def poll(self, state: WindowState) -> None:
        """Does so where it is pressed. Call once in each frame."""
        had_popup, self._had_popup = self._had_popup, widgets.list_is_open()
        if not imgui.is_key_pressed(imgui.Key.escape, False) or imgui.get_io().want_text_input:
            return
        if had_popup or self._had_popup:  # where keys work the panel, imgui has closed it
            imgui.internal.close_popups_except_modals()
            return
        uppermost = next((name for name in _PUT_AWAY if getattr(state, name)), None)
        if uppermost is not None:
            setattr(state, uppermost, False)
        elif state.picked:
            state.pick = ""
        else:
            state.full_screen = False
