"""The trace pass and what it leaves: where every pixel's light comes from. Kept while nothing it depends on has changed.

On the GPU hits are in the frame of the camera's meridian (the world turned about the spin axis so that the camera's azimuth is 0): a camera
that turns about the axis keeps its map. Whoever reads it turns it back.
"""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np

from .. import plan
from ..physics.observer import cos_sin_deg
from ..plan import REFINE_STEP, RayPlan
from ..scene import Scene
from . import refinement
from .programs import RAY_SLOTS, Programs, bind_samplers, chosen, draw
from .tables import Tables

# Slices that a refined map is sharpened in, one a frame.
_SLICES = 12


@dataclass(frozen=True)
class HitArrays:
    """A hit map on the host; row 0 is the picture's bottom row, as GL stores it.

    Attributes:
        fate: int (…): 0 unresolved, 1 escaped, 2 captured.
        steps: int (…).
        direction: float32 (…, 3): asymptotic unit vectors in the world; zero unless escaped.
        lambda_: float32 (…): L_z/E in M; zero when no crossings are kept.
        crossing: float32 (…, 3, 2): r·(cos φ, sin φ) in r_s; zero = none.
    """

    fate: np.ndarray
    steps: np.ndarray
    direction: np.ndarray
    lambda_: np.ndarray
    crossing: np.ndarray


