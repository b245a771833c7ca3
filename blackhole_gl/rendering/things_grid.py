"""A moving camera's things: coarse rays that meet them, and which cells between these one thing fills: readers of the map interpolate what their pixels meet.

A cell that a ball alone can show, as it hides the rest (`reach.Reach`), needs no rays of its own where the rays about it all meet that ball, and where it bends
little enough.
"""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

from ..planning import GRID_MARGIN, REFINE_STEP
from . import hit_texels
from .classes import Where, drawn
from .draw import Draw
from .inputs import FrameInputs
from .programs import Programs
from .reach import Reached
from .target import Target, plain_texture

_MARKED = Where(">", 0.5)  # by shaders/refine_marks.frag

BEYOND_FILLED = Where("<", 0.125)
"""The nodes, by the same, whose rays tell of cells that may show no thing."""


@dataclass(frozen=True, eq=False)
class Filled:
    """Which cells of a picture one thing fills.

    Attributes:
        solid: R8, 1 for the lower left node of each.
        marked: depth of the nodes, as shaders/refine_marks.frag writes it.
    """

    solid: moderngl.Texture
    marked: moderngl.Texture


@dataclass(frozen=True, eq=False)
class _Made:
    """All that pictures of one size and number of targets take.

    Attributes:
        made_for: that size and number.
        rays: the coarse rays' hits.
        bends: second differences between the places that they meet things at, along x and along y.
        solid: of the cell right and above of each node, R8: 1 where it is filled.
        marks: draws the nodes' depth, by which rays, bends and solid are drawn where a cell may be filled.
    """

    made_for: tuple[tuple[int, int], int]
    rays: Target
    bends: Target
    solid: Target
    depth: moderngl.Texture
    marks: moderngl.Framebuffer

    def release(self) -> None:
        for item in (self.rays, self.bends, self.solid, self.marks, self.depth):
            item.release()


class ThingsGrid:
    """Draws shaders/refine_marks.frag, refine_things.frag and refine_bends.frag."""

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._made: _Made | None = None

    def trace(self, rays: Draw, reached: Reached) -> Filled:
        """Of the picture of the trace pass `rays`, which meets things; `reached` says what cells may show."""
        inputs = rays.inputs
        made = self._targets(inputs.size, hit_texels.textures(inputs.plan.orders, inputs.plan.meetings, inputs.plan.times))
        first = -GRID_MARGIN * REFINE_STEP
        rays.set(ray_grid=(REFINE_STEP, first, first))
        made.solid.frame.clear()  # and the depth
        self._mark(inputs, made, reached)
        self._draw_marked(rays, made.rays)
        cells = self._programs.get("refine_things.frag", inputs)
        cells.sample({"things_met": self._met, "reached": reached.cells, "reach_balls": reached.balls})
        cells.set(refine_px=inputs.plan.refine_px)
        self._draw_marked(cells, made.solid)
        bends = self._programs.get("refine_bends.frag", inputs)
        bends.sample({"things_met": self._met})
        self._draw_marked(bends, made.bends)
        return Filled(made.solid.texture, made.depth)

    def _mark(self, inputs: FrameInputs, made: _Made, reached: Reached) -> None:
        marks = self._programs.get("refine_marks.frag", inputs)
        marks.sample({"reached": reached.cells})
        made.marks.use()
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "1"  # always
        marks.draw()
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"

    def _draw_marked(self, draw: Draw, target: Target) -> None:
        target.frame.use()
        target.frame.depth_mask = False
        with drawn(self._ctx, draw, _MARKED):
            draw.draw()

    def samplers(self) -> dict[str, moderngl.Texture]:
        """What common/hit_map_read.glsl interpolates for the cells that the last `trace` has told of, by name."""
        made = self._there
        return {"things_met": self._met, "things_way": made.rays.textures[-1], "bend_x": made.bends.textures[0], "bend_y": made.bends.textures[1]}

    def release(self) -> None:
        """Gives the GL objects back."""
        if self._made is not None:
            self._made.release()
        self._made = None

    @property
    def _there(self) -> _Made:
        if self._made is None:
            raise RuntimeError("no coarse grid of things has been traced yet: `trace` comes first")
        return self._made

    @property
    def _met(self) -> moderngl.Texture:
        return self._there.rays.textures[-2]

    def _targets(self, size: tuple[int, int], count: int) -> _Made:
        if self._made is None or self._made.made_for != (size, count):
            self.release()
            self._made = self._make(size, count)
        return self._made

    def _make(self, size: tuple[int, int], count: int) -> _Made:
        cells = -(-size[0] // REFINE_STEP), -(-size[1] // REFINE_STEP)
        nodes = cells[0] + 1 + 2 * GRID_MARGIN, cells[1] + 1 + 2 * GRID_MARGIN
        depth = self._ctx.depth_texture(nodes)
        return _Made(
            (size, count),
            rays=Target.of(self._ctx, [plain_texture(self._ctx, nodes, 4, "f4", moderngl.LINEAR) for _ in range(count)], depth),
            bends=Target.of(self._ctx, [plain_texture(self._ctx, nodes, 4, "f4", moderngl.LINEAR) for _ in range(2)], depth),
            solid=Target.of(self._ctx, [plain_texture(self._ctx, nodes, 1, "f1", moderngl.LINEAR)], depth),
            depth=depth,
            marks=self._ctx.framebuffer([], depth),
        )
