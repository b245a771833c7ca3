"""Where nothing is to be seen, the way out: a line for a black picture, and for a hole that is out of sight or a dot."""

from __future__ import annotations

import math

import moderngl
import numpy as np

from ..physics.observer import observe
from ..scene import Scene
from .area import Area
from .camera_control import range_by_hand, shadow_angle
from .keys import Bindings, shown
from .state import WindowState

_PERIOD_S = 0.7  # between two looks at a picture whose scene changes: reading it back holds the driver up
_DARK = 40  # of 255
_LIT_SHARE = 5e-4  # of the pixels that are lighter than that in a picture that is not black
_A_DOT = 1.1  # times the distance at which the hand stops


class WayOut:
    """Looks at the picture now and then; see `advance`.

    Args:
        bindings: the keys, which the line names.
    """

    def __init__(self, bindings: Bindings):
        self._reset, self._reset_all = (_named(bindings, action) for action in ("reset", "reset_all"))
        self._seen: Scene | None = None
        self._next = 0.0

    def advance(self, state: WindowState, window: moderngl.Framebuffer, area: Area) -> None:
        """Puts the line into `state.way_out`, once for a scene. The picture of the state's scene fills `area` of `window`."""
        if state.scene is self._seen or state.clock < self._next:
            return
        self._seen, self._next = state.scene, state.clock + _PERIOD_S
        state.way_out = ""
        if is_black(np.frombuffer(window.read(viewport=area.viewport, components=3, alignment=1), np.uint8)):
            state.way_out = f"The picture is black. {self._reset} puts the camera back, {self._reset_all} everything."
        elif trouble := out_of_sight(state.scene, area.width / area.height):
            state.way_out = f"{trouble} {self._reset} puts the camera back."


def is_black(pixels: np.ndarray) -> bool:
    """Whether hardly anything is seen in `pixels`, uint8, three of which are a pixel."""
    lit, least = pixels > _DARK, _LIT_SHARE * (pixels.size // 3)
    # One to three channels of a pixel are lit. Of a whole window channels are counted in half a millisecond, pixels in 20, amid a movement.
    channels = np.count_nonzero(lit)
    if channels < least or channels >= 3.0 * least:
        return bool(channels < least)
    return bool(np.count_nonzero(lit.reshape(-1, 3).any(axis=1)) < least)


def out_of_sight(scene: Scene, aspect: float) -> str:
    """What keeps the hole from being seen in a picture of that width over height; empty where nothing does."""
    camera = scene.camera
    extent = camera.field_m if math.isinf(camera.distance) else camera.distance
    if extent > _A_DOT * range_by_hand(scene)[1]:
        return "The hole is only a dot from here."
    if math.isinf(camera.distance) or camera.projection != "perspective":
        return ""
    observer = observe(scene)
    away = math.acos(min(max(-float((observer.hole @ observer.look)[0]), -1.0), 1.0))
    corner = math.atan(math.tan(math.radians(0.5 * camera.fov_deg)) * math.hypot(1.0, aspect))
    return "The hole is out of sight." if away > corner + shadow_angle(scene) else ""


def _named(bindings: Bindings, action: str) -> str:
    """The first key of `action`; without one, where else it is to be found."""
    return shown(bindings[action][:1]) or "Reset all in the panel"
