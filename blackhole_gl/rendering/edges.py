"""Several rays in the pixels within which what is seen changes: at the shadow's edge and on the rings, which are thinner than a pixel.

They are traced once for a hit map and kept with it; from then on they cost shading alone, and only in those few pixels. Where a thing moves, those in the
squares that it changed are traced anew.
"""

from __future__ import annotations

from enum import IntEnum

import moderngl
import numpy as np

from .boxes import grown, inside
from .coarse_transfer import MediaApart
from .edge_blocks import EdgeBlocks
from .edge_pixels import EdgePixels
from .hit_map import HitMap
from .inputs import FrameInputs
from .programs import Programs
from .ray_blocks import RayBlocks, shifts_texture
from .shading import ShadePass
from .sorting import PixelSorting, hides
from .squares import TOGETHER, Squares
from .tables import Tables
from .target import Elsewhere, Target
from .temperatures import TemperatureProfile

# Rays along each axis of a pixel while the camera moves, when they are traced anew in every frame; and of a pixel that stands for more than `_COARSE` of the
# screen's along each, in a picture that is drawn so coarse: it has fewer of them, and a ring that is a few hundredths of one wide would be a row of beads.
_MOVING_SIDE, _COARSE_SIDE, _COARSE = 2, 4, 2.5

_EDGES = 0.01  # share of the pixels of a map that is extended for which there is room at first: with too little all rays would be traced again

_NO_BLOCK = 0xFFFF


class Motion(IntEnum):
    """What moves from picture to picture, so that all of it has to be quick."""

    NOTHING = 0
    MATTER = 1
    """Things or media, before a camera at rest."""
    CAMERA = 2


