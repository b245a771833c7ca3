"""Pictures all round: where their pixels look, that their borders meet, and what is refused of them."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree import ElementTree

import moderngl
import numpy as np
import pytest
from PIL import Image

from blackhole_gl import listed_rays
from blackhole_gl.physics import observer, projection
from blackhole_gl.planning import plan
from blackhole_gl.rendering import labels, stereo, still_files, uniforms
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, SceneError, presets
from tests.shaders.harness import Piece

SIZES = {"equirectangular": (8192, 4096), "cube": (12288, 2048), "dome": (4096, 4096)}
ASK = """#version 330 core
#defines
#blocks
#include "common/observer.glsl"
uniform vec2 apart;
out vec4 found;
void main() {
    found = vec4(pixel_direction(floor(gl_FragCoord.xy * apart) + 0.5), 1.0);
}
"""


def scene_of(name: str, **values: object) -> Scene:
    return presets.load(["kerr"], {"camera.projection": name, **{key.replace("__", "."): value for key, value in values.items()}})


def by_formula(name: str, size: tuple[int, int], places: np.ndarray) -> np.ndarray:
    """Unit vectors (back, down, right), from textbooks: longitude and latitude; angle from the middle by the distance from it; tangent planes."""
    u, v = np.moveaxis(places / size, -1, 0)
    if name == "equirectangular":
        longitude, latitude = 2.0 * np.pi * (u - 0.5), np.pi * (v - 0.5)
        return np.stack([-np.cos(latitude) * np.cos(longitude), -np.sin(latitude), np.cos(latitude) * np.sin(longitude)], -1)
    if name == "dome":
        x, y = 2.0 * u - 1.0, 2.0 * v - 1.0
        away, turn = 0.5 * np.pi * np.hypot(x, y), np.arctan2(y, x)
        return np.stack([-np.cos(away), -np.sin(away) * np.sin(turn), np.sin(away) * np.cos(turn)], -1)
    face, x, y = np.floor(6.0 * u).astype(int), 2.0 * (6.0 * u % 1.0) - 1.0, 2.0 * v - 1.0
    yaw = np.radians([90.0, -90.0, 0.0, 0.0, 0.0, 180.0])[face]
    pitch = np.radians([0.0, 0.0, 90.0, -90.0, 0.0, 0.0])[face]
    ahead, up = np.cos(pitch) - y * np.sin(pitch), np.sin(pitch) + y * np.cos(pitch)
    found = np.stack([-(ahead * np.cos(yaw) - x * np.sin(yaw)), -up, ahead * np.sin(yaw) + x * np.cos(yaw)], -1)
    return found / np.linalg.norm(found, axis=-1, keepdims=True)


@pytest.mark.parametrize("name", SIZES)
def test_directions_of_ten_thousand_pixels_are_the_formula(ctx: moderngl.Context, tmp_path: Path, name: str) -> None:
    """By the shader in float32 within 1e-6, and by NumPy within rounding."""
    size, scene = SIZES[name], scene_of(name)
    path = tmp_path / "ask.frag"
    path.write_text(ASK)
    values, apart = uniforms.ray_values(plan(scene), size), (size[0] / 100.0, size[1] / 100.0)
    numbers = {key: tuple(map(float, np.ravel(values[key]))) for key in ("picture_size", "picture_offset")} | {"picture_scale": values["picture_scale"]}
    found = Piece(ctx, path, switches=uniforms.switches(plan(scene)), apart=apart, **numbers).draw((100, 100))[..., :3].reshape(-1, 3)
    middles = np.stack(np.meshgrid(np.arange(100) + 0.5, np.arange(100) + 0.5), -1).reshape(-1, 2)
    places = np.floor(middles * apart) + 0.5
    exact = by_formula(name, size, places)
    inside = np.hypot(*(2.0 * places / size - 1.0).T) < 1.0 if name == "dome" else np.ones(len(places), bool)
    assert np.abs(found - exact)[inside].max() < 1e-6
    assert np.abs(projection.directions(scene.camera, size, places) - exact)[inside].max() < 1e-14


@pytest.mark.parametrize("name", SIZES)
def test_what_pixels_meet_is_what_rays_in_their_directions_meet(renderer: Renderer, name: str) -> None:
    """The picture's map against listed rays, whose formula is NumPy's: escape directions within 2e-4 rad, the picture's own error at the shadow left out."""
    scene, size = scene_of(name, camera__yaw_deg=20.0, camera__dome_tilt_deg=40.0), tuple(side // 64 for side in SIZES[name])
    renderer.render(scene, 0.0, size)
    hits = renderer.hits()
    rays = listed_rays.pixel_rays(scene, size)[::-1].reshape(-1, 2)
    asked = listed_rays.trace_by_shader(renderer, scene, rays)
    fate, direction = hits.fate.ravel(), hits.direction.reshape(-1, 3)
    both = (fate == 1) & (asked.fate == 1)
    places = np.stack(np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5), -1).reshape(-1, 2)
    outside = (np.hypot(*(2.0 * places / size - 1.0).T) >= 1.0) if name == "dome" else np.zeros(len(places), bool)
    assert (fate[outside] == 2).all(), "nothing is seen beside the dome"
    assert ((fate == asked.fate) | outside).mean() > 0.999 and both.sum() > 0.7 * len(fate)
    apart = np.linalg.norm(direction - asked.direction, axis=-1)[both]
    assert np.quantile(apart, 0.99) < 2e-4


