"""The two sides of the divider: one camera, one time, and another method or preset."""

from __future__ import annotations

from dataclasses import replace

import pytest

from blackhole_gl.app.sides import KEPT, MOST_ACCURATE, Sides
from blackhole_gl.app.state import WindowState
from blackhole_gl.planning import plan
from blackhole_gl.scene import presets

COARSE = presets.load(["kerr"], {"rays.model": "schwarzschild", "rays.integrator": "euler", "camera.azimuth_deg": 70.0, "playback.rate": 2.0})


def info_of(name: str) -> presets.PresetInfo:
    return next(info for info in presets.available() if info.name == name)


def test_at_first_the_other_side_differs_in_how_it_is_traced_alone() -> None:
    sides = Sides()
    other = sides.other(COARSE)
    assert sides.name == MOST_ACCURATE
    assert replace(other, rays=COARSE.rays, parameters=COARSE.parameters) == COARSE
    assert plan(other).model.key == "kerr" and plan(other).integrator.key == "rk4"
    nearer = COARSE.with_values({"camera.distance": 9.0, "hole.spin": 0.2})
    assert sides.other(nearer).hole == nearer.hole and sides.other(nearer).camera == nearer.camera


def test_what_is_kept_follows_camera_time_and_view_alone() -> None:
    sides = Sides()
    sides.keep(COARSE)
    changed = presets.load(["schwarzschild"], {"camera.distance": 8.0, "playback.rate": 0.5, "post.view": "steps"})
    other = sides.other(changed)
    assert sides.name == KEPT
    assert (other.camera, other.playback, other.post.view) == (changed.camera, changed.playback, "steps")
    assert other.hole == COARSE.hole and other.rays == COARSE.rays


@pytest.mark.parametrize("name", ["schwarzschild", "particle_storm", "luminet_1979"])
def test_a_preset_stands_on_the_view_of_the_scene(name: str) -> None:
    sides = Sides()
    sides.take_preset(info_of(name), COARSE)
    other = sides.other(COARSE)
    assert sides.name == info_of(name).title and other.camera == COARSE.camera
    values = {key: value for key, value in presets.read(name).values.items() if not key.startswith(("camera.", "playback.", "post.view"))}
    assert values and all(other.get(key) == value for key, value in values.items())
    if name == "particle_storm":
        assert other.rays == COARSE.rays and other.hole == COARSE.hole, "a look lies over the scene"
    sides.take_most_accurate()
    assert sides.kept is None


def test_sides_change_places_and_back() -> None:
    state, sides = WindowState.start(COARSE), Sides()
    sides.take_preset(info_of("schwarzschild"), COARSE)
    other = sides.other(COARSE)
    sides.swap(state)
    assert state.scene == other and sides.other(state.scene) == COARSE
    sides.swap(state)
    assert state.scene == COARSE and sides.other(COARSE) == other
