"""The shaded disk in whole small pictures: switches, edges, the bright side, and no pixel that is not a number."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene

SIZE = (160, 90)
PLAIN = {"disk.turbulence": False, "sky.enabled": False, "hole.spin": 0.6}


@pytest.fixture(scope="module")
def renderer(ctx):
    made = Renderer(ctx)
    yield made
    made.release()


@pytest.fixture(scope="module")
def light(renderer):
    """Scene values → radiance (90, 160, 3), top row first."""

    def run(time: float = 0.0, size: tuple[int, int] = SIZE, **values) -> np.ndarray:
        renderer.render(Scene().with_values({**PLAIN, **{key.replace("__", ".", 1): value for key, value in values.items()}}), time, size)
        return renderer.radiance().astype(float)

    return run


def sides(image: np.ndarray) -> tuple[float, float]:
    """Light of the left and of the right half."""
    middle = image.shape[1] // 2
    return float(image[:, :middle].sum()), float(image[:, middle:].sum())


@pytest.mark.parametrize("law", ["exact", "s0", "s1"])
def test_the_approaching_side_is_the_bright_one(light, law: str) -> None:
    """Matter that turns counter-clockwise seen from above approaches on the left, and the other way round for a < 0."""
    left, right = sides(light(disk__frequency_shift=law, hole__spin=0.0))
    assert left > 1.5 * right
    left, right = sides(light(disk__frequency_shift=law, hole__spin=-0.5))
    assert right > 1.5 * left


def test_mirrored_holes_give_mirrored_pictures(light) -> None:
    """a → −a mirrors everything. Footprints are taken in blocks of two pixels, which an even width mirrors too; half floats: 2e-3."""
    np.testing.assert_allclose(light(hole__spin=-0.6), light(hole__spin=0.6)[:, ::-1], rtol=5e-3, atol=5e-3)


def test_white_light_has_the_luminance_of_the_black_bodies(light) -> None:
    """The fits of the colours keep luminance 1 but for the six digits of their weights; both are half floats, good to 1e-3."""
    coloured, white = light(), light(disk__colour="white")
    assert np.all(white == white[..., :1])
    assert np.any(coloured[..., 0] > 1.5 * coloured[..., 2])
    np.testing.assert_allclose(coloured @ (0.2126, 0.7152, 0.0722), white[..., 0], rtol=2e-3, atol=1e-4)


def test_switches_act_on_what_they_say(light) -> None:
    """Without beaming, Doppler colour and redshift both sides shine alike; each alone makes them differ or dims."""
    off = dict(disk__beaming=False, disk__doppler_colour=False, disk__redshift=False, hole__spin=0.0)
    even = light(**off)
    left, right = sides(even)
    assert left == pytest.approx(right, rel=5e-3)
    left, right = sides(light(**{**off, "disk__beaming": True}))
    assert left > 1.5 * right
    coloured = light(**{**off, "disk__doppler_colour": True})
    middle = SIZE[0] // 2
    blueness = [float(half[..., 2].sum() / half[..., 0].sum()) for half in (coloured[:, :middle], coloured[:, middle:])]
    assert blueness[0] > 1.2 * blueness[1]
    assert light(**{**off, "disk__redshift": True}).sum() < 0.9 * even.sum()


def test_exponent_zero_leaves_brightness_alone(light) -> None:
    left, right = sides(light(hole__spin=0.0, disk__beaming_exponent=0.0)[..., 1:2])
    assert left == pytest.approx(right, rel=0.25)  # colour still differs: green is only most of the luminance


def test_edges_are_soft(light) -> None:
    """A picture of few pixels has the light of one of many: the disk's edge covers parts of pixels. 3 %: hit map of 80 × 45."""
    facts = dict(disk__temperature_law="shakura_sunyaev", disk__beaming=False, disk__outer_radius=6.0)
    coarse, fine = light(size=(80, 45), **facts), light(size=(640, 360), **facts)
    assert coarse.mean() == pytest.approx(fine.mean(), rel=0.03)


def test_opaque_disks_hide_and_additive_ones_add(light) -> None:
    additive, clear, opaque = (light(disk__compositing=c, disk__opacity=o).sum() for c, o in (("additive", 0.5), ("opacity", 0.0), ("opacity", 1.0)))
    assert clear == pytest.approx(additive, rel=2e-3)  # an infinitely thin veil hides nothing
    assert opaque < additive


@pytest.mark.parametrize("values", [
    {"camera.inclination_deg": 0.0},
    {"camera.inclination_deg": 90.0},
    {"camera.inclination_deg": 180.0},
    {"camera.distance": 1.02, "hole.spin": 0.0},
    {"camera.distance": 1e4, "camera.fov_deg": 1.0},
    {"camera.distance": float("inf")},
    {"hole.spin": 0.9999, "camera.inclination_deg": 89.99, "disk.inner_radius": 0.0},
    {"hole.spin": 0.9999, "disk.orbit": "retrograde"},
    {"disk.outer_radius": 1.0},
    {"rays.lensing": False},
    {"camera.fov_deg": 150.0, "camera.distance": 3.0},
])
def test_every_pixel_is_a_number(light, values) -> None:
    found = light(disk__turbulence=True, disk__point_field=True, sky__enabled=True, **{key.replace(".", "__", 1): value for key, value in values.items()})
    assert np.isfinite(found).all() and found.min() >= 0.0


def test_same_time_same_picture(light) -> None:
    facts = dict(disk__turbulence=True, sky__enabled=True)
    first = light(12.5, **facts)
    light(99.0, **facts)
    np.testing.assert_array_equal(light(12.5, **facts), first)
    assert np.abs(light(13.5, **facts) - first).max() > 0.01


def test_no_disk_shines_into_the_shadow(light) -> None:
    """Disk off: the shadow is black, the sky is not."""
    found = light(disk__enabled=False, sky__enabled=True)
    assert found[SIZE[1] // 2, SIZE[0] // 2].max() == 0.0
    assert found.max() > 0.0
