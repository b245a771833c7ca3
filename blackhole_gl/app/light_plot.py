"""The plot of a light curve: the light of the whole picture over one turn of what moves, drawn while the view rests, and where in it scene time is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
from imgui_bundle import ImVec4, imgui, implot

from ..measure import light_curve
from ..measure.light_curve import LightCurve
from ..scene import Scene, SceneError
from . import theme, tool_window
from .state import WindowState

TITLE = "Light curve"
_RESTS = 0.4  # seconds of stillness before a new view is drawn
_TIMES, _SIZE = 64, (192, 108)  # a small picture a frame
_COLOUR = ImVec4(0.95, 0.55, 0.20, 1.0)


class LightPlot:
    """The plot's window and the pictures behind it.

    Args:
        make_renderer: makes a renderer of its own, so that the picture's hit map is left alone.

    Attributes:
        curve: of the last view, as far as it is drawn; None before the first.
    """

    def __init__(self, make_renderer: Callable[[moderngl.Context], Any]):
        self._make_renderer = make_renderer
        self._renderer: Any = None
        self._parts: Iterator[LightCurve] | None = None
        self._view: Scene | None = None
        self._turn = 1.0
        self._since = 0.0
        self._failure = ""
        self.curve: LightCurve | None = None

    def busy(self, state: WindowState) -> bool:
        """Whether frames are wanted although nothing moves."""
        return state.show_light and (self._parts is not None or self._view != _wanted(state.scene))

    def advance(self, gl: moderngl.Context, state: WindowState, now: float) -> None:
        """Draws one time of the curve, when the plot is shown and the camera rests. Leaves the context with another framebuffer bound.

        Args:
            now: any clock in seconds.
        """
        if not state.show_light or state.camera_moves:
            self._since = now
            return
        wanted = _wanted(state.scene)
        try:
            if wanted != self._view and now - self._since >= _RESTS:
                if self._renderer is None:
                    self._renderer = self._make_renderer(gl)
                self._view, self._failure, self._turn = wanted, "", light_curve.turn(wanted)
                self._parts = light_curve.in_parts(self._renderer, wanted, light_curve.times(wanted, _TIMES), _SIZE)
            if self._parts is not None:
                self.curve = next(self._parts)
                self._parts = None if len(self.curve.time) == _TIMES else self._parts
        except SceneError as error:
            self._parts, self.curve, self._failure = None, None, str(error)

    def draw(self, state: WindowState) -> None:
        """The plot's window, when it is wanted; its close button puts it away."""
        if not state.show_light:
            return
        tool_window.begins_in_the_corner(40.0, 20.0)
        state.show_light = tool_window.draw(TITLE, lambda: self._contents(state.time))

    def _contents(self, time: float) -> None:
        if self._failure:
            imgui.text_wrapped(self._failure)
        elif self.curve is None or self._view is None:
            imgui.text_colored(theme.QUIET, "waiting for the camera to rest")
        else:
            how = "as it arrives" if self._view.rays.light_travel else "all at once: rays.light_travel is off"
            imgui.text_colored(theme.QUIET, f"{self.curve.relative.min():.2f} to {self.curve.relative.max():.2f} of the mean; {how}")
        if not implot.begin_plot("##light", (-1.0, -1.0), implot.Flags_.no_mouse_text.value | implot.Flags_.no_legend.value):
            return
        implot.setup_axes("time within a turn, r_s/c", "light over its mean", implot.AxisFlags_.none.value, implot.AxisFlags_.auto_fit.value)
        implot.setup_axis_limits(implot.ImAxis_.x1.value, 0.0, self._turn, implot.Cond_.always.value)
        if self.curve is not None:
            spec = implot.Spec()
            spec.line_color = _COLOUR
            implot.plot_line("light", np.ascontiguousarray(self.curve.time), np.ascontiguousarray(self.curve.relative), spec=spec)
            here = implot.Spec()
            here.line_color = theme.TEXT
            implot.plot_inf_lines("now", np.array([time % self._turn]), spec=here)
        implot.end_plot()


def _wanted(scene: Scene) -> Scene:
    """`scene` with what no light depends on as in any other."""
    return replace(scene, playback=type(scene.playback)(), post=replace(type(scene.post)(), view=scene.post.view))
