"""Draws the labels of `rendering.labels`, the bar of `rendering.scale_bar` and the ticks of `rendering.polarized_disk` over the window's picture."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from imgui_bundle import hello_imgui, imgui

from ..rendering import labels, polarized_disk, scale_bar
from ..rendering.sheet import pieces
from ..rendering.views import Colour
from ..scene import Scene
from . import theme
from .overlay import Box, Corner
from .state import WindowState


class LabelOverlay:
    """Remembers the labels of the last frame, and what they are of.

    Attributes:
        words: where the words of this frame stand.
    """

    def __init__(self) -> None:
        self._of: tuple[Scene, float] | None = None
        self._shown = labels.Labels()
        self.words: list[Box] = []

    def draw(self, state: WindowState, corner: Corner, size: tuple[float, float], taken: Iterable[Box] = ()) -> None:
        """Draws labels and ticks over the picture, whose top left is `corner`; labels follow those of the frame before. No word stands in the boxes `taken`."""
        self.words = []
        if size[1] < 1.0:
            return
        page = _Page(corner, size, [*taken])
        if state.scene.polarization.ticks and state.scene.post.view == "picture":
            try:
                page.draw(polarized_disk.ticks(state.scene, size[0] / size[1], moving=state.camera_moves))
            except ValueError:  # as below
                return
        if state.scene.post.labels:
            self._draw_labels(state, page, size[0] / size[1])
        self.words = page.words

    def _draw_labels(self, state: WindowState, page: _Page, aspect: float) -> None:
        of = labels.shape_of(state.scene), aspect
        if of != self._of:
            try:
                self._shown = labels.after(self._shown, state.scene, aspect)
            except ValueError:  # the picture fails for the same reason, which is told
                return
            self._of = of
        page.draw(self._shown)
        page.draw(scale_bar.of(state.scene, aspect))


class _Page:
    """The picture in the window, as far as it is written on.

    Args:
        corner: its top left.
        size: its width and height.
        taken: where no words may stand.
    """

    def __init__(self, corner: Corner, size: tuple[float, float], taken: list[Box]):
        self._corner, self._size, self._taken = corner, size, taken
        self._canvas, self._em = imgui.get_background_draw_list(), hello_imgui.em_size()
        self.words: list[Box] = []

    def draw(self, shown: labels.Labels) -> None:
        """Draws `shown`."""
        canvas, em, (left, top), (width, height) = self._canvas, self._em, self._corner, self._size
        canvas.push_clip_rect(self._corner, (left + width, top + height))
        for curve in shown.curves:
            for piece in pieces(curve.places):
                canvas.add_polyline([imgui.ImVec2(*self._at((x, y))) for x, y in piece.tolist()], _code(curve.colour, 0.9), 0.09 * em * curve.width, 0)
        for name in shown.names:
            box = self._box(name.text, self._at(name.place), 1.0 if name.is_on_the_left else 0.0)
            end = box[2] if name.is_on_the_left else box[0], 0.5 * (box[1] + box[3])
            canvas.add_line(self._at(name.at), end, _code(name.colour, 0.9), 0.06 * em)
            self._write(name.text, box, name.colour)
        if shown.note:
            self._write(shown.note, self._box(shown.note, (left + 0.5 * width, top + (2.0 + 1.8 * shown.note_line) * em), 0.5), labels.WHITE)
        canvas.pop_clip_rect()

    def _at(self, place: tuple[float, float]) -> Corner:
        return self._corner[0] + self._size[1] * place[0], self._corner[1] + self._size[1] * place[1]

    def _box(self, text: str, place: Corner, share: float) -> Box:
        """The box of `text` with `share` of its width to the left of `place`, moved as little as brings it between the picture's sides, and down to where
        nothing is."""
        (wide, high), pad, foot = imgui.calc_text_size(text), 0.3 * self._em, 0.1 * self._em
        first, last = self._corner[0], self._corner[0] + self._size[0] - wide - 2.0 * pad
        left = min(max(place[0] - share * wide - pad, first), max(last, first))
        top = math.floor(place[1] - 0.5 * high) - foot
        return clear_of(self._taken, (left, top, left + wide + 2.0 * pad, top + high + 2.0 * foot), self._corner[1] + self._size[1])

    def _write(self, text: str, box: Box, colour: Colour) -> None:
        """`text` on a backdrop, which is taken from now on."""
        self._canvas.add_rect_filled(box[:2], box[2:], imgui.color_convert_float4_to_u32(theme.BACKDROP))
        self._canvas.add_text((box[0] + 0.3 * self._em, box[1] + 0.1 * self._em), _code(colour, 1.0), text)
        self._taken.append(box)
        self.words.append(box)


def clear_of(taken: Sequence[Box], box: Box, foot: float) -> Box:
    """`box` moved down until it is clear of all that are `taken`; where it was, if that is below `foot`."""
    left, top, right, bottom = box
    for other in sorted(taken, key=lambda one: one[1]):
        if left < other[2] and right > other[0] and top < other[3] and top + bottom - box[1] > other[1]:
            top = other[3]
    moved = left, top, right, top + bottom - box[1]
    return moved if moved[3] <= foot else box


def _code(colour: Colour, alpha: float) -> int:
    return imgui.color_convert_float4_to_u32((*colour, alpha))
