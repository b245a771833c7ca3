"""The commands that bring scenes in and out: by file, by the system's dialog, by the clipboard."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from imgui_bundle import imgui

from . import file_dialog, scene_files
from .file_dialog import FileDialog
from .state import WindowState

NAMES = ("save", "save_as", "open", "copy", "paste")


def do(action: str, state: WindowState, dialog: FileDialog) -> None:
    """Does the action of `NAMES`."""
    if action == "save":
        scene_files.save(state)
    elif action == "save_as":
        _ask(state, dialog.ask_save, "Save the scene", file_dialog.TOML, scene_files.save_chosen)
    elif action == "open":
        _ask(state, dialog.ask_open, "Open a scene", file_dialog.SCENES, scene_files.open_chosen)
    elif action == "copy":
        imgui.set_clipboard_text(scene_files.text_of(state))
    else:
        scene_files.take(state, imgui.get_clipboard_text())


def _ask(state: WindowState, ask: Callable[..., None], title: str, kinds: Sequence[str], then: Callable[[WindowState, Path], None]) -> None:
    if file_dialog.is_there():
        ask(title, scene_files.path_of(state.file), kinds, lambda path: then(state, path))
    else:
        state.say(f"{file_dialog.MISSING} Type the path in the panel's file field, and press Save or Load there.")
