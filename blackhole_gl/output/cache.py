"""What takes long to make, kept in the user's cache folder from one start to the next."""

from __future__ import annotations

import hashlib
import os
import zlib
from pathlib import Path

from ..resources import user_cache_dir
from .files import write_whole

MOST_KEPT = 256
"""Files of one kind; those used last stay. For a while there may be a quarter more."""

_CHECK_BYTES = 4


def found(kind: str, key: bytes) -> bytes | None:
    """What was kept under `key`, which has to say all that it depends on; None where there is nothing, or it is damaged."""
    file = _file(kind, key)
    try:
        data = file.read_bytes()
        os.utime(file)
    except OSError:
        return None
    check, made = data[:_CHECK_BYTES], data[_CHECK_BYTES:]
    return made if check == _check(made) else None


def keep(kind: str, key: bytes, made: bytes) -> None:
    """Keeps `made` under `key`. Files are replaced whole, so that several processes may do so at once; where the folder cannot be written, nothing is kept."""
    file = _file(kind, key)
    try:
        write_whole(file, _check(made) + made)
        _thin_out(file.parent)
    except OSError:
        pass


def _file(kind: str, key: bytes) -> Path:
    return user_cache_dir() / kind / hashlib.sha256(key).hexdigest()


def _check(data: bytes) -> bytes:
    return zlib.crc32(data).to_bytes(_CHECK_BYTES, "little")


def _thin_out(folder: Path) -> None:
    """Removes what was used longest ago, down to `MOST_KEPT`, once a quarter more are there: when each file was used takes a millisecond to ask."""
    if len(os.listdir(folder)) <= MOST_KEPT + MOST_KEPT // 4:
        return
    with os.scandir(folder) as entries:
        by_age = sorted((entry.stat().st_mtime_ns, entry.path) for entry in entries)
    for _, path in by_age[:-MOST_KEPT]:
        os.unlink(path)
