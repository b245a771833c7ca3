"""The shade pass: hit map and time → linear radiance."""

from __future__ import annotations

import moderngl
import numpy as np

from .. import plan
from ..physics import disk_profile, observer
from ..scene import Scene
from .hit_map import HitMap
from .programs import SHADE_SLOTS, Programs, bind_samplers, chosen, draw
from .tables import Tables

# Below these depths lie the classes of pixels that may cross the disk, and that may be of the sky (shaders/shade_classes.frag); beyond the
# last those of flat cells (refine_classes.frag).
_DISK, _SKY, _FLAT_SKY = 0.2, 0.3, 0.6

Box = tuple[int, int, int, int]
"""x, y, width and height of a part of the picture, in pixels from the bottom left."""


class ShadePass:
    """Draws shaders/shade_*.frag and owns the tables they read.

    First every pixel is sorted by what it needs, into a depth buffer; then the depth test lets the disk's and the sky's
    shaders run only where they are needed. The sorting is kept as long as the hit map and the disk's edges are, and from its second frame on the
    disk is drawn within its bounds alone; a refined hit map brings a sorting of its own (shaders/refine_classes.frag).

    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._tables = Tables(ctx)
        self._profile: moderngl.Texture | None = None
        self._profile_key: tuple | None = None
        self._depth: moderngl.Texture | None = None
        self._classes: moderngl.Framebuffer | None = None
        self._classes_key: tuple | None = None
        self._disk_box: Box | None = None  # not known before the second frame of the same classes
        self._frame: moderngl.Framebuffer | None = None
        self._sky: moderngl.Framebuffer | None = None
        self._sky_key: tuple | None = None
        self._sky_kept = False

    def draw(self, scene: Scene, ray_plan: plan.RayPlan, hit_map: HitMap, target: moderngl.Framebuffer) -> None:
        """Shades `hit_map` into `target` (RGBA16F, of the map's size; its alpha is left without meaning). The uniform blocks are bound."""
        self._update_profile(scene)
        self._attach(target, hit_map.classes or self._sorted_pixels(scene, ray_plan, hit_map))
        ctx = self._ctx
        ctx.enable(moderngl.DEPTH_TEST)
        self._lay_sky(scene, ray_plan, hit_map, target)
        if ray_plan.orders:
            self._frame.use()
            ctx.enable(moderngl.BLEND)
            ctx.blend_func = moderngl.ONE, moderngl.SRC_ALPHA  # the disk, and what it lets through of the sky behind it
            disk = self._prepared("shade_disk.frag", scene, ray_plan, hit_map, hit_map.switches())
            self._draw_classes(disk, ">", _DISK, self._disk_box if hit_map.is_sharp else None)
        ctx.disable(moderngl.DEPTH_TEST | moderngl.BLEND)
        ctx.depth_func = "<"

    def _lay_sky(self, scene: Scene, ray_plan: plan.RayPlan, hit_map: HitMap, target: moderngl.Framebuffer) -> None:
        """The sky into the target. It does not depend on time: where the same one is asked for again it is kept, and copied from then on."""
        if not scene.sky.enabled:
            self._clear(self._frame)
            return
        triangle = self._programs.get("shade_sky.frag", scene, ray_plan, hit_map.switches())
        parameters = tuple(sorted((key, value) for key, value in scene.parameters.items() if key.startswith("sky.")))
        key = (id(triangle), self._classes_key, scene.camera.azimuth_deg, scene.sky, parameters)
        if key != self._sky_key or not hit_map.is_sharp:
            self._sky_key, self._sky_kept = key, False
            self._draw_sky(self._frame, scene, ray_plan, hit_map)
            return
        if not self._sky_kept:
            if self._sky is None:
                self._sky = self._ctx.framebuffer([self._ctx.texture(target.size, 4, dtype="f2")], self._depth)
            self._draw_sky(self._sky, scene, ray_plan, hit_map)
            self._sky_kept = True
        self._ctx.copy_framebuffer(target, self._sky)

    def _draw_sky(self, frame: moderngl.Framebuffer, scene: Scene, ray_plan: plan.RayPlan, hit_map: HitMap) -> None:
        self._clear(frame)
        self._draw_classes(self._prepared("shade_sky.frag", scene, ray_plan, hit_map, hit_map.switches()), ">", _SKY)
        where_flat = hit_map.switches_where_flat()
        if where_flat is not None:
            self._draw_classes(self._prepared("shade_sky.frag", scene, ray_plan, hit_map, where_flat), "<", _FLAT_SKY)

    def _clear(self, frame: moderngl.Framebuffer) -> None:
        frame.use()
        frame.depth_mask = False
        frame.color_mask = True, True, True, True
        frame.clear(0.0, 0.0, 0.0, 1.0)

    def release(self) -> None:
        """Gives the GL objects back."""
        self._tables.release()
        if self._profile is not None:
            self._profile.release()
        self._profile, self._profile_key = None, None
        self._release_classes()

    def _prepared(self, path: str, scene: Scene, ray_plan: plan.RayPlan, hit_map: HitMap, switches: dict[str, int]) -> moderngl.VertexArray:
        triangle = self._programs.get(path, scene, ray_plan, switches)
        declared = self._tables.of(chosen(scene, ray_plan, *SHADE_SLOTS), scene)
        bind_samplers(triangle.program, {**hit_map.samplers(), **declared, "temperature_profile": self._profile})
        return triangle

    def _draw_classes(self, triangle: moderngl.VertexArray, depth_func: str, depth: float, box: Box | None = None) -> None:
        """Draws where the pixel's class compares with `depth`: ``>`` where it is below, ``<`` where it is beyond; inside `box`, if one is given."""
        self._ctx.depth_func = depth_func
        triangle.program["triangle_depth"].value = 2.0 * depth - 1.0
        self._ctx.scissor = box
        draw(triangle)
        self._ctx.scissor = None

    def _sorted_pixels(self, scene: Scene, ray_plan: plan.RayPlan, hit_map: HitMap) -> moderngl.Texture:
        size = hit_map.textures[0].size
        key = (id(hit_map), hit_map.traces, size, ray_plan.orders, *plan.effective_disk_radii(scene))
        if key == self._classes_key:
            self._disk_box = self._disk_box or _disk_box(self._depth)
            return self._depth
        if self._classes is None or self._classes.size != size:
            self._release_classes()
            self._depth = self._ctx.depth_texture(size)
            self._classes = self._ctx.framebuffer([], self._depth)
        triangle = self._prepared("shade_classes.frag", scene, ray_plan, hit_map, hit_map.switches())
        self._classes.use()
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "1"  # always
        draw(triangle)
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._classes_key, self._disk_box = key, None
        return self._depth

    def _attach(self, target: moderngl.Framebuffer, classes: moderngl.Texture) -> None:
        """Makes the framebuffer of the target's picture and the pixels' classes, unless it is there."""
        picture = target.color_attachments[0]
        if self._frame is None or self._frame.color_attachments[0] is not picture or self._frame.depth_attachment is not classes:
            if self._frame is not None:
                self._frame.release()
            self._frame = self._ctx.framebuffer([picture], classes)

    def _release_classes(self) -> None:
        if self._sky is not None:
            self._sky.color_attachments[0].release()
        for item in (self._sky, self._frame, self._classes, self._depth):
            if item is not None:
                item.release()
        self._sky, self._frame, self._classes, self._depth = None, None, None, None
        self._classes_key, self._sky_key, self._sky_kept = None, None, False
        self._disk_box = None

    def _update_profile(self, scene: Scene) -> None:
        inner, outer = plan.effective_disk_radii(scene)
        key = (scene.disk.temperature_law, observer.effective_spin(scene), scene.disk.orbit, inner, outer)
        if key == self._profile_key:
            return
        values = disk_profile.table(*key)
        if self._profile is None:
            self._profile = _row(self._ctx, values[:, None])
        self._profile.write(values.tobytes())
        self._profile_key = key


def _disk_box(classes: moderngl.Texture) -> Box:
    """The smallest that holds all pixels which may cross the disk; of no size where there are none. Waits for the GPU."""
    depth = np.frombuffer(classes.read(), np.float32).reshape(classes.height, classes.width)
    pixels = depth < _DISK
    rows, columns = np.flatnonzero(pixels.any(axis=1)), np.flatnonzero(pixels.any(axis=0))
    if not rows.size:
        return 0, 0, 0, 0
    return int(columns[0]), int(rows[0]), int(columns[-1] - columns[0]) + 1, int(rows[-1] - rows[0]) + 1


def _row(ctx: moderngl.Context, values: np.ndarray) -> moderngl.Texture:
    """A one-row, linearly filtered float table from (entries, components)."""
    texture = ctx.texture((len(values), 1), values.shape[1], np.ascontiguousarray(values, np.float32).tobytes(), dtype="f4", alignment=4)
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture
