"""Writing a file so that nobody ever sees half of it."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

# Names of standard output. Opened as a file, what it was redirected to would be begun anew.
_STANDARD_OUTPUT = ("-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1")


def write_whole(path: str | Path, data: bytes) -> None:
    """Puts `data` at `path`, as `opened_whole` does.

    Raises:
        OSError: as there.
    """
    with opened_whole(path) as stream:
        stream.write(data)


@contextmanager
def opened_whole(path: str | Path) -> Generator[BinaryIO]:
    """A stream into the file at `path`: the old file stays until the new one is complete, which it is when the context ends without an exception.

    Missing parent folders are made. A link is followed. What is not a regular file (``/dev/null``, a pipe) is written to directly; ``-`` is standard output.

    Raises:
        OSError: the place cannot be written; the old file is then untouched and no part of the new one is left.
    """
    if str(path) in _STANDARD_OUTPUT:
        sys.stdout.flush()
        yield sys.stdout.buffer
        sys.stdout.buffer.flush()
        return
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            with open(path, "wb") as stream:
                yield stream
        else:
            with _replaced(Path(os.path.realpath(path))) as stream:
                yield stream
    except OSError as error:
        raise type(error)(error.errno, error.strerror, str(path)) from None  # by the name that it was asked for


@contextmanager
def _replaced(target: Path) -> Generator[BinaryIO]:
    target.parent.mkdir(parents=True, exist_ok=True)
    part = target.with_name(f".{target.name[:100]}.{os.getpid()}.part")
    try:
        with open(part, "wb") as stream:
            yield stream
        os.replace(part, target)
    finally:
        part.unlink(missing_ok=True)


def refuse_unwritable(path: str | Path, suffixes: Sequence[str], what: str) -> None:
    """Finds out whether `write_whole` could write to `path`, before there is anything to write.

    Args:
        suffixes: those that a file of this kind may have, beside none at all.
        what: the kind of file, for the message.

    Raises:
        ValueError: `path` has another suffix.
        OSError: it cannot be written.
    """
    if str(path) in _STANDARD_OUTPUT:
        return
    target = Path(os.path.realpath(path))
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "it is a folder; a file's name is needed", str(path))
    if target.exists() and not target.is_file() or os.path.exists(path) and not os.path.isfile(path):
        if not os.access(path, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return
    if target.suffix.lower() not in ("", *suffixes):
        raise ValueError(f"{path}: got the suffix {target.suffix}; {what} is written, and allowed is {' or '.join(suffixes)}")
    folder = next(parent for parent in target.parents if parent.exists())
    try:
        probe = folder / f".{os.getpid()}.part"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise type(error)(error.errno, f"its folder cannot be written to: {error.strerror}", str(path)) from None
