"""A sky that has not changed is copied, not drawn: the picture stays the same to the bit, and any change of it is seen."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

SIZE = (96, 54)


def _radiance(renderer: Renderer, time: float = 0.0, **changes: object) -> np.ndarray:
    values = {"rays.model": "schwarzschild", "rays.lensing": True, "sky.brightness": 8.0}
    renderer.render(presets.load(["schwarzschild"], {**values, **changes}), time, SIZE)
    return renderer.radiance()


def test_the_kept_sky_is_the_drawn_one(renderer: Renderer) -> None:
    _radiance(renderer, **{"camera.azimuth_deg": 1.0})
    drawn = _radiance(renderer)
    for time in (5.0, 9.0):  # kept from the second frame on, copied in the third; the disk turns
        assert not np.array_equal(_radiance(renderer, time), drawn)
    np.testing.assert_array_equal(_radiance(renderer), drawn)


@pytest.mark.parametrize(
    "change",
    [{"sky.brightness": 2.0}, {"sky.procedural.star_brightness": 3.0}, {"sky.enabled": False}, {"camera.inclination_deg": 75.0}, {"disk.enabled": False}],
)
def test_a_changed_sky_or_view_is_drawn_anew(renderer: Renderer, change: dict[str, object]) -> None:
    for _ in range(3):
        before = _radiance(renderer)
    changed = _radiance(renderer, **change)
    assert not np.array_equal(changed, before)
    _radiance(renderer, **{"camera.azimuth_deg": 1.0})
    np.testing.assert_array_equal(_radiance(renderer, **change), changed)
