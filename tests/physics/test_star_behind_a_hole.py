"""A star that passes behind a hole far away: its images' light together is a point lens's, in the picture as it is drawn."""

from __future__ import annotations

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest

from blackhole_gl.measure.flux import pixel_angles
from blackhole_gl.rendering import star_index
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.star_catalogue import Stars
from blackhole_gl.scene import presets

DISTANCE = 1000.0  # r_s
EINSTEIN = np.sqrt(2.0 / DISTANCE)  # rad, of a star at infinity
SIZE = (640, 640)
FIELD = 6.0 * EINSTEIN
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@pytest.fixture
def lone(ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch) -> Iterator[Renderer]:
    """A renderer of a sky with one star, towards +x."""
    dark = np.zeros((6, star_index.TILE, star_index.TILE, 3))
    index = star_index.index(Stars(np.array([[1.0, 0.0, 0.0]]), np.array([0.1]), np.array([6000.0])), dark)
    monkeypatch.setattr(star_index, "_shipped", lambda: index)
    made = Renderer(ctx)
    yield made
    made.release()


@pytest.mark.parametrize("model", ["schwarzschild_table", "screen_lens"])
def test_its_light_is_a_point_lenss(lone: Renderer, model: str) -> None:
    """μ = (u² + 2)/(u √(u² + 4)) within 1 %: both images' sum has no term of first order in M/b beyond it (Keeton & Petters 2005), the second is of 1e-3."""
    values = {"camera.distance": DISTANCE, "camera.azimuth_deg": 180.0, "camera.inclination_deg": 90.0, "camera.fov_deg": np.degrees(FIELD)}
    sky = {"sky.model": "catalogue", "sky.catalogue.star_size": 1e-5, "sky.catalogue.frequency_shift": False, "sky.catalogue.roll_deg": 0.0}
    scene = presets.load(["schwarzschild"], {**values, **sky, "disk.enabled": False, "rays.model": model})

    def light(u: float, lensed: bool = True) -> float:
        lone.render(scene.with_values({"sky.catalogue.yaw_deg": float(np.degrees(u * EINSTEIN)), "rays.lensing": lensed}), 0.0, SIZE)
        return float((lone.radiance().astype(float) @ LUMINANCE * pixel_angles(scene.camera, SIZE)).sum())

    plain = light(2.0, lensed=False)
    assert plain == pytest.approx(0.1 * 1.2e-4, rel=0.01)
    for u in (0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0):
        assert light(u) / plain == pytest.approx((u * u + 2.0) / (u * np.sqrt(u * u + 4.0)), rel=0.01), u
