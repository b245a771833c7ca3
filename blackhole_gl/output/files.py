"""Writing a file so that nobody ever sees half of it."""

from __future__ import annotations

import os
from pathlib import Path


def write_whole(path: str | Path, data: bytes) -> None:
    """Puts `data` at `path`: the old file stays until the new one is complete.

    Missing parent folders are made. A link is followed. What is not a regular file (``/dev/null``, a pipe) is written to directly.

    Raises:
        OSError: the place cannot be written; the old file is then untouched and no part of the new one is left.
    """
    target = Path(os.path.realpath(path))
    target.parent.mkdir(parents=True, exist_ok=True)
    if target.exists() and not target.is_file():
        target.write_bytes(data)
        return
    part = target.with_name(f".{target.name[:100]}.{os.getpid()}.part")
    try:
        part.write_bytes(data)
        os.replace(part, target)
    finally:
        part.unlink(missing_ok=True)
