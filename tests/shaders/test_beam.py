"""The telescope's beam and the map of brightness, against their formulas in float64."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import ndimage

from blackhole_gl import planning
from blackhole_gl.physics.angular_size import picture_height_uas
from blackhole_gl.rendering.beam import BeamPass, sigma_px
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.rendering.post import PostPass
from blackhole_gl.scene import Scene

SIZE = (208, 121)
FAR = {"camera.distance": math.inf, "camera.field_m": 40.0, "post.beam": True, "post.dither": False}


@pytest.fixture(scope="module")
def renderer(ctx):
    made = Renderer(ctx)
    yield made
    made.release()


def with_sigma(sigma: float, height: int) -> Scene:
    """A scene whose beam has a σ of so many pixels."""
    scene = Scene().with_values(FAR)
    mass = scene.source.mass_suns * sigma_px(scene, height) / sigma
    return scene.with_values({"source.mass_suns": mass})


def texture_of(ctx, radiance: np.ndarray):
    height, width, _ = radiance.shape
    data = np.concatenate([radiance, np.ones((height, width, 1))], -1).astype(np.float16)
    return ctx.texture((width, height), 4, data.tobytes(), dtype="f2")


def ring_and_points() -> np.ndarray:
    """A thin ring, two points of other colours, and nothing else, (h, w, 3)."""
    y, x = np.mgrid[: SIZE[1], : SIZE[0]]
    ring = np.exp(-0.5 * ((np.hypot(x - 100.3, y - 60.2) - 30.0) / 1.5) ** 2)
    light = ring[..., None] * np.array([1.0, 0.5, 0.25])
    light[50, 95], light[77, 131] = (0.0, 8.0, 0.0), (0.0, 0.0, 4.0)
    return light.astype(np.float16).astype(float)


@pytest.mark.parametrize("sigma", [0.4, 1.3, 3.9, 4.1, 7.9, 16.5, 30.0])
def test_the_beam_is_a_gaussian_of_its_width(ctx, renderer, sigma: float) -> None:
    """A thousandth of the peak: what is said of the halved pictures (beam.py)."""
    light = ring_and_points()
    source, beam = texture_of(ctx, light), BeamPass(ctx, renderer.programs)
    inputs = FrameInputs.whole(planning.plan(with_sigma(sigma, SIZE[1])), 0.0, SIZE)
    found = np.frombuffer(beam.blurred(inputs, source).read(), np.float32).reshape(SIZE[1], SIZE[0], 4)[..., :3].astype(float)
    expected = ndimage.gaussian_filter(light, (sigma, sigma, 0.0), mode="nearest", truncate=8.0)
    for channel in range(3):
        error = np.abs(found[..., channel] - expected[..., channel]).max() / expected[..., channel].max()
        assert error < 1e-3, (channel, error)
    beam.release()
    source.release()


def test_width_follows_the_object_and_the_pictures_height() -> None:
    scene = Scene().with_values(FAR)
    pixel_uas = picture_height_uas(scene.camera, scene.source) / 720
    assert sigma_px(scene, 720) * pixel_uas * 2.3548 == pytest.approx(20.0, rel=1e-4)  # digits of √(8 ln 2)
    assert sigma_px(scene, 90) == pytest.approx(sigma_px(scene, 720) / 8.0)
    nearer = scene.with_values({"source.distance_pc": 0.5 * scene.source.distance_pc})
    assert sigma_px(nearer, 720) == pytest.approx(0.5 * sigma_px(scene, 720))


def test_a_plain_sky_stays_plain_to_the_edge(ctx, renderer) -> None:
    source, beam = texture_of(ctx, np.full((SIZE[1], SIZE[0], 3), 0.25)), BeamPass(ctx, renderer.programs)
    inputs = FrameInputs.whole(planning.plan(with_sigma(21.0, SIZE[1])), 0.0, SIZE)
    found = np.frombuffer(beam.blurred(inputs, source).read(), np.float32).astype(float).reshape(-1, 4)[:, :3]
    np.testing.assert_allclose(found, 0.25, rtol=1e-5)  # float32 sums
    beam.release()
    source.release()


def shown(ctx, renderer, radiance: np.ndarray, **post: object) -> np.ndarray:
    """The picture of `radiance` as floats."""
    height, width, _ = radiance.shape
    values = {"post.dither": False, "post.colours": "afmhot", **{f"post.{key}": value for key, value in post.items()}}
    source, target = texture_of(ctx, radiance), ctx.framebuffer([ctx.texture((width, height), 4, dtype="f4")])
    made = PostPass(ctx, renderer.programs)
    made.draw(FrameInputs.whole(planning.plan(Scene().with_values(values)), 0.0, (width, height)), source, target, (0, 0, width, height))
    found = np.frombuffer(target.color_attachments[0].read(), np.float32).reshape(height, width, 4)[..., :3].copy()
    made.release()
    return found


def test_the_map_is_of_brightness_over_the_peak(ctx, renderer) -> None:
    """Its formula in float64. 2e-3: half floats of the light, times the map's slope of up to 4."""
    light = np.linspace(0.0, 7.0, 1000)[None, :, None] * np.ones(3)
    x = np.linspace(0.0, 1.0, 1000)

    def rise(low: float, high: float) -> np.ndarray:
        t = np.clip((x - low) / (high - low), 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t)

    expected = np.stack([1.0 - (1.0 - x) ** 3, rise(0.1, 0.95), np.maximum(2.0 * x - 1.0, 0.0) ** 2], -1)
    np.testing.assert_allclose(shown(ctx, renderer, light)[0], expected, atol=2e-3)


def test_luminance_rises_all_the_way_from_black_to_white(ctx, renderer) -> None:
    code = shown(ctx, renderer, np.linspace(0.0, 1.0, 512)[None, :, None] * np.ones(3))[0].astype(float)
    light = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4) @ np.array([0.2126, 0.7152, 0.0722])
    assert (np.diff(light) >= 0.0).all() and light[0] == 0.0 and light[-1] == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("size", [(1, 1), (7, 5), (8, 8), (65, 9), (640, 3)])
def test_the_brightest_pixel_is_found_wherever_it_is(ctx, renderer, size) -> None:
    light = np.random.default_rng(3).uniform(0.0, 0.5, (size[1], size[0], 3))
    for place in ((0, 0), (size[1] - 1, size[0] - 1)):
        with_peak = light.copy()
        with_peak[place] = 5.0
        code = shown(ctx, renderer, with_peak)
        np.testing.assert_allclose(code[place], 1.0, atol=1e-6)


def test_exposure_glow_curve_and_gamma_leave_the_map_alone(ctx, renderer) -> None:
    light = np.random.default_rng(4).uniform(0.0, 3.0, (40, 60, 3))
    plain = shown(ctx, renderer, light)
    for change in ({"exposure": 3.0}, {"bloom": False}, {"tone_map": "linear"}, {"tone_map": "agx"}, {"gamma": 2.0}):
        np.testing.assert_array_equal(shown(ctx, renderer, light, **change), plain)


def test_a_black_picture_is_black(ctx, renderer) -> None:
    assert shown(ctx, renderer, np.zeros((9, 16, 3))).max() == 0.0


def test_a_view_is_neither_blurred_nor_mapped(renderer) -> None:
    scene = Scene().with_values({"post.view": "g_factor"})
    renderer.render(scene, 0.0, (72, 40))
    plain = renderer.read_rgb8()
    renderer.render(scene.with_values({**FAR, "camera.distance": scene.camera.distance, "post.colours": "afmhot"}), 0.0, (72, 40))
    np.testing.assert_array_equal(renderer.read_rgb8(), plain)
