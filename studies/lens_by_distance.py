"""The screen-space lens by distance: how far it shows the sky from where light in Schwarzschild has it, beside what the plan expects."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from blackhole_gl import listed_rays
from blackhole_gl.measure.errors import angles_between
from blackhole_gl.measure.scenes import FULL_HD, ChartScene
from blackhole_gl.planning import thin_lens
from blackhole_gl.scene import Scene

DISTANCES = (30.0, 100.0, 300.0, 1000.0, 3000.0, 10000.0)
VIEWS = (10.0, 40.0, 90.0)
QUICK_DISTANCES = DISTANCES[1::2]


@dataclass(frozen=True)
class LensError:
    """Errors of the sky's place in pixels of a picture 1080 high, over rays that both let through.

    Attributes:
        distance, fov_deg: of the camera, r_s and degrees.
        median_px, most_px: measured, by the float64 reference; the second at 99 % of the rays.
        expected_px: at 99 %, by the closed form that the plan goes by; infinite where that says nothing.
    """

    distance: float
    fov_deg: float
    median_px: float
    most_px: float
    expected_px: float


COLUMNS = tuple(LensError.__dataclass_fields__)


def by_distance(quick: bool = False) -> list[LensError]:
    """The errors at every distance, for every angle of view."""
    return [_measured(distance, view) for view in VIEWS for distance in (QUICK_DISTANCES if quick else DISTANCES)]


def sky_alone(distance: float, fov_deg: float) -> Scene:
    """A hole without spin at `distance` in r_s before its sky, and nothing else."""
    return Scene().with_values({"disk.enabled": False, "camera.distance": distance, "camera.fov_deg": fov_deg})


def _measured(distance: float, fov_deg: float) -> LensError:
    item = ChartScene("lens", sky_alone(distance, fov_deg))
    rays = item.rays[: item.count]  # without those about the critical curve, which are no sample of the picture
    shown, true = (listed_rays.trace_by_reference(item.scene.with_values({"rays.model": model}), rays) for model in (thin_lens.MODEL, "schwarzschild"))
    off = angles_between(shown, true) / item.pixel
    return LensError(distance, fov_deg, float(np.nanmedian(off)), float(np.nanquantile(off, 0.99)), thin_lens.error_px(item.scene, FULL_HD))
