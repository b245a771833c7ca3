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
from ..scene import Scene
from . import theme, tool_window
from .at_rest import AtRest
from .state import WindowState

TITLE = "Light curve"
_TIMES, _SIZE = 64, (192, 108)  # a small picture a frame
_COLOUR = ImVec4(0.95, 0.55, 0.20, 1.0)


class LightPlot:
    """The plot's window and the pictures behind it.

    Args:
        make_renderer: makes a renderer of its own, so that the picture's hit map is left alone.
    """

    def __init__(self, make_renderer: Callable[[moderngl.Context], Any]):
        self._work: AtRest[Scene, LightCurve] = AtRest(make_renderer, _begin)

    @property
    def curve(self) -> LightCurve | None:
        """Of the last view, as far as it is drawn; None before the first."""
        return self._work.found

    def busy(self, state: WindowState) -> bool:
        """Whether frames are wanted although nothing moves."""
        return state.show_light and self._work.busy(_wanted(state.scene))

    def advance(self, gl: moderngl.Context, state: WindowState, now: float) -> None:
        """Draws one time of the curve, when the plot is shown and the camera rests. Leaves the context with another framebuffer bound.

        Args:
            now: any clock in seconds.
        """
        if state.show_light and not state.camera_moves:
            self._work.advance(gl, _wanted(state.scene), now)
        else:
            self._work.waits(now)

    def draw(self, state: WindowState) -> None:
        """The plot's window, when it is wanted; its close button puts it away."""
        if not state.show_light:
            return
        tool_window.begins_in_the_corner(40.0, 20.0)
        state.show_light = tool_window.draw(TITLE, lambda: self._contents(state.time))

    def _contents(self, time: float) -> None:
        curve, view = self._work.found, self._work.view
        if self._work.failure:
            imgui.text_wrapped(self._work.failure)
        elif curve is None or view is None:
            imgui.text_colored(theme.QUIET, "waiting for the camera to rest")
        else:
            how = "as it arrives" if view.rays.light_travel else "all at once: rays.light_travel is off"
            imgui.text_colored(theme.QUIET, f"{curve.relative.min():.2f} to {curve.relative.max():.2f} of the mean; {how}")
        if not implot.begin_plot("##light", (-1.0, -1.0), implot.Flags_.no_mouse_text.value | implot.Flags_.no_legend.value):
            return
        implot.setup_axes("time within a turn, r_s/c", "light over its mean", implot.AxisFlags_.none.value, implot.AxisFlags_.auto_fit.value)
        if curve is not None and view is not None:
            turn = light_curve.turn(view)
            implot.setup_axis_limits(implot.ImAxis_.x1.value, 0.0, turn, implot.Cond_.always.value)
            spec = implot.Spec()
            spec.line_color = _COLOUR
            implot.plot_line("light", np.ascontiguousarray(curve.time), np.ascontiguousarray(curve.relative), spec=spec)
            here = implot.Spec()
            here.line_color = theme.TEXT
            implot.plot_inf_lines("now", np.array([time % turn]), spec=here)
        implot.end_plot()


def _begin(renderer: Any, scene: Scene) -> Iterator[LightCurve]:
    yield from light_curve.in_parts(renderer, scene, light_curve.times(scene, _TIMES), _SIZE)


def _wanted(scene: Scene) -> Scene:
    """`scene` with what no light depends on as in any other."""
    return replace(scene, playback=type(scene.playback)(), post=replace(type(scene.post)(), view=scene.post.view))
