"""PNG files that carry the preset they were made from.

The preset's TOML travels in an uncompressed iTXt chunk (PNG specification, third edition, §11.3.3.4). Equal input gives equal
bytes: no time of writing is stored.
"""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image, PngImagePlugin

from .files import write_whole

KEYWORD = "blackhole_gl.scene"

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_SRGB_PERCEPTUAL = b"\x00"
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
    pixels = np.ascontiguousarray(pixels)
    if pixels.dtype != np.uint8 or pixels.ndim != 3 or pixels.shape[2] != 3 or pixels.size == 0:
        raise ValueError(f"a picture is (height, width, 3) uint8; got {pixels.shape} {pixels.dtype}")
    chunks = PngImagePlugin.PngInfo()
    chunks.add(b"sRGB", _SRGB_PERCEPTUAL)
    if scene_text:
        chunks.add_itxt(KEYWORD, scene_text)
    stream = io.BytesIO()
    # Stars and dithering leave little to find but runs: looking for more takes half as long again and gains nothing;
    # a picture that is mostly flat becomes a fifth to a third larger.
    Image.fromarray(pixels).save(stream, format="PNG", pnginfo=chunks, compress_level=4, compress_type=zlib.Z_RLE)
    return stream.getvalue()


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
