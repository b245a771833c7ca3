"""Pictures in tiles and bands: no edge of one shows, glow reaches over all of them, and no more is held than it reaches."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from blackhole_gl.output import png
from blackhole_gl.rendering import post, still_files, stills
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

GLOWING = {"post.bloom_intensity": 1.5, "post.bloom_spread": 3.0, "post.bloom_threshold": 0.1, "post.dither": False}
SIZE = (300, 1100)


@pytest.fixture(scope="module")
def whole(renderer: Renderer) -> np.ndarray:
    """All of it developed at once."""
    renderer.render_still(presets.load(["kerr"], GLOWING), 3.0, SIZE)
    return renderer.read_rgb8()


@pytest.fixture
def cut(monkeypatch: pytest.MonkeyPatch) -> None:
    """Bands and parts as small as they can be."""
    monkeypatch.setattr(stills, "_BAND_PIXELS", 1)
    monkeypatch.setattr(stills, "_MOST_WIDE", 1)


@pytest.mark.usefixtures("cut")
def test_no_edge_of_a_band_or_a_part_shows(renderer: Renderer, whole: np.ndarray) -> None:
    """As the whole, over edges as inside, but for a level in one value of a thousand, where the place in the glow rounds otherwise."""
    for _ in renderer.still(presets.load(["kerr"], GLOWING), 3.0, SIZE, 1, 128):
        pass
    apart = np.abs(renderer.read_rgb8().astype(int) - whole)
    assert apart.max() <= 1 and (apart > 0).mean() < 1e-3


@pytest.mark.usefixtures("cut")
def test_what_is_held_does_not_grow_with_the_height(renderer: Renderer) -> None:
    """Arrays and the textures that are alive: those of a picture twice as high are no more."""
    held: list[tuple[int, int]] = []
    made = stills.Stills._texture
    for height in (1536, 3072):
        textures: set[int] = set()

        def counted(self: stills.Stills, size: tuple[int, int], textures: set[int] = textures):
            texture = made(self, size)
            textures.add(texture.glo)
            return texture

        stills.Stills._texture = counted  # type: ignore[method-assign]
        tracemalloc.start()
        try:
            for _ in renderer.bands([(presets.load(["kerr"]), 0.0)], (256, height), 1, 128):
                pass
            held.append((len(textures), tracemalloc.get_traced_memory()[1]))
        finally:
            stills.Stills._texture = made  # type: ignore[method-assign]
            tracemalloc.stop()
    assert held[0][0] == held[1][0] < 2 * (post.GLOW_REACH // 128 + 2) + 1
    assert held[1][1] < 1.2 * held[0][1]


@pytest.mark.parametrize("size", [(16400, 1), (1, 16400), (8, 16400)])
def test_a_strip_longer_than_a_texture_is_drawn(renderer: Renderer, size: tuple[int, int]) -> None:
    """It has no more pixels than a tile, and was drawn as one."""
    renderer.render_still(presets.load(["kerr"]), 0.0, size)
    assert renderer.read_rgb8().shape == (size[1], size[0], 3)


@pytest.mark.parametrize("values", [{"post.lens": True}, {"post.beam": True}, {"post.colours": "afmhot"}])
def test_a_picture_whose_light_is_needed_at_once_is_refused_where_no_texture_holds_it(renderer: Renderer, values: dict) -> None:
    with pytest.raises(ValueError, match="got 1x40000; allowed is at most [0-9]+ pixels a side with post.lens, post.beam or post.colours"):
        renderer.render_still(presets.load(["kerr"], values), 0.0, (1, 40000))


def test_rows_that_are_written_one_by_one_are_the_picture(tmp_path: Path) -> None:
    pixels = np.random.default_rng(3).integers(0, 256, (37, 11, 3), np.uint8)
    with png.opened(tmp_path / "a.png", (11, 37)) as file:
        for first in range(0, 37, 5):
            file.write(pixels[first : first + 5])
    assert (tmp_path / "a.png").read_bytes() == png.encode(pixels)
    assert np.array_equal(png.read(tmp_path / "a.png"), pixels)
    with pytest.raises(ValueError, match="5 of 37 rows"), png.opened(tmp_path / "b.png", (11, 37)) as file:
        file.write(pixels[:5])
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_a_16_bit_picture_is_the_linear_radiance(renderer: Renderer, tmp_path: Path) -> None:
    """Read by FFmpeg, through PyAV: within half a step of 8/65535."""
    import av

    scene, size = presets.load(["kerr"]), (72, 40)
    still_files.write_linear(renderer, tmp_path / "linear.png", scene, 3.0, size)
    with av.open(str(tmp_path / "linear.png")) as container:
        frame = next(container.decode(video=0))
    assert frame.format.name == "rgb48be"
    read = frame.to_ndarray().astype(float) * still_files.WHITE / 65535.0
    light = np.minimum(renderer.still_radiance(scene, 3.0, size), still_files.WHITE)
    assert light.max() > 0.5
    np.testing.assert_allclose(read, light, atol=0.51 * still_files.WHITE / 65535.0)
    data = (tmp_path / "linear.png").read_bytes()
    assert b"gAMA\x00\x01\x86\xa0" in data and b"sRGB" not in data and b"blackhole_gl.white\x008" in data
    assert presets.load([str(tmp_path / "linear.png")]) == scene


def test_a_still_in_a_file_is_the_picture(renderer: Renderer, tmp_path: Path) -> None:
    for values in ({}, {"post.labels": True}):
        scene = presets.load(["kerr"], values)
        shares = list(still_files.write(renderer, tmp_path / "a.png", scene, 3.0, (160, 90)))
        assert shares[-1] == 1.0 and presets.load([str(tmp_path / "a.png")]) == scene
    renderer.render_still(scene.with_values({"post.labels": False}), 3.0, (160, 90))
    labelled = png.read(tmp_path / "a.png")
    assert 0.001 < (labelled != renderer.read_rgb8()).any(axis=-1).mean() < 0.9, "at such a size much of it is words"
