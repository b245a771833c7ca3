"""Panoramas of strangers: the same light from every shape and depth of file, or a sentence; never anything else."""

from __future__ import annotations

import io
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from blackhole_gl.rendering import panorama_files
from blackhole_gl.rendering.sky_cube import on_cube
from blackhole_gl.scene.schema import SceneError

KEY = "sky.image.file"
Array = np.ndarray


def light_of(direction: Array) -> Array:
    """A smooth sky (…, 3), 0…1: what every file here is a picture of."""
    return 0.5 + 0.4 * direction


def code(light: Array, most: int) -> Array:
    return np.rint(most * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055))


def equirectangular(width: int) -> Array:
    longitude = np.pi * (1.0 - 2.0 * (np.arange(width) + 0.5) / width)
    latitude = 0.5 * np.pi * (1.0 - 4.0 * (np.arange(width // 2)[:, None] + 0.5) / width)
    level = np.cos(latitude)
    return light_of(np.stack([level * np.cos(longitude), level * np.sin(longitude), np.sin(latitude) + 0.0 * longitude], axis=-1))


def faces(side: int) -> list[Array]:
    """Right, left, up, down, front, back, each as one who stands within sees it, looking along x with z above."""
    x, down = np.meshgrid(*2 * [2.0 * (np.arange(side) + 0.5) / side - 1.0])
    one = np.ones_like(x)
    front, left, up = np.eye(3)[0], np.eye(3)[1], np.eye(3)[2]
    looks = [(-left, -front, up), (left, front, up), (up, -left, -front), (-up, -left, front), (front, -left, up), (-front, left, up)]  # ahead, right, above
    found = [one[..., None] * ahead + x[..., None] * right - down[..., None] * above for ahead, right, above in looks]
    return [light_of(d / np.linalg.norm(d, axis=-1, keepdims=True)) for d in found]


def laid(side: int, across: int, down: int) -> Array:
    """The faces in one picture of so many squares."""
    right, left, up, low, front, back = faces(side)
    gap = np.zeros_like(up)
    rows = {
        (6, 1): [[right, left, up, low, front, back]],
        (1, 6): [[face] for face in (right, left, up, low, front, back)],
        (3, 2): [[right, left, up], [low, front, back]],
        (4, 3): [[gap, up, gap, gap], [left, front, right, back], [gap, low, gap, gap]],
        (3, 4): [[gap, up, gap], [left, front, right], [gap, low, gap], [gap, back[::-1, ::-1], gap]],
    }[across, down]
    return np.concatenate([np.concatenate(row, axis=1) for row in rows])


def deep_png(codes: Array) -> bytes:
    """A PNG of 16 bits a colour, three or four colours."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows, columns, colours = codes.shape
    header = struct.pack(">IIBBBBB", columns, rows, 16, {3: 2, 4: 6}[colours], 0, 0, 0)
    packed = zlib.compress(b"".join(b"\0" + row.astype(">u2").tobytes() for row in codes))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")


def npy(values: Array) -> bytes:
    stream = io.BytesIO()
    np.save(stream, values)
    return stream.getvalue()


def png(codes: Array) -> bytes:
    stream = io.BytesIO()
    Image.fromarray(codes.astype(np.uint8)).save(stream, "PNG")
    return stream.getvalue()


@pytest.fixture(autouse=True)
def small_tiles(monkeypatch: pytest.MonkeyPatch) -> None:
    """A sixteenth of the texels that the program makes of a small picture, and of the time."""
    monkeypatch.setattr(panorama_files, "_LEAST_TILE", 128)


def read(folder: Path, name: str, data: bytes) -> tuple[Array, ...]:
    path = folder / name
    path.write_bytes(data)
    return panorama_files.read(KEY, panorama_files.stamp(KEY, str(path)))


def off(levels: tuple[Array, ...], level: int) -> float:
    """The farthest that a level's texels are from the sky, those beyond the faces' edges too."""
    atlas = levels[level].astype(float)
    tile = atlas.shape[0] // 2
    place = ((np.arange(tile) + 0.5) / tile * 2.0 - 1.0) / panorama_files.INNER
    u, v = np.meshgrid(place, place)
    tiles = atlas.reshape(2, tile, 3, tile, 3).transpose(2, 0, 1, 3, 4).reshape(6, tile, tile, 3)
    return max(np.abs(tiles[face] - light_of(on_cube(np.full(u.shape, face), u, v))).max() for face in range(6))


WIDE = equirectangular(384)
FILES = {
    "8 bits": ("a.png", png(code(WIDE, 255))),
    "16 bits": ("a.png", deep_png(code(WIDE, 65535).astype(np.uint16))),
    "half floats": ("a.npy", npy(WIDE.astype(np.float16))),
    "floats": ("a.npy", npy(WIDE.astype(np.float32))),
    "codes": ("a.npy", npy(code(WIDE, 65535).astype(np.uint16))),
}


@pytest.mark.filterwarnings("error")
def test_light_beyond_single_precision_is_the_brightest_without_a_word(tmp_path: Path) -> None:
    assert read(tmp_path, "a.npy", npy(np.full((8, 16, 3), 1e300)))[0].max() == panorama_files._BRIGHTEST


@pytest.mark.parametrize("name, data", FILES.values(), ids=FILES)
def test_every_depth_holds_the_same_light(tmp_path: Path, name: str, data: bytes) -> None:
    """To 0.012: a pixel of 0.016 rad, of which the pole's row knows the middle alone, and 8 bits."""
    levels = read(tmp_path, name, data)
    assert levels[0].dtype == np.float16 and len(levels) == panorama_files.LEVELS
    assert off(levels, 0) < 0.012


@pytest.mark.parametrize("across, down", [(6, 1), (1, 6), (3, 2), (4, 3), (3, 4)])
def test_six_faces_stand_where_they_belong(tmp_path: Path, across: int, down: int) -> None:
    """To 0.012: half a pixel at a face's rim, beyond which nothing is known of it."""
    levels = read(tmp_path, "a.npy", npy(laid(64, across, down).astype(np.float32)))
    assert off(levels, 0) < 0.012


@pytest.mark.parametrize("level, most", [(1, 0.02), (2, 0.03), (4, 0.12)])
def test_coarser_levels_are_means_that_fit_together(tmp_path: Path, level: int, most: float) -> None:
    """A mean is not the middle: the sky bends within a texel, and more where that is wide."""
    assert off(read(tmp_path, "a.npy", npy(WIDE.astype(np.float32))), level) < most


def test_sixteen_bits_are_more_than_eight(tmp_path: Path) -> None:
    """A ramp of 64 steps within one of eight bits."""
    codes = np.full((128, 256, 3), 32768, np.uint16) + np.arange(256, dtype=np.uint16)[None, :, None]
    found = read(tmp_path, "a.png", deep_png(codes))[0]
    assert len(np.unique(panorama_files._picture(deep_png(codes)))) == 256
    assert np.ptp(found[found > 0.0].astype(float)) > 0.0


def test_a_float_may_be_brighter_than_white_and_what_is_no_number_is_dark(tmp_path: Path) -> None:
    light = np.ones((64, 128, 3), np.float32)
    light[:32] = 300.0
    light[40, :, :] = np.nan
    light[45, :, :] = -5.0
    light[50, :, :] = np.inf
    found = read(tmp_path, "a.npy", npy(light))[0].astype(float)
    assert np.isfinite(found).all() and found.min() < 1e-3 and 300.0 <= found.max() <= 6.0e4


def test_alpha_lets_black_through(tmp_path: Path) -> None:
    found = read(tmp_path, "a.png", png(np.dstack([np.full((64, 128, 3), 255), np.full((64, 128), 128)])))[0]
    assert found.astype(float).max() == pytest.approx(128 / 255, abs=1e-3)


def header(text: str) -> bytes:
    packed = text.encode() + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(packed)) + packed


BAD = {
    "no such shape": ("a.png", png(np.zeros((64, 100, 3))), r"it has 100×64 pixels"),
    "not what it says": ("a.png", b"GIF89a" + bytes(40), "it is none of these kinds"),
    "cut off": ("a.png", png(code(WIDE, 255))[:2000], "it is damaged"),
    "no array": ("a.npy", b"\x93NUMPY\x09\x00" + bytes(60), "it is damaged"),
    "no numbers": ("a.npy", npy(np.array([["a"]])), r"it holds <U1 \(1, 1\)"),
    "objects": ("a.npy", header("{'descr': '|O', 'fortran_order': False, 'shape': (8, 16, 3)}") + bytes(50), "it holds object"),
    "more than there is": ("a.npy", header("{'descr': '<f4', 'fortran_order': False, 'shape': (8000, 8000, 3)}") + bytes(50), "it is cut off"),
    "endless": ("a.npy", header("{'descr': '<f4', 'fortran_order': False, 'shape': (9000000000000, 16, 3)}") + bytes(50), "it has 16×9000000000000 pixels"),
    "no pixels": ("a.npy", npy(np.zeros((0, 0, 3), np.float32)), "it has 0×0 pixels"),
    "two colours": ("a.npy", npy(np.zeros((8, 16, 2), np.float32)), r"it holds float32 \(8, 16, 2\)"),
    "code that would be run": ("a.npy", header("__import__('os').abort()"), "it is damaged"),
}


@pytest.mark.parametrize("name, data, reason", BAD.values(), ids=BAD)
def test_what_cannot_be_used_is_refused_with_a_sentence(tmp_path: Path, name: str, data: bytes, reason: str) -> None:
    for _ in range(2):  # what is kept of a first try says the same
        with pytest.raises(SceneError, match=rf"^sky.image.file: the panorama .*{name} cannot be used: {reason}.*; allowed is a PNG, JPEG.*twice as wide"):
            read(tmp_path, name, data)


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="sky.image.file: the panorama .*gone.png cannot be used: it cannot be read"):
        panorama_files.stamp(KEY, str(tmp_path / "gone.png"))


def hdr(light: Array, *, encoded: bool, head: str = "") -> bytes:
    """A Radiance picture, with runs of four literal bytes where it is `encoded`."""
    largest = light.max(axis=-1)
    exponent = np.where(largest > 0.0, np.floor(np.log2(np.maximum(largest, 1e-30))) + 1, -128).astype(int)
    mantissa = np.clip(np.floor(light * 2.0 ** (8.0 - exponent[..., None])), 0, 255)
    rows = np.concatenate([mantissa, np.clip(exponent + 128, 0, 255)[..., None]], axis=-1).astype(np.uint8)
    height, width = light.shape[:2]
    data = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n{head}\n-Y {height} +X {width}\n".encode()
    for row in rows:
        if not encoded:
            data += row.tobytes()
            continue
        data += bytes((2, 2, width >> 8, width & 255))
        for channel in row.T:
            for k in range(0, width, 4):
                piece = channel[k : k + 4].tobytes()
                data += bytes((128 + len(piece), piece[0])) if len(set(piece)) == 1 else bytes((len(piece),)) + piece
    return data


@pytest.mark.parametrize("encoded", [False, True])
def test_radiances_pictures_hold_the_light_to_their_eight_bits(tmp_path: Path, encoded: bool) -> None:
    light = equirectangular(256)
    bright = 300.0 * np.asarray(light)
    given = ((light, ""), (2.0 * light, "EXPOSURE=2\n"))
    found = [read(tmp_path, f"sky{k}.hdr", hdr(values, encoded=encoded, head=head)) for k, (values, head) in enumerate(given)]
    assert off(found[0], 0) < 0.008 and off(found[1], 0) < 0.008  # mantissas of eight bits: 2⁻⁷ of the largest
    assert np.abs(read(tmp_path, "bright.hdr", hdr(bright, encoded=encoded))[0].astype(float).max() / bright.max() - 1.0) < 0.01


def test_damaged_pictures_of_radiances_are_refused_with_a_sentence(tmp_path: Path) -> None:
    whole = hdr(equirectangular(64), encoded=True)
    damaged = {
        "cut off": whole[:-40], "no Radiance picture": b"P6\n" + whole, "not in RGBE": whole.replace(b"rle_rgbe", b"rle_xyze"),
        "top left": whole.replace(b"-Y", b"+Y"), "exposure": whole.replace(b"FORMAT", b"EXPOSURE=-1\nFORMAT"),
        "pixels": whole.replace(b"-Y 32 +X 64", b"-Y 99999 +X 99999"), "no length": whole.replace(bytes((2, 2, 0, 64)), bytes((2, 2, 0, 64, 0)), 1),
    }  # fmt: skip
    for reason, data in damaged.items():
        with pytest.raises(SceneError, match=reason):
            read(tmp_path, "bad.hdr", data)


@pytest.mark.parametrize("names", [("right", "left", "up", "down", "front", "back"), ("PX", "NX", "PY", "NY", "PZ", "NZ")])
def test_six_files_are_six_faces(tmp_path: Path, names: tuple[str, ...]) -> None:
    for name, face in zip(names, faces(64)):
        (tmp_path / f"sky_{name}.png").write_bytes(png(code(face, 255)))
    data = (tmp_path / f"sky_{names[4]}.png").read_bytes()
    assert off(read(tmp_path, f"sky_{names[4]}.png", data), 0) < 0.02
    (tmp_path / f"sky_{names[0]}.png").write_bytes(png(code(faces(32)[0], 255)))
    with pytest.raises(SceneError, match="have sides of 32, 64 pixels"):
        read(tmp_path, f"sky_{names[1]}.png", (tmp_path / f"sky_{names[1]}.png").read_bytes())
