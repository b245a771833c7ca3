"""The live chart: error against cost of the methods on the view of the moment. A click on a point uses that method."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
from imgui_bundle import ImVec4, hello_imgui, imgui, implot

from .. import planning
from ..measure import live
from ..measure.live import Live, LivePoint
from ..planning import Plan
from ..scene import Scene, SceneError, catalogue
from ..worker import Worker
from . import theme, tool_window
from .state import WindowState

TITLE = "Error and cost"
_REACH = 12.0  # in units of a 96 dpi screen: how near to a point the mouse must be
_HALF_A_PIXEL = 0.5
_RESTS = 0.4  # seconds of stillness before a new view is measured
_COLOURS = (
    (0.30, 0.62, 0.90), (0.95, 0.45, 0.20), (0.20, 0.75, 0.55), (0.85, 0.55, 0.75), (0.93, 0.72, 0.20), (0.50, 0.80, 0.95),
    (0.70, 0.50, 0.35), (0.95, 0.90, 0.40), (0.62, 0.60, 0.95), (0.75, 0.85, 0.35), (0.60, 0.60, 0.60), (0.85, 0.30, 0.35),
)  # fmt: skip


class LiveChart:
    """The chart's window and the measurement behind it.

    Args:
        make_renderer: makes a renderer of its own, so that the picture's hit map is left alone.
    """

    def __init__(self, make_renderer: Callable[[moderngl.Context], Any]):
        self._make_renderer = make_renderer
        self._renderer: Any = None
        self._worker = Worker()  # one for all views: its imports take longest
        self._live: Live | None = None
        self._view: tuple | None = None
        self._since = 0.0
        self.fit_next = True

    @property
    def points(self) -> list[LivePoint]:
        """What has been measured on the view so far."""
        return self._live.points if self._live else []

    def busy(self, state: WindowState) -> bool:
        """Whether frames are wanted although nothing moves."""
        return state.show_chart and (self._live is None or self._view != live.view_of(state.scene) or self._live.busy)

    def advance(self, gl: moderngl.Context, state: WindowState, now: float) -> None:
        """A small bit of measuring, when the chart is shown and the camera rests. Leaves the context with another framebuffer bound.

        Args:
            now: any clock in seconds.
        """
        if not state.show_chart or state.camera_moves:  # scene time bends no ray
            self._since = now
            return
        view = live.view_of(state.scene)
        if view != self._view:
            self._since, self._view = now, view
            if self._live is not None:
                self._live.cancel()
            self._live = None
        if self._live is None:
            if now - self._since >= _RESTS:
                self._live = Live(state.scene, self._worker)
                self.fit_next = True
            return
        if not self._live.busy:
            return
        if self._renderer is None:
            self._renderer = self._make_renderer(gl)
        self.fit_next |= self._live.advance(self._renderer)

    def close(self) -> None:
        """Ends the measurement's other process, if there is one; what it is at is thrown away."""
        self._worker.close()

    def draw(self, state: WindowState) -> None:
        """The chart's window, when it is wanted; its close button puts it away."""
        if not state.show_chart:
            return
        tool_window.begins_in_the_corner(44.0, 26.0)
        state.show_chart = tool_window.draw(TITLE, lambda: self._contents(state))

    def _contents(self, state: WindowState) -> None:
        self._status()
        self._plot(state)

    def _status(self) -> None:
        if self._live is None:
            text = "waiting for the camera to rest"
        elif self._live.failure:
            text = self._live.failure
        elif self._live.waiting:
            text = "tracing the reference in float64 …"
        elif self._live.busy:
            text = f"measuring: {self._live.share:.0%}"
        else:
            text = "click a point to use that method"
        imgui.text_colored(theme.QUIET, text)

    def _plot(self, state: WindowState) -> None:
        shown = [point for point in self.points if point.pixels > 0.0]  # false for NaN too
        if self.fit_next or not shown:
            implot.set_next_axes_limits(*room_for(shown), implot.Cond_.always.value)
            self.fit_next = False
        if not implot.begin_plot("##methods", (-1.0, -1.0), implot.Flags_.no_mouse_text.value):
            return
        implot.setup_axes("frame time / flat frame", "error at 99 % of the rays [pixels at 1080p]")
        for axis in (implot.ImAxis_.x1, implot.ImAxis_.y1):
            implot.setup_axis_scale(axis.value, implot.Scale_.log10.value)
        implot.setup_legend(implot.Location_.east.value, implot.LegendFlags_.outside.value)
        for model in dict.fromkeys(point.method.model for point in shown):
            _plot_model(model, shown)
        if shown:
            implot.plot_inf_lines("half a pixel", np.array([_HALF_A_PIXEL]), spec=_spec(theme.DIM, flags=implot.InfLinesFlags_.horizontal.value))
        used = _in_use(shown, state.scene)
        if used:
            _ring("in use", used, theme.ACCENT)
        near = _nearest(shown) if implot.is_plot_hovered() else None
        if near is not None:
            _ring("##near", [near], theme.TEXT)
            _tooltip(near)
            if imgui.is_mouse_clicked(imgui.MouseButton_.left):
                use(near, state)
        implot.end_plot()


