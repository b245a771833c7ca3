"""Meshes in pictures: met like the shapes that they are, closed where they are closed, with the colours and normals of their files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from blackhole_gl.glsl.declared import Fate
from blackhole_gl.planning import REFINE_STEP
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, SceneError, presets

SIZE = (160, 90)
PLACE = {"x": 7.0, "y": 5.0, "z": 3.0}


def globe(path: Path, around: int, along: int) -> Path:
    """A sphere of triangles, its corners on the unit sphere: an OBJ file."""
    phi = 2.0 * np.pi * np.arange(around) / around
    theta = np.pi * np.arange(1, along) / along
    rings = np.stack([np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi)), np.outer(np.cos(theta), np.ones(around))], axis=-1)
    corners = np.concatenate([[[0.0, 0.0, 1.0]], rings.reshape(-1, 3), [[0.0, 0.0, -1.0]]])
    faces = []
    for k in range(around):
        after, last = (k + 1) % around, 1 + (along - 2) * around
        faces += [(0, 1 + k, 1 + after), (last + around, last + after, last + k)]
        for ring in range(along - 2):
            here, below = 1 + ring * around, 1 + (ring + 1) * around
            faces += [(here + k, below + k, below + after), (here + k, below + after, here + after)]
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces))
    return path


def _scene(model: str, **thing: object) -> Scene:
    given = {f"things.moon.{name}": value for name, value in {**PLACE, **thing}.items()}
    view = {"camera.distance": 20.0, "camera.azimuth_deg": 20.0, "camera.inclination_deg": 70.0, "disk.enabled": False, "rays.edges": 1}
    return presets.load(["kerr"], {**view, "rays.model": model, "hole.spin": 0.9 if model == "kerr" else 0.0, "things.moon.kind": "sphere", **given})


@pytest.mark.parametrize("model", ["flat", "kerr"])
def test_a_globe_of_triangles_is_met_where_the_sphere_is(renderer: Renderer, tmp_path: Path, model: str) -> None:
    """Its faces lie up to 1 − cos(π/60) = 1.4e-3 of its radius within; every ray that meets a sphere that small meets it, so there are no gaps."""
    fine = globe(tmp_path / "globe.obj", 60, 30)
    moon = {"kind": "mesh", "file": str(fine), "size": 2.0, "up": "z", "axis_tilt_deg": 40.0, "turn_deg": 20.0}
    found = []
    for thing in (moon, {"radius": 2.0}, {"radius": 2.0 * 0.994}):
        renderer.render(_scene(model, **thing), 0.0, SIZE)
        found.append(renderer.hits())
    mesh, sphere, smaller = found
    assert np.all(mesh.fate[smaller.fate == Fate.MET] == Fate.MET) and (smaller.fate == Fate.MET).sum() > 150
    assert np.all(sphere.fate[mesh.fate == Fate.MET] == Fate.MET)
    off = np.linalg.norm(mesh.met_place[mesh.fate == Fate.MET, 0] - np.array(list(PLACE.values())), axis=-1)
    assert np.all((off < 2.0 + 2e-5) & (off > 2.0 * 0.997)), "between a face's middle and its corners"


def test_a_smooth_globe_shines_like_the_sphere(renderer: Renderer, tmp_path: Path) -> None:
    """The normals of 1,800 corners, between them interpolated; what differs is the outline."""
    look = {"ambient": 0.2, "specular": 0.0}
    lamp = {"things.lamp.kind": "lamp", "things.lamp.x": 20.0, "things.lamp.y": -5.0, "things.lamp.z": 12.0, "things.lamp.radius": 0.0, "sky.enabled": False}
    light = []
    for thing in ({"kind": "mesh", "file": str(globe(tmp_path / "globe.obj", 60, 30)), "size": 2.0}, {"radius": 2.0}):
        renderer.render(_scene("kerr", **thing, **look).with_values(lamp), 0.0, SIZE)
        light.append(renderer.radiance())
    lit = light[1].max(axis=-1) > 0.0
    assert lit.sum() > 150 and light[1].max() > 0.2
    assert np.quantile(np.abs(light[0] - light[1])[lit], 0.9) < 0.02 * light[1].max()


def _halves(path: Path) -> Path:
    """A picture that is red on its left half, and green below on its right, blue above."""
    picture = np.zeros((64, 128, 3), np.uint8)
    picture[:, :64, 0] = picture[32:, 64:, 1] = picture[:32, 64:, 2] = 255
    Image.fromarray(picture).save(path)
    return path


@pytest.mark.parametrize("look", [{"surface": "checker", "squares_around": 6}, {"surface": "image"}], ids=["checker", "image"])
def test_a_mesh_without_texture_coordinates_is_painted_as_a_globe_is(renderer: Renderer, tmp_path: Path, look: dict) -> None:
    values = {**look, "image": str(_halves(tmp_path / "halves.png")), "lighting": "glowing", "axis_tilt_deg": 30.0, "turn_deg": 70.0}
    light = []
    for thing in ({"kind": "mesh", "file": str(globe(tmp_path / "globe.obj", 60, 30)), "size": 2.0, "up": "z"}, {"radius": 2.0}):
        renderer.render(_scene("flat", **thing, **values), 0.0, SIZE)
        light.append(renderer.radiance())
        met = renderer.hits().fate[::-1] == Fate.MET
    apart = np.abs(light[0] - light[1]).max(axis=-1)[met]
    assert met.sum() > 150 and np.ptp(light[1][met], axis=0).max() > 0.3
    assert np.mean(apart > 0.05) < 0.1, "where the colour changes, and at the outline"


def test_a_picture_lies_on_a_mesh_by_the_texture_coordinates_of_its_file(renderer: Renderer, tmp_path: Path) -> None:
    """A square that faces the camera, the picture's left on its left."""
    square = tmp_path / "square.obj"
    corners, places = ((-1, -1), (1, -1), (1, 1), (-1, 1)), ((0, 0), (1, 0), (1, 1), (0, 1))
    square.write_text("".join(f"v 0 {x} {y}\n" for x, y in corners) + "".join(f"vt {u} {v}\n" for u, v in places) + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n")
    image = str(_halves(tmp_path / "halves.png"))
    view = {"camera.azimuth_deg": 0.0, "camera.inclination_deg": 90.0, "things.moon.x": 8.0, "things.moon.y": 0.0, "things.moon.z": 0.0}
    look = {"kind": "mesh", "file": str(square), "up": "z", "size": 3.0, "surface": "image", "image": image, "lighting": "glowing"}
    renderer.render(_scene("flat", **look).with_values(view), 0.0, SIZE)
    light, met = renderer.radiance(), renderer.hits().fate[::-1] == Fate.MET
    row, column = (int(places.mean()) for places in np.nonzero(met))
    seen = [[int(np.argmax(light[row + down, column + right])) for right in (-5, 5)] for down in (-5, 5)]
    assert met.sum() > 150 and seen == [[0, 2], [0, 1]], "red on the left; on the right blue above, green below"


def test_a_mesh_shows_its_own_colours_or_ours(renderer: Renderer) -> None:
    pictures = []
    for own in (True, False):
        renderer.render(_scene("flat", kind="mesh", size=3.0, own_colours=own, lighting="glowing", colour=(0.5, 0.5, 0.5)), 0.0, SIZE)
        met = renderer.hits().fate[::-1] == Fate.MET
        pictures.append(renderer.radiance()[met])
    spread = [np.ptp(picture / picture.sum(axis=-1, keepdims=True), axis=0).max() for picture in pictures]
    assert spread[0] > 0.3 and spread[1] < 0.01, "the shipped knot's colours run along it"


def test_a_slider_of_a_mesh_compiles_nothing_and_a_bad_file_leaves_the_picture_standing(renderer: Renderer, tmp_path: Path) -> None:
    scene = _scene("kerr", kind="mesh")
    renderer.render(scene, 0.0, (36, 20))
    compiled, picture = renderer.programs.compiled, renderer.read_rgb8()
    other = globe(tmp_path / "a.obj", 8, 4)
    for values in ({"things.moon.size": 3.0}, {"things.moon.file": str(other)}, {"things.second.kind": "mesh", "things.second.file": str(other)}):
        assert renderer.render(scene.with_values(values), 0.0, (36, 20)).traced
    assert renderer.programs.compiled == compiled
    renderer.render(scene, 0.0, (36, 20))
    other.write_text("not a mesh")
    with pytest.raises(SceneError, match="things.moon.file: the mesh .* cannot be used: .*; allowed is an OBJ"):
        renderer.render(scene.with_values({"things.moon.file": str(other)}), 0.0, (36, 20))
    np.testing.assert_array_equal(renderer.read_rgb8(), picture)


def _renders_as_traced_anew(renderer: Renderer, scene: Scene) -> None:
    assert renderer.render(scene, 0.0, SIZE).traced
    shown = renderer.radiance()
    renderer.hit_map.forget()
    renderer.render(scene, 0.0, SIZE)
    np.testing.assert_array_equal(shown, renderer.radiance())


def test_a_mesh_whose_file_changes_is_shown_anew(renderer: Renderer, tmp_path: Path) -> None:
    """As pictures are, be the scene the same."""
    for around, along in ((8, 4), (24, 12), (5, 3)):
        path = globe(tmp_path / "a.obj", around, along)
        _renders_as_traced_anew(renderer, _scene("kerr", kind="mesh", file=str(path)))


def test_a_mesh_behind_one_of_another_file_keeps_its_looks(renderer: Renderer, tmp_path: Path) -> None:
    """Hits number its triangles behind those of the first: 547 pixels had the colours of others."""
    first, other = globe(tmp_path / "a.obj", 8, 4), globe(tmp_path / "b.obj", 24, 12)
    scene = _scene("kerr", kind="mesh", size=1.0)
    scene = scene.with_values({"things.second.kind": "mesh", "things.second.x": 2.0, "things.second.y": -3.0, "things.second.size": 3.0})
    for path in (first, other):
        _renders_as_traced_anew(renderer, scene.with_values({"things.moon.file": str(path)}))


def test_a_mesh_under_a_moving_camera_is_where_an_exact_map_has_it_but_for_its_outline(renderer: Renderer) -> None:
    """Ways are looked at within 0.4 of a pixel there. What differs lies at the outline, be it of an image narrower than a pixel, so that no part is lost."""
    scene, shown = presets.load(["knot_behind_a_hole"], {"rays.edges": 1, "camera.fov_deg": 43.0}), []
    for moving in (False, True):
        renderer.hit_map.forget()
        renderer.render(scene, 0.0, (320, 180), progressive=moving)
        shown.append(renderer.hits().met[..., 0, 0] >= 0)
    exact, found = shown
    outline = np.any([np.roll(shows, step, axis) != shows for shows in shown for axis in (0, 1) for step in (-1, 1)], axis=0)
    assert exact.mean() > 0.1 and not renderer.hit_map.is_sharp
    assert np.all(outline[found != exact]) and (found != exact).sum() < 0.04 * outline.sum()


def test_rays_beside_the_strands_of_a_mesh_look_for_none_and_none_is_lost(renderer: Renderer) -> None:
    """By the knot's ball alone 0.310 and 0.309 of these pictures may show it."""
    scene = presets.load(["knot_behind_a_hole"], {"rays.edges": 1, "camera.fov_deg": 43.0})
    for azimuth, most in ((0.0, 0.28), (70.0, 0.28)):
        turned = scene.with_values({"camera.azimuth_deg": azimuth})
        renderer.hit_map.forget()
        renderer.render(turned, 0.0, (320, 180), progressive=True)
        known = renderer.hit_map.known
        assert known is not None
        told = np.frombuffer(known.cells.read(alignment=1), np.uint8).reshape(known.cells.height, known.cells.width)
        cells = np.kron(told == 255, np.ones((REFINE_STEP, REFINE_STEP), bool))[:180, :320]
        renderer.hit_map.forget()
        renderer.render(turned, 0.0, (320, 180))
        shows = renderer.hits().met[..., 0, 0] >= 0
        print(f"{cells.mean():.3f} may show the knot, {shows.mean():.3f} do")
        assert np.all(cells[shows]) and cells.mean() < most
