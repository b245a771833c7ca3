"""Spheres in pictures: what moves is traced anew and nothing else, and their light."""

from __future__ import annotations

import numpy as np

from blackhole_gl.glsl.declared import Fate
from blackhole_gl.render.frame import Renderer
from blackhole_gl.scene import Scene, presets


def _scene(*names: str, **values: object) -> Scene:
    moon = {f"things.moon.{name}": value for name, value in values.items()}
    return presets.load([*names] or ["kerr"], {"things.moon.kind": "sphere", **moon})


def test_time_traces_anew_what_moves_and_nothing_that_rests_or_turns(renderer: Renderer) -> None:
    size = (32, 18)
    for values, again in (({}, False), ({"turn_rate": 1.0}, False), ({"path": "geodesic"}, True)):
        scene = _scene(**values)
        renderer.render(scene, 0.0, size)
        compiled = renderer.programs.compiled
        assert renderer.render(scene, 3.0, size).traced == again, values
        assert not renderer.render(scene, 3.0, size).traced
        assert renderer.programs.compiled == compiled


def test_an_orbiting_sphere_is_met_where_it_is_at_the_time(renderer: Renderer) -> None:
    """Every meeting lies on the sphere about the place that the closed form gives."""
    scene = _scene(path="circle", orbit_radius=9.0, orbit_rate=0.1, radius=2.0)
    scene = scene.with_values(
        {"camera.inclination_deg": 30.0, "camera.distance": 40.0, "rays.model": "kerr", "rays.integrator": "rk4", "rays.step_angle": 0.05}
    )
    for time in (0.0, 20.0, 45.0):
        renderer.render(scene, time, (160, 90))
        hits = renderer.hits()
        met = hits.fate == Fate.MET
        centre = 9.0 * np.array([np.cos(0.1 * time), np.sin(0.1 * time), 0.0])
        apart = np.linalg.norm(hits.met_place[met, 0] - centre, axis=-1)
        assert met.sum() > 50 and np.max(np.abs(apart - 2.0)) < 1e-4, "single precision at 9 r_s, and the root's own error"