def room_for(points: list[LivePoint]) -> tuple[float, float, float, float]:
    """Least and most of either axis, so that they hold `points` with room around them.

    implot's own fit pads logarithms as if they were lengths, and without points goes to the end of the numbers.
    """
    costs, errors = [point.cost for point in points] or [1.0, 10.0], [*(point.pixels for point in points), _HALF_A_PIXEL]
    return min(costs) / 1.4, max(costs) * 1.4, min(errors) / 3.0, max(errors) * 3.0


def use(point: LivePoint, state: WindowState) -> None:
    """Has the picture traced by the point's method."""
    state.change(point.method.values(point.setting))
    state.say(f"Traced by {label(point)}")


def is_used(point: LivePoint, scene: Scene, ray_plan: Plan) -> bool:
    """Whether `ray_plan`, that of `scene`, is the point's method with its step."""
    method = point.method
    if ray_plan.model.key != method.model or any(scene.get(key) != value for key, value in method.changes):
        return False
    if ray_plan.integrator is None or ray_plan.step_control is None:
        return True
    setting = {"angle": ray_plan.step_angle, "length": ray_plan.step_length}.get(method.knob)
    same = (ray_plan.integrator.key, ray_plan.step_control.key) == (method.integrator, method.step_control)
    return same and point.setting == (scene.get(method.knob_key) if setting is None else setting)


def _in_use(points: list[LivePoint], scene: Scene) -> list[LivePoint]:
    try:
        ray_plan = planning.plan(scene)
    except SceneError:  # parts that do not fit together; the window says so
        return []
    return [point for point in points if is_used(point, scene, ray_plan)]


def label(point: LivePoint) -> str:
    """The point's method with its step, in a few words."""
    sign = {"angle": "κ = ", "length": "Δt₀ = ", "tolerance": "tolerance "}.get(point.method.knob)
    return point.method.name + (f", {sign}{point.setting:g}" if sign else "")


def _plot_model(model: str, points: list[LivePoint]) -> None:
    """All curves of a model under one entry of the legend."""
    colour = _colour(model)
    for method in dict.fromkeys(point.method for point in points if point.method.model == model):
        curve = [point for point in points if point.method == method]
        order = sorted(curve, key=lambda point: -point.setting)
        costs, errors = np.array([point.cost for point in order]), np.array([point.pixels for point in order])
        implot.plot_line(model, costs, errors, spec=_spec(colour))
        implot.plot_scatter(model, costs, errors, spec=_spec(colour, marker=_marker(method.integrator)))


def _colour(model: str) -> ImVec4:
    red, green, blue = _COLOURS[list(catalogue.keys("ray_model")).index(model) % len(_COLOURS)]
    return ImVec4(red, green, blue, 1.0)


def _marker(integrator: str) -> int:
    kinds = implot.Marker_
    known = {"rk4": kinds.circle, "dopri5": kinds.diamond, "bs3": kinds.up, "verlet": kinds.square, "euler": kinds.down}
    return known.get(integrator, kinds.cross).value


def _spec(colour: ImVec4, marker: int | None = None, flags: int = 0) -> implot.Spec:
    spec = implot.Spec()
    spec.line_color = spec.marker_line_color = spec.marker_fill_color = colour
    spec.flags = flags
    if marker is not None:
        spec.marker = marker
        spec.marker_size = 0.28 * hello_imgui.em_size()
    return spec


def _ring(name: str, points: list[LivePoint], colour: ImVec4) -> None:
    spec = _spec(colour, implot.Marker_.circle.value)
    spec.marker_size = 0.6 * hello_imgui.em_size()
    spec.marker_fill_color = ImVec4(0.0, 0.0, 0.0, 0.0)
    spec.line_weight = 2.0
    implot.plot_scatter(name, np.array([p.cost for p in points]), np.array([p.pixels for p in points]), spec=spec)


def _nearest(points: list[LivePoint]) -> LivePoint | None:
    """The point under the mouse."""
    mouse = imgui.get_mouse_pos()

    def distance(point: LivePoint) -> float:
        place = implot.plot_to_pixels(point.cost, point.pixels)
        return math.hypot(place.x - mouse.x, place.y - mouse.y)

    nearest = min(points, key=distance, default=None)
    return nearest if nearest is not None and distance(nearest) <= _REACH * hello_imgui.em_size() / theme.FONT_SIZE else None


def _tooltip(point: LivePoint) -> None:
    if imgui.begin_tooltip():
        imgui.text_colored(theme.ACCENT, label(point))
        imgui.text_unformatted(f"{point.pixels:.2g} pixels ({point.error:.1e} rad) at 99 % of the rays")
        imgui.text_unformatted(f"{point.wrong_fates:.1%} of the rays end wrongly")
        imgui.text_unformatted(f"{point.cost:.1f} flat frames, {point.evaluations:.0f} evaluations a ray")
        imgui.end_tooltip()
