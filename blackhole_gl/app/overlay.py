"""What is written over the picture: figures, notices and errors."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable

import numpy as np
from imgui_bundle import ImVec4, hello_imgui, imgui

from ..physics import angular_size
from . import compass, theme
from .picture import Picture
from .state import Notice, WindowState

_FLAGS = imgui.WindowFlags_
STILL = _FLAGS.no_decoration | _FLAGS.no_docking | _FLAGS.no_move | _FLAGS.no_nav | _FLAGS.no_saved_settings
_FIXED = (STILL | _FLAGS.always_auto_resize | _FLAGS.no_focus_on_appearing).value
UNTOUCHED = _FIXED | _FLAGS.no_inputs.value

_COMPASS_EM = 6.0  # its width and height

PREPARING_AFTER_S = 0.3  # a note that comes and goes at once would only flicker

Corner = tuple[float, float]  # a place in the window, in imgui's units from the top left
Box = tuple[float, float, float, float]  # left, top, right and bottom of a part of the window
_At = Callable[[np.ndarray], Corner]  # of a place in the compass's square


def figures(state: WindowState, picture: Picture, corner: Corner) -> Box | None:
    """The renderer's figures, with their top left at `corner`; where they stand, if they do."""
    report = picture.report
    if not state.show_overlay or report is None:
        return None
    imgui.set_next_window_pos(corner)
    imgui.set_next_window_bg_alpha(0.6)
    imgui.begin("##figures", None, UNTOUCHED)
    speed = f"{imgui.get_io().framerate:.0f} fps" if state.is_moving else "at rest"
    trace = f"{report.trace_ms:.1f} ms" if report.traced else "kept"
    imgui.text_colored(theme.QUIET, f"{speed}, paused" if state.paused else speed)
    imgui.text_colored(theme.QUIET, f"trace {trace}   shade {report.shade_ms:.1f} ms   post {report.post_ms:.1f} ms")
    imgui.text_colored(theme.QUIET, report.method)
    if on_the_sky := angular_size.told(state.scene):
        imgui.text_colored(theme.QUIET, on_the_sky)
    if picture.rays is not None:
        imgui.text_colored(theme.QUIET, f"{picture.rays.steps:.1f} steps a ray")
        colour = theme.ERROR if picture.rays.unresolved else theme.QUIET
        imgui.text_colored(colour, f"{picture.rays.unresolved} unresolved rays")
    if round(report.stops, 1):
        imgui.text_colored(theme.QUIET, f"exposure {report.stops:+.1f} stops")
    for warning in report.warnings:
        imgui.text_colored(theme.DEPARTS, warning.partition(",")[0].partition(":")[0])
    if not report.sharp:
        imgui.text_colored(theme.QUIET, "interpolated between exact rays" if state.is_moving else "sharpening")
    if picture.samples > 1:
        imgui.text_colored(theme.QUIET, f"{picture.samples} rays a pixel")
    if picture.scale < 1.0:
        imgui.text_colored(theme.QUIET, f"{picture.scale:.2f} of full resolution")
    size = imgui.get_window_size()
    imgui.end()
    return *corner, corner[0] + size.x, corner[1] + size.y


def directions(state: WindowState, corner: Corner) -> Box | None:
    """The compass, with its top right at `corner`, and where it stands; none where the camera cannot be."""
    if not state.show_overlay:
        return None
    try:
        shown = compass.of(state.scene)
    except ValueError:  # the picture fails for the same reason, which is told
        return None
    em = hello_imgui.em_size()
    side = _COMPASS_EM * em
    origin = corner[0] - side, corner[1]
    canvas = imgui.get_background_draw_list()
    canvas.add_circle_filled((origin[0] + 0.5 * side, origin[1] + 0.5 * side), 0.5 * side, _code(theme.BACKDROP))

    def at(place: np.ndarray) -> Corner:
        return origin[0] + side * float(place[0]), origin[1] + side * float(place[1])

    _circle(canvas, shown, at)
    _axis(canvas, shown, at, 0.4 * em)
    _hole(canvas, shown, at, 0.25 * em)
    return *origin, corner[0], corner[1] + side


