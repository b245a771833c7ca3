"""Picture files of strangers: read right, or refused with a sentence; never anything else."""

from __future__ import annotations

import io
import os
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from blackhole_gl.rendering import picture_files
from blackhole_gl.rendering.picture_files import PictureFiles, stamp
from blackhole_gl.scene.schema import SceneError

KEY = "sky.picture.file"
FORMATS = {".png": "PNG", ".jpg": "JPEG", ".webp": "WEBP", ".bmp": "BMP"}
HALF_CODE = 188  # sRGB's code of half of all light, to 1/255


def colours(width: int = 24, height: int = 16) -> Image.Image:
    ramp = np.linspace(0, 255, width * height).reshape(height, width)
    return Image.fromarray(np.stack([ramp, ramp[::-1], 255 - ramp], axis=-1).astype(np.uint8))


def read(path: Path, most_aside: int = 4096) -> np.ndarray:
    return PictureFiles().read(KEY, stamp(KEY, str(path)), most_aside)


def put(path: Path, data: bytes) -> Path:
    path.write_bytes(data)
    return path


def png(width: int, height: int, packed: bytes) -> bytes:
    """A PNG that says it has so many grey pixels, whatever `packed` holds."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_picture_is_linear_light_from_the_bottom_up(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    image = Image.new("RGB", (8, 6), (HALF_CODE, 0, 255))
    image.paste((0, 255, 0), (0, 0, 8, 3))
    image.save(path, FORMATS[suffix], **({"lossless": True} if suffix == ".webp" else {"quality": 100, "subsampling": 0} if suffix == ".jpg" else {}))
    light = read(path)
    assert light.shape == (6, 8, 4) and light.dtype == np.float16
    np.testing.assert_allclose(light[0, 4], [0.5, 0.0, 1.0, 1.0], atol=0.03 if suffix == ".jpg" else 0.004)  # JPEG is lossy; else the code of half is
    np.testing.assert_allclose(light[5, 4], [0.0, 1.0, 0.0, 1.0], atol=0.03 if suffix == ".jpg" else 1e-3)


def test_light_is_premultiplied_by_alpha(tmp_path: Path) -> None:
    Image.new("RGBA", (2, 2), (255, 255, 255, 51)).save(tmp_path / "a.png")
    np.testing.assert_allclose(read(tmp_path / "a.png")[0, 0], 0.2, atol=1e-3)  # half floats


@pytest.mark.parametrize("mode", ["L", "LA", "P", "1", "I;16", "CMYK"])
def test_every_mode_of_these_formats_is_read(tmp_path: Path, mode: str) -> None:
    if mode == "I;16":
        image = Image.fromarray(np.full((4, 4), 0xFFFF, np.uint16))
    else:
        image = Image.new("L", (4, 4), 255).convert(mode)
    path = tmp_path / ("a.jpg" if mode == "CMYK" else "a.png")
    image.save(path)
    np.testing.assert_allclose(read(path)[0, 0], 1.0, atol=0.02)  # JPEG is lossy


def test_a_camera_held_upright_gives_an_upright_picture(tmp_path: Path) -> None:
    image = Image.new("RGB", (8, 4))
    exif = image.getexif()
    exif[0x0112] = 6  # turned by a quarter
    image.save(tmp_path / "a.jpg", exif=exif)
    assert read(tmp_path / "a.jpg").shape[:2] == (8, 4)


@pytest.mark.parametrize("suffix", [".png", ".jpg"])
def test_a_large_picture_is_reduced(tmp_path: Path, suffix: str) -> None:
    colours(400, 200).save(tmp_path / f"a{suffix}", FORMATS[suffix])
    assert read(tmp_path / f"a{suffix}", most_aside=100).shape[:2] == (50, 100)


def refused(path: Path) -> str:
    with pytest.raises(SceneError) as caught:
        read(path)
    text = str(caught.value)
    assert text.startswith(f"{KEY}: the picture {path} cannot be used: ") and text.endswith(f"; allowed is {picture_files.ALLOWED}")
    return text


def test_what_is_no_file_is_told(tmp_path: Path) -> None:
    assert "No such file" in refused(tmp_path / "none.png")
    (tmp_path / "folder.png").mkdir()
    assert "it is no file" in refused(tmp_path / "folder.png")
    assert "it is empty" in refused(put(tmp_path / "empty.png", b""))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.png")
    assert "it is no file" in refused(tmp_path / "pipe.png")


def test_a_file_of_too_many_bytes_is_not_read(tmp_path: Path) -> None:
    with open(tmp_path / "huge.png", "wb") as stream:
        stream.truncate(picture_files.MOST_BYTES + 1)
    assert f"it has {picture_files.MOST_BYTES + 1} bytes" in refused(tmp_path / "huge.png")


@pytest.mark.parametrize("size", [(picture_files.MOST_ASIDE + 1, 1), (16384, 16384), (2**31 - 1, 2**31 - 1)])
def test_a_bomb_is_not_decoded(tmp_path: Path, size: tuple[int, int]) -> None:
    text = refused(put(tmp_path / "bomb.png", png(*size, zlib.compress(bytes(1 << 16)))))
    assert f"{size[0]}×{size[1]} pixels" in text or "damaged" in text  # Pillow refuses the largest itself


def test_words_that_unpack_without_end_are_not_unpacked(tmp_path: Path) -> None:
    bomb = b"words\0\0" + zlib.compress(bytes(1 << 22)) * 64
    chunk = struct.pack(">I", len(bomb)) + b"zTXt" + bomb + struct.pack(">I", zlib.crc32(b"zTXt" + bomb))
    whole = png(2, 2, zlib.compress(bytes(6)))
    assert "it is damaged" in refused(put(tmp_path / "a.png", whole[:33] + chunk + whole[33:]))


@pytest.mark.parametrize("data", [b"%!PS-Adobe-3.0 EPSF-3.0\n", b"GIF89a", b"<svg xmlns='http://www.w3.org/2000/svg'/>", b"\0" * 100])
def test_another_kind_is_told_whatever_its_name(tmp_path: Path, data: bytes) -> None:
    assert "it is none of these kinds" in refused(put(tmp_path / "a.png", data))


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_damaged_picture_is_read_or_refused_with_a_sentence(tmp_path: Path, suffix: str) -> None:
    stream = io.BytesIO()
    colours().save(stream, FORMATS[suffix])
    whole, chance = stream.getvalue(), np.random.default_rng(7)
    for round_ in range(150):
        data = bytearray(whole[: int(chance.integers(1, len(whole)))] if round_ % 3 == 0 else whole)
        for _ in range(int(chance.integers(0, 12))):
            data[int(chance.integers(len(data)))] = int(chance.integers(256))
        path = put(tmp_path / f"{round_}{suffix}", bytes(data))
        try:
            light = read(path)
        except SceneError as error:
            assert str(path) in str(error) and picture_files.ALLOWED in str(error)
        else:
            assert np.isfinite(light).all()


def test_a_truncated_picture_is_refused(tmp_path: Path) -> None:
    colours().save(tmp_path / "a.png")
    data = (tmp_path / "a.png").read_bytes()
    assert "it is damaged" in refused(put(tmp_path / "b.png", data[: len(data) // 2]))


def test_a_picture_is_read_again_only_when_its_file_changes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, kept, reads = put(tmp_path / "a.png", b"no picture"), PictureFiles(), []
    decoded = picture_files._decoded
    monkeypatch.setattr(picture_files, "_decoded", lambda *given: reads.append(given) or decoded(*given))
    for _ in range(2):
        with pytest.raises(SceneError):
            kept.read(KEY, stamp(KEY, str(path)), 64)
    assert len(reads) == 1, "what cannot be used is remembered too"
    colours().save(path)
    first = kept.read(KEY, stamp(KEY, str(path)), 64)
    assert kept.read(KEY, stamp(KEY, str(path)), 64) is first and len(reads) == 2


def test_few_pictures_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(picture_files, "_KEPT_BYTES", 3 * 24 * 16 * 8)
    kept = PictureFiles()
    for number in range(6):
        colours().save(tmp_path / f"{number}.png")
        kept.read(KEY, stamp(KEY, str(tmp_path / f"{number}.png")), 64)
    assert len(kept._kept) == 3


def test_an_asset_is_named_wherever_it_lies() -> None:
    assert stamp(KEY, "asset:thumbnails/kerr.jpg").size > 0
    for value in ("asset:none.png", "asset:../pyproject.png", "asset:/etc/hostname.png"):
        with pytest.raises(SceneError, match=rf"^{KEY}: got '{value}'; allowed after asset: is the name of a file in "):
            stamp(KEY, value)
