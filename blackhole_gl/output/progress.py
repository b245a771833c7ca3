"""A progress line on the terminal."""

from __future__ import annotations

from collections.abc import Callable


class Progress:
    """A line on standard error that shows the share done, once a second has passed."""

    def __init__(self, label: str):
        self._label, self._bar = label, None

    def __enter__(self) -> Callable[[float], None]:
        import time

        self._start = time.monotonic()
        self._clock = time.monotonic
        return self._show

    def _show(self, share: float, what: str = "") -> None:
        elapsed = self._clock() - self._start
        if elapsed < 1.0 and self._bar is None:
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
