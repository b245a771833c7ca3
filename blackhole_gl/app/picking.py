"""A click on the picture picks the thing that is there: it is outlined and named, and the panel shows its values."""

from __future__ import annotations

import math

import moderngl
import numpy as np
from imgui_bundle import ImVec2, hello_imgui, imgui

from ..scene import Scene
from ..scene.catalogue import KIND
from . import sought, theme
from .click import Click
from .overlay import Corner
from .picture import Picture
from .state import WindowState

_WIDTH = 2
"""Pixels of the hit map; outside of them is a dark rim of one more."""


class Picking:
    """The click that picks, and the outline of what is picked."""

    def __init__(self) -> None:
        self._click = Click()
        self._asked: Corner | None = None
        self._outline = _Outline()

    def frame(self, state: WindowState, left_top: Corner, size: Corner) -> None:
        """Takes clicks on the picture, and draws the outline; clicks on a divided picture are none, and with the path view open they are its own.

        Args:
            left_top, size: of the picture, in imgui's units.
        """
        if state.camera_moves:
            self._asked = None
        if state.show_paths or state.show_sides or min(size) < 1.0:
            self._click.forget()
            self._asked = None
            return
        self._asked = self._click.poll(left_top, size) or self._asked
        if not state.camera_moves:
            self._outline.draw(state.picked, left_top, size)

    def advance(self, gl: moderngl.Context, state: WindowState, picture: Picture) -> None:
        """Reads what was clicked, and the outline of what is picked, once every pixel of the picture has a ray of its own."""
        if not picture.is_current or state.camera_moves:
            return
        if self._asked is not None:
            found = picture.renderer.last.instance_at(self._asked)
            if found is not None:
                self._asked = None
                _pick(state, found)
        self._outline.follow(gl, state.scene, state.picked, picture)


def _pick(state: WindowState, path: str) -> None:
    state.pick = path
    if path:
        sought.seek(state, f"{path}.{KIND}", reveal=False)


class _Outline:
    """A texture, as fine as the hit map, that is laid over the picture."""

    def __init__(self) -> None:
        self._texture: moderngl.Texture | None = None
        self._of: tuple[str, int] | None = None
        self._top: Corner | None = None  # where its name stands, counted 0…1 from the top left; None where nothing of it is seen

    def follow(self, gl: moderngl.Context, scene: Scene, path: str, picture: Picture) -> None:
        """Brings the texture up to date with what `picture`, of `scene`, shows of `path`."""
        of = (path, picture.renderer.hit_map.generation)
        if of == self._of:
            return
        mask = picture.renderer.last.pixels_of(scene, path) if path else None
        if path and mask is None:  # not yet: the last one stays
            return
        self._of, self._top = of, None
        if mask is not None and mask.any():
            self._top = _top(mask)
            self._fill(gl, outlined(mask))

    def draw(self, path: str, left_top: Corner, size: Corner) -> None:
        """Draws outline and name of `path` over the picture, if it has been found there."""
        if not path or self._top is None or self._texture is None or self._of is None or self._of[0] != path:
            return
        canvas, em = imgui.get_background_draw_list(), hello_imgui.em_size()
        end = left_top[0] + size[0], left_top[1] + size[1]
        canvas.add_image(imgui.ImTextureRef(self._texture.glo), left_top, end, ImVec2(0.0, 1.0), ImVec2(1.0, 0.0))
        name = path.partition(".")[2]
        wide, high = imgui.calc_text_size(name)
        x = min(max(left_top[0] + self._top[0] * size[0] - 0.5 * wide, left_top[0] + 0.5 * em), end[0] - wide - 0.5 * em)
        y = max(left_top[1] + self._top[1] * size[1] - high - 0.6 * em, left_top[1] + 0.3 * em)
        backdrop = imgui.color_convert_float4_to_u32(theme.BACKDROP)
        canvas.add_rect_filled((x - 0.3 * em, y - 0.1 * em), (x + wide + 0.3 * em, y + high + 0.1 * em), backdrop)
        canvas.add_text((math.floor(x), math.floor(y)), imgui.get_color_u32(theme.PICKED), name)

    def _fill(self, gl: moderngl.Context, pixels: np.ndarray) -> None:
        size = pixels.shape[1], pixels.shape[0]
        if self._texture is None or self._texture.size != size:
            if self._texture is not None:
                self._texture.release()
            self._texture = gl.texture(size, 4)
        self._texture.write(pixels.tobytes())


def outlined(mask: np.ndarray) -> np.ndarray:
    """uint8 (height, width, 4): a line round what is set in `mask`, bool (height, width), just outside of it, with a dark rim; clear elsewhere."""
    line = _grown(mask, _WIDTH)
    rim = _grown(line, 1)
    pixels = np.zeros((*mask.shape, 4), np.uint8)
    pixels[rim & ~line] = 0, 0, 0, 160
    colour = theme.PICKED
    pixels[line & ~mask] = [round(255.0 * part) for part in (colour.x, colour.y, colour.z, 1.0)]
    return pixels


def _grown(mask: np.ndarray, by: int) -> np.ndarray:
    for _ in range(by):
        wider = mask.copy()
        wider[:, 1:] |= mask[:, :-1]
        wider[:, :-1] |= mask[:, 1:]
        mask = wider.copy()
        mask[1:] |= wider[:-1]
        mask[:-1] |= wider[1:]
    return mask


def _top(mask: np.ndarray) -> Corner:
    """The middle of the uppermost row with anything in it, counted 0…1 from the top left; row 0 is the lowest."""
    height, width = mask.shape
    row = int(np.flatnonzero(mask.any(axis=1))[-1])
    return float(np.flatnonzero(mask[row]).mean() + 0.5) / width, 1.0 - (row + 1.0) / height
