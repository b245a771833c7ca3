"""One line of text in the panel, handed over when the user is done with it: half a path is no path."""

from __future__ import annotations

from imgui_bundle import imgui

_typed: dict[str, str] = {}  # item → what stands in it, while it is being edited: imgui has one such field at a time


def edited(item: str, text: str, hint: str = "") -> str | None:
    """Draws the field `item` that shows `text`; what the user made of it, once it is left or Enter is pressed, else None."""
    changed, now = imgui.input_text_with_hint(item, hint, _typed.get(item, text))
    if changed:
        _typed[item] = now
    if imgui.is_item_deactivated():
        return _typed.pop(item, None)
    return None
