"""Curves on the screen as a table: the critical curve, and circles of the disk's plane by order of image."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence

from ..physics import angular_size, screen_curves
from ..physics.screen_curves import ScreenCurve
from ..scene import Scene, lengths

_COLUMNS = ("curve", "radius_{radius}", "order", "angle", "alpha_{screen}", "beta_{screen}", "alpha_uas", "beta_uas", "x_px", "y_px")
_NAMES = {"r_s": "rs", "M": "m"}  # of units, in columns'


def measured(scene: Scene, radii: Sequence[float], orders: Sequence[int], samples: int) -> list[ScreenCurve]:
    """The critical curve, then each circle of `radii` (r_s) by each of `orders`.

    Raises:
        SceneError: the scene has no hole, or a radius or an order is out of range.
    """
    edge = screen_curves.critical_curve(scene, samples)
    return [edge, *(screen_curves.isoradials(scene, radii, orders, samples) if radii and orders else ())]


def as_csv(found: Sequence[ScreenCurve], scene: Scene, size: tuple[int, int], unit: str | None = None) -> str:
    """A row a point: lengths right and up of the hole in M, in µas where `scene` stands for a real object, and pixels of a picture of `size` from the outer
    corner of its top left one; radii in r_s. `unit`, one of `lengths.UNITS`: that of all lengths instead. What there is not is left empty."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    radial, across = unit or "r_s", unit or "M"
    writer.writerow([name.format(radius=_NAMES[radial], screen=_NAMES[across]) for name in _COLUMNS])
    of_rs, of_m = lengths.factor(radial), lengths.factor(across) / lengths.factor("M")
    told = angular_size.is_told(scene)
    for curve in found:
        pixels = curve.in_pixels(scene, size)
        angles = curve.in_uas(scene) if told else (math.nan + curve.alpha, math.nan + curve.beta)
        about = [curve.kind, _number(of_rs * curve.radius), curve.order if curve.order >= 0 else ""]
        for values in zip(curve.angle, of_m * curve.alpha, of_m * curve.beta, *angles, *pixels):
            writer.writerow([*about, *(_number(value) for value in values)])
    return text.getvalue()


def _number(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.12g}"
