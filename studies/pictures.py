"""The charts as pictures. Needs matplotlib, which nothing else does."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from blackhole_gl.measure.scenes import SHOWN, ChartScene
from blackhole_gl.output.files import write_whole
from blackhole_gl.planning.choice import REFINED_SIZE
from blackhole_gl.scene import catalogue
from studies.critical import Point
from studies.flight import FlightFrame
from studies.measure import Row
from studies.pareto import front
from studies.sizes import Cost

INSTALL_LINE = "pip install 'blackhole-gl[chart]'"

# Okabe & Ito's colours, told apart by everybody, and four more.
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8B5A2B", "#F0E442", "#000000", "#777777", "#882255", "#44AA99")
_MARKERS = {"euler": "v", "verlet": "s", "rk4": "o", "bs3": "^", "dopri5": "D", "nystrom4": "<", "nystrom5": ">", "": "X"}
_LINES = {"fixed": (0, (1, 1)), "radius": "-", "mino": "-", "curvature": "--", "doubling": "-.", "embedded": (0, (5, 1, 1, 1, 1, 1)), "": "none"}
QUALITIES = {"L": 0.4, "M": 0.2, "H": 0.1, "U": 0.05}
"""κ of the presets of BlackHoleGPU's steps, Low, Medium, High and Ultra, whose scenes are traced by kerr, rk4."""


class MatplotlibMissing(ValueError):
    """The pictures cannot be drawn; the text says what to install."""


def library():
    """matplotlib's pyplot, set to draw into files.

    Raises:
        MatplotlibMissing: it is not installed.
    """
    try:
        import matplotlib
    except ImportError:
        raise MatplotlibMissing(f"the chart's pictures need matplotlib, which is not installed: {INSTALL_LINE}") from None
    matplotlib.use("Agg")
    from matplotlib import pyplot

    pyplot.rcParams.update({"font.size": 8, "axes.grid": True, "grid.alpha": 0.25, "axes.spines.top": False, "lines.markersize": 3.5, "lines.linewidth": 1.0})
    return pyplot


def draw_methods(path: Path, rows: Sequence[Row], scenes: Sequence[ChartScene], chosen: Mapping[str, Row]) -> None:
    """Error against cost, a panel a scene and a curve a method, with the Pareto front, the presets of published steps and the plan's choice.

    Args:
        chosen: the row that the plan chooses, by scene.
    """
    pyplot = library()
    shown = [item for item in scenes if item.name in SHOWN]
    figure, panels = pyplot.subplots(2, 2, figsize=(10.5, 9.0), sharex=True, sharey=True)
    for axes, chart_scene in zip(panels.flat, shown):
        own = [row for row in rows if row.scene == chart_scene.name]
        _method_panel(axes, own, chart_scene)
        if chart_scene.name in chosen:
            row = chosen[chart_scene.name]
            axes.plot(row.cost_flat_ratio, row.direction_99, "o", ms=13, mfc="none", mec="black", mew=1.4, zorder=6)
    for axes in panels[1]:
        axes.set_xlabel("frame time / flat frame")
    for axes in panels[:, 0]:
        axes.set_ylabel("escape direction, 99 % of rays within [rad]")
    _legend(pyplot, figure, rows)
    _save(pyplot, figure, path)


