"""A renderer in a process started afresh, for one that was forked from a process that uses OpenGL.

Pieces of work go there and results come back through its standard input and output, pickled, each behind its length. Unlike the standard library's ways to
start a process, this asks nothing of the user's script, and a process that must have no children of that kind may use it.
"""

from __future__ import annotations

import os
import pickle
import struct
import subprocess
import sys
import threading
import traceback
from collections.abc import Callable
from typing import IO, Any

from .rendering import context
from .rendering.frame import Renderer

_LENGTH = struct.Struct("<Q")
_PROGRAM = "import sys; sys.path[:] = {path!r}; from blackhole_gl.gl_process import serve; serve({device!r}, {backend!r})"


class GlProcess:
    """The process, which ends with its standard input: when this one ends, at the latest.

    Args:
        device, backend: as in `GlThread`.
    """

    def __init__(self, device: int | None, backend: str):
        program = _PROGRAM.format(path=sys.path, device=device, backend=backend)
        self._process = subprocess.Popen([sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        assert self._process.stdin is not None and self._process.stdout is not None
        self._there, self._here = self._process.stdin, self._process.stdout
        self._lock = threading.Lock()

    def run(self, work: Callable[..., Any], given: tuple, named: dict[str, Any]) -> Any:
        """What `work` makes there with its renderer.

        Raises:
            RuntimeError: the process has ended.
            What `work` raises there.
        """
        with self._lock:
            try:
                _send(self._there, (work, given, named))
                succeeded, made = _receive(self._here)
            except (EOFError, OSError):
                raise RuntimeError("the process that draws for this one, which was forked, has ended") from None
        if not succeeded:
            raise made
        return made

    def end(self) -> None:
        """Ends it, and waits for that."""
        self._there.close()
        self._process.wait()
        self._here.close()


def serve(device: int | None, backend: str) -> None:
    """Does what comes through standard input until that closes."""
    # What work prints must not stand among the results.
    results = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    renderer: Renderer | None = None
    while True:
        try:
            work, given, named = _receive(sys.stdin.buffer)
        except EOFError:
            return
        try:
            if renderer is None:
                renderer = Renderer(context.create_headless(backend, device))
            answer = True, work(renderer, *given, **named)
        except Exception as error:
            error.add_note("In the process that draws:\n" + traceback.format_exc())
            answer = False, error
            if not isinstance(error, ValueError):
                renderer = None  # it may have been left half done
        _send(results, answer)


def _send(stream: IO[bytes], what: Any) -> None:
    packed = pickle.dumps(what, protocol=pickle.HIGHEST_PROTOCOL)
    stream.write(_LENGTH.pack(len(packed)))
    stream.write(packed)
    stream.flush()


def _receive(stream: IO[bytes]) -> Any:
    """Raises EOFError where the stream ends."""
    length = stream.read(_LENGTH.size)
    if len(length) < _LENGTH.size:
        raise EOFError
    return pickle.loads(stream.read(_LENGTH.unpack(length)[0]))
