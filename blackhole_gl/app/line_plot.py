"""The line plot: what becomes of a narrow line that the disk emits, of each order of image, while the view rests."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import moderngl
import numpy as np
from imgui_bundle import ImVec4, hello_imgui, imgui, implot

from ..measure import line_profile
from ..measure.line_profile import LineProfile
from ..scene import Scene
from . import theme, tool_window
from .at_rest import AtRest
from .state import WindowState

TITLE = "Line profile"
_PARTS, _FINENESS, _BINS = 12, 0.4, 80  # fifteen thousand rays a frame
_NAMES = ("direct image", "first ring", "second ring")
_COLOURS = (ImVec4(0.95, 0.55, 0.20, 1.0), ImVec4(0.35, 0.80, 0.40, 1.0), ImVec4(0.40, 0.60, 0.95, 1.0))  # those of the view of orders


@dataclass(frozen=True)
class _View:
    """What a profile is of.

    Attributes:
        depends: all of `scene` that it depends on.
        index: the power that the line falls by.
    """

    scene: Scene = field(compare=False)
    depends: tuple
    index: float

    @classmethod
    def of(cls, scene: Scene, index: float) -> _View:
        disk, of_rays = scene.disk, tuple(sorted((key, value) for key, value in scene.parameters.items() if key.startswith("rays.")))
        edges = disk.enabled, disk.orbit, disk.inner_radius, disk.outer_radius, disk.tilt_deg, disk.tilt_azimuth_deg, disk.compositing, disk.opacity
        return cls(scene, (scene.hole, scene.camera, scene.rays, of_rays, scene.things, scene.media, edges), index)


class LinePlot:
    """The plot's window and the rays behind it.

    Args:
        make_renderer: makes a renderer of its own, so that the picture's hit map is left alone.
    """

    def __init__(self, make_renderer: Callable[[moderngl.Context], Any]):
        self._work: AtRest[_View, LineProfile] = AtRest(make_renderer, _begin)
        self._index = 3.0

    @property
    def profile(self) -> LineProfile | None:
        """Of the last view that was traced; None before the first."""
        return self._work.found

    def busy(self, state: WindowState) -> bool:
        """Whether frames are wanted although nothing moves."""
        return state.show_line and self._work.busy(_View.of(state.scene, self._index))

    def advance(self, gl: moderngl.Context, state: WindowState, now: float) -> None:
        """Traces some of the rays, when the plot is shown and the camera rests. Leaves the context with another framebuffer bound.

        Args:
            now: any clock in seconds.
        """
        if state.show_line and not state.camera_moves:  # scene time bends no ray
            self._work.advance(gl, _View.of(state.scene, self._index), now)
        else:
            self._work.waits(now)

    def draw(self, state: WindowState) -> None:
        """The plot's window, when it is wanted; its close button puts it away."""
        if not state.show_line:
            return
        tool_window.begins_in_the_corner(40.0, 22.0)
        state.show_line = tool_window.draw(TITLE, self._contents)

    def _contents(self) -> None:
        self._status()
        self._plot()

    def _status(self) -> None:
        imgui.set_next_item_width(10.0 * hello_imgui.em_size())
        _, self._index = imgui.slider_float("power of the line falls as r to the −q##index", self._index, 0.0, 6.0, "q = %.1f")
        if self._work.failure:
            imgui.text_wrapped(self._work.failure)
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


def _begin(renderer: Any, view: _View) -> Iterator[LineProfile | None]:
    yield from line_profile.in_parts(renderer, view.scene, index=view.index, bins=_BINS, parts=_PARTS, fineness=_FINENESS)


def _line(name: str, g: np.ndarray, density: np.ndarray, colour: ImVec4) -> None:
    spec = implot.Spec()
    spec.line_color = colour
    implot.plot_line(name, g, np.ascontiguousarray(density), spec=spec)
