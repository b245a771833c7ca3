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
from .classes import MATTER, NO_THINGS
from .direction_grid import CELL, DirectionGrid, View
from .draw import Draw, Samplers
from .edges import EdgeRays, Motion
from .hit_map import HitMap
from .inputs import FrameInputs
from .post import TONE_TABLE
from .programs import Programs
from .shading import SKY_BEHIND, ShadePass
from .squares import Squares
from .star_layer import with_stars
from .tables import Tables
from .target import Target
from .temperatures import TemperatureProfile

TURNED = {"TURNED": 1}

_AT_FIRST, _FORGETS = 2.5, 0.75  # rays a pixel, about the hole's shadow; and the share of them that is taken to be left the next time


class KnownLight:
    """What is known of the directions of `grid`.

    Args:
        key: of what all of it depends on.
        plan: by which rays are traced; of a camera in the same place, wherever it looks.
        finer: side of a pixel shown over the grid's, for single stars, which are left out; 1 where they are drawn with the rest.
        light_by: what rays are traced and light is shaded with; it stays its owner's.

    Attributes:
        cells: which squares of the grid have been traced, bool (rows, columns).
        rays_a_pixel: of the cells that were traced last, or somewhat before, as pixels at edges lie together.
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
        self.rays_a_pixel = _AT_FIRST
        self._serials: list[int] = []
        self._first = self._second = np.empty((0, 2), int)  # pixels with single stars, one at least, and those that may have several
        self._textures: list[moderngl.Texture] = []  # sky and light
        self._targets: tuple[Target, ...] = ()  # of them, with the pixels' classes

    @property
    def marched(self) -> int:
        """How many rays have been traced."""
        return self._map.marched + self._edges.marched

    @property
    def light(self) -> moderngl.Texture:
        """RGBA16F, with the disk as it was drawn last."""
        return self._textures[1]

    def inputs(self, plan: Plan, time: float) -> FrameInputs:
        """A frame at `time`, exposed as the picture of `plan`."""
        own, post = self._plan, plan.scene.post
        if own.scene.post != post:
            own = replace(own, scene=replace(own.scene, post=post))
        shown = math.ceil(self.grid.picture[0] / self.finer), math.ceil(self.grid.picture[1] / self.finer)
        grid = self.grid
        offset = grid.corner[0] - grid.start[0], grid.corner[1] - grid.start[1]
        return FrameInputs(own, time, grid.size, grid.picture, offset, shown, grid.start)

    def require(self, inputs: FrameInputs) -> None:
        """Asks for the programs that it is drawn with, before it takes any memory.

        Raises:
            Unready: as `Programs.get`.
        """
        reads, scene = self._map.switches(), inputs.plan.scene
        wanted = [("trace.frag", {}), ("shade_classes.frag", reads), ("turned.frag", {}), ("edge_resolve.frag", {})]
        wanted += [("shade_sky.frag", reads)] if scene.sky.enabled else []
        wanted += [("shade_matter.frag", {**reads, **SKY_BEHIND}), ("shade_matter.frag", {**reads, **NO_THINGS})] if inputs.plan.shows_disk else []
        wanted += [("star_layer.frag", {**reads, **TONE_TABLE, **TURNED})] if self.finer < 1.0 else []
        for path, switches in wanted:
            self._programs.get(path, inputs, switches)

    def serves(self, key: Scene, plan: Plan, time: float) -> bool:
        """Whether it is of the place `key`, and by the programs that would be drawn with now."""
        return self.key == key and self._programs_of(self.inputs(plan, time)) == self._serials

    def prepare(self, inputs: FrameInputs) -> bool:
        """Makes some of what `extend` needs, as all of it takes as long as some frames; whether that is all there."""
        if len(self._textures) < 2:
            self._textures.append(self._ctx.texture(self.grid.size, 4, dtype="f2"))
        elif not self._map.prepare(inputs):
            return False
        elif not self._targets:
            depth = self._shade.sorting.prepare(self.grid.size)
            self._targets = Target.of(self._ctx, self._textures[:1], depth), Target.of(self._ctx, self._textures[1:], depth)
            for target in self._targets:
                target.frame.depth_mask = False
                target.frame.clear()
        else:
            self._edges.prepare(self.grid.size)
            return True
        return False

    def extend(self, inputs: FrameInputs, fresh: Bool[np.ndarray, "rows columns"]) -> None:
        """Traces the cells that are `fresh`, and shades their sky."""
        before, squares = self.marched, Squares.picked(fresh, CELL, self.grid.size)
        known = self.cells | fresh
        while not self.prepare(inputs):
            pass
        self._map.extend(inputs, squares, Squares.picked(known, CELL, self.grid.size))
        classes = self._shade.sorting.of(inputs, self._map)
        if inputs.plan.scene.sky.enabled:
            for target in self._targets:
                self._shade.draw_sky_in(squares, inputs, self._map, target.frame)
        for box in boxes_of(fresh, CELL):
            self._find_stars(self._targets[0], box)
            self._find_matter(classes.marks, box)
        self._edges.trace(inputs, self._map, motion=Motion.CAMERA)
        self.cells, self._serials = known, self._programs_of(inputs)
        self.rays_a_pixel = max((self.marched - before) / (len(squares) * CELL**2), _FORGETS * self.rays_a_pixel)

    def move(self, grid: DirectionGrid, held: Bool[np.ndarray, "rows columns"]) -> None:
        """Goes on with a `grid` of the same pixels that begins elsewhere; what is known of the cells `held` by both is kept."""
        gone = self.cells & ~held
        self.grid, self._plan = grid, _all_round(self._plan, grid)
        self.cells, self._matter = self.cells & held, self._matter & held
        for target in self._targets:
            for box in boxes_of(gone, CELL):  # no light from elsewhere is to glow
                target.frame.clear(viewport=box)
        self._first, self._second = (pixels[held[pixels[:, 1] // CELL, pixels[:, 0] // CELL]] for pixels in (self._first, self._second))

    def draw_disk(self, inputs: FrameInputs, seen: Bool[np.ndarray, "rows columns"]) -> None:
        """Draws the disk in the cells that are `seen`, and what several rays show of the pixels at edges."""
        if not self._targets:
            return
        (sky, target), matter = self._targets, self._matter & seen
        if matter.any():
            self._shade.draw_disk_in(Squares.picked(matter, CELL, self.grid.size), inputs, self._map, target.frame, sky.texture)
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
        for item in (*self._targets, *self._textures[len(self._targets) :]):
            item.release()

    def _programs_of(self, inputs: FrameInputs) -> list[int]:
        paths = ("trace.frag", "shade_sky.frag") if inputs.plan.scene.sky.enabled else ("trace.frag",)
        return [self._programs.get(path, inputs).serial for path in paths]

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
