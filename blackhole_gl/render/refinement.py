"""A moving camera's rays: a coarse grid of exact ones, the cells between them judged, and the pixels of those that cannot be interpolated."""

from __future__ import annotations

import math
from typing import Sequence

import moderngl
import numpy as np

from .. import plan
from ..plan import REFINE_STEP, RayPlan
from ..scene import Scene
from .programs import Programs, draw

# Crossings further out than the disk's edge by this factor do not matter: room for what lies between two nodes of the grid.
_BEYOND_DISK = 1.25


class CoarseGrid:
    """The coarse textures, the cells between their nodes, and the depth that keeps pixels of trusted cells from being traced.

    What they hold is described in shaders/common/hit_cells.glsl.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._size: tuple[int, int] | None = None
        self._textures: list[moderngl.Texture] = []
        self._nodes: moderngl.Framebuffer | None = None
        self._cells: moderngl.Framebuffer | None = None
        self._mask: moderngl.Framebuffer | None = None
        self._masked: moderngl.Framebuffer | None = None
        self.depth: moderngl.Texture | None = None

    def trace(self, triangle: moderngl.VertexArray, scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> None:
        """Traces the grid for a picture of `size` with the trace pass `triangle`, judges its cells and prepares `depth`."""
        self._make_targets(size, 1 + min(ray_plan.orders, 2))
        triangle.program["ray_grid"].value = REFINE_STEP, -REFINE_STEP, -REFINE_STEP
        self._nodes.use()
        draw(triangle)
        self._judge(scene, ray_plan, size)
        mask = self._programs.get("refine_mask.frag", scene, ray_plan)
        mask.program["cells"].value = 0
        self._cells.color_attachments[0].use(0)
        self._mask.use()
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "1"  # always
        draw(mask)
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"

    def samplers(self) -> dict[str, moderngl.Texture]:
        """What common/hit_map_read.glsl reads, by name."""
        return {"cells": self._cells.color_attachments[0], **{f"coarse{k}": texture for k, texture in enumerate(self._textures)}}

    def masked(self, textures: Sequence[moderngl.Texture]) -> moderngl.Framebuffer:
        """The framebuffer of full-size `textures` behind `depth`."""
        if self._masked is None or self._masked.color_attachments != tuple(textures):
            if self._masked is not None:
                self._masked.release()
            self._masked = self._ctx.framebuffer(textures, self.depth)
        return self._masked

    def give_own_rays(self, first: int, end: int) -> None:
        """Marks the cells of the picture's rows `first` ≤ y < `end` as traced pixel by pixel; `first` begins a row of cells."""
        cells = self._cells.color_attachments[0]
        rows = -(-end // REFINE_STEP) - first // REFINE_STEP
        cells.write(bytes(cells.width * rows), (0, first // REFINE_STEP, cells.width, rows), alignment=1)

    def own_share(self) -> float:
        """Share of the picture's pixels that are traced themselves, nodes of the grid left out. Waits for the GPU."""
        cells = np.frombuffer(self._cells.color_attachments[0].read(alignment=1), np.uint8)
        return float(np.mean(cells & 3 == 0))

    def _judge(self, scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> None:
        judge = self._programs.get("refine_cells.frag", scene, ray_plan)
        for unit, texture in enumerate(self._textures):
            texture.use(unit)
            if f"hits{unit}" in judge.program:
                judge.program[f"hits{unit}"].value = unit
        judge.program["refine_tolerance"].value = tolerances(scene, ray_plan, size)
        self._cells.use()
        draw(judge)

    def release(self) -> None:
        """Gives the GL objects back."""
        for frame in (self._nodes, self._cells, self._mask):
            if frame is not None:
                for texture in frame.color_attachments:
                    texture.release()
                frame.release()
        for item in (self._masked, self.depth):
            if item is not None:
                item.release()
        self._nodes = self._cells = self._mask = self._masked = self.depth = self._size = None
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
        self._cells = self._ctx.framebuffer([self._ctx.texture(cells, 1, dtype="u1", alignment=1)])
        self._cells.color_attachments[0].filter = moderngl.NEAREST, moderngl.NEAREST
        self.depth = self._ctx.depth_texture(size)
        self._mask = self._ctx.framebuffer([], self.depth)
        self._size = size


def tolerances(scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> tuple[float, float, float]:
    """(error of directions in rad, of crossings in r_s, radius in r_s within which crossings matter) that interpolation may make."""
    pixel = math.radians(scene.camera.fov_deg) / size[1]
    outer = plan.effective_disk_radii(scene)[1]
    distance = outer if math.isinf(scene.camera.distance) else max(scene.camera.distance, outer)
    return ray_plan.refine_px * pixel, ray_plan.refine_px * pixel * distance, _BEYOND_DISK * outer
