"""PNG files: pixels, the preset inside, and what is said of files that are not ours."""

import io
import os
import struct
import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from blackhole_gl.output import png

TEXT = 'title = "Grüße, r_s ☾"\n[hole]\nspin = 0.5\n'


@pytest.fixture
def pixels():
    return np.random.default_rng(1).integers(0, 256, (7, 5, 3), dtype=np.uint8)


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def test_pixels_and_text_come_back(tmp_path, pixels):
    path = tmp_path / "new folder" / "a.png"
    png.write(path, pixels, TEXT)
    assert png.read_scene_text(path) == TEXT
    assert np.array_equal(np.asarray(Image.open(path)), pixels)
    assert [item.name for item in path.parent.iterdir()] == ["a.png"]


@pytest.mark.parametrize("packed", [True, False], ids=["packed", "as they are"])
@pytest.mark.parametrize("rows", [1, 2, 3, 7, 100])
def test_large_pictures_are_written_in_strips(rows, packed, pixels, monkeypatch):
    """The sum over all of them is checked here, which not every reader does."""
    monkeypatch.setattr(png, "_STRIP_BYTES", rows * 15)
    monkeypatch.setattr(png, "_STORED", 40)
    data = png.encode(pixels, TEXT, packed=packed)
    assert data.count(b"IDAT") == 2 + -(-7 // rows), "header and sum are parts of their own"
    assert np.array_equal(np.asarray(Image.open(io.BytesIO(data))), pixels)
    parts, place = b"", 8
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place : place + 8])
        parts += data[place + 8 : place + 8 + length] if kind == b"IDAT" else b""
        place += 12 + length
    assert len(zlib.decompress(parts)) == 7 * 16
    assert np.array_equal(np.asarray(Image.open(io.BytesIO(png.encode(pixels[::-1], TEXT, packed=packed)))), pixels[::-1])


def test_equal_input_gives_equal_bytes(pixels):
    assert png.encode(pixels, TEXT) == png.encode(pixels.copy(), TEXT)


def test_srgb_is_declared_before_the_pixels_and_no_time_is_stored(pixels):
    data = png.encode(pixels, TEXT)
    assert _chunk(b"sRGB", b"\0") in data[: data.index(b"IDAT")]
    assert b"tIME" not in data


def test_other_readers_find_the_text(pixels):
    assert Image.open(io.BytesIO(png.encode(pixels, TEXT))).text[png.KEYWORD] == TEXT


@pytest.mark.parametrize("shape, kind", [((4, 4), np.uint8), ((4, 4, 4), np.uint8), ((4, 4, 3), np.float32), ((0, 4, 3), np.uint8)])
def test_other_arrays_are_refused(shape, kind):
    with pytest.raises(ValueError, match="height, width, 3"):
        png.encode(np.zeros(shape, kind))


def test_a_picture_without_preset_is_refused(tmp_path, pixels):
    png.write(tmp_path / "a.png", pixels)
    with pytest.raises(png.PngError, match="no preset"):
        png.read_scene_text(tmp_path / "a.png")


def test_writing_where_nothing_can_be_written_leaves_nothing(tmp_path, pixels):
    (tmp_path / "folder").mkdir()
    with pytest.raises(OSError):
        png.write(tmp_path / "folder", pixels)
    assert [item.name for item in tmp_path.iterdir()] == ["folder"]


def test_a_link_is_followed_and_a_device_is_not_replaced(tmp_path, pixels):
    (tmp_path / "real.png").write_bytes(b"old")
    try:
        (tmp_path / "link.png").symlink_to("real.png")
    except OSError:
        pytest.skip("this system makes no symbolic links, or lets this user make none")
    png.write(tmp_path / "link.png", pixels)
    assert (tmp_path / "link.png").is_symlink() and Image.open(tmp_path / "real.png").size == (5, 7)
    png.write(os.devnull, pixels)
    assert not os.path.isfile(os.devnull)


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_a_damaged_file_gives_the_text_or_an_error(tmp_path_factory, data):
    whole = bytearray(png.encode(np.zeros((2, 2, 3), np.uint8), TEXT))
    end = data.draw(st.integers(0, len(whole)))
    damaged = whole[:end]
    if damaged:
        damaged[data.draw(st.integers(0, len(damaged) - 1))] ^= data.draw(st.integers(0, 255))
    path = tmp_path_factory.getbasetemp() / "damaged.png"
    path.write_bytes(damaged)
    try:
        assert png.read_scene_text(path) == TEXT
    except png.PngError:
        pass


@pytest.mark.parametrize(
    "chunk, says",
    [(b"", "cut short"), (b"\1\0\0\0zzz", "compressed"), (b"\0\0\0\0\xff", "UTF-8"), (b"\0\0no end", "cut short")],
)
def test_a_strange_chunk_is_named(tmp_path, chunk, says):
    data = b"\x89PNG\r\n\x1a\n" + _chunk(b"iTXt", png.KEYWORD.encode() + b"\0" + chunk) + _chunk(b"IEND", b"")
    (tmp_path / "a.png").write_bytes(data)
    with pytest.raises(png.PngError, match=says):
        png.read_scene_text(tmp_path / "a.png")
