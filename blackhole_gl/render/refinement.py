"""A moving camera's rays: a coarse grid of exact ones, the cells between them judged, and the pixels of those that cannot be interpolated."""

from __future__ import annotations

import math
from collections.abc import Sequence

import moderngl
import numpy as np

from ..plan import REFINE_STEP, RayPlan
from ..scene import Scene
from .programs import Programs, bind_samplers, draw

# Crossings beyond the disk's edges by this ratio of radii do not matter: room for what lies between two nodes of the grid.
_BEYOND_DISK = 1.25

# Between the depth of pixels with rays of their own and all others in shaders/refine_classes.frag.
_OWN_RAYS = 0.1

# Textures of the nodes, and how many of them there are by the number of targets of the trace pass.
_NODES = (("coarse0", "f4"), ("bend0", "f2"), ("coarse1", "f4"), ("bend1", "f2"), ("bend2", "f2"))
_NODES_BY_TARGETS = {1: 2, 2: 4, 3: 5}


class CoarseGrid:
    """The coarse rays, the nodes and cells made of them, and what each pixel needs.

    Attributes:
        classes: depth of the picture's size, as shaders/refine_classes.frag writes it.

    The other textures are described in shaders/common/hit_cells.glsl and node_kinds.glsl.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._made_for: tuple | None = None
        self._frames: list[moderngl.Framebuffer] = []
        self._rays: moderngl.Framebuffer | None = None
        self._nodes: moderngl.Framebuffer | None = None
        self._cells: moderngl.Framebuffer | None = None
        self._sorted: moderngl.Framebuffer | None = None
        self._own: moderngl.Framebuffer | None = None
        self._node_textures: dict[str, moderngl.Texture] = {}
        self.classes: moderngl.Texture | None = None

    def trace(self, triangle: moderngl.VertexArray, scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> None:
        """Traces the grid for a picture of `size` with the trace pass `triangle`, judges its cells and sorts the pixels into `classes`."""
        self._make_targets(size, 1 + min(ray_plan.orders, 2))
        triangle.program["ray_grid"].value = REFINE_STEP, -REFINE_STEP, -REFINE_STEP
        self._rays.use()
        draw(triangle)
        self._make_nodes(scene, ray_plan, size)
        self._judge_cells(scene, ray_plan)
        self._sort_pixels(scene, ray_plan, 0, size[1], all_traced=False)

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
        return {"cells": self._cells.color_attachments[0], **self._node_textures}

    def give_own_rays(self, scene: Scene, ray_plan: RayPlan, first: int, end: int) -> None:
        """Marks the cells of the picture's rows `first` ≤ y < `end` as traced pixel by pixel; `first` begins a row of cells."""
        cells = self._cells.color_attachments[0]
        rows = -(-end // REFINE_STEP) - first // REFINE_STEP
        cells.write(bytes(2 * cells.width * rows), (0, first // REFINE_STEP, cells.width, rows), alignment=1)
        self._sort_pixels(scene, ray_plan, first, end, all_traced=True)

    def own_rays(self) -> np.ndarray:
        """Which pixels are traced themselves, bool (height, width), row 0 at the bottom; nodes of the grid left out. Waits for the GPU."""
        texture = self._cells.color_attachments[0]
        cells = np.frombuffer(texture.read(alignment=1), np.uint16).reshape(texture.height, texture.width)
        width, height = self.classes.size
        return np.kron(cells & 3 == 0, np.ones((REFINE_STEP, REFINE_STEP), bool))[:height, :width]

    def release(self) -> None:
        """Gives the GL objects back."""
        for frame in self._frames:
            for texture in frame.color_attachments:
                texture.release()
            frame.release()
        for item in (self._own, self.classes):
            if item is not None:
                item.release()
        self._rays = self._nodes = self._cells = self._sorted = self._own = self.classes = self._made_for = None
        self._frames, self._node_textures = [], {}

    def _make_nodes(self, scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> None:
        triangle = self._programs.get("refine_nodes.frag", scene, ray_plan)
        bind_samplers(triangle.program, {f"hits{k}": texture for k, texture in enumerate(self._rays.color_attachments)})
        triangle.program["refine_tolerance"].value = tolerances(scene, ray_plan, size)
        if ray_plan.orders:
            triangle.program["beyond_disk"].value = _BEYOND_DISK
        self._nodes.use()
        draw(triangle)

    def _judge_cells(self, scene: Scene, ray_plan: RayPlan) -> None:
        triangle = self._programs.get("refine_cells.frag", scene, ray_plan)
        bind_samplers(triangle.program, {"kinds": self._nodes.color_attachments[0]})
        self._cells.use()
        draw(triangle)

    def _sort_pixels(self, scene: Scene, ray_plan: RayPlan, first: int, end: int, *, all_traced: bool) -> None:
        triangle = self._programs.get("refine_classes.frag", scene, ray_plan)
        cell_classes = self._cells.color_attachments[1]
        bind_samplers(triangle.program, {"cell_classes": cell_classes})
        triangle.program["pixels_to_cells"].value = tuple(1.0 / (REFINE_STEP * side) for side in cell_classes.size)
        triangle.program["all_traced"].value = float(all_traced)
        self._sorted.use()
        self._sorted.scissor = 0, first, self.classes.width, end - first
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "1"  # always
        draw(triangle)
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"

    def _make_targets(self, size: tuple[int, int], count: int) -> None:
        if (size, count) == self._made_for:
            return
        self.release()
        cells = tuple(-(-side // REFINE_STEP) for side in size)
        nodes = tuple(side + 3 for side in cells)
        self._rays = self._framebuffer([self._texture(nodes, 4, "f4") for _ in range(count)])
        kinds = self._texture(nodes, 1, "u4")
        self._node_textures = {name: self._texture(nodes, 4, dtype) for name, dtype in _NODES[: _NODES_BY_TARGETS[count]]}
        for texture in self._node_textures.values():
            texture.filter = moderngl.LINEAR, moderngl.LINEAR
        self._nodes = self._framebuffer([kinds, *self._node_textures.values()])
        self._cells = self._framebuffer([self._texture(cells, 1, "u2"), self._texture(cells, 1, "f1")])
        self.classes = self._ctx.depth_texture(size)
        self._sorted = self._framebuffer([], self.classes)
        self._made_for = size, count

    def _texture(self, size: tuple[int, int], components: int, dtype: str) -> moderngl.Texture:
        texture = self._ctx.texture(size, components, dtype=dtype, alignment=1)
        texture.filter = moderngl.NEAREST, moderngl.NEAREST
        texture.repeat_x = texture.repeat_y = False
        return texture

    def _framebuffer(self, textures: Sequence[moderngl.Texture], depth: moderngl.Texture | None = None) -> moderngl.Framebuffer:
        self._frames.append(self._ctx.framebuffer(textures, depth))
        return self._frames[-1]


def tolerances(scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> tuple[float, float]:
    """What interpolation may make of `ray_plan.refine_px` pixels, as shaders/refine_nodes.frag takes it.

    Returns:
        Error of directions in rad; of crossings, for each r_s between them and the camera, or in r_s for parallel rays.
    """
    pixel = math.radians(scene.camera.fov_deg) / size[1]
    on_disk = 0.5 * scene.camera.field_m / size[1] if math.isinf(scene.camera.distance) else pixel
    return ray_plan.refine_px * pixel, ray_plan.refine_px * on_disk
