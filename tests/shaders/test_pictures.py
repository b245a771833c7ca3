"""Pictures of the user's as textures: a sampler for each that a plug-in names, and one array for those of all things and media."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import moderngl
import numpy as np
import pytest
from PIL import Image

from blackhole_gl.planning import plan
from blackhole_gl.rendering import instances
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.pictures import ARRAY, Pictures
from blackhole_gl.rendering.pictures import layers as layers_of
from blackhole_gl.scene import FrozenMap, Scene, SceneError
from tests.unit.kinds import known_kinds  # noqa: F401

RED, GREEN, BLUE = (255, 0, 0), (0, 255, 0), (0, 0, 255)


@pytest.fixture
def pictures(ctx: moderngl.Context) -> Iterator[Pictures]:
    made = Pictures(ctx)
    yield made
    made.release()


def put(path: Path, colour: tuple[int, int, int], size: tuple[int, int] = (4, 4)) -> str:
    Image.new("RGB", size, colour).save(path)
    return str(path)


def spheres(*images: str) -> Scene:
    return Scene().with_values({f"things.s{k}.{name}": value for k, image in enumerate(images) for name, value in (("kind", "globe"), ("image", image))})


def layers(texture: moderngl.TextureArray) -> np.ndarray:
    width, height, count = texture.size
    return np.frombuffer(texture.read(), np.float16).reshape(count, height, width, 4)


@pytest.mark.usefixtures("known_kinds")
def test_every_instance_knows_the_layer_of_its_own_picture(pictures: Pictures, tmp_path: Path) -> None:
    red, green = put(tmp_path / "r.png", RED), put(tmp_path / "g.png", GREEN, (8, 2))
    scene = spheres(red, "", green, red)
    texture = pictures.of_instances(scene)[ARRAY]
    assert texture.size == (8, 4, 2), "as large as the largest, and each once"
    shown = layers(texture)
    np.testing.assert_array_equal(shown[0], np.broadcast_to([1, 0, 0, 1], (4, 8, 4)))
    np.testing.assert_array_equal(shown[1], np.broadcast_to([0, 1, 0, 1], (4, 8, 4)))
    (kind,) = instances.used(scene)
    place = next(place for item, place in instances._places(kind)[0] if item.key == "image")
    assert instances._rows(kind, plan(scene), 0.0, FrozenMap(layers_of(scene))).reshape(4, -1)[:, place].tolist() == [0, -1, 1, 0]
    text = instances.glsl([kind])
    assert f"uniform sampler2DArray {ARRAY};" in text and f"#define thing_globe_image(i) int(textureLod(thing_globe_table, (vec2({place // 4}, i)" in text


@pytest.mark.usefixtures("known_kinds")
def test_the_array_is_made_anew_when_a_file_or_the_choice_changes_and_only_then(pictures: Pictures, tmp_path: Path) -> None:
    red = put(tmp_path / "r.png", RED)
    first = pictures.of_instances(spheres(red))[ARRAY]
    assert pictures.of_instances(spheres(red, red).with_values({"things.s1.radius": 3.0}))[ARRAY] is first and pictures.made == 1
    put(tmp_path / "r.png", BLUE)
    os.utime(red, ns=(1, 1))
    assert layers(pictures.of_instances(spheres(red))[ARRAY])[0, 0, 0].tolist() == [0, 0, 1, 1] and pictures.made == 2
    assert pictures.of_instances(spheres("")) == {}


@pytest.mark.usefixtures("known_kinds")
def test_many_pictures_share_the_room(pictures: Pictures, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("blackhole_gl.rendering.pictures.MOST_ARRAY_BYTES", 3 * 4 * 4 * 8)
    texture = pictures.of_instances(spheres(*(put(tmp_path / f"{k}.png", RED, (8, 8)) for k in range(3))))[ARRAY]
    assert texture.size == (4, 4, 3)


@pytest.mark.usefixtures("known_kinds")
def test_a_picture_that_cannot_be_used_names_the_key_of_its_instance(pictures: Pictures, tmp_path: Path) -> None:
    (tmp_path / "bad.png").write_bytes(b"no picture")
    with pytest.raises(SceneError, match=rf"^things.s1.image: the picture {tmp_path / 'bad.png'} cannot be used: it is none of these kinds"):
        pictures.of_instances(spheres(put(tmp_path / "r.png", RED), str(tmp_path / "bad.png")))


# --- the sky that is a picture ---

SIZE = (96, 64)
NAKED = {"rays.model": "flat", "rays.edges": 1, "hole.spin": 0.0, "disk.enabled": False, "camera.distance": 1e4, "camera.fov_deg": 40.0, "sky.model": "picture"}


@pytest.fixture
def renderer(ctx: moderngl.Context) -> Iterator[Renderer]:
    made = Renderer(ctx)
    yield made
    made.release()


def hung(file: str, **values: object) -> Scene:
    return Scene().with_values({**NAKED, "sky.picture.file": file, **{f"sky.picture.{name}": value for name, value in values.items()}})


def ramps(path: Path, size: tuple[int, int]) -> str:
    """Light whose red grows from left to right and whose green grows from the bottom up, from 0.2 to 1."""
    across, upwards = np.meshgrid((np.arange(size[0]) + 0.5) / size[0], (np.arange(size[1])[::-1] + 0.5) / size[1])
    light = 0.2 + 0.8 * np.stack([across, upwards, np.zeros_like(across)], axis=-1)
    code = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    Image.fromarray(np.rint(255 * code).astype(np.uint8)).save(path)
    return str(path)


@pytest.mark.parametrize("azimuth, inclination", [(0.0, 90.0), (130.0, 35.0), (-75.0, 160.0)])
def test_a_picture_behind_the_hole_is_seen_straight_from_everywhere(renderer: Renderer, tmp_path: Path, azimuth: float, inclination: float) -> None:
    scene = hung(ramps(tmp_path / "a.png", (300, 150)), width_deg=50.0, background_blue=0.5)
    renderer.render(scene.with_values({"camera.azimuth_deg": azimuth, "camera.inclination_deg": inclination}), 0.0, SIZE)
    seen = renderer.radiance()
    y, x = np.mgrid[0 : SIZE[1], 0 : SIZE[0]] + 0.5
    half = np.tan(np.radians(20.0)) / (SIZE[1] / 2)
    across, upwards = (x - SIZE[0] / 2) * half, (SIZE[1] / 2 - y) * half
    u = 0.5 + 0.5 * across / np.tan(np.radians(25.0))
    v = 0.5 + upwards / np.tan(np.radians(25.0))
    edge = 2.0 / SIZE[0]
    inside = (np.minimum(u, 1 - u) > edge) & (np.minimum(v, 1 - v) > edge)
    outside = (np.minimum(u, 1 - u) < -edge) | (np.minimum(v, 1 - v) < -edge)
    within = inside & (np.hypot(across, upwards) > 0.05)  # the black disc of the hole itself, 1 r_s wide at 10⁴, is less than a pixel
    expected = 0.2 + 0.8 * np.stack([u, v, 0.0 * u], axis=-1)
    np.testing.assert_allclose(seen[within], expected[within], atol=0.012)  # codes of 8 bits: light to 0.009 at white; half floats, directions of 32 bits
    np.testing.assert_allclose(seen[outside], np.broadcast_to([0, 0, 0.5], seen[outside].shape), atol=1e-3)
    assert inside.sum() > 500 and outside.sum() > 500


def test_a_fixed_picture_stays_where_it_hangs(renderer: Renderer, tmp_path: Path) -> None:
    scene = hung(put(tmp_path / "r.png", RED), hung="fixed", azimuth_deg=180.0, latitude_deg=0.0, width_deg=20.0)
    renderer.render(scene.with_values({"camera.azimuth_deg": 0.0, "camera.inclination_deg": 90.0}), 0.0, SIZE)
    assert renderer.radiance()[SIZE[1] // 2 + 4, SIZE[0] // 2 + 4].tolist() == [1, 0, 0]
    renderer.render(scene.with_values({"camera.azimuth_deg": 90.0, "camera.inclination_deg": 90.0}), 0.0, SIZE)
    assert renderer.radiance().max() < 1e-3  # pixels at the hole's edge show the mean of half the sky


def test_what_is_finer_than_a_pixel_is_seen_as_its_mean_light(renderer: Renderer, tmp_path: Path) -> None:
    chequers = (np.indices((1024, 1024)).sum(axis=0) % 2 * 255).astype(np.uint8)
    Image.fromarray(chequers).save(tmp_path / "c.png")
    renderer.render(hung(str(tmp_path / "c.png"), width_deg=60.0), 0.0, SIZE)
    np.testing.assert_allclose(renderer.radiance()[10:20, 20:40], 0.5, atol=0.01)  # in light, not in codes, whose mean is 0.21


def test_a_picture_that_cannot_be_used_leaves_the_last_one(renderer: Renderer, tmp_path: Path) -> None:
    renderer.render(hung(put(tmp_path / "r.png", RED)), 0.0, SIZE)
    before = renderer.read_rgb8()
    (tmp_path / "bad.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    with pytest.raises(SceneError, match=r"^sky\.picture\.file: the picture .*bad\.png cannot be used: it is "):
        renderer.render(hung(str(tmp_path / "bad.png")), 0.0, SIZE)
    np.testing.assert_array_equal(renderer.read_rgb8(), before)
    renderer.render(hung(""), 0.0, SIZE)
    assert renderer.radiance().max() == 0.0, "without a file there is the background alone"


def test_a_file_that_changes_is_shown_anew(renderer: Renderer, tmp_path: Path) -> None:
    path = put(tmp_path / "r.png", RED)
    for _ in range(3):  # from the second frame on the sky is kept
        renderer.render(hung(path, width_deg=120.0), 0.0, SIZE)
    put(tmp_path / "r.png", GREEN)
    os.utime(path, ns=(1, 1))
    renderer.render(hung(path, width_deg=120.0), 0.0, SIZE)
    assert renderer.radiance()[8, 8].tolist() == [0, 1, 0]