class HitMap:
    """The targets of the trace pass.

    Attributes:
        textures: RGBA32F, one to three by the number of crossings kept; their layout is shaders/common/hit_map_write.glsl.
        tables: what rays are traced with.
        traces: how many times rays have been traced, for tests and the overlay.
        sharpened: whether the last `trace` only made a slice of the kept map exact.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self.textures: list[moderngl.Texture] = []
        self.traces = 0
        self.sharpened = False
        self.tables = Tables(ctx)
        self._pool: list[moderngl.Texture] = []
        self._targets: dict[int, moderngl.Framebuffer] = {}
        self._target: moderngl.Framebuffer | None = None
        self._key: tuple | None = None
        self._azimuth_deg = 0.0
        self._grid = refinement.CoarseGrid(ctx, programs)
        self._traced: tuple[Scene, RayPlan] | None = None
        self._refined_for: tuple | None = None  # what a map that is not sharp depends on beside its key
        self._sharp_rows = 0

    def trace(self, scene: Scene, ray_plan: RayPlan, ray_bytes: bytes, size: tuple[int, int], *, progressive: bool = False) -> bool:
        """Traces `scene` at `size` unless the map holds just that already. The uniform blocks are bound.

        Args:
            progressive: hits that are new may be interpolated between exact rays where the plan allows it; each further call for the same
                ones then traces a slice of the map exactly, until it `is_sharp`.

        Returns:
            Whether rays were traced.
        """
        self._azimuth_deg = scene.camera.azimuth_deg
        triangle = self._programs.get("trace.frag", scene, ray_plan)
        rays = tuple(sorted((key, value) for key, value in scene.parameters.items() if key.startswith("rays.")))
        key = (id(triangle), ray_bytes, scene.hole, rays, size, ray_plan.orders)
        refined = progressive and ray_plan.refine_px > 0.0
        held = key == self._key and (not refined or self.is_sharp or self._refined_for == _refined_for(scene, ray_plan, size))
        self.sharpened = refined and held and not self.is_sharp
        if held and self.is_sharp:
            return False
        self.tables.bind(triangle.program, chosen(scene, ray_plan, *RAY_SLOTS), scene)
        self._make_targets(size, ray_plan.orders)
        if not refined:
            self._trace_rows(triangle, 0, size[1])
        elif self.sharpened:
            self._sharpen(triangle, scene, ray_plan)
        else:
            self._trace_refined(triangle, scene, ray_plan, size)
        self._key, self._traced = key, (scene, ray_plan)
        self.traces += 1
        return True

    @property
    def is_sharp(self) -> bool:
        """Whether every pixel has a ray of its own."""
        return self._refined_for is None

    def own_rays(self) -> np.ndarray:
        """Which pixels have a ray of their own, bool (height, width): all of a sharp map. Waits for the GPU."""
        width, height = self.textures[0].size
        return np.ones((height, width), bool) if self.is_sharp else self._grid.own_rays()

    @property
    def classes(self) -> moderngl.Texture | None:
        """Depth by what each pixel needs (shaders/refine_classes.frag), for a map that is not sharp; None for a sharp one."""
        return None if self.is_sharp else self._grid.classes

    def samplers(self) -> dict[str, moderngl.Texture]:
        """The textures that common/hit_map_read.glsl reads, by name."""
        found = {f"hits{k}": texture for k, texture in enumerate(self.textures)}
        return found if self.is_sharp else {**found, **self._grid.samplers()}

    def switches(self) -> dict[str, int]:
        """The switches that shaders which read the map are to be composed with."""
        return {"HIT_MAP_REFINED": int(not self.is_sharp)}

    def switches_where_flat(self) -> dict[str, int] | None:
        """The same for directions in flat cells alone (shaders/refine_classes.frag), for which less is read; None where there are none."""
        return None if self.is_sharp else {"HIT_MAP_REFINED": 2}

    def _trace_rows(self, triangle: moderngl.VertexArray, first: int, end: int) -> None:
        """Exact rays for the rows `first` ≤ y < `end`; the map is sharp after the last."""
        width, height = self._target.size
        self._target.use()
        self._target.scissor = 0, first, width, end - first
        triangle.program["ray_grid"].value = 1.0, 0.0, 0.0
        draw(triangle)
        self._target.scissor = None
        if end == height:
            self._refined_for, self._sharp_rows = None, 0

    def _trace_refined(self, triangle: moderngl.VertexArray, scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> None:
        self._grid.trace(triangle, scene, ray_plan, size)
        self._grid.trace_own_rays(triangle, self.textures)
        self._refined_for, self._sharp_rows = _refined_for(scene, ray_plan, size), 0

    def _sharpen(self, triangle: moderngl.VertexArray, scene: Scene, ray_plan: RayPlan) -> None:
        height = self._target.size[1]
        rows = -(-height // (_SLICES * REFINE_STEP)) * REFINE_STEP
        first, end = self._sharp_rows, min(self._sharp_rows + rows, height)
        self._sharp_rows = end
        self._grid.give_own_rays(scene, ray_plan, first, end)
        self._trace_rows(triangle, first, end)

    def forget(self) -> None:
        """The next `trace` traces, whatever is kept."""
        self._key = None

    def trace_listed(self, scene: Scene, ray_plan: RayPlan, directions: np.ndarray) -> HitArrays:
        """Hits of listed local directions (N, 3) instead of pixels. The uniform blocks are bound."""
        count = len(directions)
        # Whole blocks of 4 × 4: software renderers run those whole, and a texel that is not there would be a ray without a direction.
        width = min(-(-count // 4) * 4, 1024)
        height = -(-count // (4 * width)) * 4
        listed = np.zeros((height * width, 4), np.float32)
        listed[:, 0] = -1.0
        listed[:count, :3] = directions
        rays = self._ctx.texture((width, height), 4, listed.tobytes(), dtype="f4")
        triangle = self._programs.get("trace.frag", scene, ray_plan, {"RAYS_LISTED": 1})
        triangle.program["listed_rays"].value = 0
        rays.use(0)
        self.tables.bind(triangle.program, chosen(scene, ray_plan, *RAY_SLOTS), scene)
        self._key, self._azimuth_deg = None, scene.camera.azimuth_deg
        self._make_targets((width, height), ray_plan.orders)
        self._target.use()
        draw(triangle)
        self._refined_for = None
        rays.release()
        found = self.read()
        return HitArrays(*(getattr(found, name).reshape(height * width, *getattr(found, name).shape[2:])[:count] for name in HitArrays.__dataclass_fields__))

    def emission_shifts(self, scene: Scene, ray_plan: RayPlan) -> np.ndarray:
        """Exact g of the kept crossings, float32 (height, width, 3), 0 where there is none. The uniform blocks are bound."""
        width, height = self.textures[0].size
        triangle = self._programs.get("probe.frag", scene, ray_plan)
        for unit, texture in enumerate(self.textures):
            if f"hits{unit}" in triangle.program:
                triangle.program[f"hits{unit}"].value = unit
                texture.use(unit)
        target = self._ctx.framebuffer([self._ctx.texture((width, height), 4, dtype="f4")])
        target.use()
        draw(triangle)
        values = np.frombuffer(target.color_attachments[0].read(), np.float32).reshape(height, width, 4)[..., :3]
        target.color_attachments[0].release()
        target.release()
        return values

    def read(self) -> HitArrays:
        """The map as arrays of shape (height, width, …), as its readers see it. The uniform blocks of its last trace are bound."""
        width, height = self.textures[0].size
        data = [np.frombuffer(stored, np.float32).reshape(height, width, 4) for stored in (self._stored() if self.is_sharp else self._resolved())]
        data += [np.zeros((height, width, 4), np.float32)] * (3 - len(data))
        packed = np.rint(data[0][..., 3]).astype(int)
        crossing = np.stack([data[1][..., :2], data[2][..., :2], data[2][..., 2:]], axis=-2)
        return HitArrays(packed & 3, packed >> 2, self._in_world(data[0][..., :3]), data[1][..., 2], self._in_world(crossing))

    def fates_and_steps(self) -> tuple[np.ndarray, np.ndarray]:
        """Of a sharp map, as int (height, width): a third of what `read` brings to the host, and none of its arithmetic."""
        width, height = self.textures[0].size
        packed = np.frombuffer(self.textures[0].read(), np.float32).reshape(height, width, 4)[..., 3].astype(np.int32)
        return packed & 3, packed >> 2

    def _stored(self) -> list[bytes]:
        return [texture.read() for texture in self.textures]

    def _resolved(self) -> list[bytes]:
        triangle = self._programs.get("refine_resolve.frag", *self._traced, self.switches())
        bind_samplers(triangle.program, self.samplers())
        textures = [self._ctx.texture(texture.size, 4, dtype="f4") for texture in self.textures]
        target = self._ctx.framebuffer(textures)
        target.use()
        draw(triangle)
        found = [texture.read() for texture in textures]
        for made in (target, *textures):
            made.release()
        return found

    def _in_world(self, vectors: np.ndarray) -> np.ndarray:
        """Vectors (…, 2 or 3) turned from the camera's meridian to the world, as float32."""
        c, s = cos_sin_deg(self._azimuth_deg)
        x, y = vectors[..., 0].astype(float), vectors[..., 1].astype(float)
        return np.concatenate([np.stack([c * x - s * y, s * x + c * y], axis=-1), vectors[..., 2:]], axis=-1).astype(np.float32)

    def _make_targets(self, size: tuple[int, int], orders: int) -> None:
        """Textures once made are kept while the size stays, so that a disk switched off and on allocates nothing."""
        count = 1 + min(orders, 2)
        if self._pool and self._pool[0].size != size:
            self._release_targets()
        while len(self._pool) < count:
            texture = self._ctx.texture(size, 4, dtype="f4")
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
            texture.repeat_x = texture.repeat_y = False
            self._pool.append(texture)
        self.textures = self._pool[:count]
        if count not in self._targets:
            self._targets[count] = self._ctx.framebuffer(self.textures)
        self._target = self._targets[count]

    def release(self) -> None:
        """Gives the GL objects back."""
        self.tables.release()
        self._grid.release()
        self._release_targets()

    def _release_targets(self) -> None:
        for kept in (*self._targets.values(), *self._pool):
            kept.release()
        self._targets, self._pool, self._target, self.textures, self._key = {}, [], None, [], None


def _refined_for(scene: Scene, ray_plan: RayPlan, size: tuple[int, int]) -> tuple:
    """What a refined map depends on beside its key: how well it interpolates, and where the disk's edges are."""
    return refinement.tolerances(scene, ray_plan, size), plan.effective_disk_radii(scene)
