"""The values of the pixel under the mouse, beside it."""

from __future__ import annotations

import math

from imgui_bundle import hello_imgui, imgui

from ..glsl.declared import Fate
from ..rendering.pixel_values import PixelValues
from . import overlay, theme
from .overlay import Corner
from .picture import Picture
from .state import WindowState

_ORDERS = ("direct image (n = 0)", "first ring (n = 1)", "second ring (n = 2)")
_ENDS = {Fate.UNRESOLVED: "unresolved: too few steps", Fate.CAPTURED: "the hole"}


class MouseValues:
    """Asks for the pixel that the mouse is over, and draws what it has."""

    def __init__(self) -> None:
        self._of: tuple[object, ...] | None = None
        self._values: PixelValues | None = None

    def frame(self, state: WindowState, picture: Picture, left_top: Corner, size: Corner) -> None:
        """Draws the values of the pixel that the mouse is over in the last `picture`, if they are to be shown. Two pictures side by side have none.

        Args:
            left_top, size: of the picture, in imgui's units.
        """
        io = imgui.get_io()
        wanted = state.show_values and not state.show_sides and not io.want_capture_mouse and not state.camera_moves
        x, y = (io.mouse_pos.x - left_top[0]) / max(size[0], 1.0), 1.0 - (io.mouse_pos.y - left_top[1]) / max(size[1], 1.0)
        self._read(picture, (x, y) if wanted and 0.0 <= x < 1.0 and 0.0 <= y < 1.0 else None)
        if self._values is not None:
            _draw(lines(self._values), (io.mouse_pos.x, io.mouse_pos.y), left_top, size)

    def _read(self, picture: Picture, place: Corner | None) -> None:
        """Reads the pixel at `place`, when it is another or the picture's hits are."""
        if place is None or not picture.is_current or picture.report is None:
            self._of = self._values = None
            return
        asked = (place, picture.renderer.hit_map.generation, picture.report)
        if asked != self._of:
            self._of, self._values = asked, picture.renderer.last.values_at(place)


def lines(values: PixelValues) -> list[str]:
    """What is told, a line each."""
    found = []
    if values.disk is not None:
        disk = values.disk
        found += [f"disk: {_ORDERS[disk.order]}", f"r = {disk.radius:.4g} r_s   φ = {math.degrees(disk.azimuth):.1f}°"]
        found.append(f"g = {disk.g:.4g}   T = {disk.temperature:.4g} K")
    if values.met:
        found.append(f"meets {values.met}, which ends it" if values.fate == Fate.MET else f"meets {values.met}")
    end = "behind it: " if found else ""
    if values.sky is not None:
        theta, phi = (math.degrees(angle) for angle in values.sky)
        found.append(f"{end}sky, θ = {theta:.2f}°   φ = {phi:.2f}°")
    elif values.fate != Fate.MET:
        found.append(end + _ENDS[values.fate])
    if math.isfinite(values.lam):
        rest = f"b = {values.impact:.4g} M" if math.isfinite(values.impact) else f"Q = {values.eta:.4g} M²"
        found.append(f"λ = {values.lam:.4g} M   {rest}")
    if values.screen is not None:
        found.append(f"α = {values.screen[0]:.4g} M   β = {values.screen[1]:.4g} M")
    return found


def _draw(told: list[str], mouse: Corner, left_top: Corner, size: Corner) -> None:
    """Beside the mouse, on the side where the picture has more room."""
    em = hello_imgui.em_size()
    right, below = mouse[0] - left_top[0] > 0.5 * size[0], mouse[1] - left_top[1] > 0.5 * size[1]
    corner = mouse[0] + (-1.2 if right else 1.2) * em, mouse[1] + (-0.6 if below else 1.2) * em
    imgui.set_next_window_pos(corner, imgui.Cond_.always.value, (float(right), float(below)))
    imgui.set_next_window_bg_alpha(0.8)
    overlay.begin_above("##values", overlay.UNTOUCHED)
    for line in told:
        imgui.text_colored(theme.TEXT, line)
    imgui.end()