def test_values_under_the_mouse_are_those_of_the_pixel(renderer: Renderer) -> None:
    scene, size = scene_of("equirectangular"), (96, 48)
    renderer.render(scene, 0.0, size)
    hits = renderer.hits()
    for x, y in ((47, 24), (50, 22), (10, 30), (95, 5)):
        values = renderer.last.values_at(((x + 0.5) / size[0], (y + 0.5) / size[1]))
        assert values is not None and values.lam == pytest.approx(float(hits.lambda_[y, x]), abs=1e-3)


def test_no_seam_where_left_and_right_meet(renderer: Renderer) -> None:
    """What stands behind the camera, glow and all, looks as it does in front of it: within a level, also over the seam through the hole's middle."""
    shown = []
    for yaw in (0.0, 180.0):
        scene = scene_of("equirectangular", camera__yaw_deg=yaw, post__dither=False, post__bloom_intensity=1.0, camera__distance=6.0, sky__enabled=False)
        renderer.render_still(scene, 3.0, (1024, 512))
        shown.append(renderer.read_rgb8().astype(int))
    turned = np.roll(shown[1], 512, axis=1)
    apart = np.abs(turned - shown[0])
    assert shown[0][200:312, 500:524].max() > 100, "the disk crosses the seam"
    assert np.quantile(apart, 0.999) <= 1.0
    assert apart[:, 480:544].mean() <= apart[:, 380:640].mean() + 0.02, "the seam is as its surroundings"


