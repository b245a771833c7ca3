"""Scene + time → picture: the passes in order. Trace fills the hit map, shading reads it, post makes it a picture."""

from __future__ import annotations

import time as clock
from collections.abc import Callable
from dataclasses import dataclass

import moderngl
import numpy as np

from .. import plan
from ..scene import Scene
from . import diagnostics, supersampling, uniforms
from .hit_map import HitArrays, HitMap
from .post import PostPass
from .programs import Programs
from .shading import ShadePass

TILE = 512
"""Side in pixels of the tiles of a still; even, so that pixel quads never straddle two."""


@dataclass(frozen=True)
class FrameReport:
    """What one frame took.

    Attributes:
        trace_ms, shade_ms, post_ms: wall-clock milliseconds of each pass; all 0 unless asked to measure.
        traced: whether rays were traced; False when the kept hit map served.
        sharp: whether every pixel had a ray of its own.
        sharpened: whether the rays traced only made a slice of a kept map exact.
        method: the plan's method in a few words.
        reasons: why the plan chose it.
    """

    trace_ms: float
    shade_ms: float
    post_ms: float
    traced: bool
    sharp: bool
    sharpened: bool
    method: str
    reasons: tuple[str, ...]


class Renderer:
    """Draws scenes with one GL context.

    Attributes:
        programs: the compiled programs; ``programs.reload()`` takes up changed shader files.
        hit_map: the last trace.
        reference_map: the last trace by the most accurate method, for the view that compares with it.
    """

    def __init__(self, ctx: moderngl.Context):
        self.ctx = ctx
        self.programs = Programs(ctx)
        self.hit_map = HitMap(ctx, self.programs)
        self.reference_map = HitMap(ctx, self.programs)
        self._sample_map = HitMap(ctx, self.programs)
        self._mean = supersampling.Mean(ctx)
        self._shade = ShadePass(ctx, self.programs)
        self._views = diagnostics.ViewPass(ctx, self.programs)
        self._post = PostPass(ctx, self.programs)
        self._buffers: dict[str, moderngl.Buffer] = {}
        self._radiance: moderngl.Framebuffer | None = None
        self._picture: moderngl.Framebuffer | None = None

    def render(
        self,
        scene: Scene,
        time: float,
        size: tuple[int, int],
        target: moderngl.Framebuffer | None = None,
        viewport: tuple[int, int, int, int] | None = None,
        *,
        measure: bool = False,
        progressive: bool = False,
    ) -> FrameReport:
        """Draws `scene` at scene time `time` (r_s/c).

        Args:
            size: (width, height) of the picture in pixels, each at least 1.
            target: where it goes; an own 8-bit picture, read by `read_rgb8`, when None.
            viewport: (x, y, width, height) in the target; the whole picture at (0, 0) when None.
            measure: wait for each pass to end, so that the report's milliseconds mean something.
            progressive: for a camera that moves: new hits may be interpolated between exact rays, within the scene's tolerance; each
                further call for the same hits makes a slice of the picture exact, until the report says that it is sharp.

        Raises:
            SceneError, ValueError: the scene cannot be drawn; the text says why.
            ShaderError: a shader has a mistake.
        """
        scene, ray_plan = diagnostics.prepared(plan.resolved(scene), plan.plan(scene))
        stamps = [clock.perf_counter()]
        traced = self._trace(scene, ray_plan, time, size, (0.0, 0.0), progressive=progressive and not diagnostics.is_on(scene))
        self._stamp(stamps, measure)
        self._shade_into(scene, ray_plan, size)
        self._stamp(stamps, measure)
        self._post.draw(scene, ray_plan, self._radiance.color_attachments[0], target or self._own_picture(size), viewport or (0, 0, *size))
        self._stamp(stamps, measure)
        trace_ms, shade_ms, post_ms = (1e3 * (b - a) if measure else 0.0 for a, b in zip(stamps, stamps[1:]))
        return FrameReport(trace_ms, shade_ms, post_ms, traced, self.hit_map.is_sharp, self.hit_map.sharpened, ray_plan.method, ray_plan.reasons)

    def render_finer(self, scene: Scene, time: float, size: tuple[int, int], target: moderngl.Framebuffer | None = None) -> int:
        """Draws `scene` at scene time `time` with one more ray through each pixel than the last call for the same, and shows the mean of all (of an odd number of them:
        supersampling.py).

        Meant for a picture that `render` has drawn sharp: the first call takes the rays that it left.

        Returns:
            How many rays a pixel there are now.

        Raises:
            As `render`; ValueError: the scene asks for a view, whose false colours have no mean.
        """
        scene, ray_plan = plan.resolved(scene), plan.plan(scene)
        if diagnostics.is_on(scene):
            raise ValueError(f"post.view: {scene.post.view!r} has one ray a pixel; only 'picture' is drawn finer")
        self._mean.begin((scene, time, size))
        shift = supersampling.place(self._mean.count)
        if self._mean.count == 0:
            self._trace(scene, ray_plan, time, size, shift)
            hit_map = self.hit_map
        else:
            hit_map = self._sample_map
            hit_map.trace(scene, ray_plan, self._bind(scene, ray_plan, time, size, shift), size)
        self._shade_into(scene, ray_plan, size, hit_map)
        mean = self._mean.add(self._radiance_array())
        self._post.draw(scene, ray_plan, mean, target or self._own_picture(size), (0, 0, *size))
        if self._mean.count == supersampling.MOST_SAMPLES:
            self._sample_map.release()
        return self._mean.count

    def time_trace(self, scene: Scene, size: tuple[int, int], ray_plan: plan.RayPlan | None = None, *, progressive: bool = False) -> float:
        """Seconds by the wall clock that one trace of `scene` at `size` takes (by its own plan when None), programs compiled before."""
        ray_plan, scene = ray_plan or plan.plan(scene), plan.resolved(scene)
        self.programs.get("trace.frag", scene, ray_plan)
        self.hit_map.forget()
        self.ctx.finish()
        start = clock.perf_counter()
        self._trace(scene, ray_plan, 0.0, size, (0.0, 0.0), progressive=progressive)
        self.ctx.finish()
        return clock.perf_counter() - start

    def render_still(self, scene: Scene, time: float, size: tuple[int, int], samples: int = 1, progress: Callable[[float], None] | None = None) -> None:
        """Draws `scene` into the own picture in tiles, so that no single draw call is long enough for a GPU's watchdog.

        Args:
            samples: rays a pixel along each axis, on a regular grid; their radiance is averaged.
            progress: called with the share done, 0…1.

        Raises:
            As `render`.
        """
        scene, ray_plan = diagnostics.prepared(plan.resolved(scene), plan.plan(scene))
        width, height = size
        total = np.zeros((height, width, 4), np.float32)
        tiles = [(x, y) for y in range(0, height, TILE) for x in range(0, width, TILE)]
        passes = [(tile, index) for tile in tiles for index in range(samples * samples)]
        for done, ((x, y), index) in enumerate(passes):
            shift = [(k + 0.5) / samples - 0.5 for k in (index % samples, index // samples)]
            tile = min(TILE, width - x), min(TILE, height - y)
            self._trace(scene, ray_plan, time, tile, (x + shift[0], y + shift[1]), picture=size)
            self._shade_into(scene, ray_plan, tile)
            total[y : y + tile[1], x : x + tile[0]] += self._radiance_array() / samples**2
            if progress is not None:
                progress((done + 1) / len(passes))
        texture = self.ctx.texture(size, 4, total.astype(np.float16).tobytes(), dtype="f2")
        self._post.draw(scene, ray_plan, texture, self._own_picture(size), (0, 0, *size))
        texture.release()

    def trace_listed(self, scene: Scene, directions: np.ndarray) -> tuple[HitArrays, np.ndarray, plan.RayPlan]:
        """Listed local directions (N, 3) (`observer.local_directions`) through the shader that pictures use.

        Returns:
            Their hits; the exact g of each kept crossing, float32 (N, 3), 0 where there is none; the plan used.
        """
        ray_plan, scene = plan.plan(scene, keep_crossings=True), plan.resolved(scene)
        self._bind(scene, ray_plan, 0.0, (1, 1), (0.0, 0.0))
        self.ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        hits = self.hit_map.trace_listed(scene, ray_plan, directions)
        shifts = self.hit_map.emission_shifts(scene, ray_plan).reshape(-1, 3)[: len(directions)]
        return hits, shifts, ray_plan

    def read_rgb8(self) -> np.ndarray:
        """The own picture as uint8 (height, width, 3), top row first."""
        width, height = self._picture.size
        data = np.frombuffer(self._picture.read(components=3, alignment=1), np.uint8)
        return data.reshape(height, width, 3)[::-1].copy()

    def radiance(self) -> np.ndarray:
        """Scene-referred radiance of the last frame as float32 (height, width, 3), top row first."""
        return self._radiance_array()[::-1, :, :3].astype(np.float32)

    def fates_and_steps(self) -> tuple[np.ndarray, np.ndarray]:
        """What became of the rays of the last frame, and the steps they took, each as int (height, width); the hit map has to be sharp."""
        return self.hit_map.fates_and_steps()

    def hits(self) -> HitArrays:
        """The hit map of the last frame."""
        return self.hit_map.read()

    def release(self) -> None:
        """Gives the GL objects back."""
        self.hit_map.release()
        self.reference_map.release()
        self._sample_map.release()
        self._mean.release()
        self._views.release()
        self._shade.release()
        self._post.release()
        for framebuffer in (self._radiance, self._picture):
            if framebuffer is not None:
                framebuffer.color_attachments[0].release()
                framebuffer.release()
        for buffer in self._buffers.values():
            buffer.release()
        self._radiance = self._picture = None
        self._buffers = {}

    def _trace(self, scene: Scene, ray_plan: plan.RayPlan, time: float, size: tuple[int, int], offset: tuple[float, float], picture: tuple[int, int] | None = None, progressive: bool = False) -> bool:
        self.ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        traced_reference = False
        if scene.post.view == "difference":
            exact, exact_plan = diagnostics.most_accurate(scene, ray_plan)
            traced_reference = self.reference_map.trace(exact, exact_plan, self._bind(exact, exact_plan, time, picture or size, offset), size)
        ray_bytes = self._bind(scene, ray_plan, time, picture or size, offset)
        return self.hit_map.trace(scene, ray_plan, ray_bytes, size, progressive=progressive) or traced_reference

    def _shade_into(self, scene: Scene, ray_plan: plan.RayPlan, size: tuple[int, int], hit_map: HitMap | None = None) -> None:
        if self._radiance is None or self._radiance.size != size:
            self._radiance = self._fresh(self._radiance, size, 4, "f2")
        if diagnostics.is_on(scene):
            self._views.draw(scene, ray_plan, self.hit_map, self.reference_map, self._radiance)
        else:
            self._shade.draw(scene, ray_plan, hit_map or self.hit_map, self._radiance)

    def _own_picture(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        if self._picture is None or self._picture.size != size:
            self._picture = self._fresh(self._picture, size, 4, "f1")
        return self._picture

    def _fresh(self, old: moderngl.Framebuffer | None, size: tuple[int, int], components: int, dtype: str) -> moderngl.Framebuffer:
        if old is not None:
            old.color_attachments[0].release()
            old.release()
        return self.ctx.framebuffer([self.ctx.texture(size, components, dtype=dtype)])

    def _bind(self, scene: Scene, ray_plan: plan.RayPlan, time: float, size: tuple[int, int], offset: tuple[float, float]) -> bytes:
        """Fills and binds the uniform blocks; returns the ray block's bytes."""
        packed = uniforms.as_bytes(scene, ray_plan, time, size, offset)
        for block in uniforms.blocks():
            data = packed[block.name]
            if block.name not in self._buffers:
                self._buffers[block.name] = self.ctx.buffer(data, dynamic=True)
            else:
                self._buffers[block.name].write(data)
            self._buffers[block.name].bind_to_uniform_block(block.binding)
        return packed[uniforms.ray_block().name]

    def _radiance_array(self) -> np.ndarray:
        width, height = self._radiance.size
        return np.frombuffer(self._radiance.color_attachments[0].read(), np.float16).reshape(height, width, 4).astype(np.float32)

    def _stamp(self, stamps: list[float], measure: bool) -> None:
        if measure:
            self.ctx.finish()
        stamps.append(clock.perf_counter())
