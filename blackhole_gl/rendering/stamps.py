"""Files of strangers that are about to be read: what they were when they were looked at, and why some are not read at all."""

from __future__ import annotations

import os
import stat
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Stamp:
    """A file as it stood when it was looked at: another time or size means that it has to be read anew."""

    path: Path
    modified_ns: int
    size: int


class Unusable(ValueError):
    """What is wrong with a file; the text leaves its name, and what is allowed, to those who know what it is for."""


def stamp(path: Path, most_bytes: int) -> Stamp:
    """The file at `path` as it stands now.

    Raises:
        Unusable: it is not there, or is no file, or is empty, or has too many bytes.
    """
    try:
        found = os.stat(path)
    except (OSError, ValueError) as error:
        raise Unusable(f"it cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if not stat.S_ISREG(found.st_mode):  # a pipe would be waited for
        raise Unusable("it is no file")
    if found.st_size == 0:
        raise Unusable("it is empty")
    if found.st_size > most_bytes:
        raise Unusable(f"it has {found.st_size} bytes")
    return Stamp(path, found.st_mtime_ns, found.st_size)


def content(path: Path, most_bytes: int) -> bytes:
    """What the file at `path` holds.

    Raises:
        Unusable: it cannot be read, or has too many bytes by now.
    """
    try:
        with open(path, "rb") as stream:
            data = stream.read(most_bytes + 1)
    except OSError as error:
        raise Unusable(f"it cannot be read: {error.strerror or error}") from None
    if len(data) > most_bytes:
        raise Unusable("it has grown too long")
    return data
