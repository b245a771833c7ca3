"""A moving camera's rays: a coarse grid of exact ones, the cells between them judged, and the pixels of those that cannot be interpolated."""

from __future__ import annotations

import math
from typing import Sequence

import moderngl
import numpy as np

from .. import plan
from ..plan import REFINE_STEP, RayPlan
from ..scene import Scene
from .programs import Programs, bind_samplers, draw

# Crossings beyond the disk's edges by this ratio of radii do not matter: room for what lies between two nodes of the grid.
_BEYOND_DISK = 1.25

# Between the depth of pixels with rays of their own and all others in shaders/refine_classes.frag.
_OWN_RAYS = 0.15


class CoarseGrid:
    """The coarse textures, the cells between their nodes, and what each pixel needs.

    Attributes:
        classes: depth of the picture's size, as shaders/refine_classes.frag writes it.

    The other textures are described in shaders/common/hit_cells.glsl.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._size: tuple[int, int] | None = None
        self._textures: list[moderngl.Texture] = []
        self._nodes: moderngl.Framebuffer | None = None
        self._cells: moderngl.Framebuffer | None = None
        self._sorted: moderngl.Framebuffer | None = None
        self._own: moderngl.Framebuffer | None = None
        self.classes: moderngl.Texture | None = None

    def trace(self, triangle: moderngl.VertexArray, scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> None:
        """Traces the grid for a picture of `size` with the trace pass `triangle`, judges its cells and sorts the pixels into `classes`."""
        self._make_targets(size, 1 + min(ray_plan.orders, 2))
        triangle.program["ray_grid"].value = REFINE_STEP, -REFINE_STEP, -REFINE_STEP
        self._nodes.use()
        draw(triangle)
        self._judge(scene, ray_plan, size)
        sorting = self._programs.get("refine_classes.frag", scene, ray_plan)
        bind_samplers(sorting.program, {"cells": self._cells.color_attachments[0]})
        self._sorted.use()
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "1"  # always
        draw(sorting)
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"

    def trace_own_rays(self, triangle: moderngl.VertexArray, textures: Sequence[moderngl.Texture]) -> None:
        """Traces the pixels that cannot be interpolated into `textures`, of the picture's size."""
        if self._own is None or self._own.color_attachments != tuple(textures):
            if self._own is not None:
                self._own.release()
            self._own = self._ctx.framebuffer(textures, self.classes)
        self._own.use()
        self._own.depth_mask = False
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = ">"  # pixels with rays of their own are nearer than this, all others farther
        triangle.program["ray_grid"].value = 1.0, 0.0, 0.0
        triangle.program["triangle_depth"].value = 2.0 * _OWN_RAYS - 1.0
        draw(triangle)
        triangle.program["triangle_depth"].value = 0.0
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"

    def samplers(self) -> dict[str, moderngl.Texture]:
        """What common/hit_map_read.glsl reads, by name."""
        return {"cells": self._cells.color_attachments[0], **{f"coarse{k}": texture for k, texture in enumerate(self._textures)}}

    def give_own_rays(self, first: int, end: int) -> None:
        """Marks the cells of the picture's rows `first` ≤ y < `end` as traced pixel by pixel; `first` begins a row of cells."""
        cells = self._cells.color_attachments[0]
        rows = -(-end // REFINE_STEP) - first // REFINE_STEP
        cells.write(bytes(2 * cells.width * rows), (0, first // REFINE_STEP, cells.width, rows), alignment=1)

    def own_share(self) -> float:
        """Share of the picture's pixels that are traced themselves, nodes of the grid left out. Waits for the GPU."""
        cells = np.frombuffer(self._cells.color_attachments[0].read(alignment=1), np.uint16)
        return float(np.mean(cells & 3 == 0))

    def _judge(self, scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> None:
        judge = self._programs.get("refine_cells.frag", scene, ray_plan)
        bind_samplers(judge.program, {f"hits{k}": texture for k, texture in enumerate(self._textures)})
        judge.program["refine_tolerance"].value = tolerances(scene, ray_plan, size)
        self._cells.use()
        draw(judge)

    def release(self) -> None:
        """Gives the GL objects back."""
        for frame in (self._nodes, self._cells, self._sorted):
            if frame is not None:
                for texture in frame.color_attachments:
                    texture.release()
                frame.release()
        for item in (self._own, self.classes):
            if item is not None:
                item.release()
        self._nodes = self._cells = self._sorted = self._own = self.classes = self._size = None
        self._textures = []

    def _make_targets(self, size: tuple[int, int], count: int) -> None:
        if (size, count) == (self._size, len(self._textures)):
            return
        self.release()
        cells = tuple(-(-side // REFINE_STEP) for side in size)
        nodes = tuple(side + 3 for side in cells)
        for _ in range(count):
            texture = self._ctx.texture(nodes, 4, dtype="f4")
            texture.repeat_x = texture.repeat_y = False
            self._textures.append(texture)
        self._nodes = self._ctx.framebuffer(self._textures)
        self._cells = self._ctx.framebuffer([self._ctx.texture(cells, 1, dtype="u2", alignment=1)])
        self._cells.color_attachments[0].filter = moderngl.NEAREST, moderngl.NEAREST
        self.classes = self._ctx.depth_texture(size)
        self._sorted = self._ctx.framebuffer([], self.classes)
        self._size = size


def tolerances(scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> tuple[float, float, float]:
    """What interpolation may make of `ray_plan.refine_px` pixels, as shaders/refine_cells.frag takes it.

    Returns:
        Error of directions in rad; of crossings, for each r_s between them and the camera, or in r_s for parallel rays; how far
        beyond the disk's edges crossings still matter, as a ratio of radii.
    """
    pixel = math.radians(scene.camera.fov_deg) / size[1]
    on_disk = 0.5 * scene.camera.field_m / size[1] if math.isinf(scene.camera.distance) else pixel
    return ray_plan.refine_px * pixel, ray_plan.refine_px * on_disk, _BEYOND_DISK