def _circle(canvas: imgui.ImDrawList, shown: compass.Compass, at: _At) -> None:
    """The plane of the disk, bright where it comes towards the camera."""
    corners = [at(place) for place in shown.circle]
    near, far = _code(theme.TEXT), _code(theme.FAINT)
    for here, there, is_near in zip(corners, corners[1:], shown.circle_is_near):
        canvas.add_line(here, there, near if is_near else far, 1.5)


def _axis(canvas: imgui.ImDrawList, shown: compass.Compass, at: _At, head: float) -> None:
    """The axis, an arrow if there is a spin."""
    colour, (tail, tip) = _code(theme.ACCENT), (at(place) for place in shown.axis)
    canvas.add_line(tail, tip, colour, 1.5)
    length = math.dist(tail, tip)
    if not shown.spins or length < head:  # seen from above a pole it is a point
        return
    x, y = head * (tip[0] - tail[0]) / length, head * (tip[1] - tail[1]) / length
    canvas.add_triangle_filled(tip, (tip[0] - x - 0.5 * y, tip[1] - y + 0.5 * x), (tip[0] - x + 0.5 * y, tip[1] - y - 0.5 * x), colour)


def _hole(canvas: imgui.ImDrawList, shown: compass.Compass, at: _At, radius: float) -> None:
    """The direction to the hole: black with a rim where the hole is before the camera, the rim alone where it is behind."""
    middle, end = at(np.array([0.5, 0.5])), at(shown.hole)
    canvas.add_line(middle, end, _code(theme.FAINT), 1.5)
    if shown.hole_is_ahead:
        canvas.add_circle_filled(end, radius, _code(theme.HOLE))
    canvas.add_circle(end, radius, _code(theme.TEXT if shown.hole_is_ahead else theme.FAINT), 0, 1.5)


def _code(colour: ImVec4) -> int:
    return imgui.color_convert_float4_to_u32(colour)


def messages(state: WindowState, picture: Picture | None, corner: Corner, width: float) -> None:
    """Errors and the notice, with their bottom left at `corner`, at most `width` wide; errors stay until mended or dismissed."""
    since = picture.preparation.since if picture and not picture.bridges else None
    if since is not None and clock.perf_counter() - since > PREPARING_AFTER_S:
        corner = _message("Preparing", "Preparing the programs of this scene …", corner, width, is_error=False)
    if state.way_out:
        corner = _message("Way out", state.way_out, corner, width, is_error=False)
    if state.recording:
        corner = _message("Recording", state.recording, corner, width, is_error=False)
    if state.shader_error:
        corner = _message("Shader", state.shader_error, corner, width, is_error=True)
    if state.render_error:
        corner = _message("Renderer", state.render_error, corner, width, is_error=True)
    if state.notice and _dismissable("Notice", state.notice, corner, width):
        state.notice = None


def _dismissable(name: str, notice: Notice, corner: Corner, width: float) -> bool:
    _begin_message(name, corner, width, _FIXED if notice.is_error else UNTOUCHED)
    dismissed = notice.is_error and imgui.small_button("x")
    if notice.is_error:
        imgui.same_line()
    _body(notice.text, notice.is_error, width)
    imgui.end()
    return dismissed


def _message(name: str, text: str, corner: Corner, width: float, *, is_error: bool) -> Corner:
    _begin_message(name, corner, width, UNTOUCHED)
    _body(text, is_error, width)
    height = imgui.get_window_height()
    imgui.end()
    return corner[0], corner[1] - height - 0.5 * hello_imgui.em_size()


def _begin_message(name: str, corner: Corner, width: float, flags: int) -> None:
    imgui.set_next_window_pos(corner, imgui.Cond_.always.value, (0.0, 1.0))
    imgui.set_next_window_size_constraints((0.0, 0.0), (width, 1e4))
    imgui.set_next_window_bg_alpha(0.85)
    begin_above(f"{name}##message", flags)


def begin_above(name: str, flags: int) -> None:
    """Begins a window that tells something now, above those that were opened to stay: the path view would hide it."""
    imgui.begin(name, None, flags)
    imgui.internal.bring_window_to_display_front(imgui.internal.get_current_window())


def _body(text: str, is_error: bool, width: float) -> None:
    imgui.push_text_wrap_pos(width - 2.0 * imgui.get_style().window_padding.x)
    imgui.push_style_color(imgui.Col_.text, theme.ERROR if is_error else theme.TEXT)
    imgui.text_unformatted(text)
    imgui.pop_style_color()
    imgui.pop_text_wrap_pos()
