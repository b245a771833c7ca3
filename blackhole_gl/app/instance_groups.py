"""The scene's named instances in the panel: a group for each, with its values, a new name, a copy and a way out, and a line that makes another.

Items are named by key: ``###things.moon`` (the group), ``##name of things.moon``, ``Duplicate##things.moon``, ``Remove##things.moon``;
``##kind of new things``, ``##name of new things``, ``Add##things``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping

from imgui_bundle import imgui

from ..scene import Instance, Scene, catalogue, instances, met
from ..scene.catalogue import KIND, PlugIn
from ..scene.schema import Field, Value, number_of
from . import sought, text_fields, theme
from .state import WindowState

_TITLES = {"things": "Things", "media": "Media"}
_NEXT_DEG = 30.0  # along its orbit, from a thing to its copy
_APART = 2.5  # of its reach, likewise, where it rests

Shown = Callable[[Field], bool]
Table = Callable[[str, Iterable[Field]], None]
"""Draws a table of that name with a row for each field."""


class InstanceGroups:
    """What the user is about to add, and which groups are to be opened."""

    def __init__(self) -> None:
        self._kinds: dict[str, str] = {}
        self._names: dict[str, str] = {}
        self._to_open: set[str] = set()

    def draw(self, state: WindowState, shown: Shown, table: Table, *, forced_open: bool) -> None:
        """Draws all groups of the scene; of each those values that are `shown`.

        Args:
            forced_open: open whatever has something to show, and nothing else is drawn.
        """
        for section, slot in instances.SLOTS.items():
            named, kinds = getattr(state.scene, section), catalogue.plug_ins(slot)
            if not named and not kinds:
                continue
            if not forced_open:
                imgui.separator_text(_TITLES[section])
            for name, instance in named.items():
                place = instances.Place(section, name)
                items = [item for item in instances.fields_of(place, instance.kind).values() if shown(item)]
                if items:
                    self._group(place, kinds[instance.kind], items, state, table, forced_open=forced_open)
            if not forced_open:
                self._add(section, kinds, state)

    def _group(self, place: instances.Place, kind: PlugIn, items: list[Field], state: WindowState, table: Table, *, forced_open: bool) -> None:
        if forced_open or place.path in self._to_open:
            imgui.set_next_item_open(True)
            self._to_open.discard(place.path)
        sought.open_group(state, [item.key for item in items])
        imgui.push_style_color(imgui.Col_.text, theme.PICKED if state.picked == place.path else theme.TEXT)
        is_open = imgui.collapsing_header(f"{place.name}: {kind.label.lower()}###{place.path}")
        imgui.pop_style_color()
        if not is_open:
            return
        table(f"values of {place.path}", items)
        width = (imgui.get_content_region_avail().x - 2.0 * imgui.get_style().item_spacing.x) / 3.0
        imgui.set_next_item_width(width)
        name = text_fields.edited(f"##name of {place.path}", place.name)
        imgui.set_item_tooltip(f"Its name, which its keys begin with: {place.path}.{KIND}")
        if name is not None:
            self._rename(state, place, name)
        imgui.same_line()
        if imgui.button(f"Duplicate##{place.path}", (width, 0.0)):
            self._duplicate(state, place, kind)
        imgui.set_item_tooltip("Another one like it, beside it, under a name of its own.")
        imgui.same_line()
        if imgui.button(f"Remove##{place.path}", (-1.0, 0.0)):
            state.edit(lambda scene: scene.without(place.path))

    def _add(self, section: str, kinds: Mapping[str, PlugIn], state: WindowState) -> None:
        """The line that makes an instance: its kind, its name, and the button."""
        if not kinds:
            return
        kind = self._kinds.get(section, next(iter(kinds)))
        width = (imgui.get_content_region_avail().x - 2.0 * imgui.get_style().item_spacing.x) / 3.0
        imgui.set_next_item_width(width)
        if imgui.begin_combo(f"##kind of new {section}", kinds[kind].label):
            for key, plug_in in kinds.items():
                clicked, _ = imgui.selectable(f"{plug_in.label}##{key}", key == kind)
                imgui.set_item_tooltip(plug_in.summary)
                if clicked:
                    self._kinds[section] = key
            imgui.end_combo()
        imgui.same_line()
        imgui.set_next_item_width(width)
        free = _free_name(kind, state.scene, section)
        _, self._names[section] = imgui.input_text_with_hint(f"##name of new {section}", free, self._names.get(section, ""))
        imgui.same_line()
        if imgui.button(f"Add##{section}", (-1.0, 0.0)):
            self._make(state, section, kind, self._names[section].strip() or free)

    def _make(self, state: WindowState, section: str, kind: str, name: str) -> None:
        if name in getattr(state.scene, section):
            state.complain(f"{section}.{name}: there is one already; the new one needs another name.")
        elif state.edit(lambda scene: scene.with_values({f"{section}.{name}.{KIND}": kind})):
            self._names[section] = ""
            self._take_up(state, f"{section}.{name}")

    def _rename(self, state: WindowState, place: instances.Place, name: str) -> None:
        was_picked = state.picked == place.path
        if state.edit(lambda scene: scene.renamed(place.path, name)):
            self._to_open.add(f"{place.section}.{name}")
            state.pick = f"{place.section}.{name}" if was_picked else state.pick

    def _duplicate(self, state: WindowState, place: instances.Place, kind: PlugIn) -> None:
        instance = getattr(state.scene, place.section)[place.name]
        path = f"{place.section}.{_free_name(place.name.rstrip('0123456789'), state.scene, place.section)}"
        values = {KIND: instance.kind, **instance.values, **_beside(instance, kind)}
        if state.edit(lambda scene: scene.with_values({f"{path}.{name}": value for name, value in values.items()})):
            self._take_up(state, path)

    def _take_up(self, state: WindowState, path: str) -> None:
        """Shows what has just been made: in the panel and, where it is seen, in the picture."""
        self._to_open.add(path)
        state.pick = path


def _beside(instance: Instance, kind: PlugIn) -> dict[str, Value]:
    """The values in which a copy of `instance` differs from it, so that both are seen."""
    traits, values = kind.traits, instance.values
    if traits.moves and values["path"] != "fixed":
        return {"orbit_phase_deg": math.remainder(number_of(values["orbit_phase_deg"]) + _NEXT_DEG, 360.0)}
    axis = "x" if traits.moves else next(iter(traits.centre), "")
    if not axis:
        return {}
    wanted = number_of(values[axis]) + _APART * met.extent(instance, traits)
    return {axis: min(wanted, kind.parameters[axis].high)}


def _free_name(wanted: str, scene: Scene, section: str) -> str:
    """A name that a new instance can have: as `wanted`, with a number behind it where it is taken."""
    stem, count = wanted[: instances.LONGEST_NAME - 3], 1
    name = stem
    while name in getattr(scene, section):
        count += 1
        name = f"{stem}{count}"
    return name
