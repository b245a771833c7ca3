"""Where instances are at a time: circles at the geodesic rate or their own, turns, and the spheres that hold them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.physics import motion, relativity
from blackhole_gl.physics.moving_matter import own_time_squared
from blackhole_gl.physics.space_time import space_time
from blackhole_gl.planning import plan
from blackhole_gl.scene import Scene, catalogue, met, presets


def _scene(spin: float = 0.9, **values: object) -> Scene:
    return presets.load(["kerr"], {"hole.spin": spin, "things.moon.kind": "sphere", **{f"things.moon.{name}": value for name, value in values.items()}})


def _motion(scene: Scene, time: float) -> motion.Motion:
    return motion.of(scene.things["moon"], catalogue.plug_ins("thing")["sphere"].traits, space_time(scene), time)


@pytest.mark.parametrize("spin", [0.9, 0.0, -0.6])
@pytest.mark.parametrize("sense", ["prograde", "retrograde"])
def test_a_geodesic_is_gone_round_at_its_rate(spin: float, sense: str) -> None:
    """By the closed form, also after a hundred thousand turns: the phase is wrapped in float64."""
    scene = _scene(spin, path="geodesic", orbit_radius=7.0, orbit_sense=sense, orbit_phase_deg=30.0)
    rate = float(relativity.orbital_frequency(7.0, spin, sense))
    for time in (0.0, 12.5, 1e7):
        angle = math.radians(30.0) + rate * time
        found = _motion(scene, time)
        np.testing.assert_allclose(found.centre, 7.0 * np.array([math.cos(angle), math.sin(angle), 0.0]), atol=1e-7)
        np.testing.assert_allclose(found.velocity, 7.0 * rate * np.array([-math.sin(angle), math.cos(angle), 0.0]), atol=1e-8)


def test_a_tilted_circle_keeps_its_plane_and_its_own_rate() -> None:
    values = {"path": "circle", "orbit_radius": 5.0, "orbit_rate": 0.1, "orbit_tilt_deg": 40.0, "orbit_node_deg": 25.0}
    tilt, node = math.radians(40.0), math.radians(25.0)
    axis = np.array([math.sin(tilt) * math.sin(node), -math.sin(tilt) * math.cos(node), math.cos(tilt)])
    scene = _scene(**values)
    np.testing.assert_allclose(_motion(scene, 0.0).centre, 5.0 * np.array([math.cos(node), math.sin(node), 0.0]), atol=1e-12)
    assert _motion(scene, 0.1).centre[2] > 0.0, "it rises at its node"
    for time in (3.0, 11.0):
        found = _motion(scene, time)
        assert np.linalg.norm(found.centre) == pytest.approx(5.0) and found.centre @ axis == pytest.approx(0.0, abs=1e-12)
        np.testing.assert_allclose(found.velocity, 0.1 * np.cross(axis, found.centre), atol=1e-12)


def test_the_velocity_is_the_change_of_place() -> None:
    scene = _scene(path="geodesic", orbit_radius=6.0, orbit_tilt_deg=70.0, orbit_node_deg=-50.0, orbit_phase_deg=200.0)
    before, here, after = (_motion(scene, 40.0 + step) for step in (-1e-4, 0.0, 1e-4))
    np.testing.assert_allclose((after.centre - before.centre) / 2e-4, here.velocity, atol=1e-8)


def _turned(quaternion: np.ndarray, v: np.ndarray) -> np.ndarray:
    axis, w = quaternion[:3], quaternion[3]
    return v + 2.0 * np.cross(axis, np.cross(axis, v) + w * v)


def test_it_turns_about_its_own_axis() -> None:
    scene = _scene(axis_tilt_deg=60.0, axis_azimuth_deg=35.0, turn_deg=20.0, turn_rate=0.3)
    axis = np.array([math.sin(math.radians(60.0)) * math.cos(math.radians(35.0)), math.sin(math.radians(60.0)) * math.sin(math.radians(35.0)), 0.5])
    here, later = _motion(scene, 2.0), _motion(scene, 2.0001)
    for found in (here, later):
        assert np.linalg.norm(found.attitude) == pytest.approx(1.0)
        np.testing.assert_allclose(_turned(found.attitude, np.array([0.0, 0.0, 1.0])), axis, atol=1e-12)
    mark = np.array([1.0, 0.2, -0.3])
    change = (_turned(later.attitude, mark) - _turned(here.attitude, mark)) / 1e-4
    np.testing.assert_allclose(change, np.cross(here.spin, _turned(here.attitude, mark)), atol=1e-4)
    np.testing.assert_allclose(here.spin, 0.3 * axis)


def test_what_moves_is_told_from_what_rests_or_only_turns() -> None:
    traits = catalogue.plug_ins("thing")["sphere"].traits
    for values, expected in (({}, False), ({"turn_rate": 1.0}, False), ({"path": "geodesic"}, True), ({"path": "circle"}, True)):
        assert motion.moves(_scene(**values).things["moon"], traits) == expected, "a sphere that turns is met where it was"
    assert not motion.moves(presets.load(["kerr"], {"things.ring.kind": "annulus"}).things["ring"], catalogue.plug_ins("thing")["annulus"].traits)


def test_the_rows_of_a_scene_are_each_instance_in_its_place_whether_it_stands_or_moves() -> None:
    values = {"path": "geodesic", "orbit_radius": 6.0}, {"x": 7.0, "z": 2.0, "turn_deg": 40.0, "axis_tilt_deg": 30.0}, {"y": 5.0, "turn_rate": 0.4}
    things = {f"things.moon_{k}.{name}": value for k, own in enumerate(values) for name, value in {"kind": "sphere", **own}.items()}
    scene = presets.load(["kerr"], {"hole.spin": 0.9, **things, "things.ring.kind": "annulus"})
    where, kinds = space_time(scene), catalogue.plug_ins("thing")
    for time in (0.0, 3.5):
        for row, instance in zip(motion.rows(scene, "thing", where, time), scene.things.values(), strict=True):
            here = motion.of(instance, kinds[instance.kind].traits, where, time)
            expected = (*here.centre, here.reach), (*here.velocity, here.orbit_rate), (*here.spin, 0.0), here.attitude
            np.testing.assert_array_equal(row, expected)
    assert [(mover.place, mover.name) for mover in motion.movers(scene, "thing")] == [(0, "moon_0"), (2, "moon_2")]
    moved = scene.with_values({"things.moon_1.x": 3.0})
    assert motion.rows(moved, "thing", where, 0.0)[1, 0, 0] == 3.0, "another place is another scene"


def test_the_reach_of_a_scene_holds_every_bounding_sphere_at_any_time() -> None:
    orbiting = _scene(path="circle", orbit_radius=6.0, radius=1.5, orbit_tilt_deg=50.0)
    assert met.reach(orbiting) == pytest.approx(7.5)
    resting = _scene(x=3.0, y=-4.0, z=12.0, radius=2.0)
    assert met.reach(resting) == pytest.approx(15.0)
    for scene in (orbiting, resting):
        for time in np.linspace(0.0, 60.0, 13):
            found = _motion(scene, float(time))
            assert np.linalg.norm(found.centre) + found.reach <= met.reach(scene) * (1.0 + 1e-12)


@pytest.mark.parametrize("spin", [0.0, 0.9])
def test_a_circle_faster_than_light_is_gone_round_as_asked_and_its_light_shifted_as_of_matter(spin: float) -> None:
    """BlackHoleGPU's star goes round at up to 2 radians a second, 15 r_s away: a place may move so, matter may not. The plan says so."""
    scene = _scene(spin, path="circle", orbit_radius=6.0, orbit_rate=1.0, orbit_tilt_deg=20.0)
    where = space_time(scene)
    here, later = _motion(scene, 3.0), _motion(scene, 3.001)
    assert np.linalg.norm(later.centre - here.centre) / 0.001 == pytest.approx(6.0, rel=1e-3), "its place keeps the rate"
    clock = own_time_squared(here.centre, here.velocity, spin)
    assert clock == pytest.approx(0.01 * own_time_squared(here.centre, np.zeros(3), spin), rel=1e-6)
    traits = catalogue.plug_ins("thing")["sphere"].traits
    assert motion.outruns_light(scene.things["moon"], traits, where)
    assert any("things.moon goes round faster than light" in word for word in plan(scene).warnings)
    slow = _scene(spin, path="circle", orbit_radius=6.0, orbit_rate=0.1)
    assert not motion.outruns_light(slow.things["moon"], traits, where) and plan(slow).warnings == ()
    assert np.linalg.norm(_motion(slow, 3.0).velocity) == pytest.approx(0.6)
