"""The path view: rays of clicked pixels in space, with the hole, the photon shell and the disk. The steps of their march are dots, coloured by error."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import moderngl
import numpy as np
from imgui_bundle import ImVec4, hello_imgui, imgui, implot3d

from ..rendering.recording import RayPath, Recorder
from ..rendering.views import Scale, scale_of
from ..scene import SceneError
from . import path_world, theme, tool_window, view_scale
from .area import Area
from .click import Click
from .path_world import PathWorld
from .paths import Asked, Paths, Shown, told, within
from .state import WindowState

TITLE = "Paths of light"
_LOCAL_ERROR = Scale(1e-7, 0.1, "rad", True, False, (1e-7, 1e-5, 1e-3, 0.1))
_COLOURED_BY = ("error of the step", "drift of what is conserved")
_REACH = 8.0  # how near to a dot the mouse must be
_LIST_EM = 21.0
_SCALE_EM, _PICKER_EM = 3.0, 16.0
_BOX_SCALE = 1.5  # imgui's plot leaves much room round the box, which nothing here needs
_COLOURS = ((0.95, 0.62, 0.25), (0.35, 0.70, 0.95), (0.30, 0.80, 0.55), (0.90, 0.55, 0.75), (0.95, 0.90, 0.40), (0.65, 0.60, 0.95))
_BALL = ImVec4(0.02, 0.02, 0.025, 1.0)
_BALL_NET = ImVec4(0.30, 0.30, 0.34, 1.0)
_SHELL = ImVec4(0.55, 0.75, 1.0, 0.30)
_DISK = ImVec4(0.95, 0.55, 0.20, 0.16)
_DISK_EDGE = ImVec4(0.95, 0.55, 0.20, 0.65)
_QUIET = implot3d.ItemFlags_.no_legend.value

Corner = tuple[float, float]


class PathView:
    """The view's window, the clicks that fill it, and the recorder behind it.

    Attributes:
        paths: the rays shown.
        coloured_by: an index of `_COLOURED_BY`.
    """

    def __init__(self) -> None:
        self.paths = Paths()
        self._recorder: Recorder | None = None
        self.coloured_by = 0
        self._click = Click()
        self._fit_next = True

    @property
    def busy(self) -> bool:
        """Whether a frame is wanted although nothing moves."""
        return self.paths.busy

    def advance(self, gl: moderngl.Context, renderer: Any) -> None:
        """Records a ray, if one was asked for. Leaves the context with another framebuffer bound.

        Args:
            renderer: the picture's, whose programs are shared.
        """
        if not self.paths.busy:
            return
        if self._recorder is None:
            self._recorder = Recorder(gl, renderer.programs)
        deadline, renderer.programs.deadline = renderer.programs.deadline, math.inf
        self.paths.advance(self._recorder.record)
        renderer.programs.deadline = deadline

    def frame(self, state: WindowState, left_top: Corner, size: Corner, area: Area) -> None:
        """Takes clicks on the picture, marks the pixels of the rays there, and draws the window; nothing of that while it is put away.

        Args:
            left_top, size: of the picture, in imgui's units.
            area: of the picture, in framebuffer pixels.
        """
        if not state.show_paths or area.is_empty:
            self._click.forget()
            return
        place = self._click.poll(left_top, size)
        if place is not None:
            pixel = math.floor(place[0] * area.width) + 0.5, math.floor(place[1] * area.height) + 0.5
            self.paths.ask(Asked(state.scene, area.size, pixel))
        self._mark_pixels(state, left_top, size)
        self._draw(state)

    def _mark_pixels(self, state: WindowState, left_top: Corner, size: Corner) -> None:
        canvas, em = imgui.get_background_draw_list(), hello_imgui.em_size()
        for index, item in enumerate(self.paths.shown):
            asked = item.asked
            if asked.scene.camera == state.scene.camera and asked.scene.hole == state.scene.hole:
                place = left_top[0] + asked.pixel[0] / asked.size[0] * size[0], left_top[1] + (1.0 - asked.pixel[1] / asked.size[1]) * size[1]
                canvas.add_circle(place, 0.35 * em, imgui.get_color_u32(_colour(index)), 0, 2.0)

    def _draw(self, state: WindowState) -> None:
        em, viewport = hello_imgui.em_size(), imgui.get_main_viewport()
        imgui.set_next_window_pos((viewport.pos.x + 1.5 * em, viewport.pos.y + 0.5 * viewport.size.y), imgui.Cond_.first_use_ever.value)
        imgui.set_next_window_size((58.0 * em, 0.48 * viewport.size.y), imgui.Cond_.first_use_ever.value)
        state.show_paths = tool_window.draw(TITLE, lambda: self._contents(state, em))

    def _contents(self, state: WindowState, em: float) -> None:
        if imgui.begin_child("list", (_LIST_EM * em, 0.0)):
            self._list(state)
        imgui.end_child()
        imgui.same_line()
        imgui.begin_group()
        self._space(state, imgui.get_content_region_avail().y - _SCALE_EM * em)
        self._scale_row()
        imgui.end_group()

    def _list(self, state: WindowState) -> None:
        if not self.paths.shown:
            imgui.text_wrapped("Click the picture: the ray of that pixel is drawn as its method traces it, a dot for each step.")
        if self.paths.failure:
            imgui.push_style_color(imgui.Col_.text, theme.ERROR)
            imgui.text_wrapped(self.paths.failure)
            imgui.pop_style_color()
        for index, item in enumerate(list(self.paths.shown)):
            self._row(index, item)
        if not self.paths.shown:
            return
        imgui.separator()
        if imgui.button("Again as traced now"):
            self.paths.again(lambda asked: asked.by(state.scene))
        imgui.set_item_tooltip("The same rays by the method that the picture has now, beside those that are there.")
        if imgui.button("Again by the most accurate method"):
            self.paths.again(Asked.by_most_accurate)
        if imgui.button("Remove all"):
            self.paths.clear()
        imgui.same_line()
        self._fit_next |= imgui.button("Fit")

    def _scale_row(self) -> None:
        em = hello_imgui.em_size()
        imgui.set_next_item_width(_PICKER_EM * em)
        _, self.coloured_by = imgui.combo("##dots", self.coloured_by, [f"dots: {name}" for name in _COLOURED_BY])
        imgui.same_line()
        view_scale.bar(_scale(bool(self.coloured_by)), max(imgui.get_content_region_avail().x, em), em)

    def _row(self, index: int, item: Shown) -> None:
        path = item.path
        if imgui.small_button(f"x##remove {index}"):
            self.paths.remove(item)
        imgui.same_line()
        imgui.text_colored(_colour(index), path.method)
        imgui.push_style_color(imgui.Col_.text, theme.DIM)
        imgui.text_wrapped(told(path))
        imgui.pop_style_color()
        if path.tunnels:
            imgui.push_style_color(imgui.Col_.text, theme.ERROR)
            imgui.text_wrapped(f"passes through the hole in step {', '.join(map(str, path.tunnels))}")
            imgui.pop_style_color()

    def _space(self, state: WindowState, height: float) -> None:
        scene = self.paths.shown[-1].asked.scene if self.paths.shown else state.scene
        try:
            world = path_world.of(scene)
        except (SceneError, ValueError) as error:  # parts that do not fit together; the window says so too
            imgui.text_wrapped(str(error))
            return
        flags = implot3d.Flags_.no_legend | implot3d.Flags_.no_mouse_text | implot3d.Flags_.equal | implot3d.Flags_.no_clip
        if not implot3d.begin_plot("##space", (-1.0, height), flags.value):
            return
        implot3d.setup_axes("x [r_s]", "y [r_s]", "z [r_s]")
        cond = imgui.Cond_.always if self._fit_next else imgui.Cond_.once
        self._fit_next = False
        implot3d.setup_box_scale(_BOX_SCALE, _BOX_SCALE, _BOX_SCALE)
        reach = world.reach
        implot3d.setup_axes_limits(-reach, reach, -reach, reach, -reach, reach, cond.value)
        implot3d.setup_box_initial_rotation(25.0, -60.0)
        _plot_world(world)
        for index, item in enumerate(self.paths.shown):
            _plot_path(index, _drawn(item, bool(self.coloured_by), 20.0 * reach))
        near, wrong = self._nearest_dot(), self._through_the_hole()
        corner, extent = implot3d.get_plot_rect_pos(), implot3d.get_plot_rect_size()
        implot3d.end_plot()
        canvas = imgui.get_window_draw_list()
        canvas.push_clip_rect(corner, (corner.x + extent.x, corner.y + extent.y), True)
        for here, there in wrong:  # over the ball, which hides what lies in it
            canvas.add_line(here, there, imgui.get_color_u32(theme.ERROR), 0.25 * hello_imgui.em_size())
        canvas.pop_clip_rect()
        if near is not None:
            _tooltip(*near)

    def _through_the_hole(self) -> list[tuple[imgui.ImVec2, imgui.ImVec2]]:
        """Where on the screen steps lead through the hole, in straight pieces."""
        pieces: list[tuple[imgui.ImVec2, imgui.ImVec2]] = []
        for path in (item.path for item in self.paths.shown):
            for point in np.flatnonzero(np.isin(path.step, path.tunnels)):
                here, there = (implot3d.plot_to_pixels(*map(float, place)) for place in path.points[point - 1 : point + 1])
                pieces.append((here, there))
        return pieces

    def _nearest_dot(self) -> tuple[RayPath, int] | None:
        """The ray and the point of it that the mouse is at."""
        corner, extent, mouse = implot3d.get_plot_rect_pos(), implot3d.get_plot_rect_size(), imgui.get_mouse_pos()
        if not (0.0 <= mouse.x - corner.x < extent.x and 0.0 <= mouse.y - corner.y < extent.y) or imgui.is_mouse_down(imgui.MouseButton_.left):
            return None
        best, found = _REACH * hello_imgui.em_size() / theme.FONT_SIZE, None
        for item in self.paths.shown:
            for point in np.flatnonzero(item.path.is_state):
                place = implot3d.plot_to_pixels(*map(float, item.path.points[point]))
                distance = math.hypot(place.x - mouse.x, place.y - mouse.y)
                if distance < best:
                    best, found = distance, (item.path, int(point))
        return found


def _scale(by_drift: bool) -> Scale:
    return scale_of("conservation") if by_drift else _LOCAL_ERROR


@dataclass(frozen=True, eq=False)
class _Drawn:
    """A ray as it is plotted: its line and its dots, x, y and z apart, and the dots' colours as imgui packs them."""

    line: tuple[np.ndarray, ...]
    dots: tuple[np.ndarray, ...]
    colours: np.ndarray