def _method_panel(axes, rows: Sequence[Row], chart_scene: ChartScene) -> None:
    curves: dict[str, list[Row]] = {}
    for row in rows:
        curves.setdefault(row.method, []).append(row)
    for curve in curves.values():
        first = curve[0]
        style: dict[str, Any] = dict(
            color=_colour(first.model), marker=_MARKERS.get(first.integrator, "o"), linestyle=_LINES.get(first.step_control, "-")
        )
        if first.refined:
            style |= dict(markerfacecolor="white", linewidth=0.6, markersize=4.5)
        axes.plot([row.cost_flat_ratio for row in curve], [row.direction_99 for row in curve], alpha=0.85, **style)
    rows = [row for row in rows if not row.refined]  # in a larger picture: no match for those of the front
    best = [rows[index] for index in front([row.cost_flat_ratio for row in rows], [row.direction_99 for row in rows])]
    axes.plot([row.cost_flat_ratio for row in best], [row.direction_99 for row in best], color="black", lw=5, alpha=0.16, zorder=1, drawstyle="steps-post")
    for letter, angle in QUALITIES.items():
        for row in rows:
            if (row.model, row.integrator, row.step_control, row.step_angle) == ("kerr", "rk4", "mino", angle):
                axes.annotate(letter, (row.cost_flat_ratio, row.direction_99), textcoords="offset points", xytext=(-8, -9), fontweight="bold")
    axes.set(xscale="log", yscale="log", ylim=(1e-6, 6.0), title=_title(chart_scene))
    axes.axhline(0.5 * chart_scene.pixel, color="black", lw=0.7, ls=(0, (4, 4)))
    axes.annotate("half a pixel at 1080p", (1.0, 0.5 * chart_scene.pixel), xycoords=("axes fraction", "data"), ha="right", va="bottom", fontsize=7)
    pixels = axes.secondary_yaxis("right", functions=(lambda y: y / chart_scene.pixel, lambda y: y * chart_scene.pixel))
    pixels.set_ylabel("pixels at 1080p", fontsize=7)


def _title(chart_scene: ChartScene) -> str:
    scene = chart_scene.scene
    return f"a* = {scene.hole.spin:g}, camera at {scene.camera.distance:g} r_s, {scene.camera.inclination_deg:g}°, view {scene.camera.fov_deg:g}°"


def _colour(model: str) -> str:
    return _COLOURS[list(catalogue.keys("ray_model")).index(model) % len(_COLOURS)]


def _legend(pyplot, figure, rows: Sequence[Row]) -> None:
    from matplotlib.lines import Line2D

    models = [model for model in catalogue.keys("ray_model") if any(row.model == model for row in rows)]
    handles = [Line2D([], [], color=_colour(model), lw=2.5, label=model) for model in models]
    handles += [Line2D([], [], color="grey", ls="none", marker=marker, label=name or "closed model") for name, marker in _MARKERS.items()]
    handles += [Line2D([], [], color="grey", ls=line, label=name) for name, line in _LINES.items() if name]
    handles += [
        Line2D([], [], color="black", lw=5, alpha=0.16, label="Pareto front"),
        Line2D([], [], ls="none", marker="$L$", color="black", label="BlackHoleGPU's steps L M H U"),
        Line2D([], [], ls="none", marker="o", ms=10, mfc="none", mec="black", label="the plan's choice"),
        Line2D([], [], color="grey", lw=0.6, marker="o", ms=4.5, mfc="white", label="refined, {}×{}".format(*REFINED_SIZE)),
    ]
    figure.legend(handles=handles, loc="lower center", ncols=7, fontsize=7, frameon=False)
    figure.tight_layout(rect=(0.0, 0.09, 1.0, 1.0))


def draw_critical(path: Path, points: Sequence[Point]) -> None:
    """Error against the distance from the critical curve, a panel a scene."""
    pyplot = library()
    names = list(dict.fromkeys(point.scene for point in points))
    figure, panels = pyplot.subplots(1, len(names), figsize=(10.5, 4.2), sharey=True, squeeze=False)
    for axes, name in zip(panels.flat, names):
        curves: dict[tuple[str, float], list[Point]] = {}
        for point in points:
            if point.scene == name:
                curves.setdefault((point.method, point.setting), []).append(point)
        for (method, setting), curve in curves.items():
            model, integrator, _ = method.split(", ")
            style = dict(color=_colour(model), marker=_MARKERS[integrator], alpha=1.0 if setting < 0.1 else 0.55, ls="-" if setting < 0.1 else "--")
            axes.plot([p.epsilon for p in curve], [p.direction_median for p in curve], label=f"{method}, {setting:g}", **style)
        grid = np.logspace(-7, 0, 2)
        axes.plot(grid, 1e-7 / grid, color="black", lw=4, alpha=0.16, label="1e-7/ε: float32")
        axes.set(xscale="log", yscale="log", ylim=(1e-7, 6.0), xlabel="ε = distance from the critical curve, relative", title=name)
        axes.legend(fontsize=6.5, frameon=False)
    panels[0, 0].set_ylabel("escape direction, median error [rad]")
    figure.tight_layout()
    _save(pyplot, figure, path)


