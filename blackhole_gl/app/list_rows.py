"""A list in the panel: its entries below each other, each with a button that takes it out, and one that adds another. Three shares are a
colour, in one row.

Items are named by key and place: ``##things.moon.colour`` (within it ``##X``, ``##Y``, ``##Z``), ``##things.moon.radii[0]``,
``##things.moon.path[1].time``, ``-##things.moon.path[1]``, ``+##things.moon.path``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from imgui_bundle import imgui

from ..scene import Field, FrozenMap, Value
from ..scene.schema import number_of

Widget = Callable[[Field, Value], Value | None]
"""Draws the widget of a field with a value; what the user made of it, or None."""


def edited(item: Field, entries: tuple[Value, ...], widget: Widget, label: Callable[[str], str]) -> tuple[Value, ...] | None:
    """Draws the list `item`, each value by `widget`; what the user made of it, or None. `label`: the words for a key."""
    if _is_colour(item):
        return _colour(item, [number_of(entry) for entry in entries])
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


def _is_colour(item: Field) -> bool:
    part = item.element
    return item.low == item.high == 3 and part is not None and (part.kind, part.low, part.high) == ("float", 0.0, 1.0)


def _colour(item: Field, entries: list[float]) -> tuple[Value, ...] | None:
    """Light in linear shares, as in files; the square beside them shows what it looks like."""
    red, green, blue = shown = [_code(share) for share in entries]
    space = imgui.get_style().item_inner_spacing.x
    imgui.set_next_item_width(-imgui.get_frame_height() - space)
    changed, new = imgui.color_edit3(f"##{item.key}", entries, imgui.ColorEditFlags_.float.value | imgui.ColorEditFlags_.no_small_preview.value)
    imgui.same_line(0.0, space)
    if imgui.color_button(f"Colour##{item.key}", imgui.ImVec4(red, green, blue, 1.0), imgui.ColorEditFlags_.no_tooltip.value):
        imgui.open_popup(f"picker of {item.key}")
    if imgui.begin_popup(f"picker of {item.key}"):
        picked, codes = imgui.color_picker3(f"##picker of {item.key}", shown)
        if picked:
            changed, new = True, [_share(code) for code in codes]
        imgui.end_popup()
    return tuple(min(max(float(f"{share:.4g}"), 0.0), 1.0) for share in new) if changed else None  # ImGui's numbers are single


def _code(share: float) -> float:
    """sRGB's code, 0…1, of a share of light."""
    return 12.92 * share if share <= 0.0031308 else 1.055 * share ** (1.0 / 2.4) - 0.055


def _share(code: float) -> float:
    """The share of light that sRGB's `code` stands for."""
    return code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4


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
