"""Nothing outlives the window, and little is said when it ends."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from tests.app import virtual_display

SCRIPT = Path(__file__).resolve().parent / "ended.py"
GONE_S = 5.0  # within which nothing is left, on a busy machine
STATUS = {signal.SIGINT: 130, signal.SIGTERM: 128 + signal.SIGTERM, signal.SIGHUP: 128 + signal.SIGHUP, signal.SIGKILL: -signal.SIGKILL}

pytestmark = pytest.mark.skipif(os.name != "posix", reason="sends signals to a process group; no other system has them")


@pytest.mark.parametrize("number", STATUS, ids=lambda number: number.name)
def test_a_signal_ends_window_and_helper_and_says_nothing(tmp_path: Path, number: signal.Signals) -> None:
    """CTRL+C and a closed terminal signal the whole group, as here; SIGTERM and SIGKILL go to the window's process alone."""

    def signalled(window: subprocess.Popen[str]) -> None:
        if number in (signal.SIGINT, signal.SIGHUP):
            os.killpg(window.pid, number)
        else:
            window.send_signal(number)

    assert how_it_ends(["view"], os.environ, tmp_path, signalled) == (STATUS[number], "", "")


@pytest.mark.display
def test_the_button_in_its_frame_ends_window_and_helper_and_says_nothing(tmp_path: Path) -> None:
    with virtual_display.opened(["Xvfb", "xdotool"]) as display:
        ended = how_it_ends(["shown", "view"], display, tmp_path, lambda window: virtual_display.press_close_button(display, "^Blackhole GL$"))
    assert ended == (0, "", "")


def how_it_ends(words: list[str], environment: Mapping[str, str], folder: Path, end: Callable[[subprocess.Popen[str]], None]) -> tuple[int, str, str]:
    """Exit status, output and errors of a window that `end` brings to its end, with all the processes it has started."""
    environment = {**environment, "BLACKHOLE_GL_CONFIG_DIR": str(folder)}
    command = [sys.executable, str(SCRIPT), *words, "--size", "320x200"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, env=environment, start_new_session=True, preexec_fn=_hears_signals, **pipes) as window:
        try:
            assert int(window.stdout.readline()) != window.pid
            end(window)
            # The pipes end when the last of the processes that hold them has.
            printed, said = window.communicate(timeout=GONE_S)
        finally:
            if window.poll() is None or _some_left(window.pid):
                os.killpg(window.pid, signal.SIGKILL)
    return window.returncode, printed, said


def _hears_signals() -> None:
    """Who starts the tests in the background has CTRL+C ignored, and who starts them by nohup a closed terminal."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def _some_left(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True
