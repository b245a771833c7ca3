"""What tells players of MP4 and QuickTime files that a film shows all round (Google's Spherical Video RFC, version 1).

https://github.com/google/spatial-media/blob/master/docs/spherical-video-rfc.md: XML in a box of the film's track. PyAV has no words for it, so that it is
put into the file when that is written.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import BinaryIO
from uuid import UUID

SUFFIXES = (".mp4", ".mov")
"""Of files that have such boxes."""

PAIRS = {"equirectangular": False, "stereo": True}
"""Projections that there are words for, and whether they are pairs for two eyes."""

_UUID = UUID("ffcc8263-f855-4a93-8814-587a02521fdd")
_XML = """<?xml version="1.0"?>
<rdf:SphericalVideo xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:GSpherical="http://ns.google.com/videos/1.0/spherical/">
<GSpherical:Spherical>true</GSpherical:Spherical>
<GSpherical:Stitched>true</GSpherical:Stitched>
<GSpherical:StitchingSoftware>Blackhole GL</GSpherical:StitchingSoftware>
<GSpherical:ProjectionType>equirectangular</GSpherical:ProjectionType>
<GSpherical:StereoMode>{layout}</GSpherical:StereoMode>
</rdf:SphericalVideo>"""
_HEAD = 8  # bytes: size and type, ISO 14496-12, §4.2


def mark(path: Path, *, pair: bool) -> None:
    """Says in the film at `path` that its pictures are equirectangular, or with `pair` two of them, the left eye's above the right one's.

    Raises:
        ValueError: it is no such file, or the list of its frames does not end it, as FFmpeg has it.
        OSError: it cannot be changed.
    """
    with open(path, "r+b") as file:
        start = _movie(file, str(path))
        file.seek(start)
        movie = file.read()
        file.seek(start)
        file.write(_marked(movie, _box(b"uuid", _UUID.bytes + _XML.format(layout="top-bottom" if pair else "mono").encode())))


def _movie(file: BinaryIO, name: str) -> int:
    """Where the last box begins, the movie's: as nothing stands behind it, it may grow."""
    last, start, kind = 0, 0, b""
    while len(head := file.read(_HEAD)) == _HEAD:
        length, kind = struct.unpack(">I4s", head)
        if length == 1:
            (length,) = struct.unpack(">Q", file.read(8))
        last, start = start, start + length
        file.seek(start)
    if kind != b"moov":
        raise ValueError(f"{name}: got a file that ends with {kind!r}; allowed is one that ends with 'moov'")
    return last


def _marked(movie: bytes, box: bytes) -> bytes:
    """The box `movie` with `box` at the end of its track."""
    at = _HEAD
    while True:
        length, kind = struct.unpack(">I4s", movie[at : at + _HEAD])
        if kind == b"trak":
            return _box(b"moov", movie[_HEAD:at] + _box(kind, movie[at + _HEAD : at + length] + box) + movie[at + length :])
        at += length


def _box(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I4s", _HEAD + len(content), kind) + content
