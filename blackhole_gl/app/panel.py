"""The panel beside the picture, made from the scene's fields."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache

from imgui_bundle import ImVec4, hello_imgui, imgui

from .. import planning
from ..physics.space_time import is_field
from ..scene import Scene, catalogue, fields, instances, presets, sections
from ..scene.schema import Field
from . import commands, scene_files, sought, theme, widgets
from .camera_control import range_in
from .instance_groups import InstanceGroups
from .pickers import Pickers
from .rows import columns, wrapped_tooltip
from .state import WindowState
from .thumbnails import Thumbnails
from .words import WORDS

_TITLES = {
    "hole": "Black hole", "source": "Real object", "camera": "Camera", "rays": "Light rays", "disk": "Disk", "polarization": "Polarization",
    "sky": "Sky", "post": "Image", "playback": "Playback",
}  # fmt: skip
_ART = ("Art", "What makes a picture and no physics names: as you like it.")
_OF_AN_OPTION = {
    "camera.fov_deg": ("camera.projection", "perspective"),
    "camera.eye_separation": ("camera.projection", "stereo"),
    "camera.dome_tilt_deg": ("camera.projection", "dome"),
    "camera.fall_from": ("camera.observer", "fall"),
    "post.beam_uas": ("post.beam", True),
    "post.key_light": ("post.exposure_mode", "automatic"),
}
"""What has a bearing on the picture with one option of a choice alone → the choice and the option."""

_NEAR_BY = frozenset(f"camera.{name}" for name in ("fov_deg", "velocity_right", "velocity_up", "velocity_forward", "aberration", "doppler_colour", "beaming"))
"""What a camera has that is not infinitely far."""

_OPEN_AT_START = ("hole", "camera", "disk")


class Panel:
    """The panel's own memory: the list of presets, the text of its filter, what is about to be added."""

    def __init__(self) -> None:
        self._pickers = Pickers()
        self._filter = ""
        self._instances = InstanceGroups()
        self._active: tuple[Scene, Mapping[str, list[Field]]] | None = None
        self._art: tuple[Scene, str] | None = None

    def draw(self, state: WindowState, reasons: Sequence[str], warnings: Sequence[str], thumbnails: Thumbnails) -> None:
        """Draws the panel into the current window.

        Args:
            reasons: why rays are traced as they are, a phrase each.
            warnings: what they make worse than the scene asks, a sentence each.
        """
        self._pickers.draw(state, thumbnails)
        _steps(state)
        _files(state)
        _remarks(self._departing(state.scene), warnings)
        imgui.separator()
        imgui.set_next_item_width(-1.0)
        _, self._filter = imgui.input_text_with_hint("##filter", "Find a value", self._filter)
        wanted = self._filter.strip().lower()
        for section, items in self._active_rows(state.scene).items():
            if shown := [item for item in items if _matches(item, wanted)]:
                is_open = _section(section, shown, state, thumbnails, forced_open=bool(wanted))
                if is_open and section == "rays":
                    _line("Now: " + ("; ".join(reasons) or "…"), theme.DIM, f"Flat frame: {WORDS['flat frame']}")
        self._instances.draw(state, lambda item: _matches(item, wanted), lambda name, items: _table(name, items, state, thumbnails), forced_open=bool(wanted))

    def shown_fields(self, scene: Scene) -> list[Field]:
        """The fields that `scene` has rows for, whatever the filter."""
        own = [item for items in self._active_rows(scene).values() for item in items]
        return [*own, *(item for key, item in scene.fields().items() if instances.place_of(key) is not None)]

    def _active_rows(self, scene: Scene) -> Mapping[str, list[Field]]:
        """The rows of each section that have a bearing on `scene`: looked for once, as a panel draws the same ones for minutes."""
        if self._active is None or self._active[0] is not scene:
            self._active = scene, {section: [item for item in items if _is_active(item, scene)] for section, items in _sections().items()}
        return self._active[1]

    def _departing(self, scene: Scene) -> str:
        """The names of the values that make `scene` art, looked for once as its rows are."""
        if self._art is None or self._art[0] is not scene:
            self._art = scene, ", ".join(widgets.label_of(item.key).lower() for item in scene.fields().values() if widgets.departs(item, scene.get(item.key)))
        return self._art[1]

    def clear_filter(self) -> None:
        """Has every row shown."""
        self._filter = ""


def _steps(state: WindowState) -> None:
    """The buttons that go back: a step, a step forward again, all the way."""
    width = (imgui.get_content_region_avail().x - 2.0 * imgui.get_style().item_spacing.x) / 3.0
    buttons = {
        "Undo": (bool(state.history.past), WindowState.undo, "Takes the last step back. Time, which runs by itself, goes on."),
        "Redo": (bool(state.history.future), WindowState.redo, "Takes the step again that was last undone."),
        "Reset all": (state.scene != state.home, commands.reset_all, "Sets everything, the camera too, back to the presets in force or the opened file."),
    }
    for name, (enabled, command, help) in buttons.items():
        imgui.begin_disabled(not enabled)
        if imgui.button(name, (width, 0.0)):
            command(state)
        imgui.end_disabled()
        wrapped_tooltip(help)
        imgui.same_line()
    imgui.new_line()


