"""Which pixels of a hit map one ray is too few for: those within or beside which the fate, the order or what is met changes, or that
lie at the rim of a field's sphere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce

import moderngl
import numpy as np

from ..glsl.declared import EdgeMark, Fate
from ..planning import REFINE_STEP
from .boxes import NOWHERE, Box, grown, inside, joined
from .classes import OPEN_THINGS, THINGS, drawn, own_rays
from .hit_map import AS_SHARP, HitMap
from .inputs import FrameInputs
from .programs import Programs
from .sorting import PixelSorting, marks_target, set_hiding
from .target import Target

_BESIDE = 2  # pixels by which what a pixel shows decides about others

_SEEN = ~np.uint16(EdgeMark.VEILED)  # what of a mark counts
_VEILED, _MET, _NO_RAY = np.uint16(EdgeMark.VEILED), np.uint16(EdgeMark.MET << 8), np.uint16(EdgeMark.NO_RAY)
_SEEN_THROUGH_VEIL = _SEEN & ~np.uint16(3 * EdgeMark.RING_1)
_SEEN_THROUGH_VEIL_AT_CORNERS = _MET | np.uint16(EdgeMark.IN_FIELD)
_MET_TO_ESCAPED = np.uint16(Fate.MET - Fate.ESCAPED)


@dataclass(frozen=True, eq=False)
class _Looked:
    """The marks, uint16 (height, width), of the part `box` of a map of that `generation`."""

    generation: int
    marks: np.ndarray
    box: Box


class EdgePixels:
    """Finds them.

    Args:
        sorting: of the maps that are sharp; it stays its owner's.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, sorting: PixelSorting):
        self._ctx, self._programs, self._sorting = ctx, programs, sorting
        self._own: Target | None = None
        self._classes: moderngl.Texture | None = None  # that it draws by
        self._looked: _Looked | None = None

    def look(self, inputs: FrameInputs, hit_map: HitMap) -> None:
        """Brings what `find` asks of a map that is not sharp to the host, so that there is no more to wait for. Waits for the GPU."""
        if hit_map.classes is not None:
            target, box = self._marks_of_own_rays(inputs, hit_map, hit_map.classes)
            marks = _marks_in(target, box)
            self._looked = _Looked(hit_map.generation, marks, box)
            if inputs.plan.meetings:
                met, escaped = shown_in_cells(marks)
                hit_map.see(box, {OPEN_THINGS: escaped} if inputs.plan.orders else {OPEN_THINGS: escaped, THINGS: met})  # a disk needs what things do

    def find(self, inputs: FrameInputs, hit_map: HitMap, *, outlines: bool = True, within: Box | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Column and row, from the bottom left, of each pixel at an edge of `hit_map`, int (N, 2), and whether one within or beside it shows a thing or a
        medium, bool (N,). Waits for the GPU.

        Args:
            outlines: whether a thing's plain outline is an edge, too, or that of a field.
            within: the part of the picture whose pixels are asked for; all of it, where none is given.
        """
        if within is not None:
            pixels, beside = self._find(inputs, hit_map, outlines, grown(within, _BESIDE, inputs.size))
            asked = inside(pixels, within)
            return pixels[asked], beside[asked]
        return self._find(inputs, hit_map, outlines, (0, 0, *inputs.size))

    def _find(self, inputs: FrameInputs, hit_map: HitMap, outlines: bool, part: Box) -> tuple[np.ndarray, np.ndarray]:
        """As `find`, in that `part` of a sharp map alone."""
        if hit_map.classes is None:
            marks, box = _marks_in(self._sorting.of(inputs, hit_map).marks, part), part
        else:
            if self._looked is None or self._looked.generation != hit_map.generation:
                self.look(inputs, hit_map)
            assert self._looked is not None
            marks, box = self._looked.marks, self._looked.box
        pixels = at_edges(marks, corners=inputs.plan.is_inside)
        if not inputs.plan.meetings:
            return pixels + box[:2], np.zeros(len(pixels), bool)
        beside = beside_things(marks, pixels)
        if outlines:
            return pixels + box[:2], beside
        plain = beside if not inputs.plan.model.traits.field else np.ones(len(pixels), bool)
        kept = ~plain
        kept[plain] = ~at_plain_outlines(marks, pixels[plain])
        return pixels[kept] + box[:2], beside[kept]

    def release(self) -> None:
        """Gives the GL objects back."""
        if self._own is not None:
            self._own.release()
        self._own = self._classes = self._looked = None

    def _marks_of_own_rays(self, inputs: FrameInputs, hit_map: HitMap, classes: moderngl.Texture) -> tuple[Target, Box]:
        """Of a map that is not sharp, whose pixels without a ray of their own lie nowhere near an edge; and the part of the picture that holds all others."""
        if self._own is None or self._classes is not classes:
            self.release()
            self._own, self._classes = marks_target(self._ctx, classes.size, classes), classes
        frame = self._own.frame
        frame.use()
        frame.depth_mask = False
        kinds = own_rays(inputs.plan)
        box = reduce(joined, (band for where, _ in kinds for band in hit_map.bands(where)), NOWHERE)
        frame.clear(1.0, 1.0, viewport=box)  # no ray
        for where, switches in kinds:
            marks = self._programs.get("edge_marks.frag", inputs, {**AS_SHARP, **switches})
            marks.sample(hit_map.samplers())
            set_hiding(marks)
            with drawn(self._ctx, marks, where):
                marks.draw_boxes(hit_map.bands(where))
        return self._own, box


def _marks_in(target: Target, box: Box) -> np.ndarray:
    return np.frombuffer(target.frame.read(box, 2, alignment=1), "<u2").reshape(box[3], box[2])


def at_edges(marks: np.ndarray, *, corners: bool = False) -> np.ndarray:
    """Column and row, int (N, 2), of the pixels of `marks` (height, width) that differ from one of the eight beside them; in order of rows.

    Left out are the direct picture's own edges, as its cover is smooth, and what it hides. Behind it a pixel at whose corner alone the hole or a ring begins
    does as well with one ray: a straight edge does not cut it, and what a thin ring has of it is hidden.

    Args:
        marks: shaders/common/edge_marks.glsl, its first number in the low byte.
        corners: whether it has several all the same, as from inside the horizon, where all that is outside becomes a belt thinner than a pixel.
    """
    if marks.size == 0:  # nothing of the picture has rays
        return np.zeros((0, 2), np.intp)
    width = marks.shape[1] + 1
    flat = np.full((len(marks) + 2, width), _NO_RAY)  # about the picture there are none; one column keeps both sides apart
    flat[1:-1, 1:] = marks
    flat = flat.ravel()
    found = np.zeros(flat.size, bool)
    at_corners = _SEEN_THROUGH_VEIL if corners else _SEEN_THROUGH_VEIL_AT_CORNERS
    sides = np.array([1, width, width - 1, width + 1])
    ray = _has_ray(flat)
    firsts = [np.flatnonzero((flat[apart:] != flat[:-apart]) & ray[apart:] & ray[:-apart]) for apart in sides]
    side, first = np.repeat(np.arange(4), list(map(len, firsts))), np.concatenate(firsts)
    second, through_veil = first + sides[side], np.where(side < 2, _SEEN_THROUGH_VEIL, at_corners)
    here, there = flat[first], flat[second]
    changed = here ^ there
    found[first[changed & np.where(here & _VEILED, through_veil, _SEEN) != 0]] = True
    found[second[changed & np.where(there & _VEILED, through_veil, _SEEN) != 0]] = True
    rows, columns = np.divmod(np.flatnonzero(found), width)
    return np.stack([columns - 1, rows - 1], axis=-1)


def shown_in_cells(marks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of each cell of the coarse grid in `marks` (height, width), which begin with one: whether a ray of any of its pixels meets a thing or a medium, and
    whether one escapes, each bool (rows, columns). Cells without rays meet some."""
    height, width = marks.shape
    flags = marks & (_MET | ~(marks >> 1) & np.uint16(Fate.ESCAPED))
    if height % REFINE_STEP or width % REFINE_STEP:
        flags = np.pad(flags, ((0, -height % REFINE_STEP), (0, -width % REFINE_STEP)))
    rows = reduce(np.bitwise_or, (flags[k::REFINE_STEP] for k in range(REFINE_STEP)))
    cells = reduce(np.bitwise_or, (rows[:, k::REFINE_STEP] for k in range(REFINE_STEP)))
    return cells > np.uint16(Fate.ESCAPED), cells & np.uint16(Fate.ESCAPED) > 0


def beside_things(marks: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """Within or beside which of `pixels` (N, 2) of `marks` (height, width) a thing or a medium is met, bool (N,)."""
    near = _about(marks, pixels, 1)
    return (_has_ray(near) & (near & _MET != 0)).any(axis=(0, 1))


def _about(marks: np.ndarray, pixels: np.ndarray, beside: int) -> np.ndarray:
    """The marks within so many pixels of each of `pixels` (N, 2) both ways, uint16 (rows, columns, N): beyond the border of `marks` those at it."""
    height, width = marks.shape
    apart = np.arange(-beside, beside + 1)[:, None]
    columns, rows = (np.clip(places + apart, 0, side - 1) for places, side in zip(pixels.T, (width, height)))
    return marks.ravel()[(rows * width)[:, None] + columns]


def at_plain_outlines(marks: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """Which of `pixels` (N, 2) of `marks` (height, width) lie at the outline of a thing or at the rim of a field and at nothing else, bool (N,): within and
    beside them nothing is narrower than two pixels, and nothing but what is met and whether the ray comes into the field changes."""
    if not len(pixels):
        return np.zeros(0, bool)
    near = _about(marks, pixels, 2)
    least, most = _in_squares(np.minimum, near), _in_squares(np.maximum, near + np.uint16(1)) - np.uint16(1)  # by which no ray counts for nothing
    wide = _in_squares(np.logical_or, most <= least)  # in a square that is all alike
    near = near[1:-1, 1:-1]
    seen = np.where(near & 3 == Fate.MET, near - _MET_TO_ESCAPED, near) & ~_SEEN_THROUGH_VEIL_AT_CORNERS
    alike = ~_has_ray(near) | (seen == seen[1, 1])
    return (wide & alike).all(axis=(0, 1))


def _in_squares(of_two: np.ufunc, values: np.ndarray) -> np.ndarray:
    """What `of_two` makes of each square of 2×2, by the first two axes."""
    pairs = of_two(values[1:], values[:-1])
    return of_two(pairs[:, 1:], pairs[:, :-1])


def _has_ray(marks: np.ndarray) -> np.ndarray:
    """Which pixels have rays of their own."""
    return (marks & _NO_RAY) != _NO_RAY