def draw_sizes(path: Path, costs: Sequence[Cost]) -> None:
    """Frame time, and its ratio to the flat frame, against the number of pixels."""
    pyplot = library()
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10.5, 3.8))
    for name in dict.fromkeys(cost.method for cost in costs):
        curve = [cost for cost in costs if cost.method == name]
        pixels = [cost.width * cost.height for cost in curve]
        left.plot(pixels, [cost.milliseconds for cost in curve], marker="o", label=name)
        right.plot(pixels, [cost.flat_ratio for cost in curve], marker="o", label=name)
    left.set(xscale="log", yscale="log", xlabel="pixels", ylabel="trace time [ms]")
    right.set(xscale="log", yscale="log", xlabel="pixels", ylabel="trace time / flat frame")
    left.legend(fontsize=7, frameon=False)
    figure.tight_layout()
    _save(pyplot, figure, path)


def draw_flight(path: Path, frames: Sequence[FlightFrame], tolerance: float) -> None:
    """Frame by frame: displacement in pixels, ꟻLIP, the share of pixels that had rays of their own, and where the camera is.

    Args:
        tolerance: in pixels.
    """
    pyplot = library()
    figure, (moved, looks, traced, camera) = pyplot.subplots(4, 1, figsize=(10.5, 9.0), sharex=True, height_ratios=(3, 3, 2, 2))
    seconds = [frame.time for frame in frames]

    def curve(axes, key: str, label: str, colour: str, scale: float = 1.0) -> None:
        axes.plot(seconds, [scale * getattr(frame, key) for frame in frames], color=colour, label=label)

    curve(moved, "largest_px", "largest", _COLOURS[1])
    curve(moved, "px_99", "99 % of the pixels within", _COLOURS[0])
    moved.axhline(tolerance, color="black", ls="--", label="tolerance")
    moved.set(ylabel="displacement [pixels]", ylim=(0.0, 1.15 * max(tolerance, *(frame.largest_px for frame in frames))))
    curve(looks, "flip_largest", "largest pixel", _COLOURS[1])
    curve(looks, "flip_mean", "mean", _COLOURS[0])
    looks.set(ylabel="FLIP", yscale="log")
    curve(traced, "own_rays", "pixels with rays of their own", _COLOURS[2], 100.0)
    traced.set(ylabel="% of the picture", ylim=(0.0, 100.0))
    curve(camera, "inclination_deg", "inclination", _COLOURS[0])
    camera.set(ylabel="inclination [°]", xlabel="time [s]", yticks=(0, 30, 60, 90, 120), ylim=(-5, 155))
    distance = camera.twinx()
    curve(distance, "distance", "distance (right)", _COLOURS[4])
    distance.set(ylabel="distance [r_s]", yscale="log", ylim=(1.2, 60.0))
    distance.set_yticks((2, 5, 10, 20), ("2", "5", "10", "20"))
    distance.minorticks_off()
    distance.grid(False)
    for axes in (moved, looks, traced):
        axes.legend(fontsize=7, frameon=False, ncols=3, loc="upper right")
    camera.legend(handles=[*camera.get_lines(), *distance.get_lines()], fontsize=7, frameon=False, ncols=2, loc="upper right")
    figure.tight_layout()
    _save(pyplot, figure, path)


def _save(pyplot, figure, path: Path) -> None:
    data = io.BytesIO()
    figure.savefig(data, dpi=110, format="png")
    pyplot.close(figure)
    small = io.BytesIO()
    Image.open(data).convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE).save(small, "PNG", optimize=True)  # a third of the size
    write_whole(path, small.getvalue())
