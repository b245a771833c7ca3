"""When rays are traced anew and when the kept hit map serves; and that the same asked twice is the same seen twice."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

SIZE = (72, 40)
SHADING_ONLY = {
    "disk.temperature_k": 9000.0,
    "disk.outer_radius": 7.0,
    "disk.temperature_law": "tapered",
    "disk.beaming": False,
    "disk.noise_speed": 0.1,
    "disk.turbulence.contrast": 1.0,
    "disk.point_field": True,
    "sky.brightness": 0.5,
    "sky.enabled": False,
    "post.exposure": 1.0,
    "post.bloom": False,
    "post.tone_map": "agx",
    "playback.rate": 1.0,
}
TRACED_ANEW = {
    "hole.spin": 0.5,
    "camera.distance": 21.0,
    "camera.inclination_deg": 70.0,
    "camera.fov_deg": 30.0,
    "camera.observer": "zamo",
    "rays.model": "kerr_like",
    "rays.step_angle": 0.3,
    "rays.orders": 1,
    "rays.lensing": False,
    "disk.enabled": False,
}


@pytest.mark.parametrize("key", SHADING_ONLY)
def test_what_does_not_bend_light_keeps_the_hit_map(renderer: Renderer, key: str) -> None:
    scene = presets.load(["kerr"])
    renderer.render(scene, 0.0, SIZE)
    traces = renderer.hit_map.traces
    assert not renderer.render(scene.with_values({key: SHADING_ONLY[key]}), 0.0, SIZE).traced
    assert renderer.hit_map.traces == traces


@pytest.mark.parametrize("key", TRACED_ANEW)
def test_what_bends_light_traces_anew(renderer: Renderer, key: str) -> None:
    scene = presets.load(["kerr"])
    renderer.render(scene, 0.0, SIZE)
    before = renderer.hits()
    assert renderer.render(scene.with_values({key: TRACED_ANEW[key]}), 0.0, SIZE).traced
    after = renderer.hits()
    changed = (not np.array_equal(before.direction, after.direction)) or (not np.array_equal(before.crossing, after.crossing))
    assert changed, "traced anew for nothing"


def test_a_camera_that_turns_about_the_axis_keeps_its_map(renderer: Renderer) -> None:
    """Everything turns with it: hits are those of a map traced at the new azimuth, to the last bit."""
    scene = presets.load(["kerr"], {"camera.inclination_deg": 60.0})
    turned = scene.with_values({"camera.azimuth_deg": 73.0})
    renderer.render(scene, 0.0, SIZE)
    before, first, traces = renderer.hits(), renderer.read_rgb8(), renderer.hit_map.traces
    assert not renderer.render(turned, 0.0, SIZE).traced
    kept, picture = renderer.hits(), renderer.read_rgb8()
    assert renderer.hit_map.traces == traces
    renderer.hit_map.forget()
    renderer.render(turned, 0.0, SIZE)
    np.testing.assert_array_equal(renderer.hits().direction, kept.direction)
    np.testing.assert_array_equal(renderer.hits().crossing, kept.crossing)
    np.testing.assert_array_equal(renderer.read_rgb8(), picture)
    c, s = np.cos(np.radians(73.0)), np.sin(np.radians(73.0))
    np.testing.assert_allclose(kept.direction[..., 0], c * before.direction[..., 0] - s * before.direction[..., 1], atol=2e-7)  # one rounding to float32
    assert not np.array_equal(picture, first), "another part of the sky and of the disk's pattern is seen"


def test_time_goes_on_without_tracing(renderer: Renderer) -> None:
    scene = presets.load(["kerr"])
    renderer.render(scene, 0.0, SIZE)
    first, traces = renderer.read_rgb8(), renderer.hit_map.traces
    renderer.render(scene, 5.0, SIZE)
    assert renderer.hit_map.traces == traces
    assert not np.array_equal(renderer.read_rgb8(), first), "the disk turns"


def test_a_new_size_traces_anew(renderer: Renderer) -> None:
    scene = presets.load(["kerr"])
    renderer.render(scene, 0.0, SIZE)
    assert renderer.render(scene, 0.0, (36, 20)).traced


@pytest.mark.parametrize("time", [0.0, 3.5, 36000.0 * 4.0])
def test_the_same_asked_twice_is_the_same_picture(renderer: Renderer, time: float) -> None:
    scene = presets.load(["kerr", "particle_storm"])
    renderer.render(scene, time, SIZE)
    first = renderer.read_rgb8()
    renderer.render(presets.load(["schwarzschild"]), 1.0, (16, 16))  # something else in between
    renderer.render(scene, time, SIZE)
    np.testing.assert_array_equal(renderer.read_rgb8(), first)


def test_another_renderer_draws_the_same_picture(renderer: Renderer) -> None:
    scene = presets.load(["kerr"])
    renderer.render(scene, 3.5, SIZE)
    other = Renderer(renderer.ctx)
    other.render(scene, 3.5, SIZE)
    np.testing.assert_array_equal(other.read_rgb8(), renderer.read_rgb8())
    other.release()


def test_a_still_in_tiles_is_the_frame(renderer: Renderer) -> None:
    scene, size = presets.load(["kerr"]), (600, 8)
    renderer.render(scene, 0.0, size)
    frame = renderer.read_rgb8()
    renderer.render_still(scene, 0.0, size)
    np.testing.assert_array_equal(renderer.read_rgb8(), frame)


@pytest.mark.parametrize("changes", [{}, {"hole.spin": 0.0, "camera.inclination_deg": 86.0}, {"things.ring.kind": "annulus"}], ids=str)
@pytest.mark.parametrize("samples", [1, 2])
def test_tiles_do_not_show(renderer: Renderer, changes: dict, samples: int) -> None:
    """Pixels at edges are found by their neighbours, which may lie in another tile. Of odd size, as the last tiles are."""
    scene, pictures = presets.load(["kerr"], changes), []
    for tile in (512, 32):
        for _ in renderer.still(scene, 3.0, (161, 97), samples, tile):
            pass
        pictures.append(renderer.read_rgb8())
    np.testing.assert_array_equal(*pictures)


def test_a_still_goes_on_between_the_frames_of_another_renderer(renderer: Renderer) -> None:
    scene, size = presets.load(["kerr"]), (150, 100)
    renderer.render_still(scene, 0.0, size, 2)
    at_once = renderer.read_rgb8()
    other = Renderer(renderer.ctx)
    shares = []
    for share in other.still(scene, 0.0, size, 2, 64):
        shares.append(share)
        renderer.render(presets.load(["schwarzschild"]), share, SIZE)
    assert shares == sorted(shares) and len(shares) == 3 * 2 * 4 and shares[-1] == 1.0
    np.testing.assert_array_equal(other.read_rgb8(), at_once)
    other.release()


def test_fates_and_steps_are_those_of_the_whole_map(renderer: Renderer) -> None:
    renderer.render(presets.load(["kerr"]), 0.0, SIZE)
    hits = renderer.hits()
    fate, steps = renderer.fates_and_steps()
    np.testing.assert_array_equal(fate, hits.fate)
    np.testing.assert_array_equal(steps, hits.steps)
    assert set(np.unique(fate)) == {1, 2} and steps.min() > 0
