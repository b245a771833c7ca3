"""The colour scale and legend of a diagnostic view, over the picture."""

from __future__ import annotations

from collections.abc import Sequence

from imgui_bundle import hello_imgui, imgui

from ..rendering.views import Colour, Scale, View, tick_text
from . import overlay, theme

_PIECES = 96
_WIDTH_EM = 22.0


def draw(view: View | None, corner: overlay.Corner, width: float) -> float:
    """Draws what the colours of `view` mean, with its bottom right at `corner`, at most `width` wide, and returns its height; none where there is none."""
    if view is None:
        return 0.0
    em = hello_imgui.em_size()
    length = max(min(_WIDTH_EM * em, width) - 2.0 * imgui.get_style().window_padding.x, 1.0)
    imgui.set_next_window_pos(corner, imgui.Cond_.always.value, (1.0, 1.0))
    imgui.set_next_window_bg_alpha(0.75)
    imgui.begin("##view scale", None, overlay.UNTOUCHED)
    imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + length)
    imgui.text_unformatted(view.title)
    imgui.pop_text_wrap_pos()
    if view.scale is not None:
        bar(view.scale, length, em)
    for meaning, colour in view.legend:
        _legend_row(meaning, colour, em)
    height = imgui.get_window_height()
    imgui.end()
    return height


def bar(scale: Scale, length: float, em: float) -> None:
    """A scale's colours and numbers, `length` wide, in the current window."""
    left, top = imgui.get_cursor_screen_pos().x, imgui.get_cursor_screen_pos().y
    canvas, bottom = imgui.get_window_draw_list(), top + 0.8 * em
    ends = [_code(colour) for colour in scale.colours(_PIECES + 1)]
    for k, (here, there) in enumerate(zip(ends, ends[1:])):
        a, b = left + length * k / _PIECES, left + length * (k + 1) / _PIECES
        canvas.add_rect_filled_multi_color((a, top), (b, bottom), here, there, there, here)
    free = left - 1.0
    for index, tick in enumerate(scale.ticks):
        x, text = left + length * scale.place(tick), tick_text(scale, index)
        wide = imgui.calc_text_size(text).x
        start = min(max(x - 0.5 * wide, left), left + length - wide)
        canvas.add_line((x, bottom), (x, bottom + 0.25 * em), _code(_TEXT))
        if start > free or index == 0:
            canvas.add_text((start, bottom + 0.3 * em), _code(_TEXT), text)
            free = start + wide + 0.4 * em
    imgui.dummy((length, 1.1 * em + imgui.get_text_line_height()))


def _legend_row(meaning: str, colour: Colour, em: float) -> None:
    place = imgui.get_cursor_screen_pos()
    corners = (place.x, place.y + 0.1 * em), (place.x + 0.9 * em, place.y + 1.0 * em)
    imgui.get_window_draw_list().add_rect_filled(*corners, _code(colour))
    imgui.get_window_draw_list().add_rect(*corners, _code(_TEXT))  # dark ones are like what is behind them
    imgui.dummy((0.9 * em, imgui.get_text_line_height()))
    imgui.same_line()
    imgui.text_colored(theme.QUIET, meaning)


_TEXT: Colour = (theme.QUIET.x, theme.QUIET.y, theme.QUIET.z)


def _code(colour: Sequence[float]) -> int:
    return imgui.color_convert_float4_to_u32((float(colour[0]), float(colour[1]), float(colour[2]), 1.0))
