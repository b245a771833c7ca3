"""The line plot: what becomes of a narrow line that the disk emits, of each order of image, while the view rests."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import moderngl
import numpy as np
from imgui_bundle import ImVec4, hello_imgui, imgui, implot

from ..measure import line_profile
from ..measure.line_profile import LineProfile
from ..scene import Scene, SceneError
from . import theme, tool_window
from .state import WindowState

TITLE = "Line profile"
_RESTS = 0.4  # seconds of stillness before a new view is traced
_PARTS, _FINENESS, _BINS = 12, 0.4, 80  # fifteen thousand rays a frame
_NAMES = ("direct image", "first ring", "second ring")
_COLOURS = (ImVec4(0.95, 0.55, 0.20, 1.0), ImVec4(0.35, 0.80, 0.40, 1.0), ImVec4(0.40, 0.60, 0.95, 1.0))  # those of the view of orders


class LinePlot:
    """The plot's window and the rays behind it.

    Args:
        make_renderer: makes a renderer of its own, so that the picture's hit map is left alone.

    Attributes:
        profile: of the last view that was traced; None before the first.
    """

    def __init__(self, make_renderer: Callable[[moderngl.Context], Any]):
        self._make_renderer = make_renderer
        self._renderer: Any = None
        self._parts: Iterator[LineProfile | None] | None = None
        self._view: tuple | None = None
        self._since = 0.0
        self._index = 3.0
        self._failure = ""
        self.profile: LineProfile | None = None

    def busy(self, state: WindowState) -> bool:
        """Whether frames are wanted although nothing moves."""
        return state.show_line and (self._parts is not None or self._view != self._wanted(state.scene))

    def advance(self, gl: moderngl.Context, state: WindowState, now: float) -> None:
        """Traces some of the rays, when the plot is shown and the camera rests. Leaves the context with another framebuffer bound.

        Args:
            now: any clock in seconds.
        """
        if not state.show_line or state.camera_moves:  # scene time bends no ray
            self._since = now
            return
        wanted = self._wanted(state.scene)
        if wanted != self._view and now - self._since >= _RESTS:
            if self._renderer is None:
                self._renderer = self._make_renderer(gl)
            self._view, self._failure = wanted, ""
            self._parts = line_profile.in_parts(self._renderer, state.scene, index=self._index, bins=_BINS, parts=_PARTS, fineness=_FINENESS)
        if self._parts is None:
            return
        try:
            found = next(self._parts)
        except SceneError as error:
            self._parts, self.profile, self._failure = None, None, str(error)
            return
        if found is not None:
            self._parts, self.profile = None, found

    def draw(self, state: WindowState) -> None:
        """The plot's window, when it is wanted; its close button puts it away."""
        if not state.show_line:
            return
        tool_window.begins_in_the_corner(40.0, 22.0)
        state.show_line = tool_window.draw(TITLE, self._contents)

    def _contents(self) -> None:
        self._status()
        self._plot()

    def _wanted(self, scene: Scene) -> tuple:
        """All that the profile depends on."""
        disk = scene.disk
        return scene.hole, scene.camera, scene.rays, scene.things, scene.media, self._index, disk.enabled, disk.orbit, disk.inner_radius, disk.outer_radius, \
            disk.tilt_deg, disk.tilt_azimuth_deg, disk.compositing, disk.opacity  # fmt: skip

    def _status(self) -> None:
        imgui.set_next_item_width(10.0 * hello_imgui.em_size())
        _, self._index = imgui.slider_float("power of the line falls as r to the −q##index", self._index, 0.0, 6.0, "q = %.1f")
        if self._failure:
            imgui.text_wrapped(self._failure)
        elif self.profile is None:
            imgui.text_colored(theme.QUIET, "waiting for the camera to rest")
        else:
            shares = ", ".join(f"{name} {share:.1%}" for name, share in zip(_NAMES, self.profile.shares, strict=True))
            imgui.text_colored(theme.QUIET, f"{shares}; mean g = {self.profile.mean:.3f}")

    def _plot(self) -> None:
        if not implot.begin_plot("##line", (-1.0, -1.0), implot.Flags_.no_mouse_text.value):
            return
        fit = implot.AxisFlags_.auto_fit.value
        implot.setup_axes("g = energy received over energy sent out", "light in a unit of g", fit, fit)
        if self.profile is not None:
            middles = np.ascontiguousarray(0.5 * (self.profile.edges[1:] + self.profile.edges[:-1]))
            density = self.profile.density
            _line("all", middles, density.sum(axis=0), theme.TEXT)
            for name, each, colour in zip(_NAMES, density, _COLOURS, strict=True):
                _line(name, middles, each, colour)
        implot.end_plot()


def _line(name: str, g: np.ndarray, density: np.ndarray, colour: ImVec4) -> None:
    spec = implot.Spec()
    spec.line_color = colour
    implot.plot_line(name, g, np.ascontiguousarray(density), spec=spec)
