"""Sliders beside a picture, for notebooks: what moves a slider draws the scene anew. Needs ipywidgets, the extra ``notebook``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from . import api
from .output import png
from .scene import Scene, SceneError
from .scene.schema import Field

_STEPS = 200  # of a slider from end to end
_BY_FACTORS = 1000.0  # the ratio of its ends from which a slider goes by factors


class Sliders:
    """A picture of a scene, and below it a slider, box or list for each of some of its values. Shown where it stands at the end of a notebook's cell.

    Args:
        keys: dotted keys of numbers, switches and choices, e.g. ``hole.spin``.
        size: (width, height) of the picture in pixels.
        time: scene time in r_s/c.

    Attributes:
        scene: the scene as the sliders have it now.
        widget: all of it, an ipywidgets.VBox: picture, controls in the order of `keys`, and a line that says what cannot be drawn.

    Raises:
        SceneError: no such key, or one whose value is no number, switch or choice.
        ImportError: there is no ipywidgets.
    """

    def __init__(self, scene: Scene, keys: Sequence[str], size: tuple[int, int] = (480, 270), time: float = 0.0):
        widgets = _ipywidgets()
        self.scene, self._size, self._time = scene, size, time
        self._picture, self._told = widgets.Image(format="png"), widgets.Label()
        controls = [_control(widgets, scene.field(key), scene.get(key)) for key in keys]
        for key, control in zip(keys, controls):
            control.observe(lambda change, key=key: self._change(key, change["new"]), names="value")
        self.widget = widgets.VBox([self._picture, *controls, self._told])
        self._draw(scene)

    def _repr_mimebundle_(self, **asked: Any) -> Any:
        return self.widget._repr_mimebundle_(**asked)

    def _change(self, key: str, value: Any) -> None:
        try:
            self._draw(self.scene.with_values({key: value}))
        except SceneError as error:  # the picture and the scene stay as they were
            self._told.value = str(error)

    def _draw(self, scene: Scene) -> None:
        self._picture.value = png.encode(api.render(scene, self._size, self._time))
        self.scene, self._told.value = scene, ""


def _control(widgets: Any, item: Field, value: Any) -> Any:
    shown = {"description": item.key, "tooltip": item.help, "style": {"description_width": "initial"}, "layout": widgets.Layout(width="32em")}
    if item.kind == "switch":
        return widgets.Checkbox(value=value, indent=False, **shown)
    if item.kind == "choice":
        return widgets.Dropdown(options=item.options, value=value, **shown)
    if item.kind == "int":
        return widgets.IntSlider(value=value, min=int(item.low), max=int(item.high), continuous_update=False, **shown)
    if item.kind != "float" or not math.isfinite(value):
        raise SceneError(item.key, f"got {value}; allowed for a slider are finite numbers, switches and choices")
    if item.low > 0.0 and item.high / item.low >= _BY_FACTORS:
        low, high = math.log10(item.low), math.log10(item.high)
        return widgets.FloatLogSlider(value=value, min=low, max=high, step=(high - low) / _STEPS, readout_format=".4g", continuous_update=False, **shown)
    step = (item.high - item.low) / _STEPS
    return widgets.FloatSlider(value=value, min=item.low, max=item.high, step=step, readout_format=".4g", continuous_update=False, **shown)


def _ipywidgets() -> Any:
    try:
        import ipywidgets
    except ImportError:
        raise ImportError("sliders need the package ipywidgets: pip install 'blackhole-gl[notebook]'") from None
    return ipywidgets
