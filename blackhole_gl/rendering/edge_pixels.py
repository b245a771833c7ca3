"""Which pixels of a hit map one ray is too few for: those within or beside which the fate, the order or what is met changes, or that
lie at the rim of a field's sphere."""

from __future__ import annotations

import moderngl
import numpy as np

from ..glsl.declared import EdgeMark
from .classes import drawn, own_rays
from .hit_map import HitMap
from .inputs import FrameInputs
from .programs import Programs
from .sorting import PixelSorting, marks_target, set_hiding
from .target import Target

_SEEN = ~np.uint16(EdgeMark.VEILED)  # what of a mark counts
_SEEN_THROUGH_VEIL = _SEEN & ~np.uint16(3 * EdgeMark.RING_1)


class EdgePixels:
    """Finds them.

    Args:
        sorting: of the maps that are sharp; it stays its owner's.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs, sorting: PixelSorting):
        self._ctx, self._programs, self._sorting = ctx, programs, sorting
        self._own: Target | None = None
        self._classes: moderngl.Texture | None = None  # that it draws by

    def find(self, inputs: FrameInputs, hit_map: HitMap) -> tuple[np.ndarray, np.ndarray]:
        """Column and row, from the bottom left, of each pixel at an edge of `hit_map`, int (N, 2), and whether one within or beside it shows a thing or a
        medium, bool (N,). Waits for the GPU."""
        classes = hit_map.classes
        texture = self._sorting.of(inputs, hit_map).marks if classes is None else self._marks_of_own_rays(inputs, hit_map, classes)
        marks = np.frombuffer(texture.read(alignment=1), "<u2").reshape(texture.height, texture.width)
        pixels = at_edges(marks)
        return pixels, beside_things(marks, pixels) if inputs.plan.meetings else np.zeros(len(pixels), bool)

    def release(self) -> None:
        """Gives the GL objects back."""
        if self._own is not None:
            self._own.release()
        self._own = self._classes = None

    def _marks_of_own_rays(self, inputs: FrameInputs, hit_map: HitMap, classes: moderngl.Texture) -> moderngl.Texture:
        """Of a map that is not sharp, whose pixels without a ray of their own lie nowhere near an edge."""
        if self._own is None or self._classes is not classes:
            self.release()
            self._own, self._classes = marks_target(self._ctx, classes.size, classes), classes
        frame = self._own.frame
        frame.use()
        frame.depth_mask = False
        frame.clear(1.0, 1.0)  # no ray
        for where, switches in own_rays(inputs.plan):
            marks = self._programs.get("edge_marks.frag", inputs, switches)
            marks.sample(hit_map.samplers())
            set_hiding(marks)
            with drawn(self._ctx, marks, where):
                marks.draw()
        return self._own.texture


def at_edges(marks: np.ndarray) -> np.ndarray:
    """Column and row, int (N, 2), of the pixels of `marks` (height, width) that differ from one of the eight beside them; in order of rows.

    Left out are the direct picture's own edges, as its cover is smooth, and what it hides.

    Args:
        marks: shaders/common/edge_marks.glsl, its first number in the low byte.
    """
    rows, columns = _part_with_changes(marks)
    framed = np.pad(marks[rows, columns], 1, mode="edge")
    width, flat = framed.shape[1], framed.ravel()
    places = _beside_changes(flat, width)
    y, x = np.divmod(places, width)
    inside = (x > 0) & (x < width - 1) & (y > 0) & (y < len(framed) - 1)
    places, x, y = places[inside], x[inside], y[inside]
    here = flat[places]
    counts = np.where(here & EdgeMark.VEILED, _SEEN_THROUGH_VEIL, _SEEN)
    differs = np.zeros(places.shape, bool)
    for step in (-width - 1, -width, -width + 1, -1, 1, width - 1, width, width + 1):
        beside = flat[places + step]
        differs |= _has_ray(beside) & ((beside ^ here) & counts != 0)
    found = differs & _has_ray(here)
    return np.stack([x[found] + (columns.start - 1), y[found] + (rows.start - 1)], axis=-1)


def beside_things(marks: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """Within or beside which of `pixels` (N, 2) of `marks` (height, width) a thing or a medium is met, bool (N,)."""
    height, width = marks.shape
    flat, found = marks.ravel(), np.zeros(len(pixels), bool)
    columns, rows = (np.clip(places + np.array([[-1], [0], [1]]), 0, side - 1) for places, side in zip(pixels.T, (width, height)))
    for row in rows * width:
        for column in columns:
            there = flat[row + column]
            found |= _has_ray(there) & (there >> 8 & EdgeMark.MET != 0)
    return found


def _part_with_changes(marks: np.ndarray) -> tuple[slice, slice]:
    """Rows and columns that hold all edges of `marks`: much of most pictures is sky and nothing else."""
    busy = marks != marks[0, 0]
    rows, columns = (np.flatnonzero(busy.any(axis=axis)) for axis in (1, 0))
    if not rows.size:
        return slice(0, 1), slice(0, 1)
    return slice(max(rows[0] - 1, 0), rows[-1] + 2), slice(max(columns[0] - 1, 0), columns[-1] + 2)


def _beside_changes(flat: np.ndarray, width: int) -> np.ndarray:
    """Places in the picture `flat`, of rows of `width`, of all that differ from one of the eight beside them, and a few more."""
    near = np.zeros(flat.size, bool)
    for apart, across in ((1, width), (width, 1)):
        changes = np.flatnonzero(flat[apart:] != flat[:-apart])
        for step in (-across, 0, across, apart - across, apart, apart + across):
            near[np.clip(changes + step, 0, flat.size - 1)] = True
    return np.flatnonzero(near)


def _has_ray(marks: np.ndarray) -> np.ndarray:
    """Which pixels have rays of their own."""
    return (marks & 255) != EdgeMark.NO_RAY
