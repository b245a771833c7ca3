"""The trace pass and what it leaves: where every pixel's light comes from. Kept while nothing it depends on has changed.

On the GPU hits are in the frame of the camera's meridian (the world turned about the spin axis so that the camera's azimuth is 0): a camera
that turns about the axis keeps its map. Whoever reads it turns it back.
"""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np

from ..observer import cos_sin_deg
from ..plan import RayPlan
from ..scene import Scene
from . import uniforms
from .programs import Programs, draw
from .ray_tables import RayTables


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
        tables: what closed ray models look up.
        traces: how many times rays have been traced, for tests and the overlay.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self.textures: list[moderngl.Texture] = []
        self.traces = 0
        self.tables = RayTables(ctx)
        self._pool: list[moderngl.Texture] = []
        self._targets: dict[int, moderngl.Framebuffer] = {}
        self._target: moderngl.Framebuffer | None = None
        self._key: tuple | None = None
        self._azimuth_deg = 0.0

    def trace(self, scene: Scene, ray_plan: RayPlan, ray_bytes: bytes, size: tuple[int, int]) -> bool:
        """Traces `scene` at `size` unless the map holds just that already. The uniform blocks are bound. True when it traced."""
        self._azimuth_deg = scene.camera.azimuth_deg
        triangle = self._programs.get("trace.frag", scene, ray_plan)
        key = (id(triangle), ray_bytes, scene.hole, tuple(sorted((k, v) for k, v in scene.parameters.items() if k.startswith("rays."))), size, ray_plan.orders)
        if key == self._key:
            return False
        self.tables.bind(triangle.program, scene)
        self._make_targets(size, ray_plan.orders)
        self._target.use()
        draw(triangle)
        self._key = key
        self.traces += 1
        return True

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
        self.tables.bind(triangle.program, scene)
        self._key, self._azimuth_deg = None, scene.camera.azimuth_deg
        self._make_targets((width, height), ray_plan.orders)
        self._target.use()
        draw(triangle)
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
        """The map as arrays of shape (height, width, …)."""
        width, height = self.textures[0].size
        data = [np.frombuffer(t.read(), np.float32).reshape(height, width, 4) for t in self.textures]
        data += [np.zeros((height, width, 4), np.float32)] * (3 - len(data))
        packed = np.rint(data[0][..., 3]).astype(int)
        crossing = np.stack([data[1][..., :2], data[2][..., :2], data[2][..., 2:]], axis=-2)
        return HitArrays(packed & 3, packed >> 2, self._in_world(data[0][..., :3]), data[1][..., 2], self._in_world(crossing))

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
            self._pool.append(texture)
        self.textures = self._pool[:count]
        if count not in self._targets:
            self._targets[count] = self._ctx.framebuffer(self.textures)
        self._target = self._targets[count]

    def release(self) -> None:
        """Gives the GL objects back."""
        self.tables.release()
        self._release_targets()

    def _release_targets(self) -> None:
        for kept in (*self._targets.values(), *self._pool):
            kept.release()
        self._targets, self._pool, self._target, self.textures, self._key = {}, [], None, [], None
