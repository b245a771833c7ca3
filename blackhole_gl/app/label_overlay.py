"""Draws the labels of `render.labels`, the bar of `render.scale_bar` and the ticks of `render.polarized_disk` over the window's picture."""

from __future__ import annotations

import math

from imgui_bundle import hello_imgui, imgui

from ..render import labels, polarized_disk, scale_bar
from ..render.sheet import pieces
from ..render.views import Colour
from ..scene import Scene
from . import theme
from .overlay import Corner
from .state import WindowState


class LabelOverlay:
    """Remembers the labels of the last frame, and what they are of."""

    def __init__(self) -> None:
        self._of: tuple[Scene, float] | None = None
        self._shown = labels.Labels()

    def draw(self, state: WindowState, corner: Corner, size: tuple[float, float]) -> None:
        """Draws labels and ticks over the picture, whose top left is `corner`; labels follow those of the frame before."""
        if size[1] < 1.0:
            return
        if state.scene.polarization.ticks and state.scene.post.view == "picture":
            try:
                _draw(polarized_disk.ticks(state.scene, size[0] / size[1], moving=state.camera_moves), corner, size)
            except ValueError:  # as below
                return
        if state.scene.post.labels:
            self._draw_labels(state, corner, size)

    def _draw_labels(self, state: WindowState, corner: Corner, size: tuple[float, float]) -> None:
        aspect = size[0] / size[1]
        of = labels.shape_of(state.scene), aspect
        if of != self._of:
            try:
                self._shown = labels.after(self._shown, state.scene, aspect)
            except ValueError:  # the picture fails for the same reason, which is told
                return
            self._of = of
        _draw(self._shown, corner, size)
        _draw(scale_bar.of(state.scene, aspect), corner, size)


def _draw(shown: labels.Labels, corner: Corner, size: tuple[float, float]) -> None:
    canvas, em = imgui.get_background_draw_list(), hello_imgui.em_size()
    canvas.push_clip_rect(corner, (corner[0] + size[0], corner[1] + size[1]))

    def at(place: tuple[float, float]) -> Corner:
        return corner[0] + size[1] * place[0], corner[1] + size[1] * place[1]

    for curve in shown.curves:
        for piece in pieces(curve.places):
            canvas.add_polyline([imgui.ImVec2(*at((x, y))) for x, y in piece.tolist()], _code(curve.colour, 0.9), 0.09 * em * curve.width, 0)
    for name in shown.names:
        canvas.add_line(at(name.at), at(name.place), _code(name.colour, 0.9), 0.06 * em)
        _text(canvas, name.text, at(name.place), name.colour, 1.0 if name.is_on_the_left else 0.0, (corner[0], corner[0] + size[0]))
    if shown.note:
        place = corner[0] + 0.5 * size[0], corner[1] + (2.0 + 1.8 * shown.note_line) * em
        _text(canvas, shown.note, place, labels.WHITE, 0.5, (corner[0], corner[0] + size[0]))
    canvas.pop_clip_rect()


def _text(canvas: imgui.ImDrawList, text: str, place: Corner, colour: Colour, share: float, sides: tuple[float, float]) -> None:
    """`text` on a backdrop, with `share` of its width to the left of `place`, moved as little as brings it between the picture's `sides`."""
    em, (wide, high) = hello_imgui.em_size(), imgui.calc_text_size(text)
    pad = 0.3 * em
    left = min(max(place[0] - share * wide, sides[0] + pad), max(sides[1] - wide - pad, sides[0] + pad))
    top = math.floor(place[1] - 0.5 * high)
    canvas.add_rect_filled((left - pad, top - 0.1 * em), (left + wide + pad, top + high + 0.1 * em), imgui.color_convert_float4_to_u32(theme.BACKDROP))
    canvas.add_text((left, top), _code(colour, 1.0), text)


def _code(colour: Colour, alpha: float) -> int:
    return imgui.color_convert_float4_to_u32((*colour, alpha))
