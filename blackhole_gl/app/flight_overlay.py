"""What is told over the picture while a flight is flown: the two clocks, where on its way the traveller is, and in a run that explains what is seen."""

from __future__ import annotations

import math

import numpy as np
from imgui_bundle import ImVec4, hello_imgui, imgui

from ..physics.flight import Flight, Moment
from ..scene import Scene
from . import flight_inset, theme
from .overlay import UNTOUCHED, Box, Corner
from .state import WindowState

_INSET_EM, _NOTE_EM = 9.0, 46.0
_HOLE = ImVec4(0.0, 0.0, 0.0, 1.0)


class FlightOverlay:
    """Remembers the map of the flight that it drew last."""

    def __init__(self) -> None:
        self._mapped: tuple[Flight, flight_inset.Inset] | None = None

    def draw(self, state: WindowState, right_top: Corner, middle_top: Corner, width: float) -> list[Box]:
        """Draws it, and tells where it stands: clocks and map with their top right at `right_top`, the note with its upper edge at `middle_top`, no wider than
        `width`.

        Nothing while the flight's window is away and nothing plays.
        """
        now = state.timeline
        if now.flight is None or now.moment is None or not (state.show_timeline or now.plays):
            return []
        if self._mapped is None or self._mapped[0] is not now.flight:
            self._mapped = now.flight, flight_inset.of(now.flight)
        found = [_clocks_and_map(self._mapped[1], now.moment, state.scene, right_top)]
        if now.note:
            found.append(_note(now.note, middle_top, min(width, _NOTE_EM * hello_imgui.em_size())))
        return found


def _clocks_and_map(shown: flight_inset.Inset, moment: Moment, scene: Scene, right_top: Corner) -> Box:
    imgui.set_next_window_pos(right_top, imgui.Cond_.always.value, (1.0, 0.0))
    imgui.set_next_window_bg_alpha(0.6)
    imgui.begin("##flight clocks", None, UNTOUCHED)
    for name, value in clocks(moment):
        imgui.text_colored(theme.QUIET, name)
        imgui.same_line(6.5 * hello_imgui.em_size())
        imgui.text_colored(theme.TEXT, value)
    side = _INSET_EM * hello_imgui.em_size()
    corner = imgui.get_cursor_screen_pos()
    imgui.dummy((side, side))
    _map(shown, scene, (corner.x, corner.y), side)
    return _ended()


def clocks(moment: Moment) -> list[tuple[str, str]]:
    """(what, value) of all that the traveller reads: two clocks on a way of gravity's, else the scene's."""
    r = ("r", f"{moment.scene.camera.distance:.4g} r_s")
    if math.isnan(moment.proper_time):
        return [("scene time", f"{moment.time:.2f} r_s/c"), r]
    far = f"{moment.far_time:.2f} r_s/c" if math.isfinite(moment.far_time) else "never"
    speed = [("speed", f"{moment.speed:.3f} c")] if moment.speed < 1.0 else []
    return [("own clock", f"{moment.proper_time:.2f} r_s/c"), ("far away", far), r, *speed]


def _map(shown: flight_inset.Inset, scene: Scene, corner: Corner, side: float) -> None:
    canvas = imgui.get_window_draw_list()

    def at(place: np.ndarray) -> tuple[float, float]:
        return corner[0] + side * float(place[0]), corner[1] + side * float(place[1])

    def line(places: np.ndarray, colour: ImVec4, thick: float) -> None:
        canvas.add_polyline([imgui.ImVec2(*at(place)) for place in places], imgui.get_color_u32(colour), thick, 0)

    for circle in shown.circles:
        line(circle, theme.FAINT, 1.5)
    line(shown.way, theme.QUIET, 1.5)
    if shown.hole:
        middle, radius = at(np.array([0.5, 0.5])), max(side * shown.hole, 2.0)
        canvas.add_circle_filled(middle, radius, imgui.get_color_u32(_HOLE))
        canvas.add_circle(middle, radius, imgui.get_color_u32(theme.TEXT), 0, 1.5)
    canvas.add_circle_filled(at(shown.place(scene)), 0.3 * hello_imgui.em_size(), imgui.get_color_u32(theme.ACCENT))


def _note(text: str, top: Corner, width: float) -> Box:
    imgui.set_next_window_pos(top, imgui.Cond_.always.value, (0.5, 0.0))
    imgui.set_next_window_size((width, 0.0))
    imgui.set_next_window_bg_alpha(0.7)
    imgui.begin("##flight note", None, UNTOUCHED & ~imgui.WindowFlags_.always_auto_resize.value)
    imgui.text_wrapped(text)
    return _ended()


def _ended() -> Box:
    """Where the window stands that ends here."""
    corner, size = imgui.get_window_pos(), imgui.get_window_size()
    imgui.end()
    return corner.x, corner.y, corner.x + size.x, corner.y + size.y
