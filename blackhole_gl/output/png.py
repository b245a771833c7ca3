"""PNG files that carry the preset they were made from.

The preset's TOML travels in an uncompressed iTXt chunk (PNG specification, third edition, §11.3.3.4). Equal input gives equal
bytes: no time of writing is stored.
"""

from __future__ import annotations

import functools
import io
import os
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .files import write_whole

KEYWORD = "blackhole_gl.scene"

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_SRGB_PERCEPTUAL = b"\x00"
_SUB, _UP = 1, 2  # kinds of differences, §9.2
_STRIP_BYTES = 1 << 22
_ZLIB_HEADER = b"\x78\x5e"  # RFC 1950, §2.2: deflate, windows of 32 KiB, packed fast
_ADLER = 65521
# The longest preset taken from a file; ours have a few thousand bytes.
_LONGEST_TEXT = 1 << 20


class PngError(ValueError):
    """A file is no PNG, is damaged, or carries no preset; the text says which."""


def encode(pixels: np.ndarray, scene_text: str = "") -> bytes:
    """An 8-bit sRGB PNG.

    Args:
        pixels: (height, width, 3) uint8, display-referred sRGB, top row first.
        scene_text: the preset to carry, TOML; empty for none.

    Raises:
        ValueError: `pixels` has another shape or type.
    """
    if pixels.dtype != np.uint8 or pixels.ndim != 3 or pixels.shape[2] != 3 or pixels.size == 0:
        raise ValueError(f"a picture is (height, width, 3) uint8; got {pixels.shape} {pixels.dtype}")
    height, width, _ = pixels.shape
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)), (b"sRGB", _SRGB_PERCEPTUAL)]
    if scene_text:
        chunks.append((b"iTXt", KEYWORD.encode("ascii") + b"\0\0\0\0\0" + scene_text.encode("utf-8")))
    chunks += [(b"IDAT", data) for data in _packed(pixels)]
    return b"".join([_SIGNATURE, *(part for kind, data in (*chunks, (b"IEND", b"")) for part in _chunk(kind, data))])


def _chunk(kind: bytes, data: bytes) -> tuple[bytes, ...]:
    return struct.pack(">I", len(data)), kind, data, struct.pack(">I", zlib.crc32(data, zlib.crc32(kind)))


