"""Which pixels of a hit map one ray is too few for: those within or beside which the fate, the order or what is met changes, or that
lie at the rim of a field's sphere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce

import moderngl
import numpy as np

from .boxes import NOWHERE, Box, grown, inside, joined
from .classes import OPEN_THINGS, THINGS, drawn, own_rays
from .edge_marks import BESIDE, MarkedSquares, shown_in_cells
from .hit_map import AS_SHARP, HitMap
from .inputs import FrameInputs
from .programs import Programs
from .sorting import PixelSorting, marks_target, set_hiding
from .target import Target


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
            pixels, beside = self._find(inputs, hit_map, outlines, grown(within, BESIDE, inputs.size))
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
        found = MarkedSquares.of(marks).edges(corners=inputs.plan.is_inside)
        pixels = found.pixels + box[:2]
        if not inputs.plan.meetings:
            return pixels, np.zeros(len(pixels), bool)
        beside = found.beside_things()
        if outlines:
            return pixels, beside
        kept = ~found.at_plain_outlines()
        if not inputs.plan.model.traits.field:
            kept |= ~beside
        return pixels[kept], beside[kept]

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
