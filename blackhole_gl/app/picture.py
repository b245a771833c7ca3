"""The picture behind the panel: rendered only when something changed, kept, and drawn into the free part of the window."""

from __future__ import annotations

import contextlib
import time as clock
from dataclasses import dataclass, replace
from typing import Any

import moderngl
import numpy as np

from .. import plan
from ..render.programs import Unready
from ..render.supersampling import MOST_SAMPLES
from ..scene import Scene
from .preparation import Preparation
from .resolution import COARSEST, Resolution

# A scene whose programs have not drawn yet is drawn coarse first, whether rays may be interpolated or not: the first draw makes drivers finish
# what compiling began, and takes its time however few the pixels. After that nothing is missing.
_REHEARSALS = (False, True)  # the one with fewer programs first

# A picture at rest that takes longer than this for one more ray a pixel, two times running, is left as it is, in seconds: meanwhile the window answers
# nothing. Once is no more than a first draw, or another program's doing.
_LONGEST_SAMPLE_S = 0.5

# The place travels from corner to corner instead of being worked out at each pixel: software renderers then have a quick way.
_VERTEX = """#version 330 core
out vec2 place;
void main() { place = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2); gl_Position = vec4(place * 2.0 - 1.0, 0.0, 1.0); }
"""
_FRAGMENT = """#version 330 core
uniform sampler2D picture;
in vec2 place;
out vec4 colour;
void main() { colour = texture(picture, place); }
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

    def scaled(self, scale: float) -> tuple[int, int]:
        """(width, height) of a picture with about `scale` times as many pixels each way, at least one."""
        return _side(self.width, scale), _side(self.height, scale)


def _side(pixels: int, scale: float) -> int:
    """`scale` times as many pixels, or up to four less.

    llvmpipe compiles every shader anew that reads a texture of the first kind whose side is a power of two, and takes up to a second for it. The grid
    of a refined hit map and the first level of the bloom have a quarter of the picture's side, rounded up, and with every step of the scale another.
    """
    side = max(round(pixels * scale), 1)
    quarter = -(-side // 4)
    is_power_of_two = quarter & (quarter - 1) == 0
    return 4 * (quarter - 1) if scale < 1.0 and quarter > 4 and is_power_of_two else side


@dataclass(frozen=True)
class RayFigures:
    """What became of the picture's rays: mean steps of a ray, and how many ended nowhere."""

    steps: float
    unresolved: int

    @classmethod
    def of(cls, fate: np.ndarray, steps: np.ndarray) -> RayFigures:
        """The figures of rays by what became of them, as in `HitArrays`, and the steps they took."""
        return cls(float(np.mean(steps)), int(np.count_nonzero(fate == 0)))


@dataclass(frozen=True)
class _Method:
    """How a scene was traced: the scene as it was asked for, and with everything chosen that it left to the plan."""

    asked: Scene
    stated: Scene

    @classmethod
    def of(cls, asked: Scene, drawn: Scene) -> _Method:
        """That of `asked`, which was drawn as `drawn`."""
        return cls(asked, plan.plan(drawn).scene)

    def stated_in(self, scene: Scene) -> Scene | None:
        """`scene` traced in this way; None unless it is the scene asked for with another camera or hole, and of the same space-time."""
        if replace(scene, camera=self.asked.camera, hole=self.asked.hole) != self.asked or plan.plan(scene).scene.rays.model != self.stated.rays.model:
            return None
        return replace(scene, rays=self.stated.rays, parameters=self.stated.parameters)

    def bridges(self, scene: Scene) -> bool:
        """Whether `scene`, some program of which is missing, may be drawn in this way meanwhile: only where it is its method that is new."""
        return self.stated_in(scene) is not None and plan.plan(scene).scene.rays != self.stated.rays


@dataclass(frozen=True)
class _Drawing:
    """What a picture was drawn of."""

    scene: Scene
    time: float
    size: tuple[int, int]
    progressive: bool


