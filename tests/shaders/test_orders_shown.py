"""The disk's images one by one, and each in its colour."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.planning import plan
from blackhole_gl.rendering import metering
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.tables import Tables
from blackhole_gl.rendering.temperatures import TemperatureProfile
from blackhole_gl.rendering.views import linear_light, view_of
from blackhole_gl.scene import Scene, presets

SIZE = (160, 100)
ALONE = ("direct", "first_ring", "second_ring")
LUMINANCE = np.array((0.2126, 0.7152, 0.0722))


def radiance(renderer: Renderer, shown: str, **values: object) -> np.ndarray:
    plain = {"sky.enabled": False, "disk.compositing": "additive", "camera.fov_deg": 25.0, "disk.orders_shown": shown}
    renderer.render(presets.load(["kerr"], {**plain, **values}), 3.0, SIZE)
    return renderer.radiance().astype(float)


@pytest.mark.parametrize("values", [{}, {"things.one.kind": "annulus"}], ids=["disk", "with a thing"])
def test_orders_alone_add_up_to_the_picture(renderer: Renderer, values: dict) -> None:
    """2e-3: three roundings to half floats. A thing is in all three; without any disk its own edge, a pixel wide, is drawn otherwise."""
    alone = [radiance(renderer, shown, **values) for shown in ALONE]
    whole = radiance(renderer, "all", **values)
    rest = radiance(renderer, "all", **values, **{"disk.enabled": False}) if values else np.zeros_like(whole)
    agree = np.isclose(sum(alone) - 2.0 * rest, whole, rtol=2e-3, atol=2e-3).all(axis=-1)
    assert agree.all() if not values else agree.mean() > 0.99
    lit = [(light - rest).sum() for light in alone]
    assert lit[0] > lit[1] > lit[2] > 0.0


def test_each_shows_its_own_crossings_alone(renderer: Renderer) -> None:
    """Where the disk hides what is behind it, too: the first ring is seen before the shadow, from which the direct image would keep it."""
    for order, shown in enumerate(ALONE):
        light = radiance(renderer, shown, **{"disk.compositing": "opacity", "rays.edges": 1})[::-1].sum(axis=-1)
        crossing = renderer.hits().crossing[:, :, order]
        r = np.hypot(crossing[..., 0], crossing[..., 1])
        assert light[(r > 1.5) & (r < 9.0)].min() > 0.0, shown
        assert light[r == 0.0].max() == 0.0, shown


def test_tints_are_those_of_the_view_and_keep_the_luminance(renderer: Renderer) -> None:
    """1e-2: tints are written with three digits."""
    whole, tinted = radiance(renderer, "all"), radiance(renderer, "tinted")
    np.testing.assert_allclose(tinted @ LUMINANCE, whole @ LUMINANCE, rtol=1e-2, atol=2e-3)
    legend = view_of(Scene().with_values({"post.view": "order"})).legend
    for (_, colour), shown in zip(legend, ALONE):
        light = radiance(renderer, shown)
        others = sum(radiance(renderer, other).sum(axis=-1) for other in ALONE if other != shown)
        bright = (light.sum(axis=-1) > 0.05) & (others == 0.0)
        if bright.any():
            wanted = linear_light(np.array(colour))
            found = tinted[bright]
            np.testing.assert_allclose(found / (found @ LUMINANCE)[:, None], np.broadcast_to(wanted / (wanted @ LUMINANCE), found.shape), rtol=3e-2, atol=1e-2)


def test_a_switch_from_one_to_another_is_seen_at_once(renderer: Renderer) -> None:
    """The pixels' sorting by what they need is kept, and belongs to what is shown."""
    first = radiance(renderer, "first_ring")
    radiance(renderer, "direct"), radiance(renderer, "direct")
    np.testing.assert_array_equal(radiance(renderer, "first_ring"), first)
    assert not renderer.render(presets.load(["kerr"], {"disk.orders_shown": "tinted", "camera.fov_deg": 25.0}), 3.0, SIZE).traced


def test_automatic_exposure_is_that_of_the_whole_picture(renderer: Renderer) -> None:
    """Of the second ring alone a light meter sees a pixel or two."""
    pictures = []
    for shown in ("all", "second_ring"):
        scene = presets.load(["kerr"], {"disk.orders_shown": shown, "post.exposure_mode": "automatic"})
        pictures.append((renderer.render(scene, 3.0, SIZE).stops, renderer.read_rgb8().max()))
    assert pictures[0][0] == pictures[1][0] != 0.0
    assert pictures[1][1] > 60, "its sky is there"


@pytest.mark.parametrize("lit", [1, 2, 3])
def test_a_few_lit_pixels_are_metered(renderer: Renderer, lit: int, monkeypatch: pytest.MonkeyPatch) -> None:
    values = np.zeros((metering.SIZE[1], metering.SIZE[0], 4), np.float16)
    values[0, :lit, :3] = 0.25
    monkeypatch.setattr(metering.ShadePass, "draw", lambda self, inputs, hit_map, target, media: target.color_attachments[0].write(values.tobytes()))
    meter = metering.Meter(renderer.ctx, renderer.programs, Tables(renderer.ctx), TemperatureProfile(renderer.ctx))
    stops = meter.stops(plan(presets.load(["kerr"], {"post.exposure_mode": "automatic"})))
    assert stops == pytest.approx(metering.ADAPTS * np.log2(0.255 / 0.25), abs=1e-3)


@pytest.mark.parametrize("shown", ALONE)
def test_a_moving_picture_shows_the_same(renderer: Renderer, shown: str) -> None:
    """Interpolated hits, sorted by another shader. A twentieth is what edges may differ by; 1e-4 the few pixels of the second ring."""
    scene = presets.load(["kerr"], {"disk.orders_shown": shown, "sky.enabled": False, "rays.model": "kerr", "post.bloom": False, "camera.distance": 22.0})
    renderer.hit_map.forget()
    report = renderer.render(scene, 3.0, SIZE, progressive=True)
    moving = renderer.radiance()
    assert np.isfinite(moving).all() and not report.sharp
    renderer.render(scene, 3.0, SIZE)
    assert np.abs(moving - renderer.radiance()).mean() < max(0.05 * renderer.radiance().mean(), 1e-4)
