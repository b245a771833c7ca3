"""How the window ends when it is told to from outside: CTRL+C on the terminal, a closed terminal, a session that ends."""

from __future__ import annotations

import signal
from types import FrameType, TracebackType

_NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")  # the last on Windows alone, the one before it nowhere there


class Ending:
    """While it is entered, a signal that ends programs is noted, for the loop to end by: raised in the middle of a frame, an exception would
    go through the callbacks of the window's library, which cannot be left half-way. The same signal again ends the program at once.

    Signals that were ignored before stay so, as under ``nohup``. To be entered in the main thread.

    Attributes:
        signal: the one that came; None while none has.
    """

    def __init__(self) -> None:
        self.signal: signal.Signals | None = None
        self._before: dict[signal.Signals, signal._HANDLER] = {}

    def __enter__(self) -> Ending:
        for number in (getattr(signal, name) for name in _NAMES if hasattr(signal, name)):
            before = signal.getsignal(number)
            if before is not signal.SIG_IGN:
                self._before[number] = before
                signal.signal(number, self._note)
        return self

    def _note(self, number: int, _: FrameType | None) -> None:
        self.signal = signal.Signals(number)
        signal.signal(number, signal.SIG_DFL)

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        """Raises what the signal asks for, unless something else goes wrong: KeyboardInterrupt, or SystemExit with 128 + its number."""
        for number, before in self._before.items():
            signal.signal(number, before)
        if error is not None or self.signal is None:
            return
        if self.signal == signal.SIGINT:
            raise KeyboardInterrupt
        raise SystemExit(128 + self.signal)
