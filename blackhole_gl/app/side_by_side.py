"""Side by side: a divider over the picture, to drag, with another method or preset on its right, each side with its error and cost.

Both sides are whole pictures of the same camera and time, and each renderer keeps its own hits: at rest both are sharp, and to drag the divider traces nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from imgui_bundle import hello_imgui, imgui

from ..measure import live
from ..measure.gauge import Gauged, gauging
from ..scene import Scene, SceneError, presets
from . import overlay, theme, tool_window
from .area import Area
from .divided import RightSide, joined
from .picture import Picture
from .preparation import Preparation, Submit
from .sides import KEPT, MOST_ACCURATE, Sides
from .state import WindowState

TITLE = "Side by side"
_RESTS = 0.4  # seconds of stillness before a new view is measured
_CHOICES_EM = 25.0  # of the window in which the other side is chosen
_HANDLE_EM = 1.2
_FLAGS = imgui.WindowFlags_
_STRIP = (overlay.STILL | _FLAGS.no_background | _FLAGS.no_bring_to_front_on_focus | _FLAGS.no_focus_on_appearing).value

Corner = tuple[float, float]


@dataclass
class _Gauge:
    """A side's figures: of which view and method, as far as they have come."""

    of: tuple[Any, ...] | None = None
    bits: Iterator[Gauged | None] | None = None
    found: Gauged | None = None