@pytest.mark.parametrize("size", [(512, 288), (600, 256)], ids=["borders above", "borders aside"])
def test_glow_goes_round_in_the_window(size: tuple[int, int], renderer: Renderer) -> None:
    """Of what stands at the seam as of what stands in the middle: within a level, but for what falls between the pixels otherwise."""
    shown = []
    for yaw in (0.0, 150.0, 180.0):
        quiet: dict[str, object] = {"post__dither": False, "post__bloom_intensity": 1.0, "sky__enabled": False, "rays__edges": 1}
        renderer.render(scene_of("equirectangular", camera__yaw_deg=yaw, camera__distance=6.0, **quiet), 3.0, size)
        left, pixels = (size[0] - 512) // 2, renderer.read_rgb8()
        shown.append(pixels[:, left : left + 512].astype(int))
        assert not pixels[:, :left].any() and not pixels[:, left + 512 :].any() and not pixels[: (size[1] - 256) // 2].any(), "borders are black"
    assert shown[2][:, :2].max() > 100, "something stands at the seam"
    apart = np.abs(np.roll(shown[2], 256, axis=1) - shown[0])
    assert np.quantile(apart, 0.99) <= 1.0
    assert apart[:, 248:264].mean() <= apart[:, 128:384].mean() + 0.2
    # Where the seam is beside the hole, light from the right border reaches over the left one as it does inside.
    middle = shown[1]
    steps = np.abs(np.diff(np.concatenate([middle[:, -3:], middle[:, :3]], axis=1), axis=1)).mean(axis=(0, 2))
    assert steps[2] <= max(steps[:2].max(), steps[3:].max()) + 0.5


@pytest.mark.parametrize("name", ["dome", "equirectangular"])
def test_a_coarse_picture_enlarged_fills_its_projection_as_a_fine_one_does(name: str, renderer: Renderer) -> None:
    """As the window has it while the camera moves."""
    shown = []
    for size in ((120, 90), (240, 180)):
        target = renderer.ctx.simple_framebuffer((240, 180), 3)
        scene = scene_of(name, sky__enabled=False, post__bloom_threshold=0.0, post__exposure=8.0, camera__distance=6.0)
        renderer.render(scene, 3.0, size, target, (0, 0, 240, 180))
        shown.append(np.frombuffer(target.read(components=3, alignment=1), np.uint8).reshape(180, 240, 3).any(axis=-1))
        target.release()
    assert 0.2 < shown[1].mean() < 0.7
    assert (shown[0] != shown[1]).mean() < 0.02


def test_no_seam_over_the_zenith(renderer: Renderer) -> None:
    """The topmost row meets itself half way round: it differs there by no more than from the row below it. The glow of what stands there goes over it."""
    quiet: dict[str, object] = {"post__dither": False, "sky__enabled": False, "post__bloom_threshold": 0.0}
    scene = scene_of("equirectangular", camera__pitch_deg=-90.0, camera__inclination_deg=60.0, **quiet)
    renderer.render_still(scene, 3.0, (512, 256))
    rows = renderer.read_rgb8().astype(int)
    over = np.abs(rows[0] - np.roll(rows[0], 256, axis=0)).mean()
    inside = max(np.abs(rows[k] - rows[k + 1]).mean() for k in range(3))
    assert rows[:8].mean() > 4.0 and over <= inside + 1.0


def test_an_eye_looks_from_aside_and_its_axes_stay() -> None:
    scene = scene_of("stereo", camera__eye_separation=1.0, camera__yaw_deg=30.0, camera__pitch_deg=-20.0, camera__roll_deg=10.0, camera__azimuth_deg=70.0)
    middle = observer.observe(scene)
    back, _, right = middle.axes
    for longitude in (0.0, 1.0, math.pi, -2.0):
        places = []
        for side in (-1.0, 1.0):
            eye = stereo.eye(scene, longitude, side)
            seen = observer.observe(eye)
            np.testing.assert_allclose(seen.axes, middle.axes, atol=1e-12)
            places.append(eye.camera.distance * seen.n)
        ahead = math.sin(longitude) * right - math.cos(longitude) * back
        apart = places[1] - places[0]
        assert np.linalg.norm(apart) == pytest.approx(1.0) and abs(apart @ ahead) < 1e-12
        np.testing.assert_allclose(0.5 * (places[0] + places[1]), scene.camera.distance * middle.n, atol=1e-12)


def test_a_stereo_pair_has_the_left_eye_above(renderer: Renderer) -> None:
    """Each eye's half, where it looks ahead, is the mono picture from its place; the hole stands farther to the right for the left eye."""
    scene = scene_of("stereo", camera__eye_separation=2.0, post__bloom=False, post__dither=False, sky__enabled=False, disk__outer_radius=4.0)
    renderer.render_still(scene, 3.0, (512, 512))
    pair = renderer.read_rgb8().astype(int)
    x = np.arange(512)
    left, right = (float((half.sum(axis=(0, 2)) * x).sum() / half.sum()) for half in (pair[:256], pair[256:]))
    expected = 2.0 / scene.camera.distance * 512 / (2.0 * math.pi)  # parallax of the hole, in pixels
    assert left - right == pytest.approx(expected, rel=0.1), "the disk's near side is a fifth nearer than the hole, its far side as much farther"
    eye = stereo.eye(scene, 0.0, -1.0).with_values({"camera.projection": "equirectangular"})
    renderer.render_still(eye, 3.0, (512, 256))
    ahead = slice(250, 262)
    assert np.abs(renderer.read_rgb8()[:, ahead].astype(int) - pair[:256, ahead]).mean() < 1.0


def test_viewers_find_the_metadata_of_a_panorama(renderer: Renderer, tmp_path: Path) -> None:
    path = tmp_path / "round.png"
    for _ in still_files.write(renderer, path, scene_of("equirectangular"), 0.0, (128, 64)):
        pass
    with Image.open(path) as picture:
        packet = ElementTree.fromstring(picture.text["XML:com.adobe.xmp"].encode())
    (described,) = packet.iter("{http://www.w3.org/1999/02/22-rdf-syntax-ns#}Description")
    told = {key.removeprefix("{http://ns.google.com/photos/1.0/panorama/}"): value for key, value in described.attrib.items()}
    assert told["ProjectionType"] == "equirectangular" and told["FullPanoWidthPixels"] == "128" and told["CroppedAreaImageHeightPixels"] == "64"
    assert presets.load([str(path)]).camera.projection == "equirectangular"


@pytest.mark.parametrize(
    "values, says",
    [
        ({"camera.distance": math.inf}, "parallel rays"),
        ({"post.lens": True}, "plane picture"),
        ({"post.beam": True}, "plane picture"),
    ],
)
def test_what_a_projection_has_not_is_refused(values: dict[str, object], says: str) -> None:
    with pytest.raises(SceneError, match=says):
        plan(scene_of("dome").with_values(values))


def test_a_picture_of_another_shape_is_refused(renderer: Renderer) -> None:
    with pytest.raises(ValueError, match="got 1280x720; allowed with camera.projection = equirectangular is width:height 2:1.*1440x720"):
        renderer.render_still(scene_of("equirectangular"), 0.0, (1280, 720))
    with pytest.raises(ValueError, match="6:1"):
        renderer.render_still(scene_of("cube"), 0.0, (100, 100))


def test_labels_say_that_there_are_none() -> None:
    assert "camera.projection = dome" in labels.of(scene_of("dome"), 1.0).note


def test_a_cube_has_no_glow_and_says_so() -> None:
    made = plan(scene_of("cube"))
    assert not made.scene.post.bloom and any("glow" in text for text in made.warnings)
