"""Pixels of a sharp hit map sorted by what they need, with the marks by which edges are found: one pass over its hits."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl

from ..glsl.declared import PixelClass
from ..scene import Scene
from .draw import Draw
from .hit_map import HitMap
from .inputs import FrameInputs
from .programs import Programs
from .squares import Squares
from .target import Target

_VEIL = 0.5


@dataclass(frozen=True, eq=False)
class Sorted:
    """The pixels of a picture.

    Attributes:
        key: of what they depend on.
        depth: by what each needs, as shaders/shade_classes.frag writes it.
        marks: RG8, shaders/common/edge_marks.glsl.
        before: key of those that were sorted before, from which they differ in `changed` alone; None where they may anywhere.
    """

    key: tuple
    depth: moderngl.Texture
    marks: Target
    before: tuple | None = None
    changed: Squares | None = None


class PixelSorting:
    """Draws shaders/shade_classes.frag; what it made is kept as long as the hit map and the disk's edges are."""

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._target: Target | None = None
        self._depth: moderngl.Texture | None = None
        self._kept: Sorted | None = None

    def of(self, inputs: FrameInputs, hit_map: HitMap) -> Sorted:
        """The pixels of `hit_map`, which is sharp."""
        plan, scene = inputs.plan, inputs.plan.scene
        size = hit_map.textures[0].size
        key = hit_map.generation, size, plan.orders, plan.disk_edge, plan.disk_outer, scene.disk.orders_shown, scene.disk.compositing, hides(scene)
        kept = self._kept
        if kept is None or kept.key != key:
            changed = hit_map.changed_since(kept.key[0]) if kept is not None and kept.key[1:] == key[1:] else None
            kept = self._kept = self._sort(inputs, hit_map, size, key, changed)
        return kept

    def prepare(self, size: tuple[int, int]) -> moderngl.Texture:
        """Makes what the pixels of a map of `size` are sorted into, unless it is there; returns their depth."""
        if self._target is None or self._depth is None or self._target.size != size:
            self.release()
            self._depth = self._ctx.depth_texture(size)
            self._target = marks_target(self._ctx, size, self._depth)
        return self._depth

    def release(self) -> None:
        """Gives the GL objects back."""
        for item in (self._target, self._depth):
            if item is not None:
                item.release()
        self._target, self._depth, self._kept = None, None, None

    def _sort(self, inputs: FrameInputs, hit_map: HitMap, size: tuple[int, int], key: tuple, changed: Squares | None) -> Sorted:
        """All pixels, or those that have `changed` anew."""
        depth = self.prepare(size)
        assert self._target is not None
        classes = self._programs.get("shade_classes.frag", inputs, hit_map.switches())
        classes.sample(hit_map.samplers())
        set_hiding(classes)
        self._target.frame.use()
        self._ctx.enable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "1"  # always
        if changed is None and hit_map.parts is not None:
            self._target.frame.clear(1.0, 1.0, depth=PixelClass.NEITHER.depth)  # no ray
            classes.draw_squares(hit_map.parts)
        elif changed is None:
            classes.draw()
        else:
            classes.draw_squares(changed)
        self._ctx.disable(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "<"
        before = self._kept.key if self._kept is not None and changed is not None else None
        return Sorted(key, depth, self._target, before, changed)


def hides(scene: Scene) -> bool:
    """Whether the direct picture of the disk hides what is behind it well enough for the first ring's edges not to be seen."""
    return scene.disk.opacity > _VEIL


def marks_target(ctx: moderngl.Context, size: tuple[int, int], depth: moderngl.Texture) -> Target:
    """For the marks of a picture of `size`, with the pixels' `depth`."""
    texture = ctx.texture(size, 2, dtype="f1", alignment=1)
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    return Target.of(ctx, [texture], depth)


def set_hiding(marks: Draw) -> None:
    """Tells a program that makes marks what the disk hides, if it asks."""
    marks.tell(disk_hides=hides(marks.inputs.plan.scene))