@lru_cache(maxsize=64)
def _drawn(item: Shown, by_drift: bool, reach: float) -> _Drawn:
    """What is plotted of a ray up to `reach`; the same in every frame. Dots are grey where nothing was measured."""
    path = item.path
    near = path.is_state & (np.linalg.norm(path.points, axis=1) < reach)
    values, scale = (path.drift if by_drift else path.error)[near], _scale(by_drift)
    colours, quiet = scale.colours(256), (theme.FAINT.x, theme.FAINT.y, theme.FAINT.z)
    picked = [colours[round(255 * scale.place(max(value, scale.low)))] if math.isfinite(value) else quiet for value in values.tolist()]
    codes = [imgui.color_convert_float4_to_u32((float(red), float(green), float(blue), 1.0)) for red, green, blue in picked]
    return _Drawn(_columns(within(path.points, reach)), _columns(path.points[near]), np.array(codes, np.uint32))


@lru_cache(maxsize=4)
def _ball(world: PathWorld) -> implot3d.Mesh:
    corners = [implot3d.Point(*map(float, corner)) for corner in world.hole_radius * world.ball]
    return implot3d.Mesh(corners, world.ball_faces.ravel().tolist())


def _columns(points: np.ndarray) -> tuple[np.ndarray, ...]:
    return tuple(np.ascontiguousarray(values) for values in points.T)


