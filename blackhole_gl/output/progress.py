"""A progress line on the terminal."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from rich.progress import Progress as Bar  # imported when there is something to show


class Show(Protocol):
    """Shows how much is done."""

    def __call__(self, share: float, what: str = "") -> None:
        """The share done, 0…1, and what is being done; the line's own label when empty."""


class Progress:
    """A line on the terminal, as standard error, that shows the share done once a second has passed; in a file or a pipe it would be an empty line."""

    def __init__(self, label: str):
        self._label = label
        self._bar: Bar | None = None

    def __enter__(self) -> Show:
        import time

        self._start = time.monotonic()
        self._clock = time.monotonic
        return self._show

    def _show(self, share: float, what: str = "") -> None:
        elapsed = self._clock() - self._start
        if self._bar is None and (elapsed < 1.0 or not sys.stderr.isatty()):
            return
        if self._bar is None:
            from rich.console import Console
            from rich.progress import Progress

            self._bar = Progress(console=Console(stderr=True), transient=True)
            self._task = self._bar.add_task(self._label, total=1.0)
            self._bar.start()
        self._bar.update(self._task, completed=share, description=what or self._label)

    def __exit__(self, *_) -> None:
        if self._bar is not None:
            self._bar.stop()
