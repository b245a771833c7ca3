"""A moving camera's rays where the coarse grid is too coarse: rays at every second pixel, and those between interpolated where they bend little enough.

It is for cells whose pixels would all have rays of their own, where many of these lie together: whatever is interpolated is written into the map as if traced.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from ..glsl.declared import PixelClass
from ..physics.observer import cos_sin_deg
from ..planning import HALF_MARGIN, HALF_STEP, REFINE_STEP
from ..shapes import Bool, Float, Int
from .boxes import Box, bands_of, few_of
from .classes import MATTER, OPEN_THINGS, OWN_RAYS, Where, drawn
from .draw import Draw
from .inputs import FrameInputs
from .packed_rays import PackedRays
from .programs import Programs
from .ray_blocks import RayBlocks
from .reach import Reached
from .refinement import tolerances
from .target import Elsewhere, Target, plain_texture

# Of a cell and the eight about it so many have to be traced: along lines, such as outlines of things, rays of their own are cheaper.
_TOGETHER = 4

# And so many times as many cells, those about them too, have such rays at most: along the outlines of a few balls it is twice as many and more, in what a
# field crowds together, or a mesh shows, 1.1 to 1.6 times.
_MOST_RAYS = 1.7

# Things that are seen as wide as that straight on, in pixels, are told by rays two pixels apart.
_WIDE_PX = 16.0

# What stands in the texture of chosen cells, of 255.
_CLEAR, _NOT_CLEAR = 128, 255

# Of its cells, those along a side of one of the coarse grid's.
_ALONG = REFINE_STEP // HALF_STEP

# Rows of these cells whose pixels are drawn at a time.
_BAND = 32

# Depth of rays that are not asked for (shaders/refine_half_marks.frag).
_UNASKED = 0.5

WITHOUT_THINGS, WITH_THINGS = Where("<", 0.75), Where(">", 0.25)
"""The rays by shaders/refine_half_marks.frag."""


@dataclass(frozen=True, eq=False)
class _Made:
    """All that pictures of one size and number of targets take.

    Attributes:
        made_for: that size and number.
        chosen: of the coarse grid's cells, R8, for shaders/refine_half_marks.frag.
        rays: their hits, with a depth by which they are drawn.
        without_things: draws into the first of those textures alone.
        marks: draws that depth.
        ends: what refine_half_ends.frag makes of them; None without things.
        cells: of 2×2 pixels, R8, as shaders/refine_half_cells.frag leaves them.
        classes: depth of the picture's size, by these.
        sorted: draws into `classes`.
        packed: rays of the pixels that are left and may show things.
    """

    made_for: tuple[tuple[int, int], int]
    chosen: moderngl.Texture
    rays: Target
    without_things: moderngl.Framebuffer
    depth: moderngl.Texture
    marks: moderngl.Framebuffer
    ends: Target | None
    cells: Target
    classes: moderngl.Texture
    sorted: moderngl.Framebuffer
    packed: PackedRays

    def release(self) -> None:
        for item in (self.chosen, self.rays, self.without_things, self.marks, self.depth, self.ends, self.cells, self.sorted, self.classes, self.packed):
            if item is not None:
                item.release()


class HalfGrid:
    """Draws shaders/refine_half_*.frag.

    Attributes:
        cells: depth by what the 2×2 pixels of each cell still needed when `judge` was called last: of `MATTER` they were interpolated.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._kept: _Made | None = None
        self._elsewhere = Elsewhere(ctx)
        self._into: dict[int, moderngl.Framebuffer] = {}  # by the number of targets
        self.cells = np.empty((0, 0), np.float32)
        self._held: dict[Where, np.ndarray] = {}  # which of them are
        self._rays = 0  # of the last picture
        self._chosen = np.empty((0, 0), bool)  # of the coarse grid's cells
        self._with_nodes = np.empty((0, 0), bool)  # those of them that may show things
        self._ray_boxes: list[Box] = []  # hold all rays

    def choose(self, inputs: FrameInputs, count: int, own: Bool[np.ndarray, "rows columns"], things: Bool[np.ndarray, "rows columns"]) -> bool:
        """Marks the rays for those of the coarse grid's cells that lie together; whether there are any, and these rays spare more than they are. Where programs
        are to be foreseen any cells will do.

        Args:
            count: targets of the trace pass.
            own, things: which cells have rays of their own that meet no things, and that may.
        """
        foresees = self._programs.foresees
        if foresees:
            for name in ("marks", "cells", "fill", *(("ends", "put") if inputs.plan.meetings else ())):
                self._programs.get(f"refine_half_{name}.frag", inputs)
        left = own | things
        together = left if foresees else left & (_about(left) >= _TOGETHER)
        about = _about(together) > 0
        with_rays, asked = np.count_nonzero(about), np.count_nonzero(together)
        if not asked or not foresees and with_rays > _MOST_RAYS * asked:
            return False
        made = self._targets(inputs.size, count)
        chosen = np.where(together & things, _NOT_CLEAR, np.where(together, _CLEAR, 0)).astype(np.uint8)
        made.chosen.write(chosen.tobytes(), alignment=1)
        self._rays, self._chosen, self._with_nodes = int(with_rays) * _ALONG**2, together, together & things
        made.rays.frame.clear()
        marks = self._programs.get("refine_half_marks.frag", inputs)
        marks.sample({"chosen": made.chosen})
        self._ray_boxes = list(_nodes_in(about, made.depth.size))
        made.marks.clear(depth=_UNASKED)
        self._write_depth(made.marks, marks, self._ray_boxes)
        return True

    def trace(self, rays: Draw, where: Where) -> None:
        """Traces the marked rays that are `where`; those that meet no things by the trace pass for these."""
        made = self._made
        first = -HALF_MARGIN * HALF_STEP
        rays.set(ray_grid=(HALF_STEP, first, first))
        frame = made.rays.frame if where is WITH_THINGS else made.without_things
        frame.use()
        frame.depth_mask = False
        with drawn(self._ctx, rays, where):
            rays.draw()

    def judge(
        self, inputs: FrameInputs, held: Float[np.ndarray, "rows columns"], cell_classes: moderngl.Texture, reached: Reached | None, narrow: int
    ) -> None:
        """Tells which pixels are interpolated, and sorts all that had rays of their own by what they still need.

        Args:
            held, cell_classes: depth by what the pixels of each of the coarse grid's cells need, here and in R8.
            reached: what these may show; None in a scene without things.
            narrow: a bit for each of its balls that may be seen narrower than two pixels (`narrow_balls`).
        """
        made = self._made
        if made.ends is not None:
            ends = self._programs.get("refine_half_ends.frag", inputs)
            ends.sample(self._hits)
            made.ends.frame.clear()
            made.ends.frame.use()
            ends.draw_boxes(self._ray_boxes)
        cells = self._programs.get("refine_half_cells.frag", inputs)
        self._ends.filter = moderngl.NEAREST, moderngl.NEAREST
        cells.sample({"chosen": made.chosen, "cell_classes": cell_classes, **self._hits, **({} if reached is None else {"cell_balls": reached.cell_balls})})
        cells.set(refine_tolerance=tolerances(inputs), refine_px=inputs.plan.refine_px)
        cells.tell(narrow_balls=narrow)
        texture = made.cells.texture
        left = np.where(OWN_RAYS.holds(held) | OPEN_THINGS.holds(held), held, PixelClass.NEITHER.depth)
        texture.write(_parted(np.rint(255.0 * left).astype(np.uint8))[: texture.height, : texture.width].tobytes(), alignment=1)
        made.cells.frame.use()
        cells.draw_boxes(few_of(bands_of(self._chosen, texture.size, _ALONG, _BAND // _ALONG)))
        self.cells = np.frombuffer(texture.read(alignment=1), np.uint8).reshape(texture.height, texture.width) * np.float32(1.0 / 255.0)
        self._held = {}
        sort = self._programs.get("refine_classes.frag", inputs)
        sort.sample({"cell_classes": texture})
        sort.set(pixels_to_cells=tuple(1.0 / (HALF_STEP * side) for side in texture.size), all_traced=0.0)
        made.sorted.clear(depth=PixelClass.NEITHER.depth)
        asked = np.abs(self.cells - PixelClass.NEITHER.depth) > 0.05
        self._write_depth(made.sorted, sort, few_of(bands_of(asked, inputs.size, HALF_STEP, _BAND)))

    def fill(self, inputs: FrameInputs, textures: Sequence[moderngl.Texture]) -> None:
        """Writes what is interpolated into `textures`, of the picture's size."""
        fill = self._programs.get("refine_half_fill.frag", inputs)
        fill.sample({**self._hits, "half_cells": self._made.cells.texture})
        self._ends.filter = moderngl.LINEAR, moderngl.LINEAR
        self.trace_own_rays(fill, textures, MATTER)

    def trace_own_rays(self, rays: Draw, textures: Sequence[moderngl.Texture], where: Where) -> None:
        """Draws those pixels that are `where` into `textures`, of the picture's size: `OWN_RAYS` are those left to trace that show no things."""
        into = self._into.get(len(textures))
        if into is None or into.color_attachments != tuple(textures) or into.depth_attachment is not self._made.classes:
            if into is not None:
                into.release()
            into = self._into[len(textures)] = self._ctx.framebuffer(textures, self._made.classes)
        into.use()
        into.depth_mask = False
        rays.tell(ray_grid=(1.0, 0.0, 0.0))
        with drawn(self._ctx, rays, where):
            rays.draw_boxes(few_of(bands_of(self._that_are(where), self._made.classes.size, HALF_STEP, _BAND)))

    def pack(self) -> RayBlocks | None:
        """The rays that are left to pixels which may show things, side by side; None where there are none."""
        self._elsewhere.begin()  # what is drawn already: to pack takes the host a while
        nodes = _parted(self._with_nodes)[: self.cells.shape[0], : self.cells.shape[1]]
        return self._made.packed.blocks if self._made.packed.choose(self._that_are(OPEN_THINGS), nodes) else None

    def trace_packed(self, rays: Draw, textures: Sequence[moderngl.Texture]) -> None:
        """Traces those, and puts what they meet into `textures`, of the picture's size; `rays` are of the blocks that `pack` has told."""
        packed = self._made.packed
        packed.trace(rays)
        put = self._programs.get("refine_half_put.frag", rays.inputs)
        put.sample({**self._hits, "numbers": packed.numbers, **dict(zip(("packed0", "packed_met", "packed_way"), packed.textures))})
        self.trace_own_rays(put, textures, OPEN_THINGS)

    @property
    def marched(self) -> int:
        """Rays of the last picture, a few too many, and of its pixels that these did not spare."""
        return self._rays + sum(int(np.count_nonzero(self._that_are(where))) for where in (OWN_RAYS, OPEN_THINGS)) * HALF_STEP**2

    def interpolated(self) -> Bool[np.ndarray, "height width"]:
        """Which pixels of the last picture are, row 0 at the bottom."""
        width, height = self._made.classes.size
        filled = self._that_are(MATTER) & ~self._that_are(OWN_RAYS)
        return np.kron(filled, np.ones((HALF_STEP, HALF_STEP), bool))[:height, :width]

    def release(self) -> None:
        """Gives the GL objects back."""
        for into in self._into.values():
            into.release()
        if self._kept is not None:
            self._kept.release()
        self._elsewhere.release()
        self._into, self._kept = {}, None

    def _that_are(self, where: Where) -> Bool[np.ndarray, "rows columns"]:
        """Which of `cells` are."""
        if where not in self._held:
            self._held[where] = where.holds(self.cells)
        return self._held[where]

    @property
    def _made(self) -> _Made:
        if self._kept is None:
            raise RuntimeError("no rays have been chosen yet: `choose` comes first")
        return self._kept

    @property
    def _hits(self) -> Mapping[str, moderngl.Texture]:
        textures = self._made.rays.textures
        return {"half0": textures[0], **dict(zip(("half_met", "half_way"), textures[1:])), "half_ends": self._ends}

    @property
    def _ends(self) -> moderngl.Texture:
        """Where rays end: without things their hits."""
        ends = self._made.ends
        return self._made.rays.texture if ends is None else ends.texture

    def _write_depth(self, into: moderngl.Framebuffer, draw: Draw, boxes: Iterable[Box]) -> None:
        into.use()
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "1"  # always
        draw.draw_boxes(boxes)
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"

    def _targets(self, size: tuple[int, int], count: int) -> _Made:
        if self._kept is None or self._kept.made_for != (size, count):
            self.release()
            self._kept = self._make(size, count)
        return self._kept

    def _make(self, size: tuple[int, int], count: int) -> _Made:
        coarse = -(-size[0] // REFINE_STEP), -(-size[1] // REFINE_STEP)
        cells = -(-size[0] // HALF_STEP), -(-size[1] // HALF_STEP)
        nodes = cells[0] + 3 * HALF_MARGIN, cells[1] + 3 * HALF_MARGIN
        depth, classes = self._ctx.depth_texture(nodes), self._ctx.depth_texture(size)
        # Of those with things the last is filtered, and of what is made of them the ends, as of rays without.
        filters = [moderngl.NEAREST] * (count - 1) + [moderngl.LINEAR]
        rays = Target.of(self._ctx, [plain_texture(self._ctx, nodes, 4, "f4", filtered) for filtered in filters], depth)
        return _Made(
            (size, count),
            chosen=plain_texture(self._ctx, coarse, 1, "f1"),
            rays=rays,
            without_things=self._ctx.framebuffer(rays.textures[:1], depth),
            depth=depth,
            marks=self._ctx.framebuffer([], depth),
            ends=Target.of(self._ctx, [plain_texture(self._ctx, nodes, 4, "f4", moderngl.LINEAR)]) if count > 1 else None,
            cells=Target.of(self._ctx, [plain_texture(self._ctx, cells, 1, "f1")]),
            classes=classes,
            sorted=self._ctx.framebuffer([], classes),
            packed=PackedRays(self._ctx, cells, count),
        )


def narrow_balls(inputs: FrameInputs, balls: Float[np.ndarray, "balls 4"], bodies: Bool[np.ndarray, " balls"]) -> int:
    """A bit for each of the balls of `reach.Reached` that may be seen narrower than two pixels, as it is far away, or as what lies in it is no body."""
    camera = inputs.plan.scene.camera
    seen = balls[:, 3] > 0.0
    pixel = math.radians(camera.fov_deg) / inputs.size[1]
    (c, s), (cos_azimuth, sin_azimuth) = cos_sin_deg(camera.inclination_deg), cos_sin_deg(inputs.plan.azimuth_deg)
    distances = np.linalg.norm(balls[seen, :3] - camera.distance * np.array([s * cos_azimuth, s * sin_azimuth, c]), axis=1)
    wide = bodies[seen] & (balls[seen, 3] > 0.5 * _WIDE_PX * pixel * distances)
    return int(np.sum(1 << np.flatnonzero(~wide)))


def _parted(cells: np.ndarray) -> np.ndarray:
    """The same values of the smaller cells that each of the coarse grid's `cells` (rows, columns) is made of."""
    return cells.repeat(_ALONG, axis=1).repeat(_ALONG, axis=0)


def _nodes_in(cells: Bool[np.ndarray, "rows columns"], size: tuple[int, int]) -> Iterator[Box]:
    """Parts of the texture of rays, of that `size`, that hold all those in the coarse grid's `cells`."""
    rows, columns = cells.shape
    whole = _ALONG * columns, _ALONG * rows
    for x, y, width, height in few_of(bands_of(cells, whole, _ALONG, _BAND // _ALONG)):
        left, low = (place + HALF_MARGIN if place else 0 for place in (x, y))
        right, high = (end + HALF_MARGIN if end < most else full for end, most, full in ((x + width, whole[0], size[0]), (y + height, whole[1], size[1])))
        yield left, low, right - left, high - low


def _about(cells: Bool[np.ndarray, "rows columns"]) -> Int[np.ndarray, "rows columns"]:
    """Of each cell, how many of it and the eight about it are among `cells`."""
    rows, columns = cells.shape
    padded = np.zeros((rows + 2, columns + 2), np.uint8)
    padded[1:-1, 1:-1] = cells
    across = padded[:, :-2] + padded[:, 1:-1] + padded[:, 2:]
    return across[:-2] + across[1:-1] + across[2:]
