"""The light curve of a scene: the sum of its picture's light, scene time by scene time.

Of a hot spot it has one peak for the direct image and one for each ring, by how the spot's light is bent and beamed on its way, and with ``rays.light_travel``
by when it arrives: the way from the far side is longer (Broderick & Loeb 2005, MNRAS 363, 353; Hamaus et al. 2009, ApJ 692, 902).
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from .. import planning
from ..physics import hot_spot, motion, shear
from ..rendering.frame import Renderer
from ..scene import Scene, SceneError, met
from ..scene.schema import number_of
from ..shapes import Float
from .flux import pixel_angles

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
"""Of red, green and blue in the luminance (Rec. 709)."""


@dataclass(frozen=True)
class LightCurve:
    """Light against time.

    Attributes:
        time: scene time in r_s/c, (T,), rising.
        colours: (T, 3): red, green and blue radiance times solid angle, in sr, or in M² for a camera at infinity.
    """

    time: Float[np.ndarray, " T"]
    colours: Float[np.ndarray, "T 3"]

    @property
    def flux(self) -> Float[np.ndarray, " T"]:
        """Luminance times solid angle."""
        return self.colours @ WEIGHTS

    @property
    def relative(self) -> Float[np.ndarray, " T"]:
        """`flux` over its mean; 0 where nothing shines."""
        return self.flux / (self.flux.mean() or 1.0)

    def as_csv(self) -> str:
        """A row a time: time, flux, flux over its mean, and the three colours."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["time", "flux", "relative", "red", "green", "blue"])
        for row in zip(self.time, self.flux, self.relative, *self.colours.T, strict=True):
            writer.writerow([f"{value:.9g}" for value in row])
        return text.getvalue()


def turn(scene: Scene) -> float:
    """How long what moves takes for one turn, in r_s/c: the hot spot; else the first thing or medium on an orbit; else the life of the disk's patterns."""
    if scene.disk.enabled and scene.get("disk.hot_spot"):
        rays, disk = scene.rays, scene.disk
        place = hot_spot.place(number_of(scene.get("disk.hot_spot.radius")), 0.0, disk.orbit, disk.tilt_deg, scene.hole.spin, rays.model, rays.lensing, 0.0)
        return 2.0 * math.pi / abs(place[3])
    where = planning.plan(scene).space_time
    for slot in met.SLOTS:
        for mover in motion.movers(scene, slot):
            speed = float(np.linalg.norm((here := motion.of(mover.instance, mover.traits, where, 0.0)).velocity))
            if speed > 0.0:
                return 2.0 * math.pi * float(np.linalg.norm(here.centre)) / speed
    return shear.RENEWAL_PERIOD


def times(scene: Scene, count: int, start: float = 0.0, duration: float = 0.0) -> Float[np.ndarray, " count"]:
    """`count` scene times at equal steps from `start` on, over a `duration` in r_s/c; 0: over one `turn`, whose end is left out as it is its beginning."""
    return start + (duration or turn(scene)) * np.arange(count) / count


def refuse(scene: Scene) -> None:
    """Raises SceneError where the picture of `scene` is no light."""
    if scene.post.view != "picture":
        raise SceneError("post.view", f"got {scene.post.view!r}, whose colours are no light; allowed for a light curve is picture")


def measure(
    renderer: Renderer, scene: Scene, when: Float[np.ndarray, " T"], size: tuple[int, int], progress: Callable[[float], None] = lambda _: None
) -> LightCurve:
    """The light curve of `scene` at the scene times `when`, from pictures of `size` (width, height) pixels, without the sky.

    Raises:
        SceneError: the picture is no light, or cannot be drawn.
    """
    curve = LightCurve(np.zeros(0), np.zeros((0, 3)))
    for part in in_parts(renderer, scene, when, size):
        curve = part
        progress(len(curve.time) / len(when))
    return curve


def in_parts(renderer: Renderer, scene: Scene, when: Float[np.ndarray, " T"], size: tuple[int, int]) -> Iterator[LightCurve]:
    """As `measure`, the curve as far as it is known after each time."""
    refuse(scene)
    dark = scene.with_values({"sky.enabled": False})
    angles, colours = pixel_angles(scene.camera, size), []
    for number, time in enumerate(when):
        renderer.render(dark, float(time), size)
        colours.append(np.einsum("ij,ijc->c", angles, renderer.radiance().astype(float)))
        yield LightCurve(np.asarray(when[: number + 1], float), np.array(colours))
