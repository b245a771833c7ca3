"""Automatic exposure: what it evens out, what it does not depend on, and what it costs."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from blackhole_gl.planning import plan
from blackhole_gl.rendering import metering
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.hit_map import HitMap
from blackhole_gl.scene import Scene, presets

SIZE = (160, 90)
CAMERAS = [*itertools.product((0.0, 0.5, 0.9, 0.998, 0.9999), (6.0, 15.0, 60.0))]  # spins and distances
MODES = ("fixed", "automatic")


def _scene(mode: str = "automatic", **values: object) -> Scene:
    return presets.load(["kerr"], {"post.exposure_mode": mode, **{key.replace("__", "."): value for key, value in values.items()}})


def _stops(renderer: Renderer, scene: Scene) -> float:
    renderer.render(scene, 0.0, SIZE)
    return renderer.exposure.stops


def _extremes(renderer: Renderer, scene: Scene) -> tuple[float, float]:
    """Share of the disk's pixels that are nearly white, and the grey levels that its brightest tenth has at least."""
    renderer.render_still(scene.with_values({"sky.enabled": False, "post.bloom": False, "post.dither": False}), 0.0, SIZE)
    levels = renderer.read_rgb8()
    disk = levels[levels.max(axis=-1) > 0]
    return float(np.mean(disk.min(axis=-1) >= 200)), float(np.quantile(disk.max(axis=-1), 0.9))


def test_a_hole_is_neither_blown_out_nor_black_at_any_spin_and_distance(renderer: Renderer) -> None:
    found = {mode: np.array([_extremes(renderer, _scene(mode, hole__spin=a, camera__distance=r)) for a, r in CAMERAS]) for mode in MODES}
    assert found["fixed"][:, 0].max() > 0.3 and found["fixed"][:, 1].min() < 60, "what it is for"
    assert found["automatic"][:, 0].max() < 0.15 and found["automatic"][:, 1].min() > 130


def test_the_preset_of_the_first_picture_is_as_it_was(renderer: Renderer) -> None:
    """The key light is that of its disk: within a tenth of a stop, which hardly anybody tells from none."""
    assert abs(_stops(renderer, _scene())) < 0.1


def test_time_turns_and_sizes_change_nothing(renderer: Renderer) -> None:
    stops = _stops(renderer, _scene(hole__spin=0.5))
    assert stops < -0.5
    for change in ({"camera__yaw_deg": 120.0}, {"camera__roll_deg": 30.0}, {"camera__azimuth_deg": 77.0}, {"sky__brightness": 5.0}, {"post__gamma": 2.0}):
        assert _stops(renderer, _scene(hole__spin=0.5, **change)) == stops
    for time, size in ((37.0, SIZE), (0.0, (90, 200))):
        renderer.render(_scene(hole__spin=0.5), time, size)
        assert renderer.exposure.stops == stops
    renderer.render_still(_scene(hole__spin=0.5), 5.0, SIZE)
    assert renderer.exposure.stops == stops


def test_it_is_as_if_the_exposure_had_been_set_by_hand(renderer: Renderer) -> None:
    """And the glow's threshold with it."""
    scene = _scene(hole__spin=0.998, post__exposure=0.5)
    renderer.render(scene, 3.0, SIZE)
    automatic, stops = renderer.read_rgb8(), renderer.exposure.stops
    by_hand = {"post.exposure_mode": "fixed", "post.exposure": 0.5 + stops, "post.bloom_threshold": scene.post.bloom_threshold * 2.0**-stops}
    renderer.render(scene.with_values(by_hand), 3.0, SIZE)
    np.testing.assert_array_equal(renderer.read_rgb8(), automatic)
    assert renderer.exposure.stops == 0.0


def test_the_key_light_moves_it_by_the_share_that_is_made_up_for(renderer: Renderer) -> None:
    low, high = (_stops(renderer, _scene(hole__spin=0.5, post__key_light=key)) for key in (0.2, 0.4))
    assert high - low == pytest.approx(metering.ADAPTS)


