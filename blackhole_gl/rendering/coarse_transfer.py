"""The light of media at a resolution of its own: marched on a coarse grid of rays, and joined between those that went through the same."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import moderngl

from ..planning import Plan
from ..scene import FrozenMap, Scene
from .classes import EVERYWHERE, Where, drawn
from .hit_map import HitMap
from .inputs import FrameInputs
from .programs import Draw, Programs, Samplers
from .target import Target
from .transfer import changes, stretches

MOVING, TURNING = 3, 2
"""Pixels from ray to ray under a moving camera, and before one at rest while a pattern moves."""

LONGER = 1.5
"""Steps in media that are drawn coarse, over those that the scene asks for."""

LAGS = 0.25
"""Scene time in r_s/c by which a part of a moving pattern may stay behind the rest: a brush of light moves by less than a pixel in it."""

# By shaders/transfer_marks.frag.
_OWN, _BETWEEN = Where(">", 0.5), Where("<", 0.5)


@dataclass(frozen=True)
class CoarseMedia:
    """How the media of a frame are drawn that have a resolution of their own.

    Attributes:
        inputs: the frame, with its media.
        step: pixels from ray to ray; 1: each has its own.
        footprint: pixels that what a ray sees is a mean of.
        passes: whether the next picture is another moment of the same, so that the grid and what lies at edges may take turns.
    """

    inputs: FrameInputs
    step: int
    footprint: float
    passes: bool

    def drawn_as(self, size: tuple[int, int]) -> CoarseMedia:
        """Of the same picture's rays drawn into `size` pixels, which need not lie side by side: each has its own."""
        return replace(self, inputs=self.inputs.drawn_as(size), step=1)


def of(inputs: FrameInputs, *, moving: bool, passes: bool) -> CoarseMedia | None:
    """How media are drawn under a `moving` camera, or in a picture that `passes` with its moment; None: as exactly as the rest.

    Things are met in order with them, a field has to be gone into, and parallel rays come from nowhere: there media are drawn with all else.
    """
    plan = inputs.plan
    apart = plan.scene.media and not plan.scene.things and plan.scene.camera.distance < 1e6 and not plan.model.traits.field and plan.scene.rays.refine
    if not apart or plan.scene.post.view != "picture":
        return None
    if not (moving or passes and changes(plan)):
        return None
    rays = plan.scene.rays
    coarser = inputs.with_plan(replace(plan, scene=plan.scene.with_values({"rays.medium_step": min(LONGER * rays.medium_step, max(rays.medium_step, 1.0))})))
    return CoarseMedia(coarser, MOVING, float(MOVING), False) if moving else CoarseMedia(coarser, TURNING, 1.0, True)  # as sharp as it will be at rest


def rest_of(inputs: FrameInputs, plan_of: Callable[[Scene], Plan]) -> FrameInputs:
    """The same frame without its media, in which nothing but the disk can be met."""
    return inputs.with_plan(plan_of(replace(inputs.plan.scene, media=FrozenMap())))


