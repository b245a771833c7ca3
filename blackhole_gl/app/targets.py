"""What pictures are drawn into: a texture that is shown and a spare one, or the window at once."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import moderngl
import numpy as np

from ..rendering.target import Target
from ..scene import Scene
from .area import Area

# The place travels from corner to corner instead of being worked out at each pixel, and is divided by nothing: software renderers then have a quick way.
_VERTEX = """#version 330 core
noperspective out vec2 place;
void main() { place = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2); gl_Position = vec4(place * 2.0 - 1.0, 0.0, 1.0); }
"""
_FRAGMENT = """#version 330 core
uniform sampler2D picture;
noperspective in vec2 place;
out vec4 colour;
void main() { colour = texture(picture, place); }
"""


@dataclass(frozen=True)
class Drawing:
    """What a picture is drawn of: the scene, its time in r_s/c, its (width, height), and those that it is shown with. The rest only says how, so
    drawings that differ in nothing else are equal.

    Attributes:
        progressive: whether some pixels may be interpolated between rays.
        passes: whether only time runs, and the next picture replaces this one.
    """

    scene: Scene
    time: float
    size: tuple[int, int]
    shown: tuple[int, int]
    progressive: bool = field(compare=False)
    passes: bool = field(compare=False)


class Targets:
    """Has pictures drawn, keeps the last good one, and brings it into the window.

    A picture that the next frame replaces is drawn into the window at once: llvmpipe takes a tenth of the frame for the copy. Should the next one fail,
    it is drawn again, into the texture. One that is drawn coarse is enlarged to the size it is shown with, and its stars are drawn over it.

    Args:
        gl: the window's context.
        renderer: what makes pictures; see ``rendering.frame.Renderer``.
    """

    def __init__(self, gl: moderngl.Context, renderer: Any):
        self._gl = gl
        self._renderer = renderer
        self._triangle = gl.vertex_array(gl.program(vertex_shader=_VERTEX, fragment_shader=_FRAGMENT), [])
        self._shown: Target | None = None
        self._spare: Target | None = None
        self._coarse: Target | None = None
        self._in_window: Drawing | None = None  # the last picture, where only the window has it
        self._is_there = False  # that, in this frame

    def begin_frame(self) -> None:
        """The window holds nothing yet of what it is to show."""
        self._is_there = False

    def render(self, drawing: Drawing) -> Any:
        """Draws into the texture; returns the report."""
        report = self._draw(drawing, self._spare_of(drawing.shown).frame, (0, 0, *drawing.shown))
        self._show_spare()
        return report

    def rehearse(self, drawing: Drawing) -> Any:
        """Draws what is not shown; returns the report. At the start, where there is nothing else to show, it is, and has its stars with the rest."""
        if self._shown is None and self._in_window is None:
            return self.render(replace(drawing, shown=drawing.size))
        return self._draw(drawing, self._spare_of(drawing.shown).frame, (0, 0, *drawing.shown), may_turn=False)

    def render_into(self, window: moderngl.Framebuffer, area: Area, drawing: Drawing) -> Any:
        """Draws into `area` of `window`; returns the report."""
        self._clear_beside(window, area)
        report = self._draw(drawing, window, area.viewport)
        self._in_window, self._is_there = drawing, True
        return report

    def render_finer(self, drawing: Drawing) -> int:
        """Draws the picture in the texture once more, with one more ray a pixel; returns how many it is the mean of."""
        samples = self._renderer.render_finer(drawing.scene, drawing.time, drawing.size, target=self._spare_of(drawing.size).frame)
        self._show_spare()
        return samples

    def keep(self) -> Any:
        """Draws the last picture into the texture, if only the window has it. Returns the report; None where nothing was drawn."""
        return None if self._in_window is None else self.render(replace(self._in_window, passes=False))

    def draw(self, window: moderngl.Framebuffer, area: Area) -> None:
        """Fills `area` of `window` with the picture, and the rest with black."""
        if self._is_there:
            window.use()
            return
        self._clear_beside(window, area)
        self._draw_shown(window, area)

    def draw_part(self, window: moderngl.Framebuffer, area: Area, part: Area) -> None:
        """Puts that `part` of the picture in `area` over what `window` holds, which is not the picture itself."""
        if part.is_empty:
            return
        window.scissor = part.viewport
        self._draw_shown(window, area)
        window.scissor = None  # type: ignore[assignment]  # moderngl's stubs lack what they say in words: None is the whole

    def _draw_shown(self, window: moderngl.Framebuffer, area: Area) -> None:
        if self._shown is not None and not area.is_empty:
            self._enlarge(self._shown.texture, window, area.viewport)

    def read_rgb8(self) -> np.ndarray:
        """The picture in the texture as uint8 (height, width, 3), top row first.

        Raises:
            RuntimeError: none has been drawn.
        """
        if self._shown is None:
            raise RuntimeError("no picture has been drawn yet: `render` comes first")
        width, height = self._shown.size
        data = np.frombuffer(self._shown.frame.read(components=3, alignment=1), np.uint8)
        return data.reshape(height, width, 3)[::-1]

    def _draw(self, drawing: Drawing, target: moderngl.Framebuffer, viewport: tuple[int, int, int, int], *, may_turn: bool = True) -> Any:
        """Draws into `viewport` (x, y, width, height), which has the size that the drawing is shown with; returns the report."""
        render = partial(
            self._renderer.render,
            *(drawing.scene, drawing.time, drawing.size),
            measure=True,
            progressive=drawing.progressive,
            may_turn=drawing.progressive and may_turn,
            glow_may_last=drawing.passes,
        )
        if drawing.size == drawing.shown:
            return render(target=target, viewport=viewport)
        coarse = self._coarse = self._of_size(self._coarse, drawing.size)
        report = render(target=coarse.frame, shown=drawing.shown)
        self._enlarge(coarse.texture, target, viewport)
        self._renderer.draw_stars(target, viewport)
        return report

    def _enlarge(self, texture: moderngl.Texture, target: moderngl.Framebuffer, viewport: tuple[int, int, int, int]) -> None:
        # Smooth only where it is enlarged: pixel for pixel it looks the same, for less.
        filtering = moderngl.NEAREST if texture.size == viewport[2:] else moderngl.LINEAR
        texture.filter = (filtering, filtering)
        target.use()
        outer, target.viewport = target.viewport, viewport
        self._gl.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        texture.use(0)
        self._triangle.render(moderngl.TRIANGLES, vertices=3)
        target.viewport = outer

    def _show_spare(self) -> None:
        self._shown, self._spare = self._spare, self._shown
        self._in_window = None

    def _spare_of(self, size: tuple[int, int]) -> Target:
        """What the next picture goes into. The one shown is left alone: should rendering fail, it is the last good one."""
        self._spare = self._of_size(self._spare, size)
        return self._spare

    def _of_size(self, there: Target | None, size: tuple[int, int]) -> Target:
        """`there`, made anew unless it has this `size`."""
        if there is not None and there.size == size:
            return there
        if there is not None:
            there.release()
        texture = self._gl.texture(size, 4)
        texture.repeat_x = texture.repeat_y = False
        return Target.of(self._gl, [texture])

    def _clear_beside(self, window: moderngl.Framebuffer, area: Area) -> None:
        """Makes `window` black, unless the picture will fill it."""
        window.use()
        self._gl.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._gl.scissor = None
        if self._shown is None or area.size != window.size:
            window.clear()
