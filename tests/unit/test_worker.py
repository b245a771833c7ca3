"""The other process: whose it is, and how it ends."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor
from multiprocessing.process import BaseProcess
from pathlib import Path

import pytest

import blackhole_gl
from blackhole_gl.worker import Worker

LONG = 60.0  # seconds of sleep; no test waits for their end
AT_ONCE = 5.0  # seconds in which what waits for nothing is over, on a busy machine


@pytest.fixture
def worker() -> Iterator[Worker]:
    made = Worker()
    yield made
    made.close()


@pytest.fixture
def other() -> Iterator[BaseProcess]:
    """Another child of this process, which the worker knows nothing of."""
    process = multiprocessing.get_context("spawn").Process(target=time.sleep, args=(LONG,))
    process.start()
    yield process
    process.terminate()
    process.join()


def is_running(pid: int) -> bool:
    return any(child.pid == pid for child in multiprocessing.active_children())


def test_one_process_does_all_the_work(worker: Worker) -> None:
    assert not worker.is_started
    found = {worker.submit(os.getpid).result() for _ in range(3)}
    assert len(found) == 1 and os.getpid() not in found and worker.is_started


def test_closing_ends_the_own_process_and_no_other(worker: Worker, other: BaseProcess) -> None:
    pid = worker.submit(os.getpid).result()
    at_work, waiting = worker.submit(time.sleep, LONG), worker.submit(time.sleep, LONG)
    assert is_running(pid)
    began = time.monotonic()
    worker.close()
    assert time.monotonic() - began < AT_ONCE
    assert not is_running(pid) and other.is_alive()
    assert at_work.done() and waiting.done()


def test_two_workers_end_apart(worker: Worker) -> None:
    second = Worker()
    pid, second_pid = worker.submit(os.getpid).result(), second.submit(os.getpid).result()
    second.close()
    assert is_running(pid) and not is_running(second_pid)
    assert worker.submit(os.getpid).result() == pid


def test_closing_twice_or_before_the_start_does_nothing(worker: Worker, other: BaseProcess) -> None:
    worker.close()
    worker.submit(os.getpid).result()
    worker.close()
    worker.close()
    assert other.is_alive() and not worker.is_started


def test_after_its_process_has_died_there_is_another(worker: Worker) -> None:
    """As where the system runs out of memory: that piece of work has failed, the next is done."""
    died = worker.submit(os._exit, 1)
    with pytest.raises(BrokenExecutor):
        died.result(timeout=LONG)
    assert worker.submit(os.getpid).result() != os.getpid()


SCRIPT = """
import sys, time
from blackhole_gl.worker import Worker

if __name__ == "__main__":
    worker = Worker()
    worker.submit(time.sleep, 60.0)
    time.sleep(float(sys.argv[1]))
    worker.close()
"""


@pytest.mark.parametrize("seconds", [0.0, 0.5])
def test_closing_while_it_starts_or_works_says_nothing(tmp_path: Path, seconds: float) -> None:
    """In an interpreter of its own: what an executor left to itself complains of comes when that ends."""
    script = tmp_path / "close.py"
    script.write_text(SCRIPT)
    environment = {**os.environ, "PYTHONPATH": str(Path(blackhole_gl.__file__).parents[1])}
    done = subprocess.run([sys.executable, str(script), str(seconds)], capture_output=True, text=True, timeout=60, env=environment)
    assert (done.returncode, done.stderr) == (0, "")


def test_what_goes_wrong_in_there_is_told_here(worker: Worker) -> None:
    with pytest.raises(ZeroDivisionError) as told:
        worker.submit(divmod, 1, 0).result(timeout=LONG)
    assert "In the other process" in told.value.__notes__[0]
    with pytest.raises((AttributeError, TypeError, pickle.PicklingError)):
        worker.submit(lambda: None).result(timeout=LONG)
    with pytest.raises(RuntimeError):
        worker.submit(threading.Lock).result(timeout=LONG)  # made, and cannot be sent
    assert worker.submit(os.getpid).result(timeout=LONG) != os.getpid()


PARENT = """
import os, signal, sys, time
from blackhole_gl.worker import Worker

if __name__ == "__main__":
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # ignored, where the tests were started by nohup
    worker = Worker()
    print(worker.submit(os.getpid).result(), flush=True)
    if sys.argv[1] == "works":
        worker.submit(time.sleep, 60.0)
    elif sys.argv[1] == "deaf":  # as in a driver's compiler: nothing of Python's runs meanwhile
        worker.submit(sum, range(10**12))
    time.sleep(60.0)
"""


@pytest.mark.skipif(os.name != "posix", reason="kills by signals; no other system has them")
@pytest.mark.parametrize("does", ["waits", "works", "deaf"])
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGHUP], ids=lambda number: number.name)
def test_it_ends_with_the_process_that_started_it_and_nothing_is_said(tmp_path: Path, number: signal.Signals, does: str) -> None:
    """The parent gets no chance to close it."""
    script = tmp_path / "parent.py"
    script.write_text(PARENT)
    environment = {**os.environ, "PYTHONPATH": str(Path(blackhole_gl.__file__).parents[1])}
    # The error output is a pipe, which ends when the last of the processes that hold it has.
    with subprocess.Popen([sys.executable, str(script), does], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment) as parent:
        assert parent.stdout is not None
        child = int(parent.stdout.readline())
        parent.send_signal(number)
        try:
            _, said = parent.communicate(timeout=AT_ONCE)
        except subprocess.TimeoutExpired:
            os.kill(child, signal.SIGKILL)
            raise
    assert said == ""