def _packed(pixels: np.ndarray) -> list[bytes]:
    """A zlib stream of all rows, in parts that were packed on all cores: on one, a picture of 7680 × 4320 took longer to pack than to draw."""
    strips = range(0, len(pixels), max(_STRIP_BYTES // (3 * pixels.shape[1]), 1))
    bounds = list(zip(strips, [*strips[1:], len(pixels)]))
    if len(bounds) == 1:
        found = [_strip(pixels, *bounds[0])]
    else:
        from concurrent.futures import ThreadPoolExecutor  # zlib and NumPy leave the interpreter to others

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            found = list(pool.map(lambda rows: _strip(pixels, *rows), bounds))
    check = functools.reduce(_check_of_both, ((strip.check, strip.length) for strip in found))[0]
    return [_ZLIB_HEADER, *(strip.data for strip in found), struct.pack(">I", check)]


class _Strip(NamedTuple):
    """Packed rows, and Adler's checksum and length of what they are unpacked to."""

    data: bytes
    check: int
    length: int


def _strip(pixels: np.ndarray, first: int, end: int) -> _Strip:
    """Stars and dithering leave little to find but runs: looking for more takes half as long again and gains nothing, and so do the other two differences
    that PNG has; a picture that is mostly flat becomes a third to a half larger."""
    rows = _differences(pixels, first, end)
    packer = zlib.compressobj(4, zlib.DEFLATED, -15, 9, zlib.Z_RLE)
    data = packer.compress(rows) + packer.flush(zlib.Z_FINISH if end == len(pixels) else zlib.Z_FULL_FLUSH)
    return _Strip(data, zlib.adler32(rows), len(rows))


def _check_of_both(one: tuple[int, int], other: tuple[int, int]) -> tuple[int, int]:
    """Adler's checksum (RFC 1950, §8.2) and length of two texts after one another, from those of each."""
    (before, length_before), (after, length) = one, other
    low = ((before & 0xFFFF) + (after & 0xFFFF) - 1) % _ADLER
    high = ((before >> 16) + (after >> 16) + length * ((before & 0xFFFF) - 1)) % _ADLER
    return high << 16 | low, length_before + length


def _differences(pixels: np.ndarray, first: int, end: int) -> bytes:
    """Rows `first` to `end`, each as differences from its left neighbours or from the row above, whichever are the smaller in sum, behind the kind's number."""
    rows = np.ascontiguousarray(pixels[first:end]).reshape(end - first, -1)
    above = np.zeros_like(rows)
    above[1:] = rows[:-1]
    if first:
        above[0] = pixels[first - 1].ravel()
    upwards = rows - above
    leftwards = rows.copy()
    leftwards[:, 3:] -= rows[:, :-3]
    small = _sizes(upwards) < _sizes(leftwards)
    found = np.empty((len(rows), rows.shape[1] + 1), np.uint8)
    found[:, 0] = np.where(small, _UP, _SUB)
    found[:, 1:] = np.where(small[:, None], upwards, leftwards)
    return found.tobytes()


def _sizes(differences: np.ndarray) -> np.ndarray:
    """The sum over each row, of bytes that stand for −128 to 127."""
    return np.minimum(differences, 0 - differences).sum(axis=1, dtype=np.uint64)


def write(path: str | Path, pixels: np.ndarray, scene_text: str = "") -> None:
    """Writes `encode(pixels, scene_text)` to `path`, whole or not at all.

    Raises:
        ValueError: see `encode`.
        OSError: `path` cannot be written.
    """
    write_whole(path, encode(pixels, scene_text))


def read(path: str | Path) -> np.ndarray:
    """The pixels of the picture at `path`, uint8 (height, width, 3), top row first.

    Raises:
        OSError: it cannot be read, or is no picture.
    """
    from PIL import Image  # where pictures are only written it is not needed

    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB"))


def read_scene_text(path: str | Path) -> str:
    """The preset that the PNG at `path` carries, as TOML.

    Chunks are walked here and not by Pillow, which refuses large pictures and would decode pixels nobody asked for.

    Raises:
        PngError: not a PNG, damaged, or without a preset.
        OSError: `path` cannot be read.
    """
    with open(path, "rb") as stream:
        for kind, data in _chunks(stream):
            if kind == b"iTXt":
                keyword, _, rest = data.partition(b"\0")
                if keyword == KEYWORD.encode("ascii"):
                    return _international_text(rest)
    raise PngError("the picture carries no preset; only pictures that Blackhole GL saved do")


def _international_text(rest: bytes) -> str:
    """The text of an iTXt chunk, from what follows its keyword."""
    # compression flag, compression method, language tag \0, translated keyword \0, text
    parts = rest[2:].split(b"\0", 2)
    if len(parts) != 3:
        raise PngError("the picture is damaged: its preset's chunk is cut short")
    if rest[0]:
        raise PngError("another program has compressed the picture's preset; only the picture as it was saved can be opened")
    try:
        return parts[2].decode("utf-8")
    except UnicodeDecodeError:
        raise PngError("the picture is damaged: its preset is not UTF-8") from None


def _chunks(stream: io.BufferedIOBase) -> Iterator[tuple[bytes, bytes]]:
    """The (type, data) of each ancillary chunk up to the end; the pixels are skipped."""
    if stream.read(len(_SIGNATURE)) != _SIGNATURE:
        raise PngError("not a PNG file")
    while True:
        head = stream.read(8)
        if len(head) < 8:
            raise PngError("the picture is damaged: it ends early")
        length, kind = struct.unpack(">I4s", head)
        if kind == b"IEND":
            return
        if kind != b"iTXt" or length > _LONGEST_TEXT:
            stream.seek(length + 4, io.SEEK_CUR)
            continue
        data, check = stream.read(length), stream.read(4)
        if len(data) < length or check != struct.pack(">I", zlib.crc32(kind + data)):
            raise PngError("the picture is damaged: a chunk's checksum is wrong")
        yield kind, data