class Picture:
    """Renders a scene into a texture of its own and draws that into the window. A picture that the next frame replaces is drawn into the window at once, where it
    is as large as its area: llvmpipe takes a tenth of the frame for the copy. Should the next one fail, it is drawn again, into the texture.

    Args:
        gl: the window's context.
        renderer: what makes pictures; see ``render.frame.Renderer``.
        preparation: when programs may be compiled.

    Attributes:
        report: of the last picture rendered, a ``render.frame.FrameReport``; None before the first.
        rays: what became of its rays, as of the last `count_rays`.
        scale: width and height of the last picture over those of its area.
        samples: rays a pixel that the last picture is the mean of.
        bridges: whether the picture goes on by an earlier method while the programs of the scene's own are prepared, as where a moving camera
            comes to where the plan takes another.
    """

    def __init__(self, gl: moderngl.Context, renderer: Any, preparation: Preparation):
        self._gl = gl
        self.renderer = renderer
        self.preparation = preparation
        self.report: Any = None
        self.rays: RayFigures | None = None
        self.scale = 1.0
        self.samples = 1
        self.bridges = False
        self._program = gl.program(vertex_shader=_VERTEX, fragment_shader=_FRAGMENT)
        self._triangle = gl.vertex_array(self._program, [])
        self._shown: moderngl.Framebuffer | None = None
        self._spare: moderngl.Framebuffer | None = None
        self._in_window: _Drawing | None = None  # the last picture, where only the window has it
        self._is_drawn = False  # that, in this frame
        self._made_of: tuple | None = None
        self._resolution = Resolution()
        self._most_samples = 1  # that it is to have at rest
        self._sample_took_s = 0.0  # the last one
        self._begun: float | None = None  # when the last picture of this movement was begun, in seconds
        self._took_ms = 0.0
        self._rehearsed = 0  # of `_REHEARSALS`, and one more when a whole picture has followed
        self._rays_stale = True
        self._method: _Method | None = None  # of the last picture
        self._prepared: _Method | None = None  # what the other process was asked for

    @property
    def is_current(self) -> bool:
        """Whether the picture is of the scene of the last `update`, and neither an earlier one nor a rehearsal, nor by another method."""
        return self._is_rehearsed and not self.bridges

    @property
    def _is_rehearsed(self) -> bool:
        return self._rehearsed > len(_REHEARSALS)

    def forget(self) -> None:
        """Makes the next `update` render, whatever it is given."""
        self._made_of = None

    @property
    def is_sharp(self) -> bool:
        """Whether every pixel shown has a ray of its own; after a movement that takes some more calls of `update`."""
        return self.report is None or self.report.sharp

    @property
    def is_final(self) -> bool:
        """Whether further calls of `update` for the same would draw nothing."""
        return self.is_current and self.is_sharp and self.samples >= self._most_samples

    def update(
        self, scene: Scene, time: float, area: Area, *, moving: bool, camera_moving: bool, exact: bool = False, window: moderngl.Framebuffer | None = None
    ) -> bool:
        """Renders when anything that shows has changed. `draw` is to follow.

        Args:
            time: scene time in r_s/c.
            moving: whether the next frame will differ; a picture too costly for the scene's frame rate is then drawn coarser.
            camera_moving: whether rays have to be traced anew, which costs more than shading; some pixels are then interpolated between rays.
            exact: make the picture sharp at once.
            window: where a picture that moves may be drawn at once.

        Returns:
            Whether a picture was rendered.
        """
        now = clock.perf_counter()
        self._is_drawn = False
        waits = self.preparation.waits(now)
        bridge = self._bridge(scene, waits)
        self.bridges = bridge is not None
        if waits and not self.bridges:
            return False
        drawn = bridge or scene
        rehearsing = self._rehearsed < len(_REHEARSALS)
        scale = COARSEST[True] if rehearsing else self._scale_for(scene, now, moving, camera_moving)
        size = area.scaled(scale)
        wanted = (drawn, time, size)
        if wanted == self._made_of and self.is_sharp and not rehearsing:
            self._begun = None
            return self._keep() or self._draw_finer(drawn, time, size)
        # Remembered before rendering: what fails is not tried again until something changes.
        self._made_of = wanted
        self.samples = self._most_samples = 1
        progressive = _REHEARSALS[self._rehearsed] if rehearsing else camera_moving or not (exact or self.is_current and self.is_sharp)
        if rehearsing:
            self.renderer.hit_map.forget()
        self.renderer.programs.deadline = self.preparation.deadline(now)
        drawing = _Drawing(drawn, time, size, progressive)
        at_once = window is not None and moving and self._is_rehearsed and size == (area.width, area.height)
        try:
            report = self._render_into(window, area, drawing) if at_once else self._render(drawing)
        except Unready:
            self.renderer.hit_map.forget()  # it may be half drawn
            self._made_of = None
            self._keep_if_possible()
            self._miss(scene, area.scaled(COARSEST[True]), now)
            return False
        except Exception:
            self.preparation.over()
            self._keep_if_possible()
            raise
        self.report, self.scale = report, scale
        if drawn.post.view == "picture":
            self._most_samples = MOST_SAMPLES
        self._rays_stale |= report.traced
        self._follow(report, rehearsing)
        if self._is_rehearsed and not waits:
            self._method = _Method.of(scene, drawn)
            self.preparation.over()
        return True

    def _render(self, drawing: _Drawing) -> Any:
        """Draws into the texture; returns the report."""
        report = self.renderer.render(drawing.scene, drawing.time, drawing.size, target=self._spare_of(drawing.size), measure=True, progressive=drawing.progressive)
        self._shown, self._spare = self._spare, self._shown
        self._in_window = None
        return report

    def _render_into(self, window: moderngl.Framebuffer, area: Area, drawing: _Drawing) -> Any:
        """Draws into `area` of `window`; returns the report."""
        self._clear_beside(window, area)
        viewport = (area.x, area.y, area.width, area.height)
        report = self.renderer.render(drawing.scene, drawing.time, drawing.size, target=window, viewport=viewport, measure=True, progressive=drawing.progressive)
        self._in_window, self._is_drawn = drawing, True
        return report

    def _keep(self) -> bool:
        """Draws the last picture into the texture, if only the window has it. Returns whether it was drawn."""
        if self._in_window is None:
            return False
        self.report = self._render(self._in_window)
        return True

    def _keep_if_possible(self) -> None:
        """For when the next picture failed, which is what is to be told."""
        with contextlib.suppress(Exception):
            self._keep()

    def _draw_finer(self, scene: Scene, time: float, size: tuple[int, int]) -> bool:
        """One more ray a pixel for a picture in which nothing changes any more. Returns whether there was one to take."""
        if self.samples >= self._most_samples:
            return False
        begun = clock.perf_counter()
        self.samples = self.renderer.render_finer(scene, time, size, target=self._spare_of(size))
        self._shown, self._spare = self._spare, self._shown
        took, before = clock.perf_counter() - begun, self._sample_took_s
        self._sample_took_s = took
        if min(took, before) > _LONGEST_SAMPLE_S:
            self._most_samples = self.samples
        return True

    def _follow(self, report: Any, rehearsing: bool) -> None:
        """What a picture means for those to come."""
        if rehearsing:
            self._begun = None
            self._rehearsed += 1
            return
        if not self._is_rehearsed:
            self._rehearsed += 1
            self._resolution = Resolution()  # what is known is of another scene
        self._learn(report)

    def _bridge(self, scene: Scene, waits: bool) -> Scene | None:
        """`scene` by the method that it can be drawn with now, while another is prepared: that of the last picture, and then the one asked for, though
        the camera may be where the plan takes a third by then. None where nothing is prepared, or the scene is another one altogether."""
        if self.preparation.since is None or not self._is_rehearsed:
            return None
        return (self._method if waits else self._prepared).stated_in(scene)

    def _miss(self, scene: Scene, size: tuple[int, int], now: float) -> None:
        """A program of `scene` was missing."""
        self.preparation.missed(scene, size, now)
        if self._is_rehearsed and not self.bridges and self._method.bridges(scene):
            self._prepared = _Method.of(scene, scene)
        else:
            self._rehearsed = 0

    def _learn(self, report: Any) -> None:
        """Takes in what the picture cost."""
        self._took_ms = report.trace_ms + report.shade_ms + report.post_ms
        if not report.sharpened:
            self._resolution.record(self.scale, self._took_ms, traced=report.traced)

    def count_rays(self) -> None:
        """Brings `rays` up to date with the hit map. A part of it is read back, so this is for frames in which no rays are traced."""
        if self._rays_stale and self.is_sharp:
            self.rays = RayFigures.of(*self.renderer.fates_and_steps())
            self._rays_stale = False

    def read_rgb8(self) -> np.ndarray:
        """The picture as uint8 (height, width, 3), top row first."""
        width, height = self._shown.size
        data = np.frombuffer(self._shown.read(components=3, alignment=1), np.uint8)
        return data.reshape(height, width, 3)[::-1]

    def _scale_for(self, scene: Scene, now: float, moving: bool, camera_moving: bool) -> float:
        if not moving:
            self._begun = None
            self._resolution.rest()
            return 1.0
        elapsed = 0.0
        if self._begun is not None:
            elapsed = now - self._begun
            self._resolution.record_rest(1e3 * elapsed - self._took_ms)
        self._begun = now
        return self._resolution.scale(scene.playback.target_fps, camera_moving=camera_moving, elapsed=elapsed)

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
        if self._is_drawn:
            window.use()
            return
        self._clear_beside(window, area)
        if self._shown is None or area.is_empty:
            return
        texture = self._shown.color_attachments[0]
        # Smooth only where it is enlarged: pixel for pixel it looks the same, for less.
        filtering = moderngl.NEAREST if texture.size == (area.width, area.height) else moderngl.LINEAR
        texture.filter = (filtering, filtering)
        self._gl.viewport = (area.x, area.y, area.width, area.height)
        texture.use(0)
        self._triangle.render(moderngl.TRIANGLES, vertices=3)

    def _clear_beside(self, window: moderngl.Framebuffer, area: Area) -> None:
        """Makes `window` black, unless the picture will fill it."""
        window.use()
        self._gl.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self._gl.scissor = None
        if self._shown is None or (area.width, area.height) != window.size:
            window.clear()
