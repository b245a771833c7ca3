"""The panel's group about the window itself: the text's size, and what is kept from one run to the next.

Items are named by key of ``window.toml``: ``##window.text_size``.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from imgui_bundle import imgui

from . import sought, theme
from .kept import Kept, file
from .state import WindowState

SECTION = "window"
TEXT_SIZES = (0.75, 0.9, 1.0, 1.15, 1.3, 1.5, 1.75, 2.0)
SETTINGS = {
    # key of window.toml: label, help
    "text_size": ("Text size", "Of all text in the window, over that which the screen's scale asks for."),
    "start_line": ("Line at start", "Whether a line over the picture says at start how to move."),
    "keep_window": ("Keep the size", "Whether the next window is as large as this one."),
    "keep_panel": ("Keep the panel", "Whether the panel of the next window is as wide as this one's, and hidden if it is."),
    "keep_scene": ("Keep the scene", "Whether the next window opens on the scene that this one showed last, unless another is asked for."),
}


def draw(state: WindowState, kept: Kept) -> Kept:
    """Draws the group at the end of the panel; what the user made of `kept`."""
    sought.open_group(state, [f"{SECTION}.{name}" for name in SETTINGS])
    if not imgui.collapsing_header(f"Window##{SECTION}"):
        return kept
    if imgui.begin_table(f"values of {SECTION}", 2):
        imgui.table_setup_column("name", imgui.TableColumnFlags_.width_stretch.value, 0.44)
        imgui.table_setup_column("value", imgui.TableColumnFlags_.width_stretch.value, 0.56)
        for name, (label, help_text) in SETTINGS.items():
            imgui.table_next_row()
            imgui.table_next_column()
            imgui.align_text_to_frame_padding()
            imgui.text_unformatted(label)
            imgui.set_item_tooltip(help_text)
            imgui.table_next_column()
            kept = _text_size(kept) if name == "text_size" else _switch(kept, name)
            imgui.set_item_tooltip(help_text)
            sought.mark(state, f"{SECTION}.{name}")
        imgui.end_table()
    imgui.push_style_color(imgui.Col_.text, theme.DIM)
    imgui.text_wrapped(f"Kept in {file()}")
    imgui.pop_style_color()
    return kept


def _switch(kept: Kept, name: str) -> Kept:
    changed, value = imgui.checkbox(f"##{SECTION}.{name}", getattr(kept, name))
    changes: dict[str, Any] = {name: value}
    return replace(kept, **changes) if changed else kept


def _text_size(kept: Kept) -> Kept:
    """A list and no slider: the slider would grow under the hand."""
    imgui.set_next_item_width(-1.0)
    if imgui.begin_combo(f"##{SECTION}.text_size", f"{100.0 * kept.text_size:.0f} %"):
        for size in TEXT_SIZES:
            clicked, _ = imgui.selectable(f"{100.0 * size:.0f} %", size == kept.text_size)
            if clicked:
                kept = replace(kept, text_size=size)
        imgui.end_combo()
    return kept
