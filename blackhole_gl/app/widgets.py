"""One row of the panel: the name of a value, and the widget that changes it. Items are named by key, ``##disk.outer_radius``."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType

from imgui_bundle import hello_imgui, imgui

from ..scene import catalogue, fields, instances
from ..scene.schema import Field, Value, describe, number_of
from . import list_rows, text_fields, theme
from .thumbnails import ROW_EM

Change = Callable[[Mapping[str, Value]], None]
DrawPicture = Callable[[str, float], bool]
"""Draws the small picture of that name, so many em high; false where there is none."""

_SHOWN_DIGITS = 4
_LOG_RATIO = 200.0  # a range that spans more than this is walked in equal ratios
_FLAGS = imgui.SliderFlags_.always_clamp.value | imgui.SliderFlags_.no_round_to_format.value
_LABELS = {
    "camera.fov_deg": "Field of view", "camera.field_m": "Picture height", "source.mass_suns": "Mass", "source.distance_pc": "Distance",
    "post.beam_uas": "Beam width",
}  # fmt: skip
_OPTIONS = {
    "s0": "orbital-plane renderer's", "s1": "BlackHoleGPU's", "page_thorne": "Page–Thorne", "shakura_sunyaev": "Shakura–Sunyaev", "zamo": "ZAMO",
    "aces": "ACES", "agx": "AgX",
}  # fmt: skip
_SLOT_OF_CHOICE = {"rays.model": "ray_model", "rays.integrator": "integrator", "rays.step_control": "step_control", "sky.model": "sky"}


def label_of(key: str) -> str:
    """The words for `key` that people read: ``disk.outer_radius`` → ``Outer radius``."""
    name = key.rsplit(".", 1)[-1].removesuffix("_deg").removesuffix("_k")
    return _LABELS.get(key) or name.replace("_", " ").capitalize()


def _option(option: str) -> str:
    """The words for an option of a choice that people read."""
    return _OPTIONS.get(option) or option.replace("_", " ")


def departs(item: Field, value: Value) -> bool:
    """Whether `value` is art where physics names another."""
    return item.physical is not None and value != item.physical


def row(item: Field, value: Value, change: Change, unfit: Mapping[str, str] = MappingProxyType({}), picture: DrawPicture | None = None) -> None:
    """Draws the row of `item` in a table of two columns; an edit calls `change`. `unfit`: options that do not fit now, and why; `picture`: draws theirs."""
    imgui.table_next_row()
    imgui.table_next_column()
    _mark(item, value, change)
    _label(item, value, change)
    imgui.table_next_column()
    imgui.set_next_item_width(-1.0)
    edited = _widget(item, value, unfit, picture)
    _tooltip(item)
    _menu(item, f"widget {item.key}", change)
    if edited is not None and edited != value:
        change({item.key: edited})


def _mark(item: Field, value: Value, change: Change) -> None:
    """A dot before a value that departs from physics; a click on it goes back to physics."""
    size, physical = 0.5 * hello_imgui.em_size(), item.physical
    if physical is None or not departs(item, value):
        imgui.dummy((size, size))
        imgui.same_line(0.0, 0.35 * hello_imgui.em_size())
        return
    if imgui.invisible_button(f"##departs {item.key}", (size, imgui.get_frame_height())):
        change({item.key: physical})
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    centre = (0.5 * (low.x + high.x), 0.5 * (low.y + high.y))
    imgui.get_window_draw_list().add_circle_filled(centre, 0.5 * size, imgui.get_color_u32(theme.DEPARTS))
    imgui.set_item_tooltip(f"Departs from physics: the physical value is {format_value(item, physical)}. Click to go back to it.")
    imgui.same_line(0.0, 0.35 * hello_imgui.em_size())


def _label(item: Field, value: Value, change: Change) -> None:
    imgui.align_text_to_frame_padding()
    changed = value != item.default
    if not changed:
        imgui.push_style_color(imgui.Col_.text, theme.DIM)
    imgui.selectable(f"{label_of(item.key)}##name {item.key}", False, imgui.SelectableFlags_.allow_double_click.value)
    if not changed:
        imgui.pop_style_color()
    if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left):
        change({item.key: item.default})
    _tooltip(item)
    _menu(item, f"name {item.key}", change)


def _menu(item: Field, name: str, change: Change) -> None:
    if not imgui.begin_popup_context_item(f"menu of {name}"):
        return
    if imgui.menu_item_simple(f"Reset to {format_value(item, item.default)}"):
        change({item.key: item.default})
    if item.physical is not None and item.physical != item.default and imgui.menu_item_simple(f"Physical value, {format_value(item, item.physical)}"):
        change({item.key: item.physical})
    if imgui.menu_item_simple("Copy the key"):
        imgui.set_clipboard_text(item.key)
    imgui.end_popup()


def _tooltip(item: Field) -> None:
    if not imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip.value) or not imgui.begin_tooltip():
        return
    imgui.push_text_wrap_pos(26.0 * hello_imgui.em_size())
    imgui.text_unformatted(item.help or label_of(item.key))
    imgui.push_style_color(imgui.Col_.text, theme.DIM)
    if item.kind in ("text", "file", "list"):
        imgui.text_unformatted(f"{item.allowed()[0].upper()}{item.allowed()[1:]}.")
    if item.kind in ("float", "int"):
        imgui.text_unformatted(f"{item.allowed()[0].upper()}{item.allowed()[1:]}; {format_value(item, item.default)} in the preset.")
        imgui.text_unformatted("Ctrl+click types a value. Double-click resets.")
    imgui.text_unformatted(item.key)
    imgui.pop_style_color()
    imgui.pop_text_wrap_pos()
    imgui.end_tooltip()


def format_value(item: Field, value: Value) -> str:
    """`value` of `item` as people read it, with its unit."""
    if item.kind == "switch":
        return "on" if value else "off"
    if item.kind == "choice":
        return _option(str(value))
    if isinstance(value, tuple):
        return f"{len(value)} entries" if value else "an empty list"
    if isinstance(value, str):
        return value or "nothing"
    return f"{value:g} {item.unit}".strip()


def _slider(item: Field, value: float) -> float | None:
    if item.allow_infinity:
        return _slider_or_infinity(item, value)
    return _finite_slider(item, value)


def _finite_slider(item: Field, value: float) -> float | None:
    low, high = item.low, item.high
    flags = _FLAGS | (imgui.SliderFlags_.logarithmic.value if low > 0 and high / low >= _LOG_RATIO else 0)
    unit = item.unit.replace("%", "%%")
    edited, new = imgui.slider_float(f"##{item.key}", value, low, high, f"{_format(value)} {unit}".strip(), flags)
    if _is_reset():
        return number_of(item.default)
    if not edited:
        return None
    # The widget works in float32, in which 0.1 comes back as 0.10000000149; a dragged value needs no more digits than are shown.
    digits = _SHOWN_DIGITS if imgui.is_mouse_down(imgui.MouseButton_.left) else 7
    return min(max(float(f"{new:.{digits}g}"), low), high)


def _format(value: float) -> str:
    """A printf format with as many decimals as `value` needs, to `_SHOWN_DIGITS` significant digits."""
    decimals = f"{value:.{_SHOWN_DIGITS}g}".partition(".")[2]
    return f"%.{len(decimals)}f" if decimals.isdigit() or not decimals else "%.3e"


def _slider_or_infinity(item: Field, value: float) -> float | None:
    far = math.isinf(value)
    style = imgui.get_style()
    box = imgui.get_frame_height() + style.item_inner_spacing.x + imgui.calc_text_size("far").x
    imgui.set_next_item_width(-box - style.item_spacing.x)
    if far:
        imgui.begin_disabled()
        imgui.slider_float(f"##{item.key}", item.high, item.low, item.high, "infinitely far")
        imgui.end_disabled()
        edited = None
    else:
        edited = _finite_slider(item, value)
    _tooltip(item)
    imgui.same_line()
    toggled, now_far = imgui.checkbox(f"far##infinite {item.key}", far)
    if toggled:
        return math.inf if now_far else _near(item)
    return edited


def _near(item: Field) -> float:
    """Where a value of `item` goes that is to be infinite no more: to its default, or to that of the bare scene where that is infinite too."""
    candidates = (number_of(item.default), number_of(fields().get(item.key, item).default), item.high)
    return next(value for value in candidates if math.isfinite(value))


def _whole_slider(item: Field, value: int) -> int | None:
    low, high = int(item.low), int(item.high)
    flags = _FLAGS | (imgui.SliderFlags_.logarithmic.value if low > 0 and high / low >= _LOG_RATIO else 0)
    edited, new = imgui.slider_int(f"##{item.key}", value, low, high, f"%d {item.unit}".strip(), flags)
    if _is_reset():
        return int(number_of(item.default))
    return new if edited else None


def _switch(item: Field, value: bool) -> bool | None:
    edited, new = imgui.checkbox(f"##{item.key}", value)
    if _is_reset():
        return bool(item.default)
    return new if edited else None


def _is_reset() -> bool:
    """Whether the last widget was double-clicked. It lets go of the mouse, which would move its value again."""
    if imgui.get_io().key_ctrl or not (imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)):
        return False
    imgui.internal.clear_active_id()
    return True


def _slot_of(key: str) -> str | None:
    """The catalogue slot whose plug-ins are the options of the choice `key`; None where they are words of its own."""
    place = instances.place_of(key)
    if place is not None:
        return instances.SLOTS[place.section] if place.parameter == catalogue.KIND else None
    return _SLOT_OF_CHOICE.get(key)


def _text(item: Field, value: str) -> str | None:
    return text_fields.edited(f"##{item.key}", value, "a file" if item.kind == "file" else "")


def _widget(item: Field, value: Value, unfit: Mapping[str, str] = MappingProxyType({}), picture: DrawPicture | None = None) -> Value | None:
    """Draws the widget of `item`; what the user made of `value`, or None. `unfit`, `picture`: see `row`."""
    if isinstance(value, bool):
        return _switch(item, value)
    if isinstance(value, str):
        return _choice(item, value, unfit, picture) if item.kind == "choice" else _text(item, value)
    if isinstance(value, tuple):
        return list_rows.edited(item, value, _widget, label_of)
    if isinstance(value, (int, float)):
        return _whole_slider(item, int(value)) if item.kind == "int" else _slider(item, value)
    raise TypeError(f"{item.key}: got {describe(value)}, which has no widget of its own")


def _is_combo_reset() -> bool:
    """Whether the combo that is to be drawn next is double-clicked: the first click opens its list, which then has the mouse."""
    low, size = imgui.get_cursor_screen_pos(), (imgui.calc_item_width(), imgui.get_frame_height())
    over = imgui.is_mouse_hovering_rect(low, (low.x + size[0], low.y + size[1]))
    return over and imgui.is_mouse_double_clicked(imgui.MouseButton_.left) and list_is_open()


def _choice(item: Field, value: str, unfit: Mapping[str, str], picture: DrawPicture | None) -> str | None:
    slot = _slot_of(item.key)
    plug_ins = catalogue.plug_ins(slot) if slot else {}
    names = {option: plug_ins[option].label if option in plug_ins else _option(option) for option in item.options}
    picked = str(item.default) if _is_combo_reset() else None
    if imgui.begin_combo(f"##{item.key}", names.get(value, value), imgui.ComboFlags_.height_large.value if slot else 0):
        for option, name in names.items():
            grey = imgui.SelectableFlags_.disabled.value if option in unfit else 0
            height, on_picture = 0.0, False
            if slot and picture and picture(f"{catalogue.SLOTS[slot].folder}/{option}", ROW_EM):
                on_picture = imgui.is_item_clicked() and not grey
                imgui.same_line()
                height = ROW_EM * hello_imgui.em_size()
            imgui.push_style_var(imgui.StyleVar_.selectable_text_align, (0.0, 0.5))
            clicked, _ = imgui.selectable(f"{name}##{option}", option == value, grey, (0.0, height))
            imgui.pop_style_var()
            if clicked or on_picture:
                picked = option
            if on_picture:
                imgui.close_current_popup()
            if option in plug_ins and imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip.value | imgui.HoveredFlags_.allow_when_disabled.value):
                imgui.set_tooltip(unfit.get(option, plug_ins[option].summary))
        imgui.end_combo()
    return picked


def list_is_open() -> bool:
    """Whether a picker's list or another popup is open."""
    return imgui.is_popup_open("", imgui.PopupFlags_.any_popup.value)
