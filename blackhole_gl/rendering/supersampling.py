"""A picture at rest, drawn again and again with rays through other places of its pixels: the mean has no jagged edges and no dotted rings."""

from __future__ import annotations

import moderngl
import numpy as np

MOST_SAMPLES = 17
"""Pictures in a mean: one through the pixels' middles, and eight pairs to both sides of it, so that the mean lies where the first does."""

# Columns and rows of the cells, of four by four in a pixel, that a pair's first place lies in; its second lies across the middle.
_CELLS = (0, 1), (1, 3), (1, 0), (0, 2), (0, 3), (1, 1), (0, 0), (1, 2)


def place(count: int) -> tuple[float, float]:
    """Where in its pixel the ray of picture `count` (from 0) goes, −½…½ each way from the middle; the first goes through the middle.

    All others lie in cells of their own, and in rows and columns of their own when cells are cut in four again.
    """
    if count == 0:
        return 0.0, 0.0
    column, row = _CELLS[(count - 1) // 2]
    side = 1.0 if count % 2 else -1.0
    return side * ((4 * column + row + 0.5) / 16.0 - 0.5), side * ((4 * row + 3 - column + 0.5) / 16.0 - 0.5)


class Mean:
    """The mean radiance of the pictures added so far.

    Attributes:
        of: what the pictures show; a picture of anything else begins a new mean.
        count: how many have been added.
    """

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self._total: np.ndarray | None = None
        self._texture: moderngl.Texture | None = None
        self.of: object = None
        self.count = 0

    def begin(self, of: object) -> None:
        """Forgets all pictures unless they are `of` the same."""
        if of != self.of:
            self.of, self.count, self._total = of, 0, None

    @property
    def texture(self) -> moderngl.Texture:
        """The mean as RGBA16F; that of whole pairs, as one of a pair alone would move the picture. Something has to have been added."""
        assert self._texture is not None
        return self._texture

    def add(self, radiance: np.ndarray) -> None:
        """Adds `radiance`, float32 (height, width, 4), row 0 at the bottom."""
        self._total = radiance.copy() if self._total is None else np.add(self._total, radiance, out=self._total)
        self.count += 1
        height, width = radiance.shape[:2]
        if self._texture is None or self._texture.size != (width, height):
            self.release()
            self._texture = self._ctx.texture((width, height), 4, dtype="f2")
        if self.count % 2:
            self._texture.write((self._total * np.float32(1.0 / self.count)).astype(np.float16).tobytes())

    def release(self) -> None:
        """Gives the GL object back."""
        if self._texture is not None:
            self._texture.release()
        self._texture = None
