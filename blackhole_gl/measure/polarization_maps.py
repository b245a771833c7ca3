"""Maps of the polarization of a picture, pixel by pixel, and the few numbers that are told of them."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..physics.observer import observe
from ..planning import plan as make_plan
from ..rendering import labels
from ..rendering.polarized_disk import Stokes, directions_at, stokes, why_not
from ..scene import Scene, SceneError
from ..shapes import Float

_BATCH = 16384  # rays at a time: what is worked out on the way takes 24 numbers of each, many times over


@dataclass(frozen=True)
class PolarizationMaps:
    """I, Q and U of a picture, top row first.

    Attributes:
        stokes: float64 (height, width): `Stokes`.
        hole: (right, down) of the hole's place, in pixels from the top left corner.
    """

    stokes: Stokes
    hole: tuple[float, float]

    @property
    def net(self) -> tuple[float, float]:
        """The polarized share of all light together, and its position angle in degrees, from up counter-clockwise, −90 … 90."""
        total = Stokes(*(np.array(part.sum()) for part in (self.stokes.i, self.stokes.q, self.stokes.u)))
        return float(total.polarized / total.i), float(np.degrees(total.angle))

    @property
    def mean_share(self) -> float:
        """The polarized share, averaged over the light."""
        return float(self.stokes.polarized.sum() / self.stokes.i.sum())

    @property
    def beta_2(self) -> complex:
        """`beta_2_about` the hole."""
        return self.beta_2_about(self.hole)

    def beta_2_about(self, centre: tuple[float, float]) -> complex:
        """Σ (Q + iU) e^{−2iφ} / Σ I with φ, too, from up counter-clockwise about `centre` (as `hole`): 1 for light polarized outwards, −1 round, ±i for
        spirals (Palumbo, Wong & Prather 2020), times the polarized share."""
        height, width = self.stokes.i.shape
        x, y = np.meshgrid(np.arange(width) + 0.5 - centre[0], centre[1] - np.arange(height) - 0.5)
        turn = np.exp(-2j * np.arctan2(-x, y))
        return complex(((self.stokes.q + 1j * self.stokes.u) * turn).sum() / self.stokes.i.sum())

    def through(self, blur: Callable[[Float[np.ndarray, "h w"]], Float[np.ndarray, "h w"]]) -> PolarizationMaps:
        """The maps with each of I, Q and U through `blur`."""
        return replace(self, stokes=Stokes(*(blur(part) for part in (self.stokes.i, self.stokes.q, self.stokes.u))))

    def as_npz(self) -> bytes:
        """A NumPy archive of I, Q and U."""
        data = io.BytesIO()
        np.savez_compressed(data, I=self.stokes.i, Q=self.stokes.q, U=self.stokes.u)
        return data.getvalue()


def measure(scene: Scene, size: tuple[int, int], progress: Callable[[float], None] | None = None) -> PolarizationMaps:
    """The maps of a picture of `scene` of `size` (width, height), by a ray through the middle of each pixel.

    Raises:
        SceneError: the polarization of such a scene is not known, or no light of its disk arrives.
        ValueError: the scene cannot be drawn.
    """
    plan, observer, (width, height) = make_plan(scene), observe(scene), size
    if why := why_not(plan):
        raise SceneError("polarization", why)
    x, y = np.meshgrid((np.arange(width) + 0.5) / height, (np.arange(height) + 0.5) / height)
    directions = directions_at(observer, scene, width / height, np.stack([x.ravel(), y.ravel()], axis=-1))
    parts = []
    for first in range(0, len(directions), _BATCH):
        parts.append(stokes(plan, observer, directions[first : first + _BATCH]))
        if progress is not None:
            progress(min(first + _BATCH, len(directions)) / len(directions))
    found = Stokes(*(np.concatenate([getattr(part, name) for part in parts]).reshape(height, width) for name in ("i", "q", "u")))
    if not found.i.any():
        raise SceneError("disk", "no light of the disk arrives at the camera")
    hole = labels.places(observer, scene, width / height, observer.hole)
    return PolarizationMaps(found, (float(hole[0]) * height, float(hole[1]) * height))


