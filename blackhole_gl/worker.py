"""One other process of this program's, which does the work handed to it piece by piece."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import Any, ParamSpec, TypeVar

_Given = ParamSpec("_Given")
_Made = TypeVar("_Made")


class _Spawning(SpawnContext):
    """Starts processes afresh, as a fork would share a window's context with them, and knows which: an executor does not tell before Python 3.14."""

    def __init__(self) -> None:
        super().__init__()
        self.started: list[SpawnProcess] = []

    def Process(self, *args: Any, **named: Any) -> SpawnProcess:  # type: ignore[override]  # a class there; executors only call it
        process = super().Process(*args, **named)
        self.started.append(process)
        return process


class Worker:
    """Owns the process: starts it when there is first something to do, and ends it and no other."""

    def __init__(self) -> None:
        self._processes = _Spawning()
        self._pool: ProcessPoolExecutor | None = None

    @property
    def is_started(self) -> bool:
        """Whether it has been given anything to do, and was not closed since."""
        return self._pool is not None

    def submit(self, work: Callable[_Given, _Made], *given: _Given.args, **named: _Given.kwargs) -> Future[_Made]:
        """Has `work` done after all that was handed over before. `work` and what it is given and gives must be such as pickle takes.

        The future fails with what `work` raises, and with BrokenExecutor, a RuntimeError, where the process ends meanwhile. Another is started then
        for what is handed over next.
        """
        try:
            return self._started().submit(work, *given, **named)
        except BrokenExecutor:
            self.close()
            return self._started().submit(work, *given, **named)

    def close(self) -> None:
        """Ends the process and waits for its end. What it is at is thrown away, and its future fails or is cancelled."""
        if self._pool is None:
            return
        for process in self._processes.started:
            process.terminate()
        # Waited for, which takes no time now: an executor left to itself may trip over its closed pipe when the interpreter ends.
        self._pool.shutdown(cancel_futures=True)
        self._processes, self._pool = _Spawning(), None

    def _started(self) -> ProcessPoolExecutor:
        if self._pool is None:
            self._pool = ProcessPoolExecutor(1, mp_context=self._processes)
        return self._pool
