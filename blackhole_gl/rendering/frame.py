"""Scene + time → picture: the passes in order. Trace fills the hit map, shading reads it, post makes it a picture."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import moderngl
import numpy as np

from ..physics import projection
from ..planning import Plan
from ..planning import plan as make_plan
from ..scene import Scene
from . import coarse_transfer, diagnostics, instances, kept_light, listed, supersampling, views
from .coarse_transfer import MediaApart
from .edges import EdgeRays, Motion
from .frame_report import FrameReport
from .hit_map import HitArrays, HitMap
from .inputs import FrameInputs
from .last_picture import LastPicture
from .metering import Exposure
from .post import PostPass, keeps_stars
from .programs import Programs, Unready
from .shading import ShadePass
from .star_layer import StarLayer
from .stills import Stills
from .structure import chosen
from .tables import Tables
from .target import Target
from .temperatures import TemperatureProfile
from .tiles import TILE, Kind, Lights, Spread, Tile
from .turning import TurningPass, Turns, can_turn
from .uniforms import stars_a_pixel


class Renderer:
    """Draws scenes with one GL context.

    Attributes:
        programs: the compiled programs; ``programs.reload()`` takes up changed shader files.
        hit_map: the last trace.
        transfer, coarse_transfer: what the media of the last picture add to each ray, drawn as exactly as the rest or at a resolution of their own.
        edges: the pixels of the last picture that have several rays.
        last: what rays of the last picture meet.
        reference_map: the last trace by the most accurate method, for the view that compares with it.
        exposure: what makes automatic exposure up.
        spread: what draws the tiles of stills in the place of this renderer, which develops them; None: nothing.
        shadings: how many times a hit map has been shaded, for tests.
    """

    def __init__(self, ctx: moderngl.Context):
        self.ctx = ctx
        self.programs = Programs(ctx)
        self._tables, self._reference_tables, self._temperatures = Tables(ctx), Tables(ctx), TemperatureProfile(ctx)
        self.hit_map = HitMap(ctx, self.programs, self._tables)
        self.reference_map = HitMap(ctx, self.programs, self._reference_tables)
        self._sample_map = HitMap(ctx, self.programs, self._tables)
        self._mean = supersampling.Mean(ctx)
        self._shade = ShadePass(ctx, self.programs, self._tables, self._temperatures)
        self.transfer, self.coarse_transfer = self._shade.transfer, self._shade.coarse_transfer
        self.edges = EdgeRays(ctx, self.programs, self._tables, self._temperatures, self._shade.sorting)
        self._views = diagnostics.ViewPass(ctx, self.programs, self._temperatures)
        self.exposure = Exposure(ctx, self.programs, self._tables, self._temperatures)
        self._post = PostPass(ctx, self.programs)
        self._stars = StarLayer(ctx)
        self._turning, self._turns = TurningPass(ctx, self.programs, self._tables, self._temperatures), Turns()
        self.last = LastPicture(self.hit_map, self._sample_map)
        self._last: FrameInputs | None = None  # without media that are marched apart
        self.shadings = 0
        self._marched = 0  # rays, by the end of the last frame
        self._turning_shown = False  # whether the last picture is of the pass of that name
        self._turning_waits = False  # whether a program of it was missing
        self._radiance: Target | None = None
        self._radiance_key: tuple | None = None  # where its light stands
        self._picture: Target | None = None
        self._stills = Stills(ctx, self._tile, self._post)
        self.spread: Spread | None = None
        self._still: np.ndarray | None = None  # the own picture, where it is a still

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
        glow_may_last: bool = False,
        shown: tuple[int, int] | None = None,
        may_turn: bool = False,
    ) -> FrameReport:
        """Draws `scene` at scene time `time` (r_s/c).

        Args:
            size: (width, height) of the picture in pixels, each at least 1.
            target: where it goes; an own 8-bit picture, read by `read_rgb8`, when None.
            viewport: (x, y, width, height) in the target; the whole picture at (0, 0) when None.
            measure: wait for each pass to end, so that the report's milliseconds mean something.
            progressive: for a camera that moves: new hits may be interpolated between exact rays, within the scene's tolerance; each
                further call for the same hits makes a slice of the picture exact, until the report says that it is sharp. Pixels at edges have four rays, or
                sixteen where they are far coarser than those `shown`, and one at plain outlines of things.
            glow_may_last: for a picture that the next one replaces, and that differs from the last by little time alone: see ``PostPass.draw``. Where a thing
                has moved in it, pixels at edges have four rays.
            shown: (width, height) that the picture will be enlarged to; single stars are then left to `draw_stars`.
            may_turn: of a `progressive` picture: where the camera has only turned or zoomed since the last one, this may be one that is filtered from light
                kept by direction (turning.py).

        Raises:
            SceneError, ValueError: the scene cannot be drawn; the text says why.
            ShaderError: a shader has a mistake.
        """
        stamps = [clock.perf_counter()]
        shown = shown if keeps_stars(scene) else None
        planned = self.exposure.of(diagnostics.prepared(make_plan(scene)), patient=progressive)
        before, turned = self._turns.last, self._turns.turned(scene)
        if not self._turns.stays:
            self._turning.forget()
        self._turning_shown = turned and may_turn and progressive and can_turn(planned)
        if self._turning_shown:
            into = target or self._own_picture(size).frame, viewport or (0, 0, *size)
            turn = partial(self._turning.draw, scene, planned, time, size, *into, shown=shown, before=before or scene)
            self._turning_shown = self._turned(turn)
        if self._turning_shown:
            self.last.show(None)
            self._stamp(stamps, measure)
            made = self._report((0.0, 1e3 * (stamps[-1] - stamps[0]) if measure else 0.0, 0.0), False, planned, sharp=False, telling=False)
            return replace(made, sharpened=self._turning.prepares)
        inputs = FrameInputs.whole(planned, time, size, shown=shown)
        media = coarse_transfer.of(inputs, moving=progressive, passes=glow_may_last)
        self._last = rest = coarse_transfer.rest_of(inputs, media)
        self.last.show(inputs, apart=rest is not inputs)
        traced = self._trace(rest, progressive=progressive and not diagnostics.is_on(scene))
        self._views.fit(scene, self.hit_map, moving=progressive)
        if not diagnostics.is_on(scene):
            self.edges.look(rest, self.hit_map)
        self._stamp(stamps, measure)
        thing_moved = traced and glow_may_last and instances.anything_moves(inputs.plan)
        if not progressive and self.programs.deadline < math.inf:
            self._ask_for_coarse_media(inputs)
        motion = Motion.CAMERA if progressive else Motion.MATTER if thing_moved or media is not None and media.passes else Motion.NOTHING
        telling = self.coarse_transfer.tells
        radiance = self._kept_or_shaded(rest, media, motion)
        telling = telling or self.coarse_transfer.tells
        marched = not progressive or self._march_exactly(inputs, rest, passes=glow_may_last, stays=not traced or self.hit_map.sharpened)
        telling = telling or glow_may_last and not marched
        self._stamp(stamps, measure)
        self._post.draw(rest, radiance.texture, target or self._own_picture(size).frame, viewport or (0, 0, *size), glow_may_last=glow_may_last)
        self._stamp(stamps, measure)
        trace_ms, shade_ms, post_ms = (1e3 * (b - a) if measure else 0.0 for a, b in zip(stamps, stamps[1:]))
        return self._report((trace_ms, shade_ms, post_ms), traced, inputs.plan, sharp=marched and self.hit_map.is_sharp, telling=telling)

    def _turned(self, draw: Callable[[], bool]) -> bool:
        """Whether `draw`, of the pass that turns views, has drawn. It may compile a program a frame whenever that is; while others are missing the picture is
        to be drawn as under any moving camera."""
        deadline = self.programs.deadline
        self.programs.deadline = max(deadline, clock.perf_counter())
        self._turning_waits = False
        try:
            return draw()
        except Unready:
            self._turning_waits = True
            self._turning.forget()
            return False
        finally:
            self.programs.deadline = deadline

    def turns(self, scene: Scene) -> bool:
        """Whether `scene` differs from the last picture, or those before it from the same place, by the camera's look alone, and such a picture may be one that
        is filtered from light kept by direction.

        Raises:
            As `render`.
        """
        return self._turns.would_turn(scene) and not self._turning_waits and can_turn(make_plan(scene))

    def _ask_for_coarse_media(self, inputs: FrameInputs) -> None:
        """Has the programs compiled that media take while a camera that has stopped sees them as in motion, and while time runs: a window rehearses neither."""
        for moving in (True, False):
            media = coarse_transfer.of(inputs, moving=moving, passes=True)
            if media is not None and not media.exact:
                self.coarse_transfer.ask_for(media, self.hit_map)

    def _march_exactly(self, inputs: FrameInputs, rest: FrameInputs, *, passes: bool, stays: bool) -> bool:
        """Whether all is there of the media that the next picture shows at rest; where the view `stays`, some more of their rays are marched."""
        media = coarse_transfer.of(inputs, moving=False, passes=passes)
        if media is None:
            return True
        if not (stays and self.hit_map.is_sharp):
            return not media.exact
        return self._shade.march_apart(rest, media, self.hit_map) if media.exact else self._shade.prepare_coarse(media, self.hit_map)

    def draw_stars(self, target: moderngl.Framebuffer, viewport: tuple[int, int, int, int]) -> None:
        """Adds the single stars that the last `render` left out to its picture enlarged, which `viewport` (x, y, width, height) of `target` holds.

        To come right after that `render`, with nothing drawn between.

        Raises:
            RuntimeError: none has been drawn.
        """
        if self._turning_shown:
            self._turning.draw_stars(target, viewport)
            return
        if self._last is None:
            raise RuntimeError("no picture has been drawn yet: `render` comes first")
        scene = self._last.plan.scene
        if stars_a_pixel(scene) and not diagnostics.is_on(scene) and min(self._last.finer) < 1.0:
            stars, samplers = self._shade.stars(self._last, self.hit_map)
            self._stars.draw(stars, {**samplers, **self._post.samplers}, _drawn(self._radiance), target, viewport, self._post.glow_window)

    def render_finer(self, scene: Scene, time: float, size: tuple[int, int], target: moderngl.Framebuffer | None = None) -> int:
        """Draws `scene` at scene time `time` with one more ray through each pixel than the last call for the same, and shows the mean of all (of an odd
        number of them: supersampling.py).

        Meant for a picture that `render` has drawn sharp: the first call takes the rays that it left.

        Returns:
            How many rays a pixel there are now; no more than the scene has at rest, whose mean is shown again.

        Raises:
            As `render`; ValueError: the scene asks for a view whose false colours have no mean.
        """
        if not views.has_mean(scene):
            raise ValueError(f"post.view: {scene.post.view!r} has one ray a pixel; its colours have no mean")
        self._mean.begin((scene, time, size))
        inputs = FrameInputs.whole(self.exposure.of(diagnostics.prepared(make_plan(scene))), time, size)
        if self._mean.count < scene.rays.at_rest:
            self._add_to_the_mean(inputs)
        self._post.draw(inputs, self._mean.texture, target or self._own_picture(size).frame, (0, 0, *size))
        if self._mean.count == scene.rays.at_rest:
            self._sample_map.release()
        return self._mean.count

    def _add_to_the_mean(self, inputs: FrameInputs) -> None:
        one = replace(inputs, offset=supersampling.place(self._mean.count))
        media = coarse_transfer.of(one, moving=False, passes=False)
        rest = coarse_transfer.rest_of(one, media)
        first = self._mean.count == 0
        if first:
            self._trace(rest)
            self._views.fit(inputs.plan.scene, self.hit_map)
        else:
            self._sample_map.trace(rest)
        radiance = self._shaded(rest, self.hit_map if first else self._sample_map, media)
        if not diagnostics.is_on(inputs.plan.scene):
            self.edges.draw(replace(rest, offset=inputs.offset), self.hit_map, radiance, media=media and replace(media, inputs=inputs))
        self._mean.add(_radiance_of(radiance).astype(np.float32))

    def time_trace(self, plan: Plan, size: tuple[int, int], *, progressive: bool = False) -> float:
        """Seconds by the wall clock that one trace by `plan` at `size` takes, programs compiled before."""
        inputs = FrameInputs.whole(plan, 0.0, size)
        self.programs.get("trace.frag", inputs)
        self.hit_map.forget()
        self.ctx.finish()
        start = clock.perf_counter()
        self._trace(inputs, progressive=progressive)
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
        for share in self.still(scene, time, size, samples):
            if progress is not None:
                progress(share)

    def still(self, scene: Scene, time: float, size: tuple[int, int], samples: int = 1, tile: int = TILE) -> Iterator[float]:
        """Draws what `render_still` does, one ray a pixel of one tile at a time; yields the share done after each. The picture is there at the end.

        Args:
            tile: side of the tiles in pixels; even.

        Raises:
            As `render`.
        """
        return self._gathered([(scene, time)], size, samples, tile)

    def render_mean(self, moments: Sequence[tuple[Scene, float]], size: tuple[int, int], samples: int = 1) -> None:
        """Draws the mean light of several (scene, time), exposed as the middle one, as `render_still` draws one.

        Raises:
            As `render`.
        """
        for _ in self._gathered(moments, size, samples, TILE):
            pass

    def bands(
        self, moments: Sequence[tuple[Scene, float]], size: tuple[int, int], samples: int = 1, tile: int = TILE
    ) -> Iterator[tuple[float, np.ndarray | None]]:
        """Draws as `render_mean` does, but keeps no picture: yields the share done, after each tile and with rows that are finished, uint8
        (rows, width, 3) from the top down, or None. What it takes of memory does not grow with the picture's height.

        Raises:
            As `render`.
        """
        return self._stills.bands(self._still_plans(moments, size, samples), size, samples, tile, self._lights(moments, size, samples))

    def still_radiance(self, scene: Scene, time: float, size: tuple[int, int], samples: int = 1) -> np.ndarray:
        """Scene-referred radiance of what `render_still` draws, float32 (height, width, 3), top row first.

        Raises:
            As `render`.
        """
        moments = [(scene, time)]
        return self._stills.light(self._still_plans(moments, size, samples), size, samples, self._lights(moments, size, samples))

    def tiles(
        self, moments: Sequence[tuple[Scene, float]], size: tuple[int, int], samples: int, side: int, wanted: Sequence[Tile], kind: Kind
    ) -> list[np.ndarray]:
        """The light of the tiles `wanted`, of `side` pixels, of what `bands` draws: what another renderer's `spread` asks of this one. Each is
        (height, width, 4) of the type `kind`, row 0 at the bottom.

        Raises:
            As `render`.
        """
        return self._stills.tiles(self._still_plans(moments, size, samples), size, samples, side, wanted, kind)

    def _lights(self, moments: Sequence[tuple[Scene, float]], size: tuple[int, int], samples: int) -> Lights | None:
        return None if self.spread is None else partial(self.spread, moments, size, samples)

    def _gathered(self, moments: Sequence[tuple[Scene, float]], size: tuple[int, int], samples: int, tile: int) -> Iterator[float]:
        """Has the own picture drawn; yields the share done."""
        picture, done = np.empty((size[1], size[0], 3), np.uint8), 0
        for share, rows in self.bands(moments, size, samples, tile):
            if rows is None:
                yield share
            else:
                picture[done : done + len(rows)] = rows
                done += len(rows)
        self._still = picture

    def _still_plans(self, moments: Sequence[tuple[Scene, float]], size: tuple[int, int], samples: int) -> list[tuple[Plan, float]]:
        projection.refuse_size(moments[0][0].camera, size)
        plans = [(self._still_plan(scene, samples), time) for scene, time in moments]
        self._fit_view(plans[-1][0], size)
        return plans

    def _still_plan(self, scene: Scene, samples: int) -> Plan:
        made = make_plan(_with_fewer_edge_rays(scene, -(-scene.rays.edges // samples)))
        return self.exposure.of(diagnostics.prepared(made), at_once=True)

    def _tile(self, inputs: FrameInputs) -> Target:
        """The radiance of a part of a still."""
        media = coarse_transfer.of(inputs, moving=False, passes=False)
        rest = coarse_transfer.rest_of(inputs, media)
        self._trace(rest)
        return self._shaded_with_edges(rest, media)

    def trace_listed(self, scene: Scene, directions: np.ndarray) -> tuple[HitArrays, np.ndarray, Plan]:
        """Listed local directions (N, 3) (`observer.local_directions`) through the shader that pictures use, wherever the camera looks.

        Returns:
            Their hits; the exact g of each kept crossing, float32 (N, 3), 0 where there is none; the plan used.
        """
        self.ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        return listed.trace(self.hit_map, scene, directions)

    def read_rgb8(self) -> np.ndarray:
        """The own picture as uint8 (height, width, 3), top row first.

        Raises:
            RuntimeError: none has been drawn.
        """
        if self._still is not None:
            return self._still
        picture = _drawn(self._picture)
        width, height = picture.size
        pixels = np.empty((height, width, 3), np.uint8)
        picture.frame.read_into(pixels, components=3, alignment=1)
        return pixels[::-1]

    def radiance(self) -> np.ndarray:
        """Scene-referred radiance of the last frame as float32 (height, width, 3), top row first.

        Raises:
            RuntimeError: none has been drawn.
        """
        return _radiance_of(_drawn(self._radiance))[::-1, :, :3].astype(np.float32)

    def fates_and_steps(self) -> tuple[np.ndarray, np.ndarray]:
        """What became of the rays of the last frame, and the steps they took, each as int (height, width); the hit map has to be sharp."""
        return self.hit_map.fates_and_steps()

    def hits(self) -> HitArrays:
        """The hit map of the last frame that was not filtered from light kept by direction."""
        return self.hit_map.read()

    def view_of(self, scene: Scene) -> views.View | None:
        """The diagnostic view that `scene` asks for, with the scale of the last frame; None for the picture itself."""
        return self._views.view_of(scene)

    def release(self) -> None:
        """Gives the GL objects back."""
        self.hit_map.release()
        self.reference_map.release()
        self._sample_map.release()
        self._mean.release()
        self.edges.release()
        self._views.release()
        self.exposure.release()
        self._shade.release()
        self._post.release()
        self._stars.release()
        self._turning.release()
        for tables in (self._tables, self._reference_tables, self._temperatures):
            tables.release()
        for target in (self._radiance, self._picture):
            if target is not None:
                target.release()
        self.programs.release()
        self._stills.release()
        self._radiance = self._picture = self._still = None

    def _trace(self, inputs: FrameInputs, *, progressive: bool = False) -> bool:
        self.ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        traced_reference = False
        if inputs.plan.scene.post.view == "difference":
            traced_reference = self.reference_map.trace(inputs.with_plan(diagnostics.most_accurate(inputs.plan)))
        return self.hit_map.trace(inputs, progressive=progressive) or traced_reference

    def _kept_or_shaded(self, inputs: FrameInputs, media: MediaApart | None, motion: Motion) -> Target:
        """`_shaded_with_edges` of the own hit map, unless that is what the radiance holds."""
        made, compiled = self._light_key(inputs, media, motion), self.programs.compiled
        if self._radiance is None or made is None or made != self._radiance_key:
            self._shaded_with_edges(inputs, media, motion)
            self._radiance_key = made if self.programs.compiled == compiled else self._light_key(inputs, media, motion)
        return _drawn(self._radiance)

    def _light_key(self, inputs: FrameInputs, media: MediaApart | None, motion: Motion) -> tuple | None:
        if not (kept_light.stands(inputs.plan) and (media is None or kept_light.stands(media.inputs.plan))):
            return None
        files = self._tables.pictures.stamps(chosen(inputs.plan, "sky", "disk_layer", "ray_model"), inputs.plan.scene)
        own = self.hit_map.generation, self.hit_map.is_sharp, motion, self.programs.compiled, files
        return *own, kept_light.key(inputs), None if media is None else (kept_light.key(media.inputs), media.step)

    def _shaded(self, inputs: FrameInputs, hit_map: HitMap, media: MediaApart | None = None) -> Target:
        """The radiance that the hits of `hit_map` have in the scene, with `media` that are marched apart."""
        self._radiance_key = None
        self.shadings += 1
        if self._radiance is None or self._radiance.size != inputs.size:
            self._radiance = self._fresh(self._radiance, inputs.size, 4, "f2")
        if diagnostics.is_on(inputs.plan.scene):
            self._views.draw(inputs, hit_map, self.reference_map, self._radiance.frame)
        else:
            self._shade.draw(inputs, hit_map, self._radiance.frame, media)
        return self._radiance

    def _shaded_with_edges(self, inputs: FrameInputs, media: MediaApart | None = None, motion: Motion = Motion.NOTHING) -> Target:
        """The same of the own hit map, with several rays in the pixels at edges."""
        if diagnostics.is_on(inputs.plan.scene):
            return self._shaded(inputs, self.hit_map, media)
        radiance = self._shaded(inputs, self.hit_map, media)
        self.edges.draw(inputs, self.hit_map, radiance, motion=motion, media=media)
        return radiance

    def _fit_view(self, plan: Plan, size: tuple[int, int]) -> None:
        """Has tiles of a picture of `size` drawn by one scale, that of the whole, found on a picture no larger than a tile."""
        if plan.scene.post.view == "steps":
            share = min(1.0, TILE / math.sqrt(size[0] * size[1]))
            inputs = FrameInputs.whole(plan, 0.0, (max(round(share * size[0]), 1), max(round(share * size[1]), 1)))
            self._trace(inputs)
            self._views.fit(plan.scene, self.hit_map)

    def _own_picture(self, size: tuple[int, int]) -> Target:
        self._still = None
        if self._picture is None or self._picture.size != size:
            self._picture = self._fresh(self._picture, size, 4, "f1")
        return self._picture

    def _fresh(self, old: Target | None, size: tuple[int, int], components: int, dtype: str) -> Target:
        if old is not None:
            old.release()
        return Target.of(self.ctx, [self.ctx.texture(size, components, dtype=dtype)])

    def _report(self, took_ms: tuple[float, float, float], traced: bool, plan: Plan, *, sharp: bool, telling: bool) -> FrameReport:
        made, exposure = self.hit_map, self.exposure
        marched, self._marched = self._marched, self.hit_map.marched + self.edges.marched + self._turning.marched
        told = plan.method, plan.reasons, plan.warnings, exposure.stops, exposure.settled
        return FrameReport(*took_ms, traced, self._marched - marched, sharp, made.sharpened or telling, *told)

    def _stamp(self, stamps: list[float], measure: bool) -> None:
        if measure:
            self.ctx.finish()
        stamps.append(clock.perf_counter())


def _with_fewer_edge_rays(scene: Scene, most: int) -> Scene:
    """`scene` with at most so many rays along each axis of a pixel at edges: for pictures that are summed up."""
    return scene if scene.rays.edges <= most else scene.with_values({"rays.edges": most})


def _drawn(target: Target | None) -> Target:
    if target is None:
        raise RuntimeError("no picture has been drawn yet: `render` comes first")
    return target


def _radiance_of(target: Target) -> np.ndarray:
    """float16 (height, width, 4), row 0 at the bottom. Waits for the GPU."""
    width, height = target.size
    return np.frombuffer(target.texture.read(), np.float16).reshape(height, width, 4)
