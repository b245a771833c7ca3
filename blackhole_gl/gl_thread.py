"""Renderers that any thread of any process may use: each lives with its GL context on a thread of its own, which does one piece of work after the other.

A context belongs to the thread where it is current, so that work is brought to it and never the other way round. In a process that was forked from one that
uses OpenGL none can be made, since the driver's own threads are left behind: there a process started afresh does the work.
"""

from __future__ import annotations

import os
import queue
import threading
import weakref
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Concatenate, ParamSpec, TypeVar

from .gl_process import GlProcess
from .rendering import context
from .rendering.frame import Renderer

_Given = ParamSpec("_Given")
_Made = TypeVar("_Made")


class GlThread:
    """A renderer, made when there is first something to draw, and the thread that it lives on.

    Args:
        device: number of the device to draw on, of `context.device_names`; the driver's first when None.
        backend: as in `context.create_headless`.
    """

    def __init__(self, device: int | None = None, backend: str = "auto"):
        self._made_by = device, backend
        self._begin()

    def call(self, work: Callable[Concatenate[Renderer, _Given], _Made], *given: _Given.args, **named: _Given.kwargs) -> _Made:
        """What `work` makes with the renderer, after all that was asked for before; `work` has to be a function of a module, which pickle finds by its name.

        Raises:
            ContextError: there is no OpenGL here.
            RuntimeError: it was closed.
            What `work` raises. After anything but a ValueError the renderer, which may have been left half done, is made anew for the next.
        """
        if self._process_id != os.getpid():
            self._begin()
        with self._lock:
            if self._closed:
                raise RuntimeError("this renderer was closed")
            runner = self._runner()
        return runner(work, given, named)

    def close(self) -> None:
        """Gives back all that it holds, when what was asked for before is done; nothing can be asked of it any more."""
        if self._process_id != os.getpid():
            self._begin()
        with self._lock:
            self._closed = True
            if self._end is not None:
                self._end()

    def _begin(self) -> None:
        """Sets out afresh, as also in a forked process, where neither the thread nor who held the lock is there."""
        self._process_id = os.getpid()
        self._lock = threading.Lock()
        self._closed = getattr(self, "_closed", False)
        self._run: Callable[..., Any] | None = None
        self._end: Callable[[], object] | None = None

    def _runner(self) -> Callable[..., Any]:
        if self._run is None:
            made = GlProcess(*self._made_by) if context.forked_from_gl() else _Running(*self._made_by)
            self._run, self._end = made.run, weakref.finalize(self, made.end)
        return self._run


class _Running:
    """The thread while there is one."""

    def __init__(self, device: int | None, backend: str):
        self._tasks: queue.SimpleQueue[tuple[Future, Callable[..., Any], tuple, dict] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=_serve, args=(self._tasks, device, backend), name="blackhole-gl", daemon=True)
        self._thread.start()

    def run(self, work: Callable[..., Any], given: tuple, named: dict[str, Any]) -> Any:
        future: Future[Any] = Future()
        self._tasks.put((future, work, given, named))
        return future.result()

    def end(self) -> None:
        self._tasks.put(None)
        if self._thread is not threading.current_thread():  # a collector may run there
            self._thread.join()


def _serve(tasks: queue.SimpleQueue, device: int | None, backend: str) -> None:
    """Does what comes until there is None."""
    renderer: Renderer | None = None
    for future, work, given, named in iter(tasks.get, None):
        try:
            if renderer is None:
                renderer = Renderer(context.create_headless(backend, device))
            made = work(renderer, *given, **named)
        except ValueError as error:  # of a scene or a size: said before anything is drawn
            future.set_exception(error)
        except BaseException as error:
            _release(renderer)
            renderer = None
            future.set_exception(error)
        else:
            future.set_result(made)
        del future, work, given, named  # they may be large, and the next is waited for
    _release(renderer)


def _release(renderer: Renderer | None) -> None:
    if renderer is not None:
        renderer.release()
        renderer.ctx.release()
