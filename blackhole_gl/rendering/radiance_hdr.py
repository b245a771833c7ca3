"""Radiance's pictures (.hdr, RGBE) → light. G. Ward, "Real Pixels", Graphics Gems II (1991), and the reference manual of Radiance, "Picture file format"."""

from __future__ import annotations

import re

import numpy as np

from .stamps import Unusable

_HEADER = 1 << 16  # bytes in which it ends, or it is none
_SIZE = re.compile(rb"-Y ([1-9]\d{0,4}) \+X ([1-9]\d{0,4})")
_ENCODED = range(8, 0x8000)  # widths of rows whose bytes are run-length encoded, one colour after the other
_LONGEST = 128  # literal bytes; beyond it a count says how often one byte comes


def size(data: bytes) -> tuple[int, int]:
    """(width, height) in pixels of the file that `data` is.

    Raises:
        Unusable: it is no such file, or one that is not stored from the top left.
    """
    found = _begin(data)[:2]
    return found[0], found[1]


def light(data: bytes) -> np.ndarray:
    """Linear light of `data`, float32 (height, width, 3), top row first, as it was before any exposure that its header tells of.

    Raises:
        Unusable: as `size`; or it is cut off or damaged.
    """
    width, height, start, exposure = _begin(data)
    rows = np.empty((height, width, 4), np.uint8)
    for row in rows:
        start = _read_row(data, start, row)
    exponent = rows[..., 3:].astype(np.int32) - (128 + 8)
    return np.where(rows[..., 3:] > 0, np.ldexp(rows[..., :3].astype(np.float32), exponent), 0.0).astype(np.float32) / np.float32(exposure)


def _begin(data: bytes) -> tuple[int, int, int, float]:
    """Width and height, where the pixels begin, exposure."""
    head, blank, rest = data[:_HEADER].partition(b"\n\n")
    line, newline, _ = rest.partition(b"\n")
    if not head.startswith(b"#?") or not blank or not newline:
        raise Unusable("it is no Radiance picture, whatever its name says")
    values = [entry.partition(b"=") for entry in head.split(b"\n")]
    if [value for name, _, value in values if name == b"FORMAT"] != [b"32-bit_rle_rgbe"]:
        raise Unusable("its colours are not in RGBE")
    found = _SIZE.fullmatch(line)
    if found is None:
        raise Unusable("its rows do not run from the top left")
    try:
        exposure = float(np.prod([float(value) for name, _, value in values if name == b"EXPOSURE"]))
    except ValueError:
        exposure = 0.0
    if not 1e-12 < exposure < 1e12:
        raise Unusable("its exposure is no number above 0")
    return int(found[2]), int(found[1]), len(head) + len(blank) + len(line) + 1, exposure


def _read_row(data: bytes, start: int, row: np.ndarray) -> int:
    """Fills `row` (width, 4) from `start` on; where it ends."""
    width = len(row)
    if width not in _ENCODED or data[start : start + 4] != bytes((2, 2, width >> 8, width & 255)):
        end = start + 4 * width
        if end > len(data):
            raise Unusable("it is cut off")
        row[:] = np.frombuffer(data[start:end], np.uint8).reshape(width, 4)
        return end
    start += 4
    for channel in range(4):
        found = bytearray()
        while len(found) < width:
            if start + 1 >= len(data):
                raise Unusable("it is cut off")
            count = data[start]
            if count > _LONGEST:
                found += data[start + 1 : start + 2] * (count - _LONGEST)
                start += 2
            else:
                found += data[start + 1 : start + 1 + count]
                start += 1 + count
            if not count:
                raise Unusable("it is damaged: a run of no length")
        if len(found) != width:
            raise Unusable("it is damaged: a row of another length")
        row[:, channel] = np.frombuffer(bytes(found), np.uint8)
    return start
