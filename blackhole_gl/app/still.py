"""A picture of any size and any number of rays, made between the window's frames. No imgui here."""

from __future__ import annotations

import time as clock
from collections.abc import Generator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..output import png
from ..rendering import still_files
from ..rendering.annotation import annotated, is_annotated
from ..rendering.views import View
from ..scene import Scene, presets
from .divided import RightSide, joined

TILE = 128
"""Side of its tiles in pixels: one with a ray a pixel takes some tens of milliseconds on a software renderer."""

_FRAME_SHARE_S = 0.04  # of a frame, after which no further tile is begun


@dataclass(frozen=True)
class Order:
    """What is to be made.

    Attributes:
        time: scene time in r_s/c.
        size: (width, height) in pixels.
        samples: rays a pixel along each axis.
        path: where it goes.
        right: what stands right of a divider; None without one. The file opens as the left side.
    """

    scene: Scene
    time: float
    size: tuple[int, int]
    samples: int
    path: Path
    right: RightSide | None = None


class Still:
    """One picture on its way. It has a renderer of its own, so that the window's keeps its hit map.

    Attributes:
        share: how much of it is drawn, 0…1.
        failure: why there is none, or empty.
    """

    def __init__(self, renderer: Any, order: Order):
        self.order, self.share, self.failure = order, 0.0, ""
        self._renderer = renderer
        self._sides = [order.scene] if order.right is None else [order.scene, order.right.scene]
        self._drawn: list[np.ndarray] = []
        self._drawing = self._draw_sides()
        self._writer = ThreadPoolExecutor(1)  # a large picture takes seconds to compress
        self._written: Future | None = None

    @property
    def is_over(self) -> bool:
        """Whether the file is written, or has failed."""
        return bool(self.failure) or self._written is not None and self._written.done()

    def advance(self) -> None:
        """Goes on for a part of a frame. Its longest part is one tile; the programs are compiled before the first, and the last is followed by the bloom."""
        if self.is_over or self._written is not None:
            return
        began = clock.perf_counter()
        try:
            while clock.perf_counter() - began < _FRAME_SHARE_S:
                if self._draw():
                    self._written = self._writer.submit(self._write, self._renderer.view_of(self.order.scene))
                    return
        except Exception as error:  # whatever the renderer cannot do: too large a picture, say
            self.failure = str(error) or type(error).__name__

    def result(self) -> str:
        """What the user is told, once it is over.

        Raises:
            OSError: the file cannot be written.
        """
        if self.failure:
            raise OSError(self.failure)
        if self._written is not None:
            self._written.result()
        return f"Saved {self.order.path}"

    def close(self) -> None:
        """Gives all back; what is being written is still written."""
        self._drawing.close()
        self._renderer.release()
        self._writer.shutdown()

    def _draw_sides(self) -> Generator[float]:
        """Yields the share that is drawn. What nothing is drawn over goes into its file meanwhile, so that no more than some bands of it are held."""
        order = self.order
        if order.right is None and not is_annotated(order.scene, self._renderer.view_of(order.scene)):
            yield from still_files.write(self._renderer, order.path, order.scene, order.time, order.size, order.samples, TILE)
            return
        for side in self._sides:
            for share in self._renderer.still(side, order.time, order.size, order.samples, TILE):
                yield (len(self._drawn) + share) / len(self._sides)
            self._drawn.append(self._renderer.read_rgb8())

    def _draw(self) -> bool:
        """Draws one tile with one ray a pixel; whether that was the last."""
        share = next(self._drawing, None)
        self.share = 1.0 if share is None else share
        return share is None

    def _write(self, view: View | None) -> None:
        order = self.order
        if not self._drawn:
            return  # it is
        pixels = self._drawn[0] if order.right is None else joined(self._drawn[0], self._drawn[1], order.right.share)
        png.write(order.path, annotated(pixels, order.scene, view), presets.picture_text(order.scene, order.time, order.path.absolute().parent))