class CoarseTransfer:
    """Draws shaders/transfer.frag for a grid of rays, and what lies between them by shaders/transfer_marks.frag and transfer_join.frag.

    Attributes:
        marches: how many times it has drawn, for tests.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self.marches = 0
        self._made: _Made | None = None
        self._last: _Last | None = None
        self._marked: tuple | None = None

    def draw(self, media: CoarseMedia, hit_map: HitMap, samplers: Samplers, *, apart: bool) -> None:
        """Fills the textures for all pixels of `hit_map`, which where they are `apart` knows of no media, unless they hold just that; `samplers` are what rays
        look things up in."""
        inputs, step = media.inputs, media.step
        march = self._programs.get("transfer.frag", inputs, {**hit_map.switches(), "GRID": 1, "FROM_CAMERA": int(apart)})
        rays = replace(inputs, time=0.0), hit_map.generation, march.serial, step
        made = self._targets(inputs.size, stretches(inputs.plan), step)
        grid, own = self._due(rays, inputs.time if changes(inputs.plan) else 0.0, media.passes)
        march.sample(samplers)
        march.set(meeting_reach=inputs.plan.reach)
        if "block_side" in march.program:
            march.set(block_side=float(hit_map.block_side))
        if step == 1:
            if own:
                self._march(march, made.whole, EVERYWHERE, 1, media.footprint)
            return
        if grid:
            self._march(march, made.grid, EVERYWHERE, step, media.footprint)
            if rays != self._marked:
                self._mark(media, hit_map, made)
                self._marked = rays
            self._join(media, made)
        if own:
            march.sample(samplers)
            self._march(march, made.whole, _OWN, 1, media.footprint)

    def _due(self, rays: tuple, time: float, passes: bool) -> tuple[bool, bool]:
        """Whether the grid, and the rays beside it, are to be marched for `rays` at scene time `time`: one of the two, where the other has just been."""
        last, self._last = self._last, _Last(rays, time, time)
        if last is None or last.rays != rays:
            return True, True
        late = abs(time - last.grid) > LAGS or abs(time - last.own) > LAGS or not passes
        grid = time != last.grid and (late or last.grid_is_older)
        own = time != last.own and (late or not last.grid_is_older)
        self._last = _Last(rays, time if grid else last.grid, time if own else last.own, grid_is_older=own if grid != own else last.grid_is_older)
        return grid, own

    def _march(self, march: Draw, target: Target, where: Where, spacing: int, footprint: float) -> None:
        self.marches += 1
        self._ctx.disable(moderngl.BLEND)
        target.frame.use()
        target.frame.depth_mask = False
        march.set(ray_spacing=(float(spacing), footprint))
        with drawn(self._ctx, march, where):
            march.draw()

    @property
    def samplers(self) -> Mapping[str, moderngl.Texture]:
        """What shaders/common/stretches.glsl reads, by name."""
        return {} if self._made is None else _named(self._made.whole)

    def release(self) -> None:
        """Gives the GL objects back."""
        if self._made is not None:
            self._made.release()
        self._made = self._last = self._marked = None

    def _mark(self, media: CoarseMedia, hit_map: HitMap, made: _Made) -> None:
        marks = self._programs.get("transfer_marks.frag", media.inputs, hit_map.switches())
        marks.sample({**hit_map.samplers(), "passed0": made.grid.textures[1]})
        marks.set(spacing=float(media.step))
        made.marks.use()
        with drawn(self._ctx, marks, EVERYWHERE):
            marks.draw()

    def _join(self, media: CoarseMedia, made: _Made) -> None:
        join = self._programs.get("transfer_join.frag", media.inputs)
        join.sample(_named(made.grid))
        factors = [1.0 / (media.step * side) for side in made.grid.size]
        join.set(pixels_to_grid=(*factors, *(0.5 / side - 0.5 * factor for side, factor in zip(made.grid.size, factors))))
        made.whole.frame.use()
        made.whole.frame.depth_mask = False
        with drawn(self._ctx, join, _BETWEEN):
            join.draw()

    def _targets(self, size: tuple[int, int], count: int, step: int) -> _Made:
        if self._made is None or self._made.made_for != (size, count, step):
            self.release()
            self._made = _Made.of(self._ctx, size, count, step)
        return self._made


@dataclass(frozen=True)
class _Last:
    """What was marched last.

    Attributes:
        rays: key of the rays.
        grid, own: scene time that the grid and the rays beside it are of.
        grid_is_older: whose turn it is.
    """

    rays: tuple
    grid: float
    own: float
    grid_is_older: bool = False


@dataclass(frozen=True, eq=False)
class _Made:
    """Textures, a pair for each stretch, of a picture's size and of the grid's.

    Attributes:
        made_for: the picture's size, the stretches, and the pixels from ray to ray.
        marks: draws into `depth`.
        depth: of `whole`: which pixels are marched by themselves.
    """

    made_for: tuple[tuple[int, int], int, int]
    whole: Target
    grid: Target
    marks: moderngl.Framebuffer
    depth: moderngl.Texture

    @classmethod
    def of(cls, ctx: moderngl.Context, size: tuple[int, int], count: int, step: int) -> _Made:
        depth = ctx.depth_texture(size)
        coarse = (1, 1) if step == 1 else tuple(-(-(side - 1) // step) + 1 for side in size)
        whole, grid = ([_texture(ctx, own) for _ in range(2 * count)] for own in (size, coarse))
        for texture in grid:
            texture.filter = moderngl.LINEAR, moderngl.LINEAR
        return cls((size, count, step), Target.of(ctx, whole, depth), Target.of(ctx, grid), ctx.framebuffer([], depth), depth)

    def release(self) -> None:
        for item in (self.whole, self.grid, self.marks, self.depth):
            item.release()


def _texture(ctx: moderngl.Context, size: tuple[int, ...]) -> moderngl.Texture:
    texture = ctx.texture((size[0], size[1]), 4, dtype="f4")
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    texture.repeat_x = texture.repeat_y = False
    return texture


def _named(target: Target) -> dict[str, moderngl.Texture]:
    return {f"{('gathered', 'passed')[place % 2]}{place // 2}": texture for place, texture in enumerate(target.textures)}

