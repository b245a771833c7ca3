"""The lens over the finished picture: its formula in NumPy on the same picture, and the ray model of the same formula."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.planning import plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene

SIZE = (160, 90)
FLAT = {
    "rays.model": "flat", "rays.edges": 1, "hole.spin": 0.0, "disk.enabled": False, "camera.distance": 20.0, "camera.fov_deg": 60.0, "camera.azimuth_deg": 40.0,
    "post.tone_map": "linear", "post.bloom": False, "post.dither": False, "sky.procedural.galaxy_brightness": 20.0, "sky.procedural.star_brightness": 0.0,
}  # fmt: skip


def light_of(code: np.ndarray) -> np.ndarray:
    """Light of sRGB codes 0…255."""
    share = code / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def place_of_hole(scene: Scene, size: tuple[int, int]) -> tuple[np.ndarray, float]:
    """Pixel of the hole, rows from the bottom, and the width of a pixel on a screen at distance 1; for a camera that is turned by yaw alone."""
    pixel = 2.0 * np.tan(np.radians(0.5 * scene.camera.fov_deg)) / size[1]
    return np.array([0.5 * size[0] - np.tan(np.radians(scene.camera.yaw_deg)) / pixel, 0.5 * size[1]]), pixel


def displaced(picture: np.ndarray, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """The formula on `picture` (rows from the bottom), bilinear, its edge beyond it; and the distance from the hole on a screen at distance 1."""
    height, width = picture.shape[:2]
    hole, pixel = place_of_hole(scene, (width, height))
    y, x = np.mgrid[0:height, 0:width] + 0.5
    offset = np.stack([x, y], axis=-1) - hole
    rho = np.linalg.norm(offset, axis=-1) * pixel
    factor = 1.0 - 2.0 * scene.post.lens_radius / (rho * np.sqrt(scene.camera.distance)) ** 2
    at = np.clip(hole + offset * factor[..., None] - 0.5, 0.0, [width - 1.0, height - 1.0])
    low = np.minimum(np.floor(at).astype(int), [width - 2, height - 2])
    (u, v), (i, j) = np.moveaxis(at - low, -1, 0)[..., None], np.moveaxis(low, -1, 0)
    lower = (1.0 - u) * picture[j, i] + u * picture[j, i + 1]
    upper = (1.0 - u) * picture[j + 1, i] + u * picture[j + 1, i + 1]
    return (1.0 - v) * lower + v * upper, rho


@pytest.mark.parametrize("radius, yaw", [(1.0, 0.0), (0.3, 0.0), (3.0, 0.0), (1.0, 17.0)])
def test_the_picture_is_that_of_the_formula(ctx, radius: float, yaw: float) -> None:
    renderer = Renderer(ctx)
    scene = Scene().with_values({**FLAT, "post.lens": True, "post.lens_radius": radius, "post.lens_shadow": 0.0, "camera.yaw_deg": yaw})
    renderer.render(scene, 0.0, SIZE)
    before, shown = renderer.radiance()[::-1].astype(float), renderer.read_rgb8()[::-1].astype(float)
    expected, rho = displaced(before, scene)
    assert before.std() > 0.05 and np.abs(expected - before).max() > 0.1, "there is something to displace"
    # Half a code of 8 bits, and texture coordinates that filters know to 1/256 of a texel, of slopes to 0.3 a texel.
    off = np.abs(light_of(shown) - np.clip(expected, 0.0, 1.0))
    assert np.quantile(off, 0.999) < 0.006 and off.max() < 0.03
    renderer.release()


def test_without_the_switch_nothing_is_displaced_and_from_infinity_neither(ctx) -> None:
    renderer = Renderer(ctx)
    for values in ({}, {"camera.distance": np.inf}):
        plain = Scene().with_values({**FLAT, **values})
        renderer.render(plain, 0.0, SIZE)
        before = renderer.read_rgb8()
        renderer.render(plain.with_values({"post.lens": bool(values)}), 0.0, SIZE)
        np.testing.assert_array_equal(renderer.read_rgb8(), before)
    renderer.release()


def test_over_a_flat_sky_it_is_the_ray_model_of_the_same_formula(ctx) -> None:
    """Inside half the Einstein ring what is shown is beyond the picture's edge, which a ray sees and a picture does not."""
    renderer = Renderer(ctx)
    lens = {"post.lens": True, "post.lens_shadow": 2.598}
    renderer.render(Scene().with_values({**FLAT, **lens}), 0.0, (320, 180))
    over = light_of(renderer.read_rgb8().astype(float))
    renderer.render(Scene().with_values({**FLAT, "rays.model": "screen_lens"}), 0.0, (320, 180))
    rays = light_of(renderer.read_rgb8().astype(float))
    scene = Scene().with_values({**FLAT, **lens})
    _, rho = displaced(np.zeros((180, 320, 1)), scene)
    outside = rho > 0.9 * np.sqrt(2.0 / 20.0)
    assert np.median(np.abs(over - rays)[outside]) < 0.004  # a code of 8 bits
    assert np.quantile(np.abs(over - rays)[outside], 0.98) < 0.05  # the galaxy's finest detail, filtered before it is displaced or after
    hole = rho < 0.95 * 2.598 / 20.0
    assert over[hole].max() == 0.0 and rays[hole].max() == 0.0
    renderer.release()


def test_the_line_is_where_the_plan_says_that_the_ring_is(ctx) -> None:
    scene = Scene().with_values({**FLAT, "post.lens": True, "post.lens_ring": True, "sky.enabled": False, "post.lens_radius": 1.5})
    renderer = Renderer(ctx)
    renderer.render(scene, 0.0, SIZE)
    green = renderer.read_rgb8()[..., 1]
    _, rho = displaced(np.zeros((SIZE[1], SIZE[0], 1)), scene)
    ring = np.sqrt(2 * 1.5 / 20.0)
    _, pixel = place_of_hole(scene, SIZE)
    assert green[np.abs(rho - ring) < 0.4 * pixel].min() > 200 and green[np.abs(rho - ring) > 1.6 * pixel].max() == 0
    assert f"an Einstein ring of {np.degrees(np.arctan(ring)):.3g}°" in plan(scene).reasons[-1]
    renderer.release()


def test_stars_are_displaced_with_the_rest_of_a_coarse_picture(ctx) -> None:
    """They are not drawn apart then."""
    renderer = Renderer(ctx)
    scene = Scene().with_values({**FLAT, "post.lens": True, "sky.procedural.star_brightness": 20.0})
    renderer.render(scene, 0.0, SIZE, shown=(2 * SIZE[0], 2 * SIZE[1]))
    light = renderer.radiance()
    renderer.render(scene, 0.0, SIZE)
    np.testing.assert_array_equal(renderer.radiance(), light)
    renderer.release()
