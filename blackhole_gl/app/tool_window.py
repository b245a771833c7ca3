"""What all windows over the picture have in common: a title, a button that closes, no place kept from one start to the next."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import hello_imgui, imgui

_FLAGS = imgui.WindowFlags_
_OFTEN = _FLAGS.no_docking | _FLAGS.no_collapse | _FLAGS.no_saved_settings


def draw(title: str, contents: Callable[[], bool | None], *more: imgui.WindowFlags_) -> bool:
    """Draws the window with `contents`, which may say False to close it. True if it stays open.

    Its place and size are those that were set for the next window.

    Args:
        more: flags of its own.
    """
    flags = _OFTEN.value
    for flag in more:
        flags |= flag.value
    visible, stays = imgui.begin(title, True, flags)
    closes = visible and contents() is False
    imgui.end()
    return bool(stays) and not closes


def begins_in_the_corner(width_em: float, height_em: float) -> None:
    """The next window opens at the top left, in that size; where the user takes it, it stays."""
    em, corner = hello_imgui.em_size(), imgui.get_main_viewport().pos
    imgui.set_next_window_pos((corner.x + 2.0 * em, corner.y + 8.0 * em), imgui.Cond_.first_use_ever.value)
    imgui.set_next_window_size((width_em * em, height_em * em), imgui.Cond_.first_use_ever.value)


def appears_in_the_middle() -> None:
    """The next window stands in the middle each time it opens."""
    centre = imgui.get_main_viewport().get_center()
    imgui.set_next_window_pos((centre.x, centre.y), imgui.Cond_.appearing.value, (0.5, 0.5))
