"""The light of media at a resolution of its own: marched on a coarse grid of rays, and joined between those that went through the same."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import moderngl
import numpy as np

from ..planning import plan as make_plan
from ..scene import FrozenMap
from .boxes import Box
from .classes import EVERYWHERE, Where, drawn
from .coarse_targets import BETWEEN, OWN, CoarseTargets, named
from .draw import Draw, Samplers
from .hit_map import HitMap
from .inputs import FrameInputs
from .kept_samples import MOST_SAMPLES, KeptSamples, can_keep
from .programs import Programs
from .ray_lists import RayList
from .target import Target
from .transfer import changes, stretches

MOVING, TURNING = 3, 2
"""Pixels from ray to ray under a moving camera, and before one at rest while a pattern moves."""

LONGER = 2.0
"""Steps in media that are marched coarse in every frame, over those that the scene asks for."""

FINE, FINE_IN_MOTION = 1e-3, 0.05
"""How exactly surfaces of media are found, of the length on which a medium changes."""

LAGS = 0.25
"""Scene time in r_s/c by which a part of a moving pattern may stay behind the rest: a brush of light moves by less than a pixel in it."""

MOST_BENT = 0.6
"""How much light may bend from ray to ray of a grid, against how bright it is there, for that between them to be joined. A pattern bends everywhere, and is
blurred to what the grid has of it."""

_A_FRAME = 30_000  # rays of a grid that are marched between two pictures for one to come


@dataclass(frozen=True)
class MediaApart:
    """How the media of a frame are drawn whose rays are marched from the camera, apart from all else, which knows of no media.

    Attributes:
        inputs: the frame, with its media.
        step: pixels from ray to ray; 1: each has its own.
        footprint: pixels that what a ray sees is a mean of.
        fine: how exactly surfaces are found, of a medium's scale.
        exact: whether they are drawn as exactly as the rest, for pictures that stay.
        rests: whether the next picture is by the same rays, of a sharp map, so that samples along them are worth telling.
        passes: whether the next picture is another moment of the same, so that the grid and what lies at edges may take turns.
        apart: whether those are rays of blocks, beside which others lie than in a picture: nothing is joined between them.
    """

    inputs: FrameInputs
    step: int
    footprint: float
    fine: float
    passes: bool
    exact: bool = False
    rests: bool = False
    apart: bool = False

    def in_blocks(self, size: tuple[int, int], side: int) -> MediaApart:
        """Of the same picture's rays in blocks of `side`², drawn into `size` pixels: each has its own, or under a moving camera four of sixteen share one."""
        return replace(self, inputs=self.inputs.drawn_as(size), step=1 if self.exact or self.passes or side < 4 else 2, apart=True)


def of(inputs: FrameInputs, *, moving: bool, passes: bool) -> MediaApart | None:
    """How media are drawn under a `moving` camera, in a picture that `passes` with its moment, or in one that stays; None: with all else.

    Things are met in order with them, a field has to be gone into, and parallel rays come from nowhere, but in Mino time.
    """
    plan = inputs.plan
    begins = plan.scene.camera.distance < math.inf or plan.model.traits.marches_in == "mino"
    apart = plan.scene.media and not plan.scene.things and begins and not plan.model.traits.field and plan.scene.rays.refine
    if not apart or plan.scene.post.view != "picture":
        return None
    if not (moving or passes and changes(plan)):
        return MediaApart(inputs, 1, 1.0, FINE, passes=False, exact=True)
    rays = plan.scene.rays
    longer = 1.0 if can_keep(plan) and not moving else LONGER
    coarser = inputs.with_plan(replace(plan, scene=plan.scene.with_values({"rays.medium_step": min(longer * rays.medium_step, max(rays.medium_step, 1.0))})))
    step = MOVING if moving else TURNING
    return MediaApart(coarser, step, float(step), FINE_IN_MOTION if moving else FINE, passes=passes, rests=not moving)


