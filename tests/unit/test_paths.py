"""The rays of the path view: which are recorded, what stands around them, how a line is cut to what is shown."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl import planning
from blackhole_gl.app import path_world
from blackhole_gl.app.paths import Asked, Paths, told, within
from blackhole_gl.glsl.declared import Fate
from blackhole_gl.physics import relativity
from blackhole_gl.rendering.recording import RayPath
from blackhole_gl.scene import SceneError, presets

KERR = presets.load(["kerr"])
MIDDLE = Asked(KERR, (320, 200), (160.0, 100.0))


def recorded(asked: list, *, fails: bool = False):
    """Stands for `Recorder.record`: keeps what it is asked for."""

    def record(scene, local):
        asked.append((scene, local))
        if fails:
            raise SceneError("rays.integrator", "no such thing")
        return None

    return record


def test_a_ray_is_recorded_once() -> None:
    paths, asked = Paths(), []
    paths.ask(MIDDLE)
    paths.ask(MIDDLE)
    assert paths.busy
    for _ in range(3):
        paths.advance(recorded(asked))
    paths.ask(MIDDLE)
    assert len(asked) == len(paths.shown) == 1 and not paths.busy
    np.testing.assert_allclose(asked[0][1], (-1.0, 0.0, 0.0))


def test_the_same_rays_by_another_method_keep_camera_and_hole() -> None:
    paths, asked = Paths(), []
    paths.ask(MIDDLE)
    paths.ask(Asked(KERR, (320, 200), (170.5, 90.5)))
    for _ in range(2):
        paths.advance(recorded(asked))
    elsewhere = KERR.with_values({"rays.model": "schwarzschild", "rays.integrator": "euler", "camera.distance": 7.0, "hole.spin": 0.1})
    paths.again(lambda one: one.by(elsewhere))
    paths.again(Asked.by_most_accurate)
    while paths.busy:
        paths.advance(recorded(asked))
    scenes = [scene for scene, _ in asked]
    assert [scene.rays.model for scene in scenes] == ["auto", "auto", "schwarzschild", "schwarzschild", "kerr", "kerr"]
    assert all(scene.camera == KERR.camera and scene.hole == KERR.hole for scene in scenes)
    assert [tuple(local) for _, local in asked[:2]] == [tuple(local) for _, local in asked[2:4]]
    paths.remove(paths.shown[0])
    assert len(paths.shown) == 5
    paths.clear()
    assert not paths.shown and not paths.busy


def test_what_cannot_be_recorded_is_told_until_something_can() -> None:
    paths = Paths()
    paths.ask(MIDDLE)
    paths.advance(recorded([], fails=True))
    assert not paths.shown and "no such thing" in paths.failure
    paths.ask(MIDDLE)
    paths.advance(recorded([]))
    assert len(paths.shown) == 1 and paths.failure is None


def test_the_space_has_the_hole_the_shell_and_the_disk_of_the_plan() -> None:
    made, world = planning.plan(KERR), path_world.of(KERR)
    assert world.hole_radius == pytest.approx(relativity.horizon_radius(0.9))
    np.testing.assert_allclose(np.linalg.norm(world.ball, axis=1), 1.0)
    corners = world.ball[world.ball_faces]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    assert areas.sum() == pytest.approx(4.0 * np.pi, rel=0.02)  # of flat faces, so many: the whole ball, and no face twice
    radii = np.linalg.norm(np.concatenate(world.shell), axis=1)
    assert radii.min() == pytest.approx(relativity.photon_orbit_radius(0.9)) and radii.max() == pytest.approx(relativity.photon_orbit_radius(0.9, "retrograde"))
    disk = np.linalg.norm(world.disk, axis=1)
    assert disk.min() == pytest.approx(made.disk_inner) and disk.max() == pytest.approx(made.disk_outer) and not world.disk[:, 2].any()
    bare = path_world.of(KERR.with_values({"disk.enabled": False, "rays.lensing": False}))
    assert not bare.shell and not len(bare.disk) and not bare.edges


def test_a_line_is_cut_where_it_comes_in_and_goes_out() -> None:
    line = np.array([(20.0, 1.0, 0.0), (3.0, 1.0, 0.0), (0.0, 2.0, 0.0), (-4.0, 3.0, 0.0), (-4.0, 300.0, 0.0)])
    cut = within(line, 10.0)
    np.testing.assert_allclose(np.linalg.norm(cut[[0, -1]], axis=1), 10.0)
    np.testing.assert_array_equal(cut[1:-1], line[1:4])
    assert cut[0, 1] == 1.0 and cut[-1, 0] == -4.0
    assert not len(within(line + 1000.0, 10.0))
    np.testing.assert_array_equal(within(line[1:4], 10.0), line[1:4])


def test_a_ray_is_told_in_a_line() -> None:
    points = np.array([(5.0, 0.0, 0.0), (2.0, 0.0, 1.0), (-5.0, 0.0, 1.0)])
    path = RayPath(
        points=points,
        step=np.array([0, 1, 2]),
        is_state=np.array([False, True, True]),
        nearest=np.linalg.norm(points, axis=1),
        error=np.array([np.nan, 1e-5, 2e-3]),
        drift=np.full(3, np.nan),
        crossings=np.array([(3.0, 4.0, 0.0)]),
        direction=np.array([-1.0, 0.0, 0.0]),
        fate=Fate.ESCAPED,
        steps=2,
        hole_radius=1.0,
        method="kerr",
    )
    assert told(path) == "escaped, 2 steps, largest error of one 2.0e-03 rad, meets the disk's plane at r = 5.00"
