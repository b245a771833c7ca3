"""The picture behind the panel: rendered only when something changed, kept, and drawn into the free part of the window."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np

from ..scene import Scene

# A picture that takes longer is drawn coarser until it rests: (milliseconds, the coarsest divisor). Under a moving camera fluency comes
# first; a disk that turns before a still camera is looked at, and software renderers would otherwise never show it sharp.
_BUDGET = {True: (60.0, 4), False: (150.0, 2)}

_VERTEX = """#version 330 core
void main() { gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0); }
"""
_FRAGMENT = """#version 330 core
uniform sampler2D picture;
uniform vec4 area;
out vec4 colour;
void main() { colour = vec4(texture(picture, (gl_FragCoord.xy - area.xy) / area.zw).rgb, 1.0); }
"""


@dataclass(frozen=True)
class Area:
    """A rectangle of the window in framebuffer pixels, counted from the bottom left."""

    x: int
    y: int
    width: int
    height: int

    @classmethod
    def of_screen(cls, left: float, top: float, width: float, height: float, display_height: float, scale: tuple[float, float]) -> Area:
        """The area of a rectangle in screen coordinates, from the top left, on a display with `scale` framebuffer pixels to a unit."""
        x, right = round(left * scale[0]), round((left + width) * scale[0])
        y, ceiling = round((display_height - top - height) * scale[1]), round((display_height - top) * scale[1])
        return cls(x, y, right - x, ceiling - y)

    @property
    def is_empty(self) -> bool:
        """Whether it holds no pixel."""
        return self.width < 1 or self.height < 1

    def coarsened(self, divisor: int) -> tuple[int, int]:
        """(width, height) of a picture with `divisor` times fewer pixels each way."""
        return math.ceil(self.width / divisor), math.ceil(self.height / divisor)


@dataclass(frozen=True)
class RayFigures:
    """What became of the picture's rays: mean steps of a ray, and how many ended nowhere."""

    steps: float
    unresolved: int

    @classmethod
    def of(cls, hits: Any) -> RayFigures:
        """The figures of a `HitArrays`."""
        return cls(float(np.mean(hits.steps)), int(np.count_nonzero(hits.fate == 0)))


class Picture:
    """Renders a scene into a texture of its own and draws that into the window.

    Args:
        gl: the window's context.
        renderer: what makes pictures; see ``render.frame.Renderer``.
    """

    def __init__(self, gl: moderngl.Context, renderer: Any):
        self._gl = gl
        self.renderer = renderer
        self.report: Any = None
        self.rays: RayFigures | None = None
        self.divisor = 1
        self._program = gl.program(vertex_shader=_VERTEX, fragment_shader=_FRAGMENT)
        self._triangle = gl.vertex_array(self._program, [])
        self._shown: moderngl.Framebuffer | None = None
        self._spare: moderngl.Framebuffer | None = None
        self._made_of: tuple | None = None
        # What a picture of full size costs. Before the first it is unknown, and a coarse one comes sooner.
        self._trace_ms = self._shade_ms = math.inf
        self._divisors: dict[bool, int] = {}
        self._rays_stale = True

    def forget(self) -> None:
        """Makes the next `update` render, whatever it is given."""
        self._made_of = None

    def update(self, scene: Scene, time: float, area: Area, *, moving: bool, camera_moving: bool) -> bool:
        """Renders when anything that shows has changed.

        Args:
            time: scene time in r_s/c.
            moving: whether the next frame will differ; a costly picture is then drawn coarser.
            camera_moving: whether rays have to be traced anew, which costs more than shading.

        Returns:
            Whether a picture was rendered.
        """
        self.divisor = self._divisor_for(camera_moving) if moving else 1
        size = area.coarsened(self.divisor)
        wanted = (scene, time, size)
        if wanted == self._made_of:
            return False
        # Remembered before rendering: what fails is not tried again until something changes.
        self._made_of = wanted
        self.report = self.renderer.render(scene, time, size, target=self._spare_of(size), measure=True)
        self._shown, self._spare = self._spare, self._shown
        full = self.divisor**2
        self._shade_ms = (self.report.shade_ms + self.report.post_ms) * full
        if self.report.traced:
            self._trace_ms = self.report.trace_ms * full
        self._rays_stale |= self.report.traced
        return True

    def count_rays(self) -> None:
        """Brings `rays` up to date with the hit map. It is read back whole, so this is for frames in which no rays are traced."""
        if self._rays_stale:
            self.rays = RayFigures.of(self.renderer.hits())
            self._rays_stale = False

    def read_rgb8(self) -> np.ndarray:
        """The picture as uint8 (height, width, 3), top row first."""
        width, height = self._shown.size
        data = np.frombuffer(self._shown.read(components=3, alignment=1), np.uint8)
        return data.reshape(height, width, 3)[::-1]

    def _divisor_for(self, camera_moving: bool) -> int:
        budget, coarsest = _BUDGET[camera_moving]
        needed = math.sqrt((self._shade_ms + (self._trace_ms if camera_moving else 0.0)) / budget)
        kept = self._divisors.get(camera_moving, 1)
        # A choice is kept while it is right to about a third, so that the picture does not hop between two sizes.
        if not kept - 1.3 < needed < kept + 0.3:
            kept = max(math.ceil(min(needed, coarsest)), 1)
        self._divisors[camera_moving] = kept
        return kept

    def _spare_of(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        """What the next picture goes into. The one shown is left alone: should rendering fail, it is the last good one."""
        if self._spare is None or self._spare.size != size:
            if self._spare is not None:
                self._spare.color_attachments[0].release()
                self._spare.release()
            texture = self._gl.texture(size, 4)
            texture.repeat_x = texture.repeat_y = False
            self._spare = self._gl.framebuffer([texture])
        return self._spare

    def draw(self, window: moderngl.Framebuffer, area: Area) -> None:
        """Fills `area` of `window` with the picture, and the rest with black."""
        window.use()
        self._gl.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._gl.scissor = None
        window.clear()
        if self._shown is None or area.is_empty:
            return
        self._gl.viewport = (area.x, area.y, area.width, area.height)
        self._shown.color_attachments[0].use(0)
        self._program["area"].value = (area.x, area.y, area.width, area.height)
        self._triangle.render(moderngl.TRIANGLES, vertices=3)
