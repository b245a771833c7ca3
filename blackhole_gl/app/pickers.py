"""The pickers of presets, which say what the scene *is*: a preset that it has left is called modified, whoever or whatever changed it."""

from __future__ import annotations

from collections.abc import Mapping

from imgui_bundle import imgui

from ..scene import Scene, presets
from . import preset_switch
from .rows import columns, wrapped_tooltip
from .state import WindowState


class Pickers:
    """The list of presets, and what those in force say."""

    def __init__(self) -> None:
        self._listed = presets.available()
        self._layers: dict[str, presets.Preset] = {}
        self._seen: tuple[Scene, Mapping[str, str]] | None = None
        self._remarks: dict[str, str] = {}

    def draw(self, state: WindowState) -> None:
        """Draws a table with a row for each picker."""
        self._look_again(state)
        if not imgui.begin_table("pickers", 2):
            return
        columns()
        for label, groups in preset_switch.PICKERS.items():
            self._picker(label, groups, state)
        if any(info.group in preset_switch.WHOLE for info in self._listed):
            self._picker("Scene", preset_switch.WHOLE, state)
        imgui.end_table()

    def _look_again(self, state: WindowState) -> None:
        """Brings the list up to date with what is in force, and the remarks with the scene."""
        if self._seen is not None and self._seen[0] is state.scene and self._seen[1] == state.chosen:
            return
        if self._seen is None or self._seen[1] != state.chosen:
            if {(group, name) for group, name in state.chosen.items()} - {(info.group, info.name) for info in self._listed}:
                self._listed = presets.available()  # one has just been saved
            paths = {info.name: info.path for info in reversed(self._listed)}
            self._layers = {group: presets.read(paths[name]) for group, name in state.chosen.items() if name in paths}
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
        shown = current.title + self._remarks.get(current.group, "") if current else "–"
        if not imgui.begin_combo(f"##{label} preset", shown, imgui.ComboFlags_.height_large.value):
            if current:
                wrapped_tooltip(f"{shown}\n{summary(current)}")
            return
        if imgui.is_window_appearing():
            self._listed = presets.available()
        listed = [info for info in self._listed if info.group in groups]
        for before, info in zip((None, *listed), listed):
            if before is not None and before.group != info.group:
                imgui.separator()
            clicked, _ = imgui.selectable(f"{info.title}##{info.name}", info == current)
            wrapped_tooltip(summary(info))
            if clicked:
                preset_switch.pick(state, info.group, info.name)
        imgui.end_combo()


def summary(info: presets.PresetInfo) -> str:
    """What a preset is, and whether it takes the camera along."""
    return " ".join(part for part in (info.description, "Moves the camera." if info.moves_camera else "") if part)