def _files(state: WindowState) -> None:
    width = (imgui.get_content_region_avail().x - 3.0 * imgui.get_style().item_spacing.x) / 4.0
    imgui.set_next_item_width(2.0 * width + imgui.get_style().item_spacing.x)
    edited, state.file = imgui.input_text("##file", state.file)
    if edited:
        state.replace_file = ""
    wrapped_tooltip(f"A preset (.toml) or a picture saved by this program (.png, .jpg). A bare name lies in {presets.user_presets_dir()}.")
    imgui.same_line()
    if imgui.button("Save", (width, 0.0)):
        scene_files.save(state)
    imgui.same_line()
    if imgui.button("Load", (width, 0.0)):
        scene_files.load(state)
    half = 2.0 * width + imgui.get_style().item_spacing.x
    if imgui.button("Copy as TOML", (half, 0.0)):
        imgui.set_clipboard_text(scene_files.text_of(state))
    imgui.same_line()
    if imgui.button("Paste TOML", (half, 0.0)):
        scene_files.take(state, imgui.get_clipboard_text())


@cache
def _sections() -> Mapping[str, list[Field]]:
    """The rows of each section: what physics names, then art, then the plug-ins' own."""
    found: dict[str, list[Field]] = {}
    for key, item in fields().items():
        found.setdefault(key.split(".", 1)[0], []).append(item)
    return {section: sorted(items, key=lambda item: (_plug_in_of(item) is not None, item.art)) for section, items in found.items()}


def _section(section: str, items: list[Field], state: WindowState, thumbnails: Thumbnails, *, forced_open: bool) -> bool:
    """Draws one section; True when it is open."""
    if forced_open:
        imgui.set_next_item_open(True)
    else:
        imgui.set_next_item_open(section in _OPEN_AT_START, imgui.Cond_.first_use_ever.value)
        sought.open_group(state, [item.key for item in items])
    is_open = imgui.collapsing_header(f"{_TITLES.get(section, section.capitalize())}##{section}")
    wrapped_tooltip(sections.SECTIONS[section].__doc__ or "")
    if not is_open:
        return False
    _table(f"values of {section}", items, state, thumbnails)
    return True


def _table(name: str, items: Iterable[Field], state: WindowState, thumbnails: Thumbnails) -> None:
    """A row for each of `items`, art under that heading and those of a plug-in under its name."""
    if not imgui.begin_table(name, 2):
        return
    columns()
    heading, scene = None, state.scene  # as it was: another kind picked in one row has not the values of the next
    for item in items:
        before, heading = heading, _heading(item)
        if heading is not None and heading != before:
            _subheading(*heading)
        in_force = state.in_force(item)
        ranged = range_in(scene, item if in_force == item.default else replace(item, default=in_force))
        widgets.row(ranged, scene.get(item.key), state.change, planning.unfit_options(item.key, scene), thumbnails.draw)
        sought.mark(state, item.key)
    imgui.end_table()


def _heading(item: Field) -> tuple[str, str] | None:
    """What stands over the rows of `item` and its like, and what that means; None for what physics names."""
    plug_in = _plug_in_of(item)
    if plug_in is not None:
        return plug_in.label, plug_in.summary
    return _ART if item.art else None


def _subheading(title: str, help: str) -> None:
    imgui.table_next_row()
    imgui.table_next_column()
    imgui.dummy((0.5 * hello_imgui.em_size(), 0.0))
    imgui.same_line(0.0, 0.35 * hello_imgui.em_size())
    imgui.text_colored(theme.ACCENT, title)
    wrapped_tooltip(help)


def _plug_in_of(item: Field) -> catalogue.PlugIn | None:
    """The plug-in that declares `item`, or None for the scene's own and for those of instances."""
    return _plug_in_by_key().get(item.key)


@cache
def _plug_in_by_key() -> Mapping[str, catalogue.PlugIn]:
    return {key: plug_in for slot in catalogue.SLOTS for plug_in in catalogue.plug_ins(slot).values() for key in plug_in.parameters}


def _is_active(item: Field, scene: Scene) -> bool:
    """Whether `item` has any bearing on `scene`: those of a near or a far camera, of a hole or a field, of an option that is chosen, and those of plug-ins
    that take part."""
    if item.key == "camera.field_m":
        return math.isinf(scene.camera.distance)
    if item.key in _NEAR_BY and math.isinf(scene.camera.distance):
        return False
    if item.key in _OF_AN_OPTION:
        choice, option = _OF_AN_OPTION[item.key]
        return scene.get(choice) == option
    if item.key.startswith(("hole.", "rays.field_")):
        return is_field(scene) != item.key.startswith("hole.")
    parts = item.key.split(".")
    if len(parts) < 3:
        return True
    section, plug_in = parts[0], parts[1]
    switch = fields().get(f"{section}.{plug_in}")
    if switch is not None:
        return bool(scene.get(switch.key))
    return any(other.kind == "choice" and key.startswith(f"{section}.") and scene.get(key) == plug_in for key, other in fields().items())


def _matches(item: Field, wanted: str) -> bool:
    return wanted in item.key.lower() or wanted in widgets.label_of(item.key).lower()


def _remarks(departing: str, warnings: Sequence[str]) -> None:
    """A line that says what makes this picture worse than asked for, and which values, named in `departing`, make it art."""
    remarks = [warning[:1].upper() + warning[1:] for warning in warnings] + ["Departs from physics: " + departing] * bool(departing)
    _line(". ".join(remarks) or "Physics throughout", theme.DEPARTS if remarks else theme.DIM)


def _line(text: str, colour: ImVec4, more: str = "") -> None:
    """A remark that takes one line whatever it says, so that nothing below it moves while a value is dragged; a tooltip has all of it."""
    imgui.text_colored(colour, text)
    wrapped_tooltip(f"{text}\n{more}".strip())
