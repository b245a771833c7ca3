"""JPEG files that carry the preset they were made from, as comments (ISO/IEC 10918-1, B.2.4.5)."""

from __future__ import annotations

import io
import struct
from pathlib import Path

import numpy as np

from . import png
from .files import write_whole

SUFFIXES = (".jpg", ".jpeg")

_QUALITY = 95
_START, _COMMENT, _APPLICATION_1, _SCAN = b"\xff\xd8", b"\xff\xfe", b"\xff\xe1", b"\xff\xda"
_XMP_KEYWORD = b"http://ns.adobe.com/xap/1.0/\0"
_KEYWORD = png.KEYWORD.encode("ascii") + b"\0"
_LONGEST = 0xFFFF - 2  # bytes of a segment


def write(path: str | Path, pixels: np.ndarray, scene_text: str = "", xmp: str = "") -> None:
    """Writes (height, width, 3) uint8 `pixels`, top row first, to `path`, whole or not at all; colours at full resolution.

    Args:
        scene_text: the preset to carry, TOML; empty for none.
        xmp: further metadata as an XMP packet; empty for none.

    Raises:
        OSError: `path` cannot be written.
    """
    from PIL import Image  # where pictures are only written as PNG it is not needed

    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "JPEG", quality=_QUALITY, subsampling="4:4:4")
    packed = stream.getvalue()
    length = len(_START) + 2 + struct.unpack(">H", packed[4:6])[0]  # with the segment that has to come first
    told = _segments(_APPLICATION_1, _XMP_KEYWORD, xmp) + _segments(_COMMENT, _KEYWORD, scene_text)
    write_whole(path, packed[:length] + told + packed[length:])


def read_scene_text(path: str | Path) -> str:
    """The preset that the JPEG at `path` carries, as TOML.

    Raises:
        ValueError: not a JPEG, damaged, or without a preset.
        OSError: `path` cannot be read.
    """
    found: list[bytes] = []
    with open(path, "rb") as file:
        if file.read(2) != _START:
            raise ValueError("not a JPEG file")
        while (kind := file.read(2)) != _SCAN:
            size = file.read(2)
            if len(size) < 2 or kind[:1] != b"\xff":
                raise ValueError("the picture is damaged: it ends early")
            content = file.read(struct.unpack(">H", size)[0] - 2)
            if kind == _COMMENT and content.startswith(_KEYWORD):
                found.append(content[len(_KEYWORD) :])
    if not found:
        raise ValueError("the picture carries no preset; only pictures that Blackhole GL saved do")
    try:
        return b"".join(found).decode()
    except UnicodeDecodeError:
        raise ValueError("the picture is damaged: its preset is not UTF-8") from None


def _segments(kind: bytes, keyword: bytes, text: str) -> bytes:
    """`text`, cut into pieces where it is long, each behind `keyword`."""
    content, most = text.encode(), _LONGEST - len(keyword)
    pieces = [keyword + content[start : start + most] for start in range(0, len(content), most)]
    return b"".join(kind + struct.pack(">H", len(piece) + 2) + piece for piece in pieces)
