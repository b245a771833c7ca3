"""Which pixels of a hit map one ray is too few for: those within or beside which the fate, the order or what is met changes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import moderngl
import numpy as np

from ..glsl.declared import PixelClass
from ..scene import Scene
from .hit_map import HitMap
from .inputs import FrameInputs
from .programs import Draw, Programs
from .target import Target

_VEIL = 0.5

_OWN_RAYS = PixelClass.OWN_RAY.depth_beyond


@dataclass(frozen=True, eq=False)
class _Made:
    """Of a picture's size. With the classes of a map that is not sharp, whose pixels without a ray of their own lie nowhere near an edge.

    Attributes:
        marks: RG8, shaders/common/edge_marks.glsl.
        edges: R8, 1 at edges.
    """

    marks: Target
    edges: Target
    classes: moderngl.Texture | None

    @classmethod
    def of(cls, ctx: moderngl.Context, size: tuple[int, int], classes: moderngl.Texture | None) -> _Made:
        def target(components: int) -> Target:
            texture = ctx.texture(size, components, dtype="f1", alignment=1)
            texture.filter = moderngl.NEAREST, moderngl.NEAREST
            texture.repeat_x = texture.repeat_y = False
            return Target.of(ctx, [texture], classes)

        return cls(target(2), target(1), classes)

    def fits(self, size: tuple[int, int], classes: moderngl.Texture | None) -> bool:
        return self.marks.size == size and self.classes is classes

    def release(self) -> None:
        self.marks.release()
        self.edges.release()


def hides(scene: Scene) -> bool:
    """Whether the direct picture of the disk hides what is behind it well enough for the first ring's edges not to be seen."""
    return scene.disk.opacity > _VEIL


class EdgePixels:
    """Finds them."""

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._made: dict[bool, _Made] = {}  # of maps that are sharp, and that are not

    def find(self, inputs: FrameInputs, hit_map: HitMap) -> np.ndarray:
        """Column and row, from the bottom left, of each pixel at an edge of `hit_map`, int (N, 2). Waits for the GPU."""
        made = self._targets(inputs.size, hit_map)
        marks = self._programs.get("edge_marks.frag", inputs)
        marks.sample(hit_map.samplers())
        if "disk_hides" in marks.program:
            marks.set(disk_hides=hides(inputs.plan.scene))
        self._draw(marks, made.marks, made.classes, 1.0)
        edges = self._programs.get("edge_pixels.frag", inputs)
        edges.sample({"marks": made.marks.texture})
        self._draw(edges, made.edges, made.classes, 0.0)
        width, height = inputs.size
        found = np.frombuffer(made.edges.texture.read(alignment=1), np.uint8)
        rows, columns = np.divmod(np.flatnonzero(found), width)
        return np.stack([columns, rows], axis=-1)

    def release(self) -> None:
        """Gives the GL objects back."""
        for made in self._made.values():
            made.release()
        self._made = {}

    def _targets(self, size: tuple[int, int], hit_map: HitMap) -> _Made:
        made = self._made.get(hit_map.is_sharp)
        if made is None or not made.fits(size, hit_map.classes):
            if made is not None:
                made.release()
            made = self._made[hit_map.is_sharp] = _Made.of(self._ctx, size, hit_map.classes)
        return made

    def _draw(self, draw: Draw, target: Target, classes: moderngl.Texture | None, elsewhere: float) -> None:
        """Draws every pixel, or where there are `classes` those with rays of their own, all others `elsewhere`."""
        target.frame.use()
        if classes is None:
            draw.set(triangle_depth=0.0)
            draw.draw()
            return
        target.frame.depth_mask = False
        target.frame.clear(elsewhere, elsewhere)
        with drawn_nearer(self._ctx, draw, _OWN_RAYS):
            draw.draw()


@contextmanager
def drawn_nearer(ctx: moderngl.Context, draw: Draw, depth: float) -> Iterator[None]:
    """Has `draw` draw only where the depth buffer holds less than `depth`."""
    draw.set(triangle_depth=2.0 * depth - 1.0)
    ctx.enable(moderngl.DEPTH_TEST)
    ctx.depth_func = ">"
    yield
    ctx.disable(moderngl.DEPTH_TEST)
    ctx.depth_func = "<"
