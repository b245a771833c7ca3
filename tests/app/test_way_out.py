"""What is told where nothing is to be seen."""

import math

import numpy as np
import pytest

from blackhole_gl.app.camera_control import range_by_hand
from blackhole_gl.app.way_out import is_black, out_of_sight
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

SIZE = (320, 180)
PHYSICS = [info.name for info in presets.available() if info.group == "physics"]


def black(renderer: Renderer, scene) -> bool:
    renderer.render_still(scene, 3.0, SIZE, 1)
    return is_black(np.ascontiguousarray(renderer.read_rgb8()))


@pytest.mark.parametrize("name", PHYSICS)
def test_a_hand_that_zooms_never_ends_in_black(renderer: Renderer, name: str) -> None:
    scene = presets.load([name])
    for distance in range_by_hand(scene):
        assert not black(renderer, scene.with_values({"camera.distance": min(distance, 1e4)})), distance


def test_pixels_are_counted_and_not_their_channels() -> None:
    for lit, channels, is_dark in ((4, 3, True), (5, 1, False), (5, 3, False), (0, 1, True), (9_000, 2, False)):
        pixels = np.zeros((10_000, 3), np.uint8)
        pixels[:lit, :channels] = 200
        assert is_black(pixels.ravel()) is is_dark, "five of 10,000 pixels, whatever their colour, are no black picture"


@pytest.mark.parametrize("values", [{"post.exposure": -8.0}, {"disk.enabled": False, "sky.enabled": False}, {"camera.distance": 1.02}])
def test_a_black_picture_is_noticed(renderer: Renderer, values) -> None:
    scene = presets.load(["schwarzschild"])
    assert not black(renderer, scene)
    assert black(renderer, scene.with_values(values))


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({}, ""),
        ({"camera.yaw_deg": 30.0}, ""),
        ({"camera.yaw_deg": 120.0}, "out of sight"),
        ({"camera.pitch_deg": -80.0}, "out of sight"),
        ({"camera.yaw_deg": 120.0, "camera.distance": 1.02}, ""),  # the hole is nearly all of the sky
        ({"camera.distance": 5000.0}, "a dot"),
        ({"camera.distance": math.inf}, ""),
        ({"camera.distance": math.inf, "camera.field_m": 5000.0}, "a dot"),
    ],
)
def test_a_hole_that_is_not_seen_is_told(values, told: str) -> None:
    found = out_of_sight(presets.load(["schwarzschild"]).with_values(values), 16.0 / 9.0)
    assert told in found if told else not found
