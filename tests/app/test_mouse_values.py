"""What is told of the pixel under the mouse."""

import math

import pytest

from blackhole_gl.app.mouse_values import lines
from blackhole_gl.glsl.declared import Fate
from blackhole_gl.rendering.pixel_values import OnDisk, PixelValues

DISK = OnDisk(1, 3.25, -0.5, 0.81234, 4100.4)


@pytest.mark.parametrize(
    "values, told",
    [
        (
            PixelValues(Fate.ESCAPED, -2.5, 7.25, math.nan, None, DISK, (1.2, 0.4), ""),
            ["disk: first ring (n = 1)", "r = 3.25 r_s   φ = -28.6°", "g = 0.8123   T = 4100 K"]
            + ["behind it: sky, θ = 68.75°   φ = 22.92°", "λ = -2.5 M   Q = 7.25 M²"],
        ),
        (PixelValues(Fate.CAPTURED, 1.0, 2.0, 5.19615, None, None, None, ""), ["the hole", "λ = 1 M   b = 5.196 M"]),
        (PixelValues(Fate.ESCAPED, math.nan, math.nan, math.nan, None, None, (0.0, 0.0), ""), ["sky, θ = 0.00°   φ = 0.00°"]),
        (
            PixelValues(Fate.MET, 1.0, 2.0, math.nan, (3.0, -4.0), None, None, "Annulus"),
            ["meets Annulus, which ends it", "λ = 1 M   Q = 2 M²", "α = 3 M   β = -4 M"],
        ),
    ],
)
def test_lines_say_what_there_is(values: PixelValues, told: list[str]) -> None:
    assert lines(values) == told
