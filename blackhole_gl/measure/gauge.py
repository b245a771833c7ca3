"""How far a scene's method errs and what it costs on its view, told in a moment: against the most accurate method, by the shader alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .. import listed_rays, planning
from ..physics import observer
from ..planning import choice
from ..rendering.diagnostics import most_accurate
from ..rendering.frame import Renderer
from ..rendering.recording import pixel_direction
from ..scene import Scene
from . import timing
from .errors import compare
from .scenes import NEAR_CRITICAL, from_critical, is_physical

_GRID = (24, 16)  # pixels across and down of which the rays are compared
_SIZE = (192, 108)  # pixels of a timed frame
_TRIALS = 5


@dataclass(frozen=True)
class Gauged:
    """A method on a view.

    Attributes:
        error_px: against the most accurate method at 99 % of the rays, but for those next to the critical curve, as the chart has it; in pixels of a picture
            1080 high. NaN where no ray can be compared, as where the camera is infinitely far away and pixels have no angle.
        wrong_fates: share of rays.
        cost: trace time as a ratio to the flat frame.
    """

    error_px: float
    wrong_fates: float
    cost: float

    def __str__(self) -> str:
        wrong = f", {self.wrong_fates:.1%} of the rays end wrongly" if self.wrong_fates else ""
        return f"{self._error}{wrong}, {self.cost:.1f} flat frames"

    @property
    def _error(self) -> str:
        if not np.isfinite(self.error_px):
            return "no error in pixels"
        if self.error_px == 0.0:
            return "the reference itself"
        return f"{self.error_px:.0f} px off" if self.error_px >= 100.0 else f"{self.error_px:.2g} px off"


def gauging(renderer: Renderer, scene: Scene, aspect: float) -> Iterator[Gauged | None]:
    """Gauges the plan of `scene` in a picture `aspect` times as wide as high, bit by bit: what is found comes last, None before.

    Args:
        renderer: one whose kept hits nobody needs.

    Raises:
        SceneError, ValueError: the scene cannot be traced.
    """
    made, flat = planning.plan(scene), planning.plan(timing.flat_scene(scene))
    for uncounted in (flat, made):
        renderer.time_trace(uncounted, _SIZE)
        yield None
    rays = _rays(scene, aspect)
    truth = listed_rays.trace_by_shader(renderer, most_accurate(made).scene, rays)
    yield None
    found = listed_rays.trace_by_shader(renderer, made.scene, rays)
    yield None
    # Others on the machine only ever add: the least of both, and not the least ratio, which a held-up yardstick would give.
    taken, yardstick = [], []
    for _ in range(_TRIALS):
        yardstick += [renderer.time_trace(flat, _SIZE) for _ in range(2)]
        taken.append(renderer.time_trace(made, _SIZE))
        yield None
    errors = compare(found, truth, _counted(scene, rays))
    error = np.nan if np.isinf(scene.camera.distance) else choice.error_px(scene, errors.direction_99, errors.crossing_r_99)
    yield Gauged(float(error), errors.wrong_fates, min(taken) / min(yardstick))


def _counted(scene: Scene, rays: np.ndarray) -> np.ndarray:
    """Which of `rays` errors are told of, (N,): all where nobody knows where the critical curve is."""
    bends = scene.rays.lensing and is_physical(scene)
    return from_critical(scene, rays) >= NEAR_CRITICAL if bends else np.ones(len(rays), bool)


def _rays(scene: Scene, aspect: float) -> np.ndarray:
    """Rays (N, 2) of `scene`'s picture, as `listed_rays` takes them: a regular grid, each row a little further along, so that none is an axis of symmetry."""
    across, down = _GRID
    size = round(100 * aspect), 100
    places = [((i + (j + 0.5) / down) / across * size[0], (j + 0.4) / down * size[1]) for j in range(down) for i in range(across)]
    local = np.array([pixel_direction(scene, size, place) for place in places]) @ observer.look_rotation(scene.camera).T
    if np.isinf(scene.camera.distance):
        return np.stack([local[:, 2], -local[:, 1]], axis=-1)
    return np.stack(observer.screen_angles(local), axis=-1)
