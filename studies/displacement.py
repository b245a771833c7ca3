"""How far one hit map of a scene lies from another, in pixels of the picture."""

from __future__ import annotations

import math

import numpy as np

from blackhole_gl import planning
from blackhole_gl.physics import observer
from blackhole_gl.rendering.hit_texels import HitArrays
from blackhole_gl.scene import Scene


def displacement_px(scene: Scene, found: HitArrays, exact: HitArrays) -> np.ndarray:
    """(height, width) displacement in pixels.

    Of escape directions where both escape, or of crossings on the disk, as large as they are at their straight distance from the camera,
    whichever is more.
    """
    height = found.fate.shape[0]
    pixel = math.radians(scene.camera.fov_deg) / height
    made = planning.plan(scene)
    edges = made.disk_inner, made.disk_outer
    escaped = (found.fate == 1) & (exact.fate == 1)
    moved = np.where(escaped, np.linalg.norm(found.direction - exact.direction, axis=-1), 0.0)
    for n in range(3):
        a, b = found.crossing[..., n, :], exact.crossing[..., n, :]
        shown = _on_disk(a, *edges) | _on_disk(b, *edges)
        moved = np.maximum(moved, np.where(shown, np.linalg.norm(a - b, axis=-1) / _distance(scene, b), 0.0))
    return moved / pixel


def _distance(scene: Scene, crossing: np.ndarray) -> np.ndarray | float:
    """How far from the camera, in r_s, something at `crossing` (…, 2) is as large as it is seen; for parallel rays what makes a pixel of them."""
    camera = scene.camera
    if math.isinf(camera.distance):
        return 0.5 * camera.field_m / math.radians(camera.fov_deg)
    place = camera.distance * observer.observe(scene).n
    return np.sqrt(np.sum((crossing - place[:2]) ** 2, axis=-1) + place[2] ** 2)


def _on_disk(crossing: np.ndarray, inner: float, outer: float) -> np.ndarray:
    r = np.linalg.norm(crossing, axis=-1)
    return (r >= inner) & (r <= outer)


def beside_an_edge(fate: np.ndarray) -> np.ndarray:
    """Pixels (height, width) that have one of another fate among their eight neighbours."""
    padded = np.pad(fate, 1, mode="edge")
    around = [padded[1 + dy : padded.shape[0] - 1 + dy, 1 + dx : padded.shape[1] - 1 + dx] for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    return np.any([other != fate for other in around], axis=0)