def _plot_path(index: int, drawn: _Drawn) -> None:
    _line(f"way {index}", drawn.line, _spec(_colour(index), 1.5))
    if not drawn.colours.size:
        return
    spec = _spec(_colour(index), 1.0)
    spec.marker, spec.marker_size = implot3d.Marker_.circle.value, 0.22 * hello_imgui.em_size()
    spec.marker_fill_colors = spec.marker_line_colors = drawn.colours
    x, y, z = drawn.dots
    implot3d.plot_scatter(f"##steps {index}", x, y, z, spec)


def _plot_world(world: PathWorld) -> None:
    spec = _spec(_BALL_NET, 0.5)
    spec.fill_color, spec.flags = _BALL, _QUIET
    implot3d.plot_mesh("##hole", _ball(world), spec)
    if len(world.disk):
        spec = _spec(_DISK, 0.0)
        spec.fill_color, spec.flags = _DISK, _QUIET | implot3d.TriangleFlags_.no_lines.value | implot3d.TriangleFlags_.no_markers.value
        x, y, z = _columns(world.disk)
        implot3d.plot_triangle("##disk", x, y, z, spec)
    for index, edge in enumerate(world.edges):
        _line(f"edge {index}", _columns(edge), _spec(_DISK_EDGE, 1.0))
    for index, outline in enumerate(world.shell):
        _line(f"shell {index}", _columns(outline), _spec(_SHELL, 1.0))


def _line(name: str, columns: tuple[np.ndarray, ...], spec: implot3d.Spec) -> None:
    x, y, z = columns
    if x.size > 1:
        implot3d.plot_line(f"##{name}", x, y, z, spec)


def _spec(colour: ImVec4, weight: float) -> implot3d.Spec:
    spec = implot3d.Spec()
    spec.line_color, spec.line_weight, spec.flags = colour, weight, _QUIET
    spec.marker = implot3d.Marker_.none.value
    return spec


def _tooltip(path: RayPath, point: int) -> None:
    if imgui.begin_tooltip():
        imgui.text_colored(theme.ACCENT, f"step {path.step[point]} of {path.steps}")
        imgui.text_unformatted(f"r = {np.linalg.norm(path.points[point]):.4g} r_s")
        imgui.text_unformatted(f"error of the step {path.error[point]:.1e} rad")
        if math.isfinite(path.drift[point]):
            imgui.text_unformatted(f"drift {path.drift[point]:.1e}")
        imgui.end_tooltip()


def _colour(index: int) -> ImVec4:
    colour: Sequence[float] = _COLOURS[index % len(_COLOURS)]
    return ImVec4(colour[0], colour[1], colour[2], 1.0)
