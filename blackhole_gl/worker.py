"""One other process of this program's, which does the work handed to it piece by piece and never outlives the one that started it."""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import queue
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Generator
from concurrent.futures import BrokenExecutor, Future
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any, ParamSpec, TypeVar

_Given = ParamSpec("_Given")
_Made = TypeVar("_Made")

_PR_SET_PDEATHSIG = 1  # of <linux/prctl.h>
_ENDED = "the process that was to do this has ended"


@dataclass(frozen=True)
class _Work:
    """A piece of work, and where its result is waited for."""

    future: Future[Any]
    call: tuple[Callable[..., Any], tuple[Any, ...], dict[str, Any]]


class Worker:
    """Owns the process: starts it when there is first something to do, and ends it and no other.

    The process ends with the one that started it, however that ends: a pipe that closes ends it while it waits, a thread that watches its parent
    while it works, and on Linux the kernel also where that thread gets no turn, as while a driver compiles. An executor of the standard library's
    would live on, and leaves semaphores behind that are complained of on the terminal.
    """

    def __init__(self) -> None:
        self._running: _Running | None = None

    @property
    def is_started(self) -> bool:
        """Whether it has been given anything to do, and was not closed since."""
        return self._running is not None

    def submit(self, work: Callable[_Given, _Made], *given: _Given.args, **named: _Given.kwargs) -> Future[_Made]:
        """Has `work` done after all that was handed over before. `work` and what it is given and gives must be such as pickle takes.

        To be called from a thread that lives as long as the process is to: on Linux that thread is the parent that it does not outlive.

        The future fails with what `work` raises, and with BrokenExecutor, a RuntimeError, where the process ends meanwhile. Another is started then
        for what is handed over next.
        """
        if self._running is not None and self._running.has_ended():
            self.close()
        if self._running is None:
            self._running = _Running()
        future: Future[_Made] = Future()
        self._running.tasks.put(_Work(future, (work, given, named)))
        return future

    def close(self) -> None:
        """Ends the process and waits for its end. What it is at is thrown away, and its future fails or is cancelled."""
        if self._running is not None:
            self._running.end()
            self._running = None


class _Running:
    """The process while there is one, and the thread that hands it one piece of work after the other."""

    def __init__(self) -> None:
        # Spawned afresh, as a fork would share a window's context with it.
        context = multiprocessing.get_context("spawn")
        self._here, there = context.Pipe()
        self.tasks: queue.SimpleQueue[_Work | None] = queue.SimpleQueue()
        self._process: BaseProcess = context.Process(target=_serve, args=(there, os.getpid()), daemon=True)
        with _interrupts_kept_away():
            self._process.start()
        there.close()  # the other end is the child's alone: when it ends, reading here does
        self._is_broken = False
        self._thread = threading.Thread(target=self._hand_over, daemon=True)
        self._thread.start()

    def has_ended(self) -> bool:
        return self._is_broken or not self._process.is_alive()

    def end(self) -> None:
        self._process.terminate()
        self._process.join()
        self.tasks.put(None)
        self._thread.join()
        self._here.close()

    def _hand_over(self) -> None:
        for task in iter(self.tasks.get, None):
            if not task.future.set_running_or_notify_cancel():
                continue
            try:
                if self._is_broken:
                    raise EOFError
                self._here.send(task.call)
                succeeded, made = self._here.recv()
            except (EOFError, OSError):
                self._is_broken = True
                task.future.set_exception(BrokenExecutor(_ENDED))
            except Exception as error:  # what cannot be pickled has not been sent, and the process waits for the next
                task.future.set_exception(error)
            else:
                (task.future.set_result if succeeded else task.future.set_exception)(made)


@contextmanager
def _interrupts_kept_away() -> Generator[None]:
    """What is started meanwhile never gets CTRL+C's signal, which a terminal sends to all: the parent ends it, and says what there is to say."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows; there `_serve` does what it can
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


# --- in the other process ---


def _serve(there: Connection, parent: int) -> None:
    """Does what comes through the pipe until that closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _end_with(parent)
    while True:
        try:
            work, given, named = there.recv()
        except (EOFError, OSError):
            return
        except Exception as error:  # it came, and cannot be made out here
            _answer(there, False, error)
            continue
        try:
            made = work(*given, **named)
        except Exception as error:
            error.add_note("In the other process:\n" + traceback.format_exc())
            _answer(there, False, error)
        else:
            _answer(there, True, made)


def _answer(there: Connection, succeeded: bool, made: Any) -> None:
    try:
        there.send((succeeded, made))
    except (EOFError, OSError):
        return  # nobody is there any more, as the next reading finds
    except Exception as error:  # it cannot be pickled
        there.send((False, RuntimeError(str(error))))


def _end_with(parent: int) -> None:
    """Ends this process when that of the id `parent`, which started it, has ended."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    started_by = multiprocessing.parent_process()
    if started_by is None or os.getppid() != parent:
        os._exit(1)  # it ended while this one started

    def watch() -> None:
        started_by.join()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
