"""Once a scene has had its rehearsals no program is compiled amid a movement, for which the picture would stand still: wherever its camera goes, as long as
the plan keeps to its method."""

import pytest

from blackhole_gl import planning
from blackhole_gl.app.area import Area
from blackhole_gl.app.picture import Picture
from blackhole_gl.app.preparation import Preparation
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

AREA = Area(0, 0, 640, 360)

# A scene whose first views have no edges, one of whose pixels none need packed rays at first, and one of a beam that needs no halving at first.
QUICK = ("explosion", "objects_lorenz", "sgr_a_eht")
ALL = tuple(info.name for info in presets.available() if info.group == "scene")


def views(scene):
    """The scene from places round about for which the plan takes the same method."""
    camera, rays = scene.camera, planning.plan(scene).scene.rays
    for lower in (0.0, 8.0, -8.0, 16.0, -16.0):
        for farther in (1.0, 0.8, 1.25):
            inclination = min(max(camera.inclination_deg + lower, 1.0), 179.0)
            values = {"inclination_deg": inclination, "azimuth_deg": camera.azimuth_deg + 3.0 * lower, "distance": farther * camera.distance}
            seen = scene.with_values({f"camera.{key}": value for key, value in values.items()})
            if planning.plan(seen).scene.rays == rays:
                yield seen


@pytest.mark.parametrize("name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in ALL if name not in QUICK)])
def test_nothing_is_compiled_amid_a_movement(ctx, name):
    renderer, scene, time = Renderer(ctx), presets.load([name]), 0.0
    picture = Picture(ctx, renderer, Preparation(None))
    window = ctx.framebuffer([ctx.texture((AREA.width, AREA.height), 4)])

    def draw(seen, camera_moving):
        nonlocal time
        time += 0.1
        picture.update(seen, time, AREA, moving=True, camera_moving=camera_moving, window=window)

    while not picture.is_current:
        draw(scene, True)
    compiled = renderer.programs.compiled
    for seen in views(scene):
        for camera_moving in (True, True, False, False):
            draw(seen, camera_moving)
        assert renderer.programs.compiled == compiled, seen.camera
    renderer.release()
