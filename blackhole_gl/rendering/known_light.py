"""The light that comes from a part of all directions, traced and shaded square by square as it is asked for."""

from __future__ import annotations

import math
from dataclasses import replace

import moderngl
import numpy as np

from ..planning import Plan
from ..scene import Scene
from ..shapes import Bool, Int
from .boxes import Box, boxes_of
from .classes import MATTER
from .direction_grid import CELL, DirectionGrid, View
from .edges import EdgeRays, Motion
from .hit_map import HitMap
from .inputs import FrameInputs
from .programs import Draw, Programs, Samplers
from .shading import ShadePass
from .shifted import shifted_into
from .squares import Squares
from .star_layer import with_stars
from .tables import Tables
from .target import Target
from .temperatures import TemperatureProfile

TURNED = {"TURNED": 1}


class KnownLight:
    """What is known of the directions of `grid`.

    Args:
        key: of what all of it depends on.
        plan: by which rays are traced; of a camera in the same place, wherever it looks.
        finer: side of a pixel shown over the grid's, for single stars, which are left out; 1 where they are drawn with the rest.
        light_by: what rays are traced and light is shaded with; it stays its owner's.

    Attributes:
        cells: which squares of the grid have been traced, bool (rows, columns).
        light: RGBA16F, with the disk as it was drawn last.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        programs: Programs,
        light_by: tuple[Tables, TemperatureProfile],
        key: Scene,
        plan: Plan,
        grid: DirectionGrid,
        finer: float,
    ):
        self._ctx, self._programs = ctx, programs
        self.key, self.grid, self.finer = key, grid, finer
        self._plan = _all_round(plan, grid)
        self._map = HitMap(ctx, programs, light_by[0])
        self._shade = ShadePass(ctx, programs, *light_by)
        self._edges = EdgeRays(ctx, programs, *light_by, self._shade.sorting)
        shape = grid.size[1] // CELL, grid.size[0] // CELL
        self.cells, self._matter = np.zeros(shape, bool), np.zeros(shape, bool)
        self._first = self._second = np.empty((0, 2), int)  # pixels with single stars, one at least, and those that may have several
        self._sky, self.light = (ctx.texture(grid.size, 4, dtype="f2") for _ in range(2))
        self._spare: moderngl.Texture | None = None
        self._targets: tuple[Target, Target] | None = None  # of sky and light, with the pixels' classes

    @property
    def marched(self) -> int:
        """How many rays have been traced."""
        return self._map.marched + self._edges.marched

    def inputs(self, plan: Plan, time: float) -> FrameInputs:
        """A frame at `time`, exposed as the picture of `plan`."""
        own, post = self._plan, plan.scene.post
        if own.scene.post != post:
            own = replace(own, scene=replace(own.scene, post=post))
        shown = math.ceil(self.grid.picture[0] / self.finer), math.ceil(self.grid.picture[1] / self.finer)
        return FrameInputs(own, time, self.grid.size, self.grid.picture, self.grid.corner, shown)

    def extend(self, inputs: FrameInputs, fresh: Bool[np.ndarray, "rows columns"]) -> None:
        """Traces the cells that are `fresh`, and shades their sky."""
        squares = Squares.picked(fresh, CELL, self.grid.size)
        self._map.extend(inputs, squares)
        classes = self._shade.sorting.of(inputs, self._map)
        self.cells = self.cells | fresh
        if self._targets is None:
            self._targets = self._made(classes.depth)
            for target in self._targets:
                target.frame.clear()
        targets = self._targets
        if inputs.plan.scene.sky.enabled:
            for target in targets:
                self._shade.draw_sky_in(squares, inputs, self._map, target.frame)
        for box in boxes_of(fresh, CELL):
            self._find_stars(targets[0], box)
            self._find_matter(classes.marks, box)

    def move(self, grid: DirectionGrid, plan: Plan, time: float) -> None:
        """Goes on with a `grid` of the same size and pixels that begins elsewhere; what is known of both is kept."""
        x, y = (new - old for new, old in zip(grid.corner, self.grid.corner))
        x += round(((grid.yaw_deg - self.grid.yaw_deg + 180.0) % 360.0 - 180.0) / math.degrees(grid.pixel))
        self.grid, self._plan = grid, _all_round(self._plan, grid)
        self.cells, self._matter = (_moved(cells, x // CELL, y // CELL) for cells in (self.cells, self._matter))
        inputs, squares = self.inputs(plan, time), Squares.picked(self.cells, CELL, grid.size)
        self._map.shift(inputs, squares, (x, y))
        self._spare = self._spare or self._ctx.texture(grid.size, 4, dtype="f2")
        shifted_into(self._ctx, self._programs, inputs, self._spare, self._sky, squares, (x, y))
        self._sky, self._spare = self._spare, self._sky
        shifted_into(self._ctx, self._programs, inputs, self._spare, self.light, squares, (x, y))
        self.light, self._spare = self._spare, self.light
        self._release_frames()
        self._targets = self._made(self._shade.sorting.of(inputs, self._map).depth)
        self._first, self._second = (self._held(pixels - (x, y)) for pixels in (self._first, self._second))

    def draw_disk(self, inputs: FrameInputs, seen: Bool[np.ndarray, "rows columns"]) -> None:
        """Draws the disk in the cells that are `seen`, and what several rays show of the pixels at edges."""
        if self._targets is None:
            return
        target, matter = self._targets[1], self._matter & seen
        if matter.any():
            self._shade.draw_disk_in(Squares.picked(matter, CELL, self.grid.size), inputs, self._map, target.frame, self._sky)
        self._edges.draw(inputs, self._map, target, motion=Motion.CAMERA)

    def stars(self, inputs: FrameInputs) -> tuple[Draw, Samplers]:
        """What draws its single stars over a view's picture; its samplers are still to be bound."""
        stars, samplers = self._shade.stars(inputs, self._map, TURNED)
        stars.set(finer=inputs.finer)
        return stars, {**samplers, "radiance": self.light}

    def stars_in(self, view: View) -> tuple[Int[np.ndarray, "pixels 2"], Int[np.ndarray, "pixels 2"]]:
        """Column and row of the pixels that `view` shows and that have a single star at least, and of those that may have several."""
        seen = self.grid.seen(view)
        first, second = (pixels[seen[pixels[:, 1] // CELL, pixels[:, 0] // CELL]] for pixels in (self._first, self._second))
        return first, second

    def release(self) -> None:
        """Gives the GL objects back."""
        self._map.release()
        self._shade.release()
        self._edges.release()
        self._release_frames()
        for texture in (self._sky, self.light, self._spare):
            if texture is not None:
                texture.release()

    def _held(self, pixels: Int[np.ndarray, "pixels 2"]) -> Int[np.ndarray, "pixels 2"]:
        return pixels[((pixels >= 0) & (pixels < self.grid.size)).all(axis=1)]

    def _made(self, depth: moderngl.Texture) -> tuple[Target, Target]:
        """Draw into sky and light, with the pixels' classes as their depth."""
        made = Target.of(self._ctx, [self._sky], depth), Target.of(self._ctx, [self.light], depth)
        for target in made:
            target.frame.depth_mask = False
        return made

    def _release_frames(self) -> None:
        for target in self._targets or ():
            target.frame.release()
        self._targets = None

    def _find_stars(self, sky: Target, box: Box) -> None:
        """Lists the pixels of `box`, whose sky is new, that have single stars."""
        if self.finer == 1.0:
            return
        x, y, width, _ = box
        found = with_stars(np.frombuffer(sky.frame.read(box, components=4, alignment=1, dtype="f2"), np.dtype("<u8")))
        first, second = (np.stack([x + pixels % width, y + pixels // width], axis=-1) for pixels in found)
        self._first, self._second = np.concatenate([self._first, first]), np.concatenate([self._second, second])

    def _find_matter(self, marks: Target, box: Box) -> None:
        """Marks the cells of `box` that show the disk."""
        x, y, width, height = (side // CELL for side in box)
        depth = np.frombuffer(marks.frame.read(box, 1, attachment=-1, dtype="f4"), np.float32)
        self._matter[y : y + height, x : x + width] |= MATTER.holds(depth).reshape(height, CELL, width, CELL).any(axis=(1, 3))


def _all_round(plan: Plan, grid: DirectionGrid) -> Plan:
    """`plan` for pictures of all directions, in which those of `grid` are a part."""
    level = {"camera.projection": "equirectangular", "camera.yaw_deg": grid.yaw_deg, "camera.pitch_deg": grid.pitch_deg, "camera.roll_deg": grid.roll_deg}
    return replace(plan, scene=plan.scene.with_values(level))


def _moved(cells: Bool[np.ndarray, "rows columns"], columns: int, rows: int) -> Bool[np.ndarray, "rows columns"]:
    """What of `cells` is still among them when they begin `columns` to the right and `rows` up."""
    found = np.zeros_like(cells)
    (low, high), (left, right) = ((max(-step, 0), min(side, side - step)) for step, side in zip((rows, columns), cells.shape))
    if low < high and left < right:
        found[low:high, left:right] = cells[low + rows : high + rows, left + columns : right + columns]
    return found