def test_nothing_that_shines_is_nothing_to_go_by(renderer: Renderer) -> None:
    assert _stops(renderer, _scene(disk__enabled=False)) == 0.0
    assert _stops(renderer, _scene(disk__emission_strength=0.0)) == 0.0


def test_things_count_as_the_disk_does(renderer: Renderer) -> None:
    ring = {"things.ring.kind": "annulus", "things.ring.inner_radius": 4.0, "things.ring.outer_radius": 6.0}
    stops = {glow: _stops(renderer, _scene(disk__enabled=False).with_values({**ring, "things.ring.brightness": glow})) for glow in (0.5, 2.0)}
    assert stops[0.5] - stops[2.0] == pytest.approx(2.0 * metering.ADAPTS, abs=0.01)  # half floats


def test_it_does_not_flicker_as_the_camera_moves(renderer: Renderer) -> None:
    """From one frame of a flight to the next: a hundredth of a stop is 0.7 % of the light."""
    flight = [_stops(renderer, _scene(camera__inclination_deg=60.0 + 0.2 * k, camera__distance=20.0 - 0.02 * k)) for k in range(40)]
    assert np.abs(np.diff(flight)).max() < 0.01


@pytest.fixture
def meterings(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    """Sizes of the pictures that are metered from now on."""
    found, trace = [], HitMap.trace

    def noted(self, inputs, **how):
        if inputs.size == metering.SIZE:
            found.append(inputs.size)
        return trace(self, inputs, **how)

    monkeypatch.setattr(HitMap, "trace", noted)
    return found


def test_it_is_metered_once_for_a_view_and_seldom_while_the_camera_moves(renderer: Renderer, meterings: list) -> None:
    view = _scene(hole__spin=0.31)
    for time in (0.0, 1.0, 2.0):
        assert renderer.render(view, time, SIZE).settled
    assert len(meterings) == 1
    frames = 4 * metering.EVERY
    reports = [renderer.render(_scene(hole__spin=0.31, camera__inclination_deg=50.0 + k), 0.0, SIZE, progressive=True) for k in range(frames)]
    assert len(meterings) - 1 in (3, 4)
    assert not all(report.settled for report in reports)
    assert renderer.render(_scene(hole__spin=0.31, camera__inclination_deg=50.0 + frames - 1), 0.0, SIZE).settled, "the last one"


def test_it_needs_no_programs_of_its_own(renderer: Renderer) -> None:
    renderer.render(_scene("fixed"), 0.0, SIZE)
    compiled = renderer.programs.compiled
    renderer.render(_scene(hole__spin=0.77), 0.0, SIZE)
    assert renderer.programs.compiled == compiled


def test_views_in_false_colours_are_left_alone(renderer: Renderer, meterings: list) -> None:
    renderer.render(_scene(post__view="steps"), 0.0, SIZE)
    assert renderer.exposure.stops == 0.0 and not meterings


def test_a_window_s_exposure_follows_and_a_still_s_does_not(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    metered = _stops(renderer, _scene(hole__spin=0.2))
    monkeypatch.setattr(renderer.exposure, "adaptation", lambda stops: stops + 1.0)
    report = renderer.render(_scene(hole__spin=0.2), 0.0, SIZE)
    assert report.stops == metered + 1.0 and not report.settled
    renderer.render_still(_scene(hole__spin=0.2), 0.0, SIZE)
    assert renderer.exposure.stops == metered


def test_looks_and_scenes_that_were_published_keep_their_exposure() -> None:
    """And those whose radiance is measured as a flux. Whatever else is shipped may have it automatic."""
    published = ("default_look", "particle_storm", "minimal_bloom", "gargantua_s1", "extreme_gravity", "thin_disk", "luminet_1979", "gargantua_as_filmed")
    measured = [info.name for info in presets.available() if info.name.startswith("gold_")]
    assert measured and {presets.load([name]).post.exposure_mode for name in (*published, *measured)} == {"fixed"}
    assert {presets.load([name]).post.exposure_mode for name in ("schwarzschild", "kerr_06", "kerr", "kerr_0998_85", "m87_like")} == {"automatic"}
    assert Scene().post.exposure_mode == "fixed", "files from before there was another"
    assert plan(Scene()).scene.post.exposure == 0.0
