"""What goes wrong in a frame of the window: it ends the window as a closed one ends, and is told in a sentence."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from pathlib import Path
from typing import ParamSpec

from imgui_bundle import imgui

from ..output.files import write_whole
from ..resources import user_config_dir
from .opening import WindowError

_FILE = "window_failure.txt"

P = ParamSpec("P")


class Failure:
    """Keeps exceptions out of the window's library, which cannot be left in the middle of a frame.

    Attributes:
        error: the first that a callback raised; None while none has. The window is then to end.
    """

    def __init__(self) -> None:
        self.error: Exception | None = None

    def kept_from(self, callback: Callable[P, None]) -> Callable[P, None]:
        """`callback`, which does nothing once something has failed."""

        def guarded(*args: P.args, **named: P.kwargs) -> None:
            if self.error is not None:
                return
            try:
                callback(*args, **named)
            except Exception as error:
                self.error = error
                # What it began and has not ended, imgui ends by itself, and has no need to tell of it.
                io = imgui.get_io()
                io.config_error_recovery_enable_assert = io.config_error_recovery_enable_debug_log = False

        return guarded

    def tell(self) -> None:
        """Says what has failed, if anything has, and leaves the details in a file of the configuration folder.

        Raises:
            WindowError: with that as its cause.
        """
        if self.error is None:
            return
        last = traceback.extract_tb(self.error.__traceback__)[-1]
        said = f"{type(self.error).__name__}: {self.error} ({Path(last.filename).name}, line {last.lineno})"
        file = user_config_dir() / _FILE
        try:
            write_whole(file, "".join(traceback.format_exception(self.error)).encode("utf-8", "backslashreplace"))
            details = f"; the details are in {file}"
        except OSError:
            details = ""
        raise WindowError(f"the window had to close, by a mistake of the program's: {said}{details}") from self.error
