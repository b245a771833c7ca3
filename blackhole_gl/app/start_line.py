"""The line over the picture that says at start how to move and where help is. It is part of the window, never of a saved picture."""

from __future__ import annotations

from imgui_bundle import hello_imgui, imgui

from ..scene import Scene
from . import theme

_STAYS_S = 10.0
_FADES_S = 0.8
_PARTS = ("Drag to orbit", "wheel to come closer", "right drag to look around")


class StartLine:
    """Shows the line until the camera has been moved, for a few seconds at most.

    Args:
        scene: the first one.
        help_key: what opens the help, as people read it; empty where no key does.
    """

    def __init__(self, scene: Scene, help_key: str):
        self._parts = (*_PARTS, f"{help_key}: all keys") if help_key else _PARTS
        self.begin(scene)

    def begin(self, scene: Scene) -> None:
        """Shows the line from the next frame on, over the picture of `scene`."""
        self._camera = scene.camera
        self._leaves: float | None = None
        self._now = 0.0

    @property
    def is_over(self) -> bool:
        """Whether nothing of it is left."""
        return self._leaves is not None and self._now >= self._leaves + _FADES_S

    @property
    def fades(self) -> bool:
        """Whether the next frame differs from this one."""
        return self._leaves is not None and self._leaves <= self._now < self._leaves + _FADES_S

    def advance(self, scene: Scene, now: float) -> float:
        """How strong the line is, 0…1, at `now` in seconds, over the picture of `scene`."""
        self._now = now
        if self._leaves is None:
            self._leaves = now + _STAYS_S
        if scene.camera != self._camera:
            self._leaves = min(self._leaves, now)
        return min(max(1.0 - (now - self._leaves) / _FADES_S, 0.0), 1.0)

    def draw(self, scene: Scene, middle: float, bottom: float, width: float) -> None:
        """Draws it with its last row's foot at `bottom`, centred on `middle`, at most `width` wide. Call once in each frame."""
        strength = self.advance(scene, imgui.get_time())
        if strength <= 0.0:
            return
        canvas, rows = imgui.get_background_draw_list(), self._rows(width)
        shadow, text = theme.HOLE, theme.TEXT
        for row, words in enumerate(reversed(rows)):
            size = imgui.calc_text_size(words)
            x, y = middle - 0.5 * size.x, bottom - (row + 1) * 1.3 * size.y
            away = 0.08 * hello_imgui.em_size()
            for place, colour, alpha in (((x + away, y + away), shadow, 0.9), ((x, y), text, 0.75)):
                canvas.add_text(place, imgui.color_convert_float4_to_u32((colour.x, colour.y, colour.z, alpha * strength)), words)

    def _rows(self, width: float) -> list[str]:
        """The parts, as many in a row as fit into `width`."""
        rows: list[str] = []
        for part in self._parts:
            longer = f"{rows[-1]}   ·   {part}" if rows else part
            if rows and imgui.calc_text_size(longer).x <= width:
                rows[-1] = longer
            else:
                rows.append(part)
        return rows
