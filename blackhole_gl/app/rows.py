"""What the panel's tables have in common: their two columns, and tooltips of several lines."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import hello_imgui, imgui

_TOOLTIP_EM = 26.0


def columns() -> None:
    """Sets up the columns of a table that has just begun: names, and what is set."""
    imgui.table_setup_column("name", imgui.TableColumnFlags_.width_stretch.value, 0.44)
    imgui.table_setup_column("value", imgui.TableColumnFlags_.width_stretch.value, 0.56)


def wrapped_tooltip(text: str, picture: Callable[[], object] | None = None) -> None:
    """A tooltip for the last item, with what `picture` draws above `text`; none where `text` is empty."""
    if text and imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip.value) and imgui.begin_tooltip():
        if picture is not None:
            picture()
        imgui.push_text_wrap_pos(_TOOLTIP_EM * hello_imgui.em_size())
        imgui.text_unformatted(text)
        imgui.pop_text_wrap_pos()
        imgui.end_tooltip()
