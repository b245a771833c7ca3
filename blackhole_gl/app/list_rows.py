"""A list in the panel: its entries below each other, each with a button that takes it out, and one that adds another.

Items are named by key and place: ``##things.moon.radii[0]``, ``##things.moon.path[1].time``, ``-##things.moon.path[1]``, ``+##things.moon.path``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from imgui_bundle import imgui

from ..scene import Field, FrozenMap, Value

Widget = Callable[[Field, Value], Value | None]
"""Draws the widget of a field with a value; what the user made of it, or None."""


def edited(item: Field, entries: tuple[Value, ...], widget: Widget, label: Callable[[str], str]) -> tuple[Value, ...] | None:
    """Draws the list `item`, each value by `widget`; what the user made of it, or None. `label`: the words for a key."""
    new = None
    for index, entry in enumerate(entries):
        key = f"{item.key}[{index}]"
        if _button(f"-##{key}", "Take this entry out", len(entries) > item.low):
            new = (*entries[:index], *entries[index + 1 :])
        changed: Value | None = None
        if item.element is not None:
            imgui.same_line()
            imgui.set_next_item_width(-1.0)
            changed = widget(replace(item.element, key=key), entry)
        elif isinstance(entry, FrozenMap):
            changed = _record(item, key, entry, widget, label)
        if changed is not None:
            new = (*entries[:index], changed, *entries[index + 1 :])
    if _button(f"+##{item.key}", "Add an entry", len(entries) < item.high):
        new = (*entries, entries[-1] if entries else _first(item))
    return new


def _record(item: Field, key: str, entry: FrozenMap[str, Value], widget: Widget, label: Callable[[str], str]) -> FrozenMap[str, Value] | None:
    new = None
    for column in item.columns:
        cell = replace(column, key=f"{key}.{column.key}")
        imgui.text_unformatted(label(cell.key))
        imgui.set_next_item_width(-1.0)
        changed = widget(cell, entry[column.key])
        if changed is not None:
            new = entry.updated({column.key: changed})
    return new


def _first(item: Field) -> Value:
    """What an empty list begins with."""
    return item.element.default if item.element is not None else FrozenMap((column.key, column.default) for column in item.columns)


def _button(name: str, what: str, works: bool) -> bool:
    imgui.begin_disabled(not works)
    pressed = imgui.small_button(name)
    imgui.end_disabled()
    imgui.set_item_tooltip(what)
    return pressed
