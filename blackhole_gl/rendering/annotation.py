"""Labels and colour scales drawn into saved pictures: the window draws its own over them."""

from __future__ import annotations

import numpy as np

from ..scene import Scene
from .views import View


def is_annotated(scene: Scene, view: View | None) -> bool:
    """Whether `annotated` draws anything."""
    return scene.post.labels or (scene.polarization.ticks if view is None else scene.post.legend)


def annotated(pixels: np.ndarray, scene: Scene, view: View | None) -> np.ndarray:
    """`pixels`, (height, width, 3) uint8 with the top row first, with what `scene` asks for in ``post.labels``, ``post.legend`` and
    ``polarization.ticks``.

    Args:
        view: the diagnostic view that they show, with its scale; None for the picture.
    """
    if not is_annotated(scene, view):
        return pixels
    height, width = pixels.shape[:2]
    legend = view if scene.post.legend else None
    ticks = scene.polarization.ticks and view is None
    from . import labels, polarized_disk, scale_bar  # only where something is drawn: most pictures are saved without
    from .sheet import Sheet

    sheet = Sheet(width, height)
    if ticks:
        sheet.labels(polarized_disk.ticks(scene, width / height))
    if scene.post.labels:
        sheet.labels(labels.of(scene, width / height))
        sheet.labels(scale_bar.of(scene, width / height))
    if legend is not None:
        sheet.legend(legend)
    return sheet.over(pixels)