class EdgeRays:
    """The pixels at edges, their rays and what these show.

    Args:
        tables, temperatures: what rays are traced and shaded with; they stay their owner's.
        sorting: of the pixels of sharp maps; so does this.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, tables: Tables, temperatures: TemperatureProfile, sorting: PixelSorting):
        self._ctx, self._programs = ctx, programs
        self._find = EdgePixels(ctx, programs, sorting)
        self._map = HitMap(ctx, programs, tables)
        self._shade = ShadePass(ctx, programs, tables, temperatures)
        self._elsewhere = Elsewhere(ctx)
        self._places: _Places | None = None
        self._texture: moderngl.Texture | None = None
        self._held: EdgeBlocks | None = None
        self._blocks: RayBlocks | None = None
        self._radiance: Target | None = None
        self._key: tuple | None = None

    def look(self, inputs: FrameInputs, hit_map: HitMap) -> None:
        """To come as soon as a map that is not sharp is traced, and `draw` after it is shaded: the marks are made ready while the GPU traces, and pixels at
        edges sought while it shades."""
        if inputs.plan.scene.rays.edges > 1 and not hit_map.is_sharp and (self._key is None or self._key[0] != hit_map.generation):
            self._find.look(inputs, hit_map)

    @property
    def pixels(self) -> np.ndarray:
        """Column and row of each pixel with several rays, from the bottom left, int (N, 2)."""
        return np.empty((0, 2), int) if self._held is None else self._held.pixels

    def draw(self, inputs: FrameInputs, hit_map: HitMap, target: Target, *, motion: Motion = Motion.NOTHING, media: MediaApart | None = None) -> None:
        """Shades the rays of the pixels at edges of `hit_map`, traced before where they are not known yet, and puts their means into `target`.

        Args:
            motion: where anything moves fewer rays will do, as for every map that is not sharp; and where the camera does, one at plain outlines of things.
            media: those that are marched apart from the rest, if any are.
        """
        if not hit_map.is_sharp:
            self._elsewhere.begin()
        self.trace(inputs, hit_map, motion=motion)
        if self._blocks is None or self._radiance is None or self._places is None:
            return
        size = self._blocks.size
        self._shade.draw(inputs.drawn_as(size), self._map, self._radiance.frame, media.in_blocks(size, self._blocks.side) if media else None)
        resolve = self._programs.get("edge_resolve.frag", inputs)
        resolve.set(pairs=self._blocks.side // 2)
        resolve.sample({"block_radiance": self._radiance.texture, "block_of_pixel": self._places.block_of_pixel})
        self._places.frame(target).use()
        resolve.draw_squares(self._places.squares)

    def trace(self, inputs: FrameInputs, hit_map: HitMap, *, motion: Motion = Motion.NOTHING) -> None:
        """Traces the rays that `draw` of the same would, where they are not known yet."""
        motion = motion if hit_map.is_sharp else Motion.CAMERA
        side = _side(inputs.plan.scene.rays.edges, min(inputs.finer), moving=motion > Motion.NOTHING)
        plan = inputs.plan
        key = (hit_map.generation, side, motion, inputs.size, plan.orders, plan.disk_edge, plan.disk_outer, plan.scene.disk.compositing, hides(plan.scene))
        if key != self._key:
            changed = hit_map.changed_since(self._key[0]) if self._key is not None and self._key[1:] == key[1:] else None
            self._trace(inputs, hit_map, side, changed, motion)
            self._key = key

    @property
    def rays_a_pixel(self) -> int:
        """Of the pixels that have several; 1 where none has."""
        return self._blocks.side**2 if self._blocks else 1

    @property
    def traces(self) -> int:
        """How many times rays have been traced."""
        return self._map.traces

    @property
    def marched(self) -> int:
        """How many rays have been traced."""
        return self._map.marched

    def release(self) -> None:
        """Gives the GL objects back."""
        self._find.release()
        self._map.release()
        self._shade.release()
        self._elsewhere.release()
        for item in (self._texture, self._radiance, self._places):
            if item is not None:
                item.release()
        self._texture, self._radiance, self._places, self._blocks, self._key, self._held = None, None, None, None, None, None

    def prepare(self, size: tuple[int, int]) -> _Places:
        """Makes what tells where in a picture of `size` pixels at edges are, unless it is there."""
        if self._places is None or self._places.size != size:
            if self._places is not None:
                self._places.release()
            self._places = _Places(self._ctx, size)
        return self._places

    def _trace(self, inputs: FrameInputs, hit_map: HitMap, side: int, changed: Squares | None, motion: Motion) -> None:
        """Finds the pixels at edges, and traces `side`² rays of each, those that stand outside `changed` alone left out; none where that is one.

        While anything moves rays of pixels within and beside which no thing is met look for none; and while the camera does, pixels at plain outlines of things
        have one ray.
        """
        before, self._held, self._blocks = self._held, None, None
        if side == 1:
            return
        pixels, seeking = self._found(inputs, hit_map, before, changed, motion)
        if self._programs.foresees and motion is Motion.CAMERA:
            pixels, seeking = _with_either(pixels, seeking, inputs)
        if not len(pixels):
            return
        places = self.prepare(inputs.size)
        found = before.after(pixels, seeking, changed, inputs.size) if before is not None and changed is not None else None
        room = 0 if hit_map.parts is None else max(2 * len(pixels), int(_EDGES * inputs.size[0] * inputs.size[1]))
        self._held, fresh = (EdgeBlocks.of(pixels, seeking, room=room), np.ones(len(pixels), bool)) if found is None else found
        places.write(pixels, self._held.places)
        self._blocks = self._blocks_of(self._held, side)
        self._map.trace_blocks(inputs, self._blocks, self._held.fresh(fresh, side, all_new=found is None), hit_map.known)

    def _found(self, inputs: FrameInputs, hit_map: HitMap, before: EdgeBlocks | None, changed: Squares | None, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
        """The pixels at edges, and which have rays that look for things: those `before` wherever none of the squares `changed` is near."""
        if before is not None and changed is not None and hit_map.parts is not None:
            return self._found_in_parts(inputs, hit_map, before, changed)
        near = None if before is None or changed is None else grown(changed.box(inputs.size), 1, inputs.size)
        pixels, seeking = self._find.find(inputs, hit_map, outlines=motion < Motion.CAMERA, within=near)
        if not (motion and inputs.plan.meetings):
            seeking = np.ones(len(pixels), bool)
        if before is None or near is None:
            return pixels, seeking
        stands = ~inside(before.pixels, near)
        return np.concatenate([before.pixels[stands], pixels]), np.concatenate([before.seeking[stands], seeking])

    def _found_in_parts(self, inputs: FrameInputs, hit_map: HitMap, before: EdgeBlocks, changed: Squares) -> tuple[np.ndarray, np.ndarray]:
        """The same of a map that is extended, and has no things: what is new of it lies at all sides of the rest."""
        standing, found = before.pixels, []
        for box in changed.boxes(inputs.size):
            near = grown(box, 1, inputs.size)
            found.append(self._find.find(inputs, hit_map, within=near)[0])
            standing = standing[~inside(standing, near)]
        numbers = np.unique(np.concatenate([standing, *found]) @ (1, inputs.size[0]))
        return np.stack([numbers % inputs.size[0], numbers // inputs.size[0]], axis=-1), np.ones(len(numbers), bool)

    def _blocks_of(self, held: EdgeBlocks, side: int) -> RayBlocks:
        """The blocks of rays, and a target for what they show."""
        if self._texture is None or self._texture.size != held.size:
            if self._texture is not None:
                self._texture.release()
            self._texture = shifts_texture(self._ctx, held.size)
        self._texture.write(held.shifts.tobytes())
        made = RayBlocks(side, self._texture)
        if self._radiance is None or self._radiance.size != made.size:
            if self._radiance is not None:
                self._radiance.release()
            radiance = self._ctx.texture(made.size, 4, dtype="f2")
            radiance.repeat_x = radiance.repeat_y = False
            self._radiance = Target.of(self._ctx, [radiance])
        return made


def _side(asked: int, finer: float, *, moving: bool) -> int:
    """Rays along each axis: even where there are several, as changes are taken between two and two of them. `finer`: the picture's size over that shown."""
    if asked == 1:
        return 1
    even = asked + asked % 2
    return min(even, _COARSE_SIDE if finer * _COARSE < 1.0 else _MOVING_SIDE) if moving else even


