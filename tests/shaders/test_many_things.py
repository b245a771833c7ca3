"""A thousand things: what the host does for a frame does not grow with those that rest."""

from __future__ import annotations

import sys
from types import FrameType

import moderngl
import numpy as np

from blackhole_gl.planning import Plan, plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.instances import InstanceTables
from blackhole_gl.scene import FrozenMap, Scene, presets

SIZE = (36, 20)


def _scene(count: int) -> Scene:
    """So many spheres about the hole, the first of them on an orbit, in a field in which a frame is drawn soon."""
    rng, values = np.random.default_rng(1), {"rays.lensing": False, "rays.edges": 1}
    for number in range(count):
        name = f"things.sphere_{number}"
        values |= {f"{name}.kind": "sphere", f"{name}.radius": 0.1, **dict(zip((f"{name}.{axis}" for axis in "xyz"), map(float, rng.uniform(-9.0, 9.0, 3))))}
    return presets.load(["kerr"], values | {"things.sphere_0.path": "geodesic", "things.sphere_0.orbit_radius": 8.0})


def _calls(renderer: Renderer, scene: Scene, time: float) -> int:
    """Functions of Python's that a frame calls, those of C left out."""
    found = 0

    def count(frame: FrameType, event: str, argument: object) -> None:
        nonlocal found
        found += event == "call"

    sys.setprofile(count)
    try:
        renderer.render(scene, time, SIZE, progressive=True)
    finally:
        sys.setprofile(None)
    return found


def _moving(scene: Scene, frame: int) -> Scene:
    return scene.with_values({"camera.azimuth_deg": 0.3 * frame})


def test_things_that_rest_cost_the_host_nothing_in_a_frame(renderer: Renderer) -> None:
    """Camera and one sphere of them moving. Each of the 490 further ones is passed by in a list or two; there were 700 calls for each."""
    calls = {}
    for count in (10, 500):
        scene = _scene(count)
        frames = [_calls(renderer, _moving(scene, frame), 0.1 * frame) for frame in range(6)]
        calls[count] = min(frames[2:])
    assert calls[500] < calls[10] + 490 * 3, calls


def test_an_equal_scene_read_anew_costs_no_more(renderer: Renderer) -> None:
    """What is kept of a scene is found by comparing: equal things that are other objects are compared once."""
    scene, equal = _scene(500), _scene(500)
    assert scene.things is not equal.things
    frames = [_calls(renderer, _moving(one, frame), 0.1) for frame, one in enumerate((scene, scene, equal, equal, equal, equal))]
    assert min(frames[4:]) < 1.1 * frames[1] + 490, frames


def test_small_things_before_a_large_one_leave_its_other_pixels_as_they_are(renderer: Renderer) -> None:
    """Near a small one a way is cut into shorter pieces, each looked at from the first thing on that the longer one came near to: that may be the large one."""
    rng, size = np.random.default_rng(3), (160, 90)
    steps = {"rays.model": "kerr", "rays.integrator": "nystrom5", "rays.step_control": "mino", "rays.step_angle": 0.03}  # short: the large one allows a whole
    values: dict[str, object] = {"hole.spin": 0.9, "rays.edges": 1, "disk.enabled": False, **steps}
    values |= {"things.large.kind": "sphere", "things.large.x": 6.0, "things.large.z": 1.0, "things.large.radius": 2.5}
    large = presets.load(["kerr"], values)
    for number, way in enumerate(rng.normal(size=(400, 3))):
        x, y, z = map(float, (6.0, 0.0, 1.0) + way / np.linalg.norm(way) * 2.56)
        values |= {f"things.small_{number}.{name}": value for name, value in {"kind": "sphere", "radius": 0.04, "x": x, "y": y, "z": z}.items()}
    found = []
    for scene in (large, presets.load(["kerr"], values)):
        renderer.render(scene, 0.0, size)
        found.append(renderer.hits())
    of_large = [(hits.met[..., 0, 0] >= 0) & (hits.met[..., 0, 1] == 0) for hits in found]
    small = (found[1].met[..., 0, 0] >= 0) & ~of_large[1]
    assert of_large[0].sum() > 500 and small.sum() > 30
    np.testing.assert_array_equal(of_large[1], of_large[0] & ~small)
    apart = np.linalg.norm(found[1].met_place[of_large[1], 0] - found[0].met_place[of_large[1], 0], axis=-1)
    assert apart.max() < 1e-3, "r_s: pieces stray by no more than that, and the place is stepped to again"


def test_tables_of_things_are_those_of_their_scene_whatever_was_asked_for_before(ctx: moderngl.Context) -> None:
    """Each is as when it is the first to be made; while only the camera moves nothing is made."""
    scene = presets.load(["kerr"], {f"things.{name}.kind": kind for name, kind in (("ball", "sphere"), ("knot", "mesh"), ("lamp", "lamp"))})
    moving = {"things.ball.path": "geodesic", "things.ball.orbit_radius": 8.0}
    changes = [{}, {"camera.azimuth_deg": 50.0}, {"things.ball.radius": 0.3}, moving, {**moving, "hole.spin": 0.2}, {"things.lamp.brightness": 7.0}]
    changes += [{"things.knot.file": ""}, {"rays.light_travel": True}, {**moving, "rays.light_travel": True}, {"media.fog.kind": "slab"}]
    tables = InstanceTables(ctx)
    for values in (*changes, *reversed(changes)):
        for time in (0.0, 3.0):
            made, alone = plan(scene.with_values(values)), InstanceTables(ctx)
            assert _contents(tables, made, time) == _contents(alone, made, time), values
            alone.release()
    first, moved = plan(scene), plan(scene.with_values({"camera.inclination_deg": 20.0}))
    kept = tables._tables(first, 0.0, FrozenMap())
    assert tables._tables(moved, 5.0, FrozenMap()) is kept
    tables.release()


def _contents(tables: InstanceTables, made: Plan, time: float) -> dict[str, bytes]:
    return {name: texture.read() for name, texture in tables.samplers(made, time).items()}
