"""The pickers of presets, which say what the scene *is*: a preset that it has left is called modified, whoever or whatever changed it."""

from __future__ import annotations

from collections.abc import Mapping

from imgui_bundle import hello_imgui, imgui

from ..scene import Scene, presets
from . import preset_switch
from .rows import columns, wrapped_tooltip
from .state import WindowState
from .thumbnails import ROW_EM, Thumbnails

_UNPICKED = "the scene's own"
_NO_SCENE = "none"
_SCENE = "Scene"
_HELP = "No preset was picked here. Other presets, an opened file or values set by hand say what one would."

_HEADINGS = {"quality": "Quality of the picture", "steps": "Steps by hand", "scene": "Whole scenes", presets.USER_GROUP: "Your own"}


class Pickers:
    """The list of presets, and what those in force say."""

    def __init__(self) -> None:
        self._listed = presets.available()
        self._thumbnails: Thumbnails
        self._layers: dict[str, presets.Preset] = {}
        self._seen: tuple[Scene, Mapping[str, str]] | None = None
        self._remarks: dict[str, str] = {}

    def draw(self, state: WindowState, thumbnails: Thumbnails) -> None:
        """Draws a table with a row for each picker."""
        self._look_again(state)
        self._thumbnails = thumbnails
        if not imgui.begin_table("pickers", 2):
            return
        columns()
        for label, groups in preset_switch.PICKERS.items():
            self._picker(label, groups, state)
        if any(info.group in preset_switch.WHOLE for info in self._listed):
            self._picker(_SCENE, preset_switch.WHOLE, state)
        imgui.end_table()

    def _look_again(self, state: WindowState) -> None:
        """Brings the list up to date with what is in force, and the remarks with the scene."""
        if self._seen is not None and self._seen[0] is state.scene and self._seen[1] == state.chosen:
            return
        if self._seen is None or self._seen[1] != state.chosen:
            if {(group, name) for group, name in state.chosen.items()} - {(info.group, info.name) for info in self._listed}:
                self._listed = presets.available()  # one has just been saved
            paths = {info.name: info.path for info in reversed(self._listed)}
            self._layers = {group: presets.read(paths[name], any_file=True) for group, name in state.chosen.items() if name in paths}
        self._seen = state.scene, dict(state.chosen)
        self._remarks = {group: preset_switch.remark(keys) for group, keys in preset_switch.left(state.scene, self._layers).items()}

    def _picker(self, label: str, groups: tuple[str, ...], state: WindowState) -> None:
        current = next((info for info in self._listed if info.group in groups and state.chosen.get(info.group) == info.name), None)
        imgui.table_next_row()
        imgui.table_next_column()
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted(label)
        imgui.table_next_column()
        imgui.set_next_item_width(-1.0)
        shown = current.title + self._remarks.get(current.group, "") if current else unpicked(label)
        if not imgui.begin_combo(f"##{label} preset", shown, imgui.ComboFlags_.height_large.value):
            if current:
                self._tooltip(current, f"{shown}\n")
            else:
                wrapped_tooltip(_HELP)
            return
        if imgui.is_window_appearing():
            self._listed = presets.available()
        above = None
        for info in self._listed:
            if info.group not in groups:
                continue
            if (named := heading(info)) != above and named:
                imgui.separator_text(named)
            above = named
            if self._row(info, info == current):
                preset_switch.pick(state, info.group, info.name)
        imgui.end_combo()

    def _row(self, info: presets.PresetInfo, is_current: bool) -> bool:
        """Draws the row of a preset; whether it was clicked."""
        height, on_picture = 0.0, False
        if self._thumbnails.draw(info.name, ROW_EM):
            on_picture = imgui.is_item_clicked()
            self._tooltip(info)
            imgui.same_line()
            height = ROW_EM * hello_imgui.em_size()
        imgui.push_style_var(imgui.StyleVar_.selectable_text_align, (0.0, 0.5))
        clicked, _ = imgui.selectable(f"{info.title}##{info.name}", is_current, 0, (0.0, height))
        imgui.pop_style_var()
        self._tooltip(info)
        if on_picture:
            imgui.close_current_popup()
        return clicked or on_picture

    def _tooltip(self, info: presets.PresetInfo, before: str = "") -> None:
        wrapped_tooltip(before + summary(info), lambda: self._thumbnails.draw(info.name))


def unpicked(label: str) -> str:
    """What the picker `label` shows where no preset was picked."""
    return _NO_SCENE if label == _SCENE else _UNPICKED


def heading(info: presets.PresetInfo) -> str:
    """What a picker writes over `info` and its like; empty where it writes nothing."""
    if info.group == "physics":
        return "Art" if info.is_art else "Physics"
    return _HEADINGS.get(info.group, "")


def summary(info: presets.PresetInfo) -> str:
    """What a preset is, and whether it takes the camera along."""
    return " ".join(part for part in (info.description, "Moves the camera." if info.moves_camera else "") if part)