class _Places:
    """Where in a picture of `size` the pixels at edges are, and their blocks of rays.

    Attributes:
        block_of_pixel: RG16UI, column and row of the pixel's block; `_NO_BLOCK` of all other pixels.
        squares: of the picture, that hold them all: as large as what software renderers shade together.
    """

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int]):
        self._ctx = ctx
        self.size = size
        self.squares = Squares.holding(np.empty((0, 2), int), 1, size)
        self._blocks = np.full((*size[::-1], 2), _NO_BLOCK, np.uint16)
        self._words = self._blocks.view(np.uint32).ravel()  # the same, a number a pixel
        self.block_of_pixel = ctx.texture(size, 2, self._blocks.tobytes(), dtype="u2")
        self.block_of_pixel.filter = moderngl.NEAREST, moderngl.NEAREST
        self._held = np.empty(0, int)  # places in `_words` of those that have one
        self._frame: moderngl.Framebuffer | None = None

    def write(self, pixels: np.ndarray, blocks: np.ndarray) -> None:
        """The `pixels` have these `blocks`, each (N, 2), one at least, and no others have any."""
        places = pixels @ (1, self.size[0])
        both = np.concatenate([self._held, places])
        first, last = int(both.min()) // self.size[0], int(both.max()) // self.size[0]
        self._words[self._held] = _NO_BLOCK << 16 | _NO_BLOCK
        self._words[places] = blocks.astype(np.uint16).view(np.uint32).ravel()
        self._held, self.squares = places, Squares.holding(pixels, min(TOGETHER, *self.size), self.size)
        rows = self._blocks[first : last + 1]  # whole ones lie in one piece
        self.block_of_pixel.write(rows, (0, first, self.size[0], len(rows)))

    def frame(self, target: Target) -> moderngl.Framebuffer:
        """Draws into `target`."""
        if self._frame is None or self._frame.color_attachments[0] is not target.texture:
            if self._frame is not None:
                self._frame.release()
            self._frame = self._ctx.framebuffer([target.texture])
            self._frame.color_mask = True, True, True, False  # alpha says where single stars are left out, which the pixel's own ray tells
        return self._frame

    def release(self) -> None:
        """Gives the GL objects back."""
        for item in (self._frame, self.block_of_pixel):
            if item is not None:
                item.release()
        self._frame = None


def _with_either(pixels: np.ndarray, seeking: np.ndarray, inputs: FrameInputs) -> tuple[np.ndarray, np.ndarray]:
    """The same and two pixels in the middle, whose rays look for things or not: however few edges a picture has, all programs of such rays are then in use."""
    middle = np.array(inputs.size) // 2 - [[1, 0], [0, 0]]
    others = ~(pixels[:, None] == middle).all(axis=-1).any(axis=1)
    return np.concatenate([pixels[others], middle]), np.concatenate([seeking[others], [not inputs.plan.meetings, True]])