def rest_of(inputs: FrameInputs, media: MediaApart | None) -> FrameInputs:
    """The same frame without its media, in which nothing but the disk can be met; itself where there are no `media` apart from the rest."""
    return inputs if media is None else inputs.with_plan(make_plan(replace(inputs.plan.scene, media=FrozenMap())))


class CoarseTransfer:
    """Draws shaders/transfer.frag for a grid of rays, and what lies between them by shaders/transfer_cells.frag, transfer_marks.frag and transfer_join.frag.

    Attributes:
        marches: how many times it has drawn, for tests.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self.marches = 0
        self._made: CoarseTargets | None = None
        self._coming: _Coming | None = None
        self._last: _Last | None = None
        self._marked: tuple | None = None

    @property
    def tells(self) -> bool:
        """Whether samples are being told, and are not all there yet."""
        return self._made is not None and self._made.samples.begun and not self._made.is_told

    def draw(self, media: MediaApart, hit_map: HitMap, samplers: Samplers) -> None:
        """Fills the textures for all pixels of `hit_map`, unless they hold just that; `samplers` are what rays look things up in."""
        inputs, asked = media.inputs, self._asked(media, hit_map, samplers)
        if self._programs.foresees:
            self.ask_for(media, hit_map)
        self._take_coming(asked)
        made = self._targets(inputs.size, stretches(inputs.plan), media.step, apart=media.apart)
        begins = self._last is None or self._last.rays != asked.rays
        if begins:
            made.forget()
        grid, own = self._due(asked.rays, inputs.time if changes(inputs.plan) else 0.0, media.passes)
        if grid:
            self._draw_grid(asked, made)
        if own and made.own.count:
            self._draw_own(asked, made)
        if media.rests and can_keep(inputs.plan):
            tell, _ = self._telling(asked), self._summing(asked)  # asked for at once: what is missing is to be missed before the scene is shown
            if not begins and not made.is_told:
                self._tell(tell, asked, made)

    def prepare(self, media: MediaApart, hit_map: HitMap, samplers: Samplers) -> bool:
        """Marches some of the rays whose samples the next picture of the same view sums, while the last one's media are shown. Returns whether all is told."""
        if not (media.rests and can_keep(media.inputs.plan)):
            return True
        asked = self._asked(media, hit_map, samplers)
        if self._coming is None or self._coming.rays != asked.rays:
            if self._coming is not None:
                self._coming.made.release()
            self._coming = _Coming(asked.rays, CoarseTargets(self._ctx, media.inputs.size, stretches(media.inputs.plan), media.step, apart=media.apart))
        coming, made = self._coming, self._coming.made
        if coming.rows < made.grid.size[1]:
            first, coming.rows = coming.rows, min(coming.rows + max(_A_FRAME // made.grid.size[0], 1), made.grid.size[1])
            self._march(asked, made.grid.frame, (float(media.step), media.footprint), made.own, (first, coming.rows))
            if coming.rows == made.grid.size[1]:
                self._mark(asked, made)
        elif not made.is_told:
            self._tell(self._telling(asked), asked, made)
        return coming.rows == made.grid.size[1] and made.is_told

    def ask_for(self, media: MediaApart, hit_map: HitMap) -> None:
        """Has every program compiled that pictures of `media`, which are not drawn yet, will take."""
        asked = self._asked(media, hit_map, {})
        self._programs.get("transfer_cells.frag", media.inputs)
        self._programs.get("transfer_marks.frag", media.inputs, hit_map.switches())
        self._programs.get("transfer_join.frag", media.inputs)
        self._programs.get("transfer_join.frag", media.inputs, {"LISTED": 1})
        if media.rests and can_keep(media.inputs.plan):
            self._telling(asked)
            self._summing(asked)

    def _take_coming(self, asked: _Asked) -> None:
        """Goes on with what was prepared, if that is what is `asked` for, and leaves it where another picture at rest is."""
        coming = self._coming
        if coming is None or not asked.media.rests:
            return
        self._coming = None
        if coming.rays != asked.rays or not coming.made.is_told:
            coming.made.release()
            return
        if self._made is not None:
            self._made.release()
        self._made, self._marked, self._last = coming.made, asked.rays, _Last(asked.rays, -np.inf, -np.inf)

    def _asked(self, media: MediaApart, hit_map: HitMap, samplers: Samplers) -> _Asked:
        march = self._programs.get("transfer.frag", media.inputs, {**hit_map.switches(), "GRID": 1, "FROM_CAMERA": 1})
        blocks = hit_map.generation if media.apart else 0  # of which pixels they are
        return _Asked(media, hit_map, samplers, march, (replace(media.inputs, time=0.0), blocks, march.serial, media.step))

    def _draw_grid(self, asked: _Asked, made: CoarseTargets) -> None:
        """The grid, and what lies between its rays; the whole picture where each of its pixels has one."""
        if made.samples.is_whole:
            self._sum(asked, made, made.samples, made.grid, EVERYWHERE)
        else:
            self._march(asked, made.grid.frame, (float(asked.media.step), asked.media.footprint), made.own)
        if asked.media.apart:
            if asked.media.step > 1:
                self._join(asked.media, made, EVERYWHERE)
            return
        if asked.rays != self._marked:
            self._mark(asked, made)
            self._marked = asked.rays
        self._join(asked.media, made, BETWEEN)

    def _draw_own(self, asked: _Asked, made: CoarseTargets) -> None:
        """The rays beside the grid's."""
        if made.own_samples.is_whole:
            self._sum(asked, made, made.own_samples, made.whole, OWN)
            return
        listed = made.listed(self._ctx, made.own)
        self._march(asked, listed.frame, (-1.0, asked.media.footprint), made.own, (0, made.own.rows))
        self._spread(asked.media, made.own, listed, made.whole, OWN, made.bands.get(OWN))

    def _sum(self, asked: _Asked, made: CoarseTargets, samples: KeptSamples, target: Target, where: Where) -> None:
        """What `samples` show at the frame's time, into `target`."""
        self.marches += 1
        listed = made.listed(self._ctx, samples.list)
        draw = self._summing(asked)
        draw.sample({**asked.samplers, **samples.samplers})
        samples.sum(draw, listed.frame, asked.media.footprint)
        self._spread(asked.media, samples.list, listed, target, where, made.bands.get(where))

    def _summing(self, asked: _Asked) -> Draw:
        return self._programs.get("transfer_samples.frag", asked.media.inputs, {"MOST_SAMPLES": MOST_SAMPLES})

    def _telling(self, asked: _Asked) -> Draw:
        return self._programs.get("transfer.frag", asked.media.inputs, {**asked.hit_map.switches(), "GRID": 1, "SAMPLES": 1, "FROM_CAMERA": 1})

    def _tell(self, march: Draw, asked: _Asked, made: CoarseTargets) -> None:
        """Some more of the samples on rays that have stayed."""
        samples, pixels, step = made.untold()
        if not samples.begun:
            listed = pixels()
            if made.is_told:
                return
            samples.begin(listed)
        _prepare(march, asked)
        samples.march_on(march, asked.samplers, (-float(step), asked.media.footprint))

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

    def _march(
        self, asked: _Asked, frame: moderngl.Framebuffer, spacing: tuple[float, float], rays: RayList, rows: tuple[int, int] | None = None
    ) -> None:
        """Into all of `frame`, or from one row up to another; `spacing` as in shaders/transfer.frag."""
        self.marches += 1
        asked.march.sample({**asked.samplers, "ray_pixels": rays.pixels})
        _prepare(asked.march, asked)
        self._ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST)
        frame.use()
        asked.march.set(ray_spacing=spacing)
        self._ctx.scissor = None if rows is None else (0, rows[0], frame.width, rows[1] - rows[0])
        asked.march.draw()
        self._ctx.scissor = None

    @property
    def samplers(self) -> Mapping[str, moderngl.Texture]:
        """What shaders/common/stretches.glsl reads, by name."""
        return {} if self._made is None else named(self._made.whole)

    @property
    def shown(self) -> Sequence[Box] | None:
        """Parts of the picture, none over another, that hold all pixels in which media may be seen; None where that is not known."""
        return None if self._made is None else self._made.shown

    def release(self) -> None:
        """Gives the GL objects back."""
        if self._made is not None:
            self._made.release()
        if self._coming is not None:
            self._coming.made.release()
        self._made = self._coming = self._last = self._marked = None

    def _mark(self, asked: _Asked, made: CoarseTargets) -> None:
        cells = self._programs.get("transfer_cells.frag", asked.media.inputs)
        cells.sample(named(made.grid))
        cells.set(most_bent=math.inf if changes(asked.media.inputs.plan) else MOST_BENT)
        made.cells.frame.use()
        self._ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST)
        cells.draw()
        marks = self._programs.get("transfer_marks.frag", asked.media.inputs, asked.hit_map.switches())
        marks.sample({**asked.hit_map.samplers(), "media_cells": made.cells.texture})
        marks.set(pixel_to_cell=tuple(1.0 / (asked.media.step * side) for side in made.cells.size))
        made.marks.use()
        with drawn(self._ctx, marks, EVERYWHERE):
            marks.draw()
        depth = np.frombuffer(made.depth.read(), np.float32).reshape(made.depth.height, made.depth.width)
        made.clear()
        made.note(depth)

    def _join(self, media: MediaApart, made: CoarseTargets, where: Where) -> None:
        join = self._programs.get("transfer_join.frag", media.inputs)
        join.sample(named(made.grid))
        factors = [1.0 / (media.step * side) for side in made.grid.size]
        offsets = [0.0 if media.apart else 0.5 / side - 0.5 * factor for side, factor in zip(made.grid.size, factors)]
        join.set(pixels_to_grid=(*factors, *offsets))
        self._fill(join, made.whole, where, made.bands.get(where))

    def _spread(self, media: MediaApart, rays: RayList, listed: Target, target: Target, where: Where, bands: Sequence[Box] | None) -> None:
        """What the rays of a list show, into their own pixels of `target`."""
        spread = self._programs.get("transfer_join.frag", media.inputs, {"LISTED": 1})
        spread.sample({**named(listed), "places": rays.places})
        self._fill(spread, target, where, bands)

    def _fill(self, draw: Draw, target: Target, where: Where, bands: Sequence[Box] | None) -> None:
        """In `bands` alone, where they are known."""
        target.frame.use()
        target.frame.depth_mask = False
        with drawn(self._ctx, draw, where):
            if bands is None:
                draw.draw()
            else:
                draw.draw_boxes(bands)

    def _targets(self, size: tuple[int, int], count: int, step: int, *, apart: bool) -> CoarseTargets:
        if self._made is None or self._made.made_for != (size, count, step, apart):
            self.release()
            self._made = CoarseTargets(self._ctx, size, count, step, apart=apart)
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


@dataclass(eq=False)
class _Coming:
    """What is prepared for a picture to come: of which rays, and the rows of their grid that are marched."""

    rays: tuple
    made: CoarseTargets
    rows: int = 0


@dataclass(frozen=True, eq=False)
class _Asked:
    """What is to be drawn: media, the hits and tables that their rays are known by, the march, and a key of all rays."""

    media: MediaApart
    hit_map: HitMap
    samplers: Samplers
    march: Draw
    rays: tuple


def _prepare(march: Draw, asked: _Asked) -> None:
    march.set(meeting_reach=march.inputs.plan.reach, fine_share=asked.media.fine)
    asked.hit_map.tell_blocks(march)
