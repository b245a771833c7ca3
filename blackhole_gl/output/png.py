"""PNG files that carry the preset they were made from.

The preset's TOML travels in an uncompressed iTXt chunk (PNG specification, third edition, §11.3.3.4). Equal input gives equal
bytes: no time of writing is stored.
"""

from __future__ import annotations

import io
import os
import struct
import zlib
from collections import deque
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from .files import opened_whole

KEYWORD = "blackhole_gl.scene"

WHITE_KEYWORD = "blackhole_gl.white"
"""Of 16-bit pictures: the radiance that 65535 stands for."""

_XMP_KEYWORD = "XML:com.adobe.xmp"
_REC_709 = (31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000)  # white, red, green, blue: x and y in 1/100,000, §11.3.2.1
_GAMMA_OF_LINEAR = 100_000
_MOST_PACKING = 8  # strips that are packed or wait for it
_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_SRGB_PERCEPTUAL = b"\x00"
_NONE, _SUB, _UP = 0, 1, 2  # kinds of differences, §9.2
_STRIP_BYTES = 1 << 22
_STORED = 0xFFFF  # bytes of a block at most
_ZLIB_HEADER = b"\x78\x5e"  # RFC 1950, §2.2: deflate, windows of 32 KiB, packed fast
_ADLER = 65521
# The longest preset taken from a file; ours have a few thousand bytes.
_LONGEST_TEXT = 1 << 20


class PngError(ValueError):
    """A file is no PNG, is damaged, or carries no preset; the text says which."""


