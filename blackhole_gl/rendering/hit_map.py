"""The trace pass and what it leaves: where every pixel's light comes from. Kept while nothing it depends on has changed.

On the GPU hits are in the plan's frame, as a rule that of the camera's meridian: a camera that turns about the axis then keeps its map. Whoever reads it
turns it to the world.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import count

import moderngl
import numpy as np

from ..physics.observer import cos_sin_deg
from ..planning import REACH_STEP, REFINE_STEP, Plan
from ..shapes import Bool
from . import half_grid, hit_texels, reach, refinement
from .boxes import Box
from .classes import NO_THINGS, OPEN_THINGS, OWN_RAYS, Where, seeking_nothing
from .draw import Draw
from .frame_met import NOTHING_MET, FrameMet
from .hit_texels import HitArrays
from .inputs import FrameInputs
from .instance_numbers import Number
from .programs import Programs
from .ray_blocks import FreshBlocks, RayBlocks
from .squares import Patches, Squares
from .tables import Tables
from .target import Target
from .things_grid import ThingsGrid

# Slices that a refined map is sharpened in, one a frame.
_SLICES = 12

_GENERATIONS = count(1)

KNOWN: Mapping[str, int] = {"BALLS_KNOWN": 1}
"""The switch of the program whose rays know which balls they may meet."""

AS_SHARP: Mapping[str, int] = {"HIT_MAP_REFINED": 0}
"""The switches of what reads pixels alone that have rays of their own, in maps that are not sharp, too: no cells are looked up."""

# Share of a picture beyond which changed squares are not worth their own draw.
_MOST_CHANGED = 0.5


class HitMap:
    """The targets of the trace pass.

    Args:
        tables: what rays are traced with; they stay their owner's.

    Attributes:
        textures: RGBA32F, one to three by the number of crossings kept; their layout is shaders/common/hit_map_write.glsl.
        traces: how many times rays have been traced, for tests and the overlay.
        generation: of what the map holds: a number that no other trace of this process has had.
        known: of a refined map that the last `trace` has made, which things its cells may show; None of other maps, or where that is not known.
        sharpened: whether the last `trace` only made a slice of the kept map exact.
        marched: how many rays have been traced for pixels of maps.
        parts: the squares that a map which is traced in parts holds; None where it holds all.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, tables: Tables):
        self._ctx, self._programs, self.tables = ctx, programs, tables
        self.textures: list[moderngl.Texture] = []
        self.traces = 0
        self.generation = 0
        self.sharpened = False
        self.marched = 0
        self.parts: Squares | None = None
        self._pool: list[moderngl.Texture] = []
        self._targets: dict[int, moderngl.Framebuffer] = {}
        self._key: tuple | None = None  # of all but the things and media, which have a key of their own
        self._met: FrameMet = NOTHING_MET
        self.known: reach.Reached | None = None
        self._reach = reach.Reach(ctx, programs, tables)
        self._changed: tuple[int, Squares] | None = None
        self._grid = refinement.CoarseGrid(ctx, programs)
        self._things = ThingsGrid(ctx, programs)
        self._half = half_grid.HalfGrid(ctx, programs)
        self._halved = False  # whether the last refined map has interpolated pixels of its own
        self._fills = False  # whether one thing may fill cells of it
        self._last: FrameInputs | None = None
        self._refined_for: tuple | None = None  # what a map that is not sharp depends on beside its key
        self._sharp_rows = 0
        self._pixels: RayBlocks | None = None  # blocks of a ray each
        self._blocks: RayBlocks | None = None  # of which the map's rays are, if they are not those

    def trace(self, inputs: FrameInputs, *, progressive: bool = False) -> bool:
        """Traces `inputs` unless the map holds just that already.

        Args:
            progressive: hits that are new may be interpolated between exact rays where the plan allows it; each further call for the same
                ones then traces a slice of the map exactly, until it `is_sharp`.

        Returns:
            Whether rays were traced.
        """
        plan = inputs.plan
        rays = self._programs.get("trace.frag", inputs)
        self._blocks = None
        key = _key_of(inputs, rays)
        refined = progressive and plan.refine_px > 0.0
        held = key == self._key and (not refined or self.is_sharp or self._refined_for == _refined_for(inputs))
        stands = held and (refined or self.is_sharp)
        before, self._met = self._met, FrameMet.of(inputs)
        self.known = None
        changed = self._squares_changed(inputs, before) if stands else None
        held = held and changed is not None and self.parts is None
        self.sharpened = refined and held and not self.is_sharp
        self._last, self.parts = inputs, None
        if held and self.is_sharp and not changed:
            return False
        self._bind_tables(rays)
        target = self._make_targets(inputs.size, hit_texels.textures(plan.orders, plan.meetings, plan.times))
        generation, was_sharp = self.generation, self.is_sharp
        if changed:
            self._trace_squares(rays, target, changed)
        if not refined and not (held and self.is_sharp):
            self._trace_rows(rays, target, 0, inputs.size[1])
        elif self.sharpened:
            self._sharpen(rays, target)
        elif not held:
            self._trace_refined(rays)
        self._key = key
        self.traces += 1
        self.generation = next(_GENERATIONS)
        self._changed = (generation, changed) if changed and was_sharp else None
        return True

    def prepare(self, inputs: FrameInputs) -> bool:
        """Makes one of the textures that `extend` needs, as all of them take a frame's time; whether all are there."""
        count = hit_texels.textures(inputs.plan.orders, 0, inputs.plan.times)
        if len(self._pool) < count:
            self._pool.append(self._texture(inputs.size))
            made = self._ctx.framebuffer([self._pool[-1]])
            made.clear()
            made.release()
        return len(self._pool) == count

    def extend(self, inputs: FrameInputs, squares: Squares, parts: Squares) -> None:
        """Traces `squares` more than the map holds of a picture of the size of `inputs`, in whatever ring; what it does not hold yet is unresolved.
        For pictures without things, and maps that have never been traced in another way.

        Args:
            parts: what it holds then.
        """
        while not self.prepare(inputs):
            pass
        rays, generation, stands = self._programs.get("trace.frag", inputs), self.generation, self.parts is not None
        self._blocks, self._last, self._refined_for, self._key = None, inputs, None, None
        self._bind_tables(rays)
        target = self._make_targets(inputs.size, hit_texels.textures(inputs.plan.orders, 0, inputs.plan.times))
        self._trace_squares(rays, target, squares)
        self._changed = (generation, squares) if stands else None
        self.parts, self.generation = parts, next(_GENERATIONS)
        self.traces += 1

    def changed_since(self, generation: int) -> Squares | None:
        """The squares of a sharp map that alone differ from what it was at that `generation`; None where all of it may."""
        return self._changed[1] if self._changed is not None and self._changed[0] == generation else None

    def _squares_changed(self, inputs: FrameInputs, before: FrameMet) -> Squares | None:
        """What may show the things and media that are other than those `before`; None where that may be most of the picture."""
        now = self._met
        if now.kinds != before.kinds:
            return None
        moved = [k for k, (old, new) in enumerate(zip(before.key, now.key)) if old != new]
        size = inputs.size
        if not moved:
            return Squares.of(np.empty((0, 2), int), REFINE_STEP, size)
        if not inputs.plan.reach_steps or min(size) < REACH_STEP:
            return None
        found = self._reach.squares(inputs, np.concatenate([before.balls[moved], now.balls[moved]]))
        return found if len(found) * REFINE_STEP**2 < _MOST_CHANGED * size[0] * size[1] else None

    def trace_blocks(self, inputs: FrameInputs, blocks: RayBlocks, fresh: FreshBlocks, known: reach.Reached | None = None) -> None:
        """Traces the rays of `blocks`, of the picture of `inputs`, that are `fresh`; `known` is what its cells may show, where that has been told."""
        inputs = inputs.drawn_as(blocks.size)
        self._last, self._blocks, self._refined_for, self.known = inputs, blocks, None, known
        target = self._make_targets(inputs.size, hit_texels.textures(inputs.plan.orders, inputs.plan.meetings, inputs.plan.times))
        seeking = {} if known is None else KNOWN
        if fresh.whole:
            self._trace_rows(self._prepared(seeking), target, 0, inputs.size[1])
        elif fresh.changed is None:
            target.clear()
        for switches, squares in ((seeking, fresh.seeking), (seeking_nothing(inputs.plan), fresh.others)):
            if any(map(len, squares)):
                self._trace_squares(self._prepared(switches), target, *squares)
        self._changed = None if fresh.changed is None else (self.generation, fresh.changed)
        self._key, self.generation = None, next(_GENERATIONS)
        self.traces += 1

    def _prepared(self, switches: Mapping[str, int]) -> Draw:
        """What traces the map's rays."""
        rays = self._programs.get("trace.frag", self._traced, switches)
        self._bind_tables(rays)
        return rays

    def _bind_tables(self, rays: Draw) -> None:
        """Gives the trace pass what it looks up: tables of the ray model, the things and media that rays may meet, and which pixels the rays are of."""
        plan = rays.inputs.plan
        things = self.tables.of_instances(rays.inputs) if plan.meetings else {}
        if self.known is not None:
            things = {**things, **self.known.samplers}
        self.tables.bind(rays, {**things, **self._ray_blocks.samplers})
        if rays.takes("stray_seen"):
            rays.set(stray_seen=refinement.tolerances(rays.inputs)[0])
        rays.tell(meeting_reach=plan.reach)
        self.tell_blocks(rays)

    @property
    def _ray_blocks(self) -> RayBlocks:
        if self._blocks is not None:
            return self._blocks
        if self._pixels is None:
            self._pixels = RayBlocks.side_by_side(self._ctx)
        return self._pixels

    @property
    def _traced(self) -> FrameInputs:
        if self._last is None:
            raise RuntimeError("the hit map holds nothing yet: `trace` comes first")
        return self._last

    @property
    def is_sharp(self) -> bool:
        """Whether every pixel has a ray of its own."""
        return self._refined_for is None

    def own_rays(self) -> np.ndarray:
        """Which pixels have a ray of their own, bool (height, width): all of a sharp map. Waits for the GPU."""
        width, height = self.textures[0].size
        if self.is_sharp:
            return np.ones((height, width), bool)
        found = self._grid.own_rays()
        if self._halved:
            found[self._sharp_rows :] &= ~self._half.interpolated()[self._sharp_rows :]
        return found

    @property
    def classes(self) -> moderngl.Texture | None:
        """Depth by what each pixel needs (shaders/refine_classes.frag), for a map that is not sharp; None for a sharp one."""
        return None if self.is_sharp else self._grid.classes

    def bands(self, where: Where) -> Sequence[Box]:
        """Parts of a map that is not sharp which hold all of its pixels that are `where`."""
        return self._grid.bands(where)

    def pieces(self, where: Where) -> Sequence[Box] | Patches:
        """The same, less what `see` has told to need nothing there; no pixel lies in two pieces."""
        return self._grid.pieces(where)

    def see(self, box: Box, seen: Mapping[Where, Bool[np.ndarray, "rows columns"]]) -> None:
        """Takes what the rays of a map that is not sharp have told of its cells in a `box`: in which of those that are `where` anything needs what is drawn
        there, until the next `trace`."""
        self._grid.see(box, seen)

    def samplers(self) -> dict[str, moderngl.Texture]:
        """The textures that common/hit_map_read.glsl reads, by name."""
        plan = self._traced.plan
        found = dict(zip(hit_texels.names(plan.orders, plan.meetings, plan.times), self.textures))
        refined = {} if self.is_sharp else self._grid.samplers()
        filled = self._things.samplers() if self._fills and not self.is_sharp else {}
        return {**found, **self._ray_blocks.samplers, **refined, **filled}

    def tell_blocks(self, draw: Draw) -> None:
        """Has a program that draws with `samplers` know which pixels the map's rays are of."""
        self._ray_blocks.tell(draw)

    def switches(self) -> Mapping[str, int]:
        """The switches that shaders which read the map are to be composed with."""
        return AS_SHARP if self.is_sharp else {"HIT_MAP_REFINED": 1, **(refinement.FILLED if self._fills else {})}

    def switches_where_flat(self) -> Mapping[str, int] | None:
        """The same for directions in flat cells alone (shaders/refine_classes.frag), for which less is read; None where there are none."""
        return None if self.is_sharp else {"HIT_MAP_REFINED": 2}

    def switches_where_filled(self) -> Mapping[str, int] | None:
        """The same for pixels of cells that one thing fills; None where none does."""
        return None if self.is_sharp or not self._fills else {"HIT_MAP_REFINED": 3, **refinement.FILLED}

    @property
    def filled(self) -> Patches:
        """Just those cells."""
        return self._grid.filled

    def _trace_rows(self, rays: Draw, target: moderngl.Framebuffer, first: int, end: int) -> None:
        """Exact rays for the rows `first` ≤ y < `end`; the map is sharp after the last."""
        width, height = target.size
        target.use()
        target.scissor = 0, first, width, end - first
        rays.set(ray_grid=(1.0, 0.0, 0.0))
        rays.draw()
        self.marched += width * (end - first)
        target.scissor = None  # type: ignore[assignment]  # moderngl's stubs lack what they say in words: None is the whole
        if end == height:
            self._refined_for, self._sharp_rows = None, 0

    def _trace_squares(self, rays: Draw, target: moderngl.Framebuffer, *squares: Squares) -> None:
        """Exact rays for `squares`; the rest of the map stays as it is."""
        target.use()
        rays.set(ray_grid=(1.0, 0.0, 0.0))
        rays.draw_squares(*squares)
        self.marched += sum(len(some) * some.side**2 for some in squares)
        if not self.is_sharp:
            for some in squares:
                self._grid.give_things(rays.inputs, some, self._sharp_rows)

    def _trace_refined(self, rays: Draw) -> None:
        inputs = rays.inputs
        if inputs.plan.meetings:
            reached = self._reach.draw(inputs, self._met.balls, self._met.numbers, self._met.fills)
            filled = None
            if reached.known and inputs.plan.meetings == 1:
                self.known = reached
                rays = self._programs.get("trace.frag", inputs, KNOWN)
            if reached.fills and inputs.plan.meetings == 1:
                self._bind_tables(rays)
                filled = self._things.trace(rays, reached)
            coarse = self._programs.get("trace.frag", inputs.in_motion, NO_THINGS)
            self._bind_tables(coarse)
            self._grid.trace(coarse, reached.cells, filled)
            self._fills = filled is not None
            self._trace_own_rays(coarse, rays)
        else:
            self._fills = False
            coarse = self._programs.get("trace.frag", inputs.in_motion)
            self._bind_tables(coarse)
            self._grid.trace(coarse, None)
            self._trace_own_rays(coarse, None)
        self._refined_for, self._sharp_rows = _refined_for(inputs), 0
        self.marched += self._grid.marched + (self._half.marched if self._halved else self._grid.left)

    def _trace_own_rays(self, rays: Draw, seeking: Draw | None) -> None:
        """Rays for the pixels that the coarse grid leaves, `seeking` for those that may show things: at every second pixel where that will do."""
        plan = rays.inputs.plan
        drawn = [(rays, OWN_RAYS, self.textures[: hit_texels.textures(plan.orders)], half_grid.WITHOUT_THINGS)]
        drawn += [] if seeking is None else [(seeking, OPEN_THINGS, self.textures, half_grid.WITH_THINGS)]
        self._halved = self._halves(rays.inputs)
        if self._halved:
            for draw, _, _, where in drawn:
                self._bind_tables(draw)
                self._half.trace(draw, where)
            # Where not each ball is one thing's there is no bit for each, and rays at every second pixel are for cells alone that show none.
            narrow = 0 if self.known is None else half_grid.narrow_balls(rays.inputs, self._met.balls, self._met.bodies)
            self._half.judge(rays.inputs, self._grid.cells, self._grid.cell_classes, self.known, narrow)
            self._half.fill(rays.inputs, self.textures)
        for draw, where, textures, _ in drawn:
            if self._halved and draw is seeking:
                self._blocks = self._half.pack()
                if self._blocks is not None:
                    self._bind_tables(draw)
                    self._half.trace_packed(draw, textures)
                self._blocks = None
                continue
            self._bind_tables(draw)
            (self._half if self._halved else self._grid).trace_own_rays(draw, textures, where)

    def _halves(self, inputs: FrameInputs) -> bool:
        """Whether there are parts of the picture of `inputs` for which rays at every second pixel will do, which are then chosen.

        Crossings of the disk's plane are not interpolated so, nor are cells beside a hole's shadow that no thing is seen in: they are few.
        """
        plan = inputs.plan
        if plan.orders or plan.meetings > 1 or plan.times:
            return False
        own, things = self._grid.cells_that_are(OWN_RAYS), self._grid.cells_that_are(OPEN_THINGS)
        return self._half.choose(inputs, len(self.textures), own & plan.model.traits.field, things & (self.known is not None))

    def _sharpen(self, rays: Draw, target: moderngl.Framebuffer) -> None:
        height = target.size[1]
        rows = -(-height // (_SLICES * REFINE_STEP)) * REFINE_STEP
        first, end = self._sharp_rows, min(self._sharp_rows + rows, height)
        self._sharp_rows = end
        self._grid.give_own_rays(rays.inputs, first, end)
        self._trace_rows(rays, target, first, end)

    def forget(self) -> None:
        """The next `trace` traces, whatever is kept."""
        self._key = None

    def trace_listed(self, plan: Plan, directions: np.ndarray) -> HitArrays:
        """Hits of listed local directions (N, 3), in the observer's tetrad wherever the camera looks, instead of pixels."""
        texture = self._listed(directions)
        width, height = texture.size
        self._last = FrameInputs.whole(plan, 0.0, (width, height))
        rays = self._programs.get("trace.frag", self._last, {"RAYS_LISTED": 1})
        rays.set(listed_rays=0)
        texture.use(0)
        self._bind_tables(rays)
        self._key, self.generation = None, next(_GENERATIONS)
        self._make_targets((width, height), hit_texels.textures(plan.orders, plan.meetings, plan.times))
        momenta = [self._ctx.texture((width, height), 4, dtype="f4") for _ in range(hit_texels.momenta_textures(plan.meetings))]
        target = self._ctx.framebuffer([*self.textures, *momenta])
        target.use()
        rays.draw()
        self._refined_for = None
        found = self.read()
        found = replace(found, momentum=hit_texels.momenta([_texels(kept) for kept in momenta], found.crossing))
        target.release()
        for kept in (texture, *momenta):
            kept.release()
        return found.each(lambda values: values.reshape(-1, *values.shape[2:])[: len(directions)])

    def _listed(self, directions: np.ndarray) -> moderngl.Texture:
        number = len(directions)
        # Whole blocks of 4 × 4: software renderers run those whole, and a texel that is not there would be a ray without a direction.
        width = min(-(-number // 4) * 4, 1024)
        height = -(-number // (4 * width)) * 4
        listed = np.zeros((height * width, 4), np.float32)
        listed[:, 0] = -1.0
        listed[:number, :3] = directions
        return self._ctx.texture((width, height), 4, listed.tobytes(), dtype="f4")

    def emission_shifts(self, directions: np.ndarray) -> np.ndarray:
        """Exact g of the kept crossings of the listed `directions` (N, 3) that were traced last, float32 (N, 3), 0 where there is none."""
        listed = self._listed(directions)
        probe = self._programs.get("probe.frag", self._traced)
        probe.sample({**self.samplers(), "listed_rays": listed})
        target = Target.of(self._ctx, [self._ctx.texture(listed.size, 4, dtype="f4")])
        target.frame.use()
        probe.draw()
        values = _texels(target.texture)[..., :3]
        target.release()
        listed.release()
        return values.reshape(-1, 3)[: len(directions)]

    def read(self) -> HitArrays:
        """The map as arrays of shape (height, width, …), as its readers see it."""
        plan = self._traced.plan
        stored = [_texels(texture) for texture in self.textures] if self.is_sharp else self._resolved()
        found = hit_texels.unpacked(stored, plan.orders, plan.meetings, plan.times)
        return replace(found, direction=self._in_world(found.direction), crossing=self._in_world(found.crossing))

    def at(self, pixel: tuple[int, int]) -> tuple[FrameInputs, HitArrays] | None:
        """What the map was traced for, and the hits of `pixel` (x, y) from the bottom left, alone, so that little is brought to the host; None where there is
        no such pixel with a ray of its own. Waits for the GPU.

        Without a map, or where it is not sharp, there is none.
        """
        if self._last is None or not self.textures or not self.is_sharp:
            return None
        width, height = self.textures[0].size
        if not (0 <= pixel[0] < width and 0 <= pixel[1] < height):
            return None
        plan, target = self._last.plan, self._targets[len(self.textures)]
        texels = [np.frombuffer(target.read((*pixel, 1, 1), 4, attachment=k, dtype="f4"), np.float32).reshape(1, 4) for k in range(len(self.textures))]
        found = hit_texels.unpacked(texels, plan.orders, plan.meetings, plan.times)
        found = replace(found, direction=self._in_world(found.direction), crossing=self._in_world(found.crossing))
        return self._last, found.each(lambda values: values.reshape(values.shape[1:]))

    def where_met(self, number: Number) -> np.ndarray:
        """The pixels whose rays meet the instance of that number, bool (height, width), of a sharp map. Waits for the GPU."""
        plan = self._traced.plan
        places = self.textures[hit_texels.textures(plan.orders) : hit_texels.textures(plan.orders, plan.meetings) : 2]
        found = np.zeros(self.textures[0].size[::-1], bool)
        for texture in places:
            met = hit_texels.met_of(_texels(texture))
            found |= (met[..., 0] == number[0]) & (met[..., 1] == number[1])
        return found

    def fates_and_steps(self) -> tuple[np.ndarray, np.ndarray]:
        """Of a sharp map, as int (height, width): a third of what `read` brings to the host, and none of its arithmetic."""
        return hit_texels.fates_and_steps(_texels(self.textures[0]))

    def _resolved(self) -> list[np.ndarray]:
        resolve = self._programs.get("refine_resolve.frag", self._traced, self.switches())
        resolve.sample(self.samplers())
        target = Target.of(self._ctx, [self._ctx.texture(texture.size, 4, dtype="f4") for texture in self.textures])
        target.frame.use()
        resolve.draw()
        found = [_texels(texture) for texture in target.textures]
        target.release()
        return found

    def _in_world(self, vectors: np.ndarray) -> np.ndarray:
        """Vectors (…, 2 or 3) turned from the plan's frame to the world, as float32."""
        c, s = cos_sin_deg(self._traced.plan.turn_deg)
        x, y = vectors[..., 0].astype(float), vectors[..., 1].astype(float)
        return np.concatenate([np.stack([c * x - s * y, s * x + c * y], axis=-1), vectors[..., 2:]], axis=-1).astype(np.float32)

    def _make_targets(self, size: tuple[int, int], count: int) -> moderngl.Framebuffer:
        """Draws into the first `count` textures. Textures once made are kept while the size stays, so that a disk switched off and on allocates nothing."""
        if self._pool and self._pool[0].size != size:
            self._release_targets()
        while len(self._pool) < count:
            self._pool.append(self._texture(size))
        self.textures = self._pool[:count]
        if count not in self._targets:
            self._targets[count] = self._ctx.framebuffer(self.textures)
        return self._targets[count]

    def _texture(self, size: tuple[int, int]) -> moderngl.Texture:
        texture = self._ctx.texture(size, 4, dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        texture.repeat_x = texture.repeat_y = False
        return texture

    def release(self) -> None:
        """Gives the GL objects back."""
        self._grid.release()
        self._things.release()
        self._half.release()
        self._reach.release()
        self._release_targets()
        if self._pixels is not None:
            self._pixels.shifts.release()
            self._pixels = None

    def _release_targets(self) -> None:
        for item in (*self._targets.values(), *self._pool):
            item.release()
        self._targets, self._pool, self.textures, self._key = {}, [], [], None


def _texels(texture: moderngl.Texture) -> np.ndarray:
    """The texels (height, width, 4) of an RGBA32F texture. Waits for the GPU."""
    return np.frombuffer(texture.read(), np.float32).reshape(texture.height, texture.width, 4)


def _key_of(inputs: FrameInputs, rays: Draw) -> tuple:
    """What bends rays and where they are looked at from: hits that have the same key, and the same things on their way, are the same."""
    scene = inputs.plan.scene
    parameters = tuple(sorted((key, value) for key, value in scene.parameters.items() if key.startswith("rays.")))
    return rays.serial, inputs.ray_bytes, scene.hole, parameters, inputs.size, inputs.plan.orders


def _refined_for(inputs: FrameInputs) -> tuple:
    """What a refined map depends on beside its key: how well it interpolates, and where the disk's edges are."""
    return refinement.tolerances(inputs), inputs.plan.disk_edge, inputs.plan.disk_outer