class SideBySide:
    """The other side's picture, the divider, and the figures of both sides.

    Args:
        make_renderer: makes the other side's renderer, and one to measure with.
        submit: see `Preparation`.

    Attributes:
        sides: what is shown where.
        failure: why the other side cannot be drawn, or None.
    """

    def __init__(self, make_renderer: Callable[[moderngl.Context], Any], submit: Submit | None):
        self.sides = Sides()
        self.failure: str | None = None
        self._make_renderer, self._submit = make_renderer, submit
        self._picture: Picture | None = None
        self._measurer: Any = None
        self._gauges = _Gauge(), _Gauge()
        self._still_since: float | None = None
        self._presets: list[presets.PresetInfo] = []

    @property
    def figures(self) -> tuple[Gauged | None, Gauged | None]:
        """Error and cost of the left and the right side, as far as they are known."""
        return self._gauges[0].found, self._gauges[1].found

    @property
    def picture(self) -> Picture | None:
        """The other side's; None before the first."""
        return self._picture

    def busy(self, state: WindowState) -> bool:
        """Whether frames are wanted although nothing moves."""
        if not state.show_sides or self.failure:
            return False
        return self._picture is None or not self._picture.is_final or any(gauge.found is None for gauge in self._gauges)

    def advance(self, gl: moderngl.Context, state: WindowState, area: Area, now: float, *, moving: bool, camera_moving: bool) -> None:
        """Draws the other side's picture, when there is one, and at rest measures a bit of either side. Leaves the context with another framebuffer bound.

        Args:
            now: any clock in seconds.
            moving, camera_moving: as for `Picture.update`; where a picture is to be saved, this side too is made sharp at once.
        """
        if not state.show_sides:
            return
        if self._picture is None:
            self._picture = Picture(gl, self._make_renderer(gl), Preparation(self._submit))
        try:
            other = self.sides.other(state.scene)
            self._picture.update(other, state.time, area, moving=moving, camera_moving=camera_moving, exact=state.picture_wanted)
            self.failure = None
        except Exception as error:  # whatever the other side cannot do, this one stays, and the reason is told
            self.failure = str(error) or type(error).__name__
            return
        if camera_moving or not self._picture.is_current:
            self._still_since = None
            return
        self._still_since = now if self._still_since is None else self._still_since
        if now - self._still_since >= _RESTS:
            self._measure(gl, (state.scene, other), area)

    def right_side(self, state: WindowState) -> RightSide | None:
        """What stands right of the divider; None where it is put away or nothing can."""
        return RightSide(self.sides.other(state.scene), self.sides.share) if state.show_sides and not self.failure else None

    def joined(self, state: WindowState, pixels: np.ndarray) -> np.ndarray | None:
        """The left side's `pixels` with the other side's beside them, as the window shows them; None while these are still to come."""
        if not state.show_sides or self.failure:
            return pixels
        return joined(pixels, self._picture.read_rgb8(), self.sides.share) if self._picture is not None and self._picture.is_current else None

    def reload(self) -> None:
        """Takes up shader files that were edited; what is wrong with them is told of the left side's."""
        if self._picture is not None and self._picture.renderer.programs.reload():
            self._picture.forget()

    def draw(self, state: WindowState, window: moderngl.Framebuffer, area: Area) -> None:
        """Puts the other side's part of `area` over what `window` holds."""
        if state.show_sides and self._picture is not None and not self.failure:
            left = round(self.sides.share * area.width)
            self._picture.draw_part(window, area, Area(area.x + left, area.y, area.width - left, area.height))

    def frame(self, state: WindowState, picture: Picture, left_top: Corner, size: Corner, foot: float) -> None:
        """The divider, what is said of the sides, and the window in which the other one is chosen; nothing while they are put away.

        Args:
            picture: the left side's.
            left_top, size: of the picture, in imgui's units.
            foot: the height at its bottom that is taken by a colour scale, in the same; 0 where there is none.
        """
        if not state.show_sides or min(size) < 1.0:
            return
        self._divider(left_top, size)
        self._labels(picture, left_top, (size[0], size[1] - (foot + 0.4 * hello_imgui.em_size() if foot else 0.0)))
        self._choices(state, left_top, size)

    def _measure(self, gl: moderngl.Context, scenes: tuple[Scene, Scene], area: Area) -> None:
        """One bit of the first side that is not measured yet."""
        for gauge, scene in zip(self._gauges, scenes):
            of = (*live.view_of(scene), scene.rays, scene.parameters, area.size)
            if gauge.of != of:
                gauge.of, gauge.bits, gauge.found = of, None, None
        waiting = next(((gauge, scene) for gauge, scene in zip(self._gauges, scenes) if gauge.found is None), None)
        if waiting is None:
            return
        gauge, scene = waiting
        if self._measurer is None:
            self._measurer = self._make_renderer(gl)
        if gauge.bits is None:
            gauge.bits = gauging(self._measurer, scene, area.width / area.height)
        gauge.found = next(gauge.bits)

    def _divider(self, left_top: Corner, size: Corner) -> None:
        em, sides = hello_imgui.em_size(), self.sides
        x = left_top[0] + sides.share * size[0]
        imgui.set_next_window_pos((x - 0.5 * _HANDLE_EM * em, left_top[1]))
        imgui.set_next_window_size((_HANDLE_EM * em, size[1]))
        imgui.push_style_var(imgui.StyleVar_.window_padding, (0.0, 0.0))
        imgui.begin("##divider", None, _STRIP)
        imgui.invisible_button("handle", (_HANDLE_EM * em, size[1]))
        held = imgui.is_item_active()
        if held:
            sides.share = min(max(sides.share + imgui.get_io().mouse_delta.x / size[0], 0.0), 1.0)
        near = held or imgui.is_item_hovered()
        if near:
            imgui.set_mouse_cursor(imgui.MouseCursor_.resize_ew)
        imgui.end()
        imgui.pop_style_var()
        canvas, colour = imgui.get_background_draw_list(), imgui.get_color_u32(theme.ACCENT if near else theme.QUIET)
        middle = left_top[1] + 0.5 * size[1]
        canvas.add_line((x, left_top[1]), (x, left_top[1] + size[1]), colour, 2.0)
        canvas.add_rect_filled((x - 0.3 * em, middle - 1.2 * em), (x + 0.3 * em, middle + 1.2 * em), colour, 0.3 * em)

    def _labels(self, picture: Picture, left_top: Corner, size: Corner) -> None:
        em = hello_imgui.em_size()
        x, y = left_top[0] + self.sides.share * size[0], left_top[1] + size[1] - 0.6 * em
        room = (x - left_top[0], left_top[0] + size[0] - x)
        left = _told(picture, self._gauges[0].found)
        right = self.failure or _told(self._picture, self._gauges[1].found)
        for side, text in enumerate((left, f"{self.sides.name}\n{right}")):
            if room[side] < 6.0 * em:
                continue
            imgui.set_next_window_pos((x + (2 * side - 1) * em, y), imgui.Cond_.always.value, (1.0 - side, 1.0))
            imgui.set_next_window_bg_alpha(0.75)
            imgui.begin(f"##side {side}", None, overlay.UNTOUCHED)
            imgui.push_text_wrap_pos(max(room[side] - 3.0 * em, em))
            imgui.push_style_color(imgui.Col_.text, theme.ERROR if side and self.failure else theme.TEXT)
            imgui.text_unformatted(text)
            imgui.pop_style_color()
            imgui.pop_text_wrap_pos()
            imgui.end()

    def _choices(self, state: WindowState, left_top: Corner, size: Corner) -> None:
        em = hello_imgui.em_size()
        # Beside the compass, and under it where the picture is too narrow for both.
        narrow = size[0] < (_CHOICES_EM + 8.0) * em
        place = (left_top[0] + 0.6 * em, left_top[1] + 7.2 * em) if narrow else (left_top[0] + size[0] - 7.5 * em, left_top[1] + 0.6 * em)
        imgui.set_next_window_pos(place, imgui.Cond_.appearing.value, (0.0 if narrow else 1.0, 0.0))
        state.show_sides = tool_window.draw(TITLE, lambda: self._choice(state), _FLAGS.always_auto_resize)

    def _choice(self, state: WindowState) -> None:
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted("On the right")
        imgui.same_line()
        imgui.set_next_item_width(18.0 * hello_imgui.em_size())
        self._picker(state)
        if imgui.button("Keep this picture there"):
            self.sides.keep(state.scene)
        imgui.set_item_tooltip("What is shown now stays on the right, whatever the panel changes on the left.")
        imgui.same_line()
        if imgui.button("Swap"):
            self.sides.swap(state)

    def _picker(self, state: WindowState) -> None:
        if not imgui.begin_combo("##other side", self.sides.name, imgui.ComboFlags_.height_large.value):
            self._presets = []
            return
        self._presets = self._presets or presets.available()
        if imgui.selectable(f"{MOST_ACCURATE}##most accurate", self.sides.name == MOST_ACCURATE)[0]:
            self.sides.take_most_accurate()
        if self.sides.name == KEPT:
            imgui.selectable(f"{KEPT}##kept", True)
        for info in self._presets:
            if imgui.selectable(f"{info.title}##{info.name}", self.sides.name == info.title)[0]:
                try:
                    self.sides.take_preset(info, state.scene)
                except SceneError as error:
                    state.complain(str(error))
        imgui.end_combo()


def _told(picture: Picture | None, figures: Gauged | None) -> str:
    """A side's method with its error and cost."""
    if picture is None or picture.report is None:
        return "preparing …"
    return f"{picture.report.method}\n{figures if figures is not None else 'to be measured at rest'}"