class Writer:
    """A PNG on its way into `stream`: rows are packed on all cores while others are drawn, and few are held.

    Args:
        size: (width, height) in pixels.
        scene_text: the preset to carry, TOML; empty for none.
        xmp: further metadata as an XMP packet; empty for none.
        white: None of an 8-bit picture in sRGB; else of a 16-bit one the linear light that 65535 stands for, Rec. 709 primaries.
        packed: whether to make it small. Pixels put down as they are take three times the bytes and a sixth of the time.
    """

    def __init__(
        self, stream: BinaryIO, size: tuple[int, int], scene_text: str = "", xmp: str = "", white: float | None = None, *, packed: bool = True
    ):
        self._stream, self._size, self._kind = stream, size, np.dtype(np.uint8 if white is None else ">u2")
        self._strip_of: Callable[..., _Strip] = _packed_strip if packed else _plain_strip
        self._bytes = 3 * self._kind.itemsize  # of a pixel
        self._strip_rows = max(_STRIP_BYTES // (self._bytes * size[0]), 1)
        self._rows, self._ahead = 0, np.empty((0, size[0] * self._bytes), np.uint8)
        self._above = np.zeros(size[0] * self._bytes, np.uint8)
        self._pool: ThreadPoolExecutor | None = None
        self._packing: deque[Future[_Strip]] = deque()
        self._check = 1, 0
        stream.write(_SIGNATURE)
        self._chunk(b"IHDR", struct.pack(">IIBBBBB", *size, 8 * self._kind.itemsize, 2, 0, 0, 0))
        if white is None:
            self._chunk(b"sRGB", _SRGB_PERCEPTUAL)
        else:
            self._chunk(b"cHRM", struct.pack(">8I", *_REC_709))
            self._chunk(b"gAMA", struct.pack(">I", _GAMMA_OF_LINEAR))
            self._chunk(b"tEXt", WHITE_KEYWORD.encode("ascii") + b"\0" + f"{white:.9g}".encode("ascii"))
        for keyword, text in ((KEYWORD, scene_text), (_XMP_KEYWORD, xmp)):
            if text:
                self._chunk(b"iTXt", keyword.encode("ascii") + b"\0\0\0\0\0" + text.encode("utf-8"))
        self._chunk(b"IDAT", _ZLIB_HEADER)

    def write(self, pixels: np.ndarray) -> None:
        """Further rows, (rows, width, 3), uint8 or uint16, from the top down; they have to stay as they are until the picture is closed.

        Raises:
            ValueError: they are of another shape or type, or too many.
        """
        kind = self._kind.newbyteorder("=")
        if pixels.dtype != kind or pixels.ndim != 3 or pixels.shape[1:] != (self._size[0], 3) or self._rows + len(pixels) > self._size[1]:
            raise ValueError(f"a picture is (height, width, 3) {kind}; got {pixels.shape} {pixels.dtype} for {self._size}")
        self._rows += len(pixels)
        rows = np.ascontiguousarray(pixels, self._kind).view(np.uint8).reshape(len(pixels), -1)
        self._ahead = np.concatenate([self._ahead, rows]) if len(self._ahead) else rows
        while len(self._ahead) >= self._strip_rows or self._rows == self._size[1] and len(self._ahead):
            strip, self._ahead = self._ahead[: self._strip_rows], self._ahead[self._strip_rows :]
            self._pack(strip, last=self._rows == self._size[1] and not len(self._ahead))
        self._finish(_MOST_PACKING)

    def close(self) -> None:
        """Ends the picture.

        Raises:
            ValueError: rows are missing.
        """
        if self._rows != self._size[1]:
            raise ValueError(f"{self._rows} of {self._size[1]} rows were written")
        self._finish(0)
        self._chunk(b"IDAT", struct.pack(">I", self._check[0]))
        self._chunk(b"IEND", b"")
        self.abandon()

    def abandon(self) -> None:
        """Lets go of what is not written yet."""
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
        self._pool = None

    def _pack(self, rows: np.ndarray, *, last: bool) -> None:
        above, self._above = self._above, rows[-1].copy()
        if last and self._check[1] == 0 and not self._packing:  # the only one
            self._packing.append(Future())
            self._packing[0].set_result(self._strip_of(rows, above, self._bytes, last=True))
            return
        if self._pool is None:
            self._pool = ThreadPoolExecutor(os.cpu_count())  # zlib and NumPy leave the interpreter to others
        self._packing.append(self._pool.submit(self._strip_of, rows, above, self._bytes, last=last))

    def _finish(self, most: int) -> None:
        """Writes what is packed, until no more than `most` strips are left."""
        while self._packing and (len(self._packing) > most or self._packing[0].done()):
            strip = self._packing.popleft().result()
            self._check = _check_of_both(self._check, (strip.check, strip.length)) if self._check[1] else (strip.check, strip.length)
            self._chunk(b"IDAT", strip.data)

    def _chunk(self, kind: bytes, data: bytes) -> None:
        for part in (struct.pack(">I", len(data)), kind, data, struct.pack(">I", zlib.crc32(data, zlib.crc32(kind)))):
            self._stream.write(part)


@contextmanager
def opened(path: str | Path, size: tuple[int, int], scene_text: str = "", xmp: str = "", white: float | None = None) -> Generator[Writer]:
    """A `Writer` of the file at `path`, which is there when all rows are, whole or not at all.

    Raises:
        ValueError: rows are missing.
        OSError: `path` cannot be written.
    """
    with opened_whole(path) as stream:
        writer = Writer(stream, size, scene_text, xmp, white)
        try:
            yield writer
            writer.close()
        finally:
            writer.abandon()


def encode(pixels: np.ndarray, scene_text: str = "", xmp: str = "", white: float | None = None, *, packed: bool = True) -> bytes:
    """A PNG of (height, width, 3) `pixels`, top row first; see `Writer`.

    Raises:
        ValueError: `pixels` has another shape or type.
    """
    stream = io.BytesIO()
    _write(stream, pixels, scene_text, xmp, white, packed=packed)
    return stream.getvalue()


def _write(stream: BinaryIO, pixels: np.ndarray, scene_text: str, xmp: str, white: float | None, *, packed: bool) -> None:
    if pixels.ndim != 3 or pixels.size == 0:
        raise ValueError(f"a picture is (height, width, 3); got {pixels.shape} {pixels.dtype}")
    writer = Writer(stream, (pixels.shape[1], pixels.shape[0]), scene_text, xmp, white, packed=packed)
    try:
        writer.write(pixels)
        writer.close()
    finally:
        writer.abandon()


def linear16(radiance: np.ndarray, white: float) -> np.ndarray:
    """Linear `radiance` (…) as uint16, of which 65535 stands for `white` and all above."""
    return np.rint(np.clip(radiance * (65535.0 / white), 0.0, 65535.0)).astype(np.uint16)


class _Strip(NamedTuple):
    """Packed rows, and Adler's checksum and length of what they are unpacked to."""

    data: bytes
    check: int
    length: int


def _plain_strip(rows: np.ndarray, _above: np.ndarray, _step: int, *, last: bool) -> _Strip:
    """Rows as they are, each behind the kind of no differences, in stored blocks (RFC 1951, §3.2.4): zlib takes four times as long for these."""
    found = np.pad(rows, ((0, 0), (1, 0)), constant_values=_NONE).tobytes()
    parts: list[bytes] = []
    for start in range(0, len(found), _STORED):
        block = found[start : start + _STORED]
        parts += (struct.pack("<BHH", last and start + _STORED >= len(found), len(block), len(block) ^ 0xFFFF), block)
    return _Strip(b"".join(parts), zlib.adler32(found), len(found))


def _packed_strip(rows: np.ndarray, above: np.ndarray, step: int, *, last: bool) -> _Strip:
    """Stars and dithering leave little to find but runs: looking for more takes half as long again and gains nothing, and so do the other two differences
    that PNG has; a picture that is mostly flat becomes a third to a half larger."""
    found = _differences(rows, above, step).tobytes()
    packer = zlib.compressobj(4, zlib.DEFLATED, -15, 9, zlib.Z_RLE)
    data = packer.compress(found) + packer.flush(zlib.Z_FINISH if last else zlib.Z_FULL_FLUSH)
    return _Strip(data, zlib.adler32(found), len(found))


def _check_of_both(one: tuple[int, int], other: tuple[int, int]) -> tuple[int, int]:
    """Adler's checksum (RFC 1950, §8.2) and length of two texts after one another, from those of each."""
    (before, length_before), (after, length) = one, other
    low = ((before & 0xFFFF) + (after & 0xFFFF) - 1) % _ADLER
    high = ((before >> 16) + (after >> 16) + length * ((before & 0xFFFF) - 1)) % _ADLER
    return high << 16 | low, length_before + length


def _differences(rows: np.ndarray, above: np.ndarray, step: int) -> np.ndarray:
    """Bytes of rows (R, B) below the row `above`, each as differences from what lies `step` bytes to the left or above, whichever are the smaller in sum,
    behind the kind's number."""
    upwards = np.empty_like(rows)
    np.subtract(rows[0], above, out=upwards[0])
    np.subtract(rows[1:], rows[:-1], out=upwards[1:])
    leftwards = rows.copy()
    leftwards[:, step:] -= rows[:, :-step]
    small = _sizes(upwards) < _sizes(leftwards)
    found = np.empty((len(rows), rows.shape[1] + 1), np.uint8)
    found[:, 0] = np.where(small, _UP, _SUB)
    found[:, 1:] = leftwards
    found[small, 1:] = upwards[small]
    return found


def _sizes(differences: np.ndarray) -> np.ndarray:
    """The sum over each row, of bytes that stand for −128 to 127."""
    return np.minimum(differences, 0 - differences).sum(axis=1, dtype=np.uint64)


def write(path: str | Path, pixels: np.ndarray, scene_text: str = "", xmp: str = "", white: float | None = None, *, packed: bool = True) -> None:
    """Writes `encode` of the same to `path`, whole or not at all.

    Raises:
        ValueError: see `encode`.
        OSError: `path` cannot be written.
    """
    with opened_whole(path) as stream:
        _write(stream, pixels, scene_text, xmp, white, packed=packed)


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
