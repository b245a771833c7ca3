"""A moving camera's rays: a coarse grid of exact ones, the cells between them judged, and the pixels of those that cannot be interpolated."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from ..glsl.declared import PixelClass
from ..planning import GRID_MARGIN, REFINE_STEP, Plan
from ..shapes import Bool
from .boxes import Box, bands_of, few_of
from .classes import FLAT_SKY, OPEN_THINGS, OWN_RAYS, THINGS, Where, drawn
from .draw import Draw
from .hit_texels import textures
from .inputs import FrameInputs
from .programs import Programs
from .squares import Patches, Squares
from .target import Target, plain_texture
from .things_grid import BEYOND_FILLED, Filled

FILLED = {"CELLS_FILLED": 1}
"""The switch of the program that knows of cells which one thing fills."""

# Crossings beyond the disk's edges by this ratio of radii do not matter: room for what lies between two nodes of the grid.
_BEYOND_DISK = 1.25

# Rows of cells whose pixels with rays of their own are drawn at a time: as high as the tiles of llvmpipe.
_BAND = 64 // REFINE_STEP

# Sides in pixels of the squares in which pixels of one kind are drawn: of things, which lie beyond flat sky, the depth test spares none of that, and of things'
# cells it does not know which show any; else it knows all. Of cells that one thing fills it knows none.
_SIDES = REFINE_STEP, 2 * REFINE_STEP, 8 * REFINE_STEP
_PATCHES = {FLAT_SKY: _SIDES[1:], THINGS: _SIDES, OPEN_THINGS: _SIDES}

# Share of the cells let pass by the depth test that need what is drawn in them up to which they are drawn in squares, which themselves take a twentieth more.
_WORTH_SQUARES = 0.85

# Textures of the nodes, and how many of them there are by the number of targets of the trace pass.
_NODES = (("coarse0", "f4"), ("bend0", "f2"), ("coarse1", "f4"), ("bend1", "f2"), ("bend2", "f2"))
_NODES_BY_TARGETS = {1: 2, 2: 4, 3: 5}


@dataclass(frozen=True, eq=False)
class _Made:
    """All that pictures of one size and number of targets are refined with; described in shaders/common/hit_cells.glsl and node_kinds.glsl.

    Attributes:
        made_for: that size and number.
        rays: the coarse rays' hits.
        nodes: kinds, then `node_textures` in their order.
        node_textures: by their names in shaders.
        cells: 16 bits for each, then their classes.
        sorted: draws into `classes`.
        classes: depth of the picture's size, as shaders/refine_classes.frag writes it.
    """

    made_for: tuple[tuple[int, int], int]
    rays: Target
    nodes: Target
    node_textures: dict[str, moderngl.Texture]
    cells: Target
    sorted: moderngl.Framebuffer
    classes: moderngl.Texture

    def release(self) -> None:
        for item in (self.rays, self.nodes, self.cells, self.sorted, self.classes):
            item.release()


class CoarseGrid:
    """The coarse rays, the nodes and cells made of them, and what each pixel needs."""

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._kept: _Made | None = None
        self._own: dict[int, moderngl.Framebuffer] = {}  # by the number of targets
        self._marked: moderngl.Framebuffer | None = None
        self._bands: dict[Where, Sequence[Box]] = {}  # that were asked for
        self._pieces: dict[Where, Sequence[Box] | Patches] = {}  # the same
        self._seen: dict[Where, np.ndarray] = {}
        self._solid = np.empty((0, 0), bool)  # cells that one thing fills
        self._filled: Patches | None = None  # the same, once asked for
        self._cells: np.ndarray | None = None  # depth by what the pixels of each cell need; None once it is not the same for all of a cell's

    @property
    def _made(self) -> _Made:
        if self._kept is None:
            raise RuntimeError("no coarse grid has been traced yet: `trace` comes first")
        return self._kept

    @property
    def marched(self) -> int:
        """Rays of the last `trace`."""
        columns, rows = self._made.rays.size
        return columns * rows

    @property
    def left(self) -> int:
        """Pixels of the last `trace` that cannot be interpolated."""
        return 0 if self._cells is None else int(np.count_nonzero(OWN_RAYS.holds(self._cells) | OPEN_THINGS.holds(self._cells))) * REFINE_STEP**2

    @property
    def classes(self) -> moderngl.Texture:
        """Depth of the picture's size by what each pixel of the last `trace` needs, as shaders/refine_classes.frag writes it."""
        return self._made.classes

    def trace(self, rays: Draw, reached: moderngl.Texture | None, filled: Filled | None = None) -> None:
        """Traces the grid for the picture of the trace pass `rays`, judges its cells and sorts the pixels into `classes`.

        Args:
            rays: end on nothing but the hole.
            reached: what each cell may show, as shaders/reach_cells.frag leaves it; None in a scene without things.
            filled: cells that one thing fills, which is written for their pixels; None where none is. Rays among these alone tell nothing, and are left out.
        """
        inputs = rays.inputs
        made = self._targets(inputs.size, textures(inputs.plan.orders))
        first = -GRID_MARGIN * REFINE_STEP
        rays.set(ray_grid=(REFINE_STEP, first, first))
        if filled is None:
            made.rays.frame.use()
            rays.draw()
        else:
            self._trace_marked(rays, made, filled)
        self._make_nodes(inputs, made)
        self._judge_cells(inputs, made, reached, filled)
        classes = made.cells.textures[1]
        self._bands, self._pieces, self._seen, self._filled = {}, {}, {}, None
        self._cells = np.frombuffer(classes.read(alignment=1), np.uint8).reshape(classes.height, classes.width) * np.float32(1.0 / 255.0)
        self._solid = np.abs(self._cells - PixelClass.SOLID_THING.depth) < 0.05
        self._sort_pixels(inputs, made, 0, inputs.size[1], all_traced=False)

    def trace_own_rays(self, rays: Draw, textures: Sequence[moderngl.Texture], where: Where) -> None:
        """Traces those of the pixels that cannot be interpolated into `textures`, of the picture's size."""
        own = self._own.get(len(textures))
        if own is None or own.color_attachments != tuple(textures):
            if own is not None:
                own.release()
            own = self._own[len(textures)] = self._ctx.framebuffer(textures, self.classes)
        own.use()
        own.depth_mask = False
        rays.set(ray_grid=(1.0, 0.0, 0.0))
        with drawn(self._ctx, rays, where):
            rays.draw_boxes(self.bands(where))

    def cells_that_are(self, where: Where) -> np.ndarray:
        """The cells whose pixels are `where`, bool (rows, columns): right after `trace`."""
        return where.holds(self.cells)

    @property
    def cells(self) -> np.ndarray:
        """Depth by what the pixels of each cell need, float32 (rows, columns): right after `trace`."""
        if self._cells is None:
            raise RuntimeError("what cells need is known right after `trace` alone")
        return self._cells

    @property
    def cell_classes(self) -> moderngl.Texture:
        """R8: depth by what the pixels of each cell need."""
        return self._made.cells.textures[1]

    def samplers(self) -> dict[str, moderngl.Texture]:
        """What common/hit_map_read.glsl reads, by name."""
        made = self._made
        return {"cells": made.cells.texture, **made.node_textures}

    def bands(self, where: Where) -> Sequence[Box]:
        """Parts of the picture that hold all of its pixels that are `where`; all of it once `give_own_rays` or `give_things` has changed some."""
        size = self.classes.size
        if self._cells is None:
            return [(0, 0, *size)]
        if where not in self._bands:
            self._bands[where] = few_of(bands_of(where.holds(self._cells), size, REFINE_STEP, _BAND))
        return self._bands[where]

    def pieces(self, where: Where) -> Sequence[Box] | Patches:
        """The same, as squares where boxes hold much that needs nothing, as `see` has told or as it is of another kind; no pixel lies in two pieces. Those of
        `THINGS` need not hold what `filled` does."""
        if self._cells is None or where not in _PATCHES:
            return self.bands(where)
        if where not in self._pieces:
            self._pieces[where] = self._picked(where, self._cells)
        return self._pieces[where]

    def _picked(self, where: Where, cells: np.ndarray) -> Sequence[Box] | Patches:
        held = where.holds(cells)
        if where == THINGS:
            held &= ~self._solid
        if where in self._seen:
            held &= self._seen[where]
        if np.count_nonzero(held) > _WORTH_SQUARES * np.count_nonzero(where.passed_by(cells)):
            return self.bands(where)
        return Patches.picked(held, REFINE_STEP, _PATCHES[where], self.classes.size)

    @property
    def filled(self) -> Patches:
        """Just those cells that one thing fills. Where there are none, one that shows no thing: what is drawn by the depth of `THINGS` leaves it alone, but its
        program is compiled to the end, which takes a draw (docs/llvmpipe.md)."""
        if self._filled is None:
            cells = self._solid
            if self._cells is not None and not cells.any():
                cells = np.zeros(cells.shape, bool)
                cells.flat[np.argmin(self._cells)] = np.min(self._cells) < PixelClass.FLAT_SKY.depth_beyond
            self._filled = Patches.picked(cells, REFINE_STEP, _SIDES, self.classes.size, exactly=True)
        return self._filled

    def see(self, box: Box, seen: Mapping[Where, Bool[np.ndarray, "rows columns"]]) -> None:
        """Takes what rays have told of the cells in a `box` of the picture: in which of those `where` the class says so anything needs what is drawn there."""
        if self._cells is None:
            return
        self._pieces = {}
        x, y, _, _ = (side // REFINE_STEP for side in box)
        for where, needed in seen.items():
            rows, columns = needed.shape
            self._seen[where] = np.ones(self._cells.shape, bool)
            self._seen[where][y : y + rows, x : x + columns] = needed

    def give_own_rays(self, inputs: FrameInputs, first: int, end: int) -> None:
        """Marks the cells of the picture's rows `first` ≤ y < `end` as traced pixel by pixel; `first` begins a row of cells."""
        made, self._cells = self._made, None
        cells = made.cells.texture
        rows = -(-end // REFINE_STEP) - first // REFINE_STEP
        cells.write(bytes(2 * cells.width * rows), (0, first // REFINE_STEP, cells.width, rows), alignment=1)
        self._solid[first // REFINE_STEP : first // REFINE_STEP + rows], self._filled = False, None
        self._sort_pixels(inputs, made, first, end, all_traced=True)

    def give_things(self, inputs: FrameInputs, squares: Squares, sharp_rows: int) -> None:
        """Marks `squares` as traced pixel by pixel and as ones that may show a thing; of the rows below `sharp_rows` every pixel is traced."""
        made, self._cells = self._made, None
        changed = squares.mask(inputs.size, REFINE_STEP)
        for texture, value in zip(made.cells.textures, (0, round(255.0 * PixelClass.THING.depth))):
            cells = np.frombuffer(texture.read(alignment=1), np.uint16 if value == 0 else np.uint8).reshape(texture.height, texture.width).copy()
            cells[changed] = value
            texture.write(cells.tobytes(), alignment=1)
        self._solid[changed], self._filled = False, None
        self._sort_pixels(inputs, made, 0, inputs.size[1], all_traced=False)
        if sharp_rows:
            self._sort_pixels(inputs, made, 0, sharp_rows, all_traced=True)

    def own_rays(self) -> np.ndarray:
        """Which pixels are traced themselves, bool (height, width), row 0 at the bottom; nodes of the grid left out. Waits for the GPU."""
        cells, classes = self._made.cells.textures
        kinds = np.frombuffer(cells.read(alignment=1), np.uint16).reshape(cells.height, cells.width)
        solid = np.frombuffer(classes.read(alignment=1), np.uint8).reshape(kinds.shape) == round(255.0 * PixelClass.SOLID_THING.depth)
        width, height = self.classes.size
        return np.kron((kinds & 3 == 0) & ~solid, np.ones((REFINE_STEP, REFINE_STEP), bool))[:height, :width]

    def release(self) -> None:
        """Gives the GL objects back."""
        for own in (*self._own.values(), *([] if self._marked is None else [self._marked])):
            own.release()
        if self._kept is not None:
            self._kept.release()
        self._own, self._marked, self._kept = {}, None, None

    def _trace_marked(self, rays: Draw, made: _Made, filled: Filled) -> None:
        """Traces the rays that tell of cells which may show no thing."""
        marked = self._marked
        if marked is None or marked.color_attachments != made.rays.textures or marked.depth_attachment is not filled.marked:
            if marked is not None:
                marked.release()
            marked = self._marked = self._ctx.framebuffer(made.rays.textures, filled.marked)
        marked.use()
        marked.depth_mask = False
        with drawn(self._ctx, rays, BEYOND_FILLED):
            rays.draw()

    def _make_nodes(self, inputs: FrameInputs, made: _Made) -> None:
        nodes = self._programs.get("refine_nodes.frag", inputs)
        nodes.sample({f"hits{k}": texture for k, texture in enumerate(made.rays.textures)})
        nodes.set(refine_tolerance=tolerances(inputs))
        if inputs.plan.orders:
            nodes.set(beyond_disk=_beyond_disk(inputs.plan))
        made.nodes.frame.use()
        nodes.draw()

    def _judge_cells(self, inputs: FrameInputs, made: _Made, reached: moderngl.Texture | None, filled: Filled | None) -> None:
        cells = self._programs.get("refine_cells.frag", inputs, {} if filled is None else FILLED)
        told = {"reached": reached, "solid": None if filled is None else filled.solid}
        cells.sample({"kinds": made.nodes.texture, **{name: texture for name, texture in told.items() if texture is not None}})
        made.cells.frame.use()
        cells.draw()

    def _sort_pixels(self, inputs: FrameInputs, made: _Made, first: int, end: int, *, all_traced: bool) -> None:
        classes = self._programs.get("refine_classes.frag", inputs)
        cell_classes = made.cells.textures[1]
        classes.sample({"cell_classes": cell_classes})
        classes.set(pixels_to_cells=tuple(1.0 / (REFINE_STEP * side) for side in cell_classes.size), all_traced=float(all_traced))
        made.sorted.use()
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "1"  # always
        if self._cells is None:
            classes.draw_boxes([(0, first, made.classes.width, end - first)])
        else:  # most of a picture is flat sky, and a clear takes next to nothing
            made.sorted.clear(depth=PixelClass.FLAT_SKY.depth)
            others = np.abs(self._cells - PixelClass.FLAT_SKY.depth) > 0.05
            classes.draw_boxes(few_of(bands_of(others, inputs.size, REFINE_STEP, _BAND)))
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"

    def _targets(self, size: tuple[int, int], count: int) -> _Made:
        if self._kept is None or self._kept.made_for != (size, count):
            self.release()
            self._kept = self._make(size, count)
        return self._kept

    def _make(self, size: tuple[int, int], count: int) -> _Made:
        cells = -(-size[0] // REFINE_STEP), -(-size[1] // REFINE_STEP)
        nodes = cells[0] + 1 + 2 * GRID_MARGIN, cells[1] + 1 + 2 * GRID_MARGIN
        kinds = plain_texture(self._ctx, nodes, 1, "u4")
        node_textures = {name: plain_texture(self._ctx, nodes, 4, dtype) for name, dtype in _NODES[: _NODES_BY_TARGETS[count]]}
        for texture in node_textures.values():
            texture.filter = moderngl.LINEAR, moderngl.LINEAR
        classes = self._ctx.depth_texture(size)
        return _Made(
            (size, count),
            rays=Target.of(self._ctx, [plain_texture(self._ctx, nodes, 4, "f4") for _ in range(count)]),
            nodes=Target.of(self._ctx, [kinds, *node_textures.values()]),
            node_textures=node_textures,
            cells=Target.of(self._ctx, [plain_texture(self._ctx, cells, 1, "u2"), plain_texture(self._ctx, cells, 1, "f1")]),
            sorted=self._ctx.framebuffer([], classes),
            classes=classes,
        )


def _beyond_disk(plan: Plan) -> float:
    """The ratio of radii beyond which crossings do not matter; lines in the disk's plane are seen as far in as there are crossings."""
    return max(_BEYOND_DISK, plan.disk_edge / plan.space_time.horizon_radius) if plan.scene.post.lines_in_plane and plan.space_time.has_hole else _BEYOND_DISK


def tolerances(inputs: FrameInputs) -> tuple[float, float]:
    """What interpolation may make of ``plan.refine_px`` pixels, as shaders/refine_nodes.frag takes it.

    Returns:
        Error of directions in rad; of crossings, for each r_s between them and the camera, or in r_s for parallel rays.
    """
    camera, height = inputs.plan.scene.camera, inputs.picture[1]
    pixel = math.radians(camera.fov_deg) / height
    on_disk = 0.5 * camera.field_m / height if math.isinf(camera.distance) else pixel
    return inputs.plan.refine_px * pixel, inputs.plan.refine_px * on_disk
