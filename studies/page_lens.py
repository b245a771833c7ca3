"""The part of docs/accuracy.md on the screen-space lens by distance."""

from __future__ import annotations

import math
from collections.abc import Sequence

from studies.lens_by_distance import LensError
from studies.table import short


def lens_section(found: Sequence[LensError]) -> str:
    """A row a distance, a column an angle of view."""
    views = list(dict.fromkeys(item.fov_deg for item in found))
    lines = [
        "## Screen-space lens by distance",
        "",
        "How far `screen_lens` shows the sky from where light in Schwarzschild has it, for a static observer: pixels of a picture 1080 high,",
        "1,500 rays, both by the float64 twins. Given are the median, the value that 99 % keep, and in brackets what the plan expects of that.",
        "",
        "| distance [r_s] | " + " | ".join(f"view {view:g}°: median | 99 % (expected)" for view in views) + " |",
        "| --- |" + " --- | --- |" * len(views),
    ]
    for distance in dict.fromkeys(item.distance for item in found):
        row = [item for item in found if item.distance == distance]
        cells = [f"{short(item.median_px)} | {short(item.most_px)} ({'–' if math.isinf(item.expected_px) else short(item.expected_px)})" for item in row]
        lines.append(f"| {distance:g} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + _REMARK


_REMARK = """

The expectation is a closed form ([physics.md](physics.md#the-screen-space-lens)): near the hole the next orders of the deflection,
15π/16 b² + 16/(3 b³), which fall as 1/D² and 1/D³ for a given share of the picture; at the picture's edge what a flat observer and a flat screen
are off by, which falls as 1/D. There is none (–) where a per cent of the picture and more lies within twice the shadow's radius. The plan takes the
lens, the cheapest of all, where this is within `rays.tolerance`, the sky is all there is to show, and the camera is 510 r_s away or more, from where
the blue shift that it lacks changes nothing by 1/255. A spin a* adds |a*|/b².
"""
