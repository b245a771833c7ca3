"""The system's own dialog for choosing a file, where there is one. It is another process: the window goes on while it is open."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from imgui_bundle import portable_file_dialogs as dialogs

from ..scene import presets

SCENES = ("Scenes, and pictures and films that carry one", " ".join(f"*{suffix}" for suffix in presets.FILES))
TOML = ("Scenes", "*.toml")
PICTURES = ("Pictures", "*.png")
_PROGRAMS = ("zenity", "kdialog", "matedialog", "qarma")  # what shows the dialogs elsewhere than on Windows and macOS
MISSING = f"There is no file dialog on this system (one of {', '.join(_PROGRAMS)} would show it)."

Chosen = Callable[[Path], None]


def is_there() -> bool:
    """Whether this system can show one."""
    return sys.platform in ("win32", "darwin") or any(shutil.which(name) for name in _PROGRAMS)


class FileDialog:
    """At most one dialog, and what is done with the file chosen in it."""

    def __init__(self) -> None:
        self._open: Any = None
        self._chosen: Chosen | None = None

    @property
    def is_open(self) -> bool:
        """Whether the user is choosing."""
        return self._open is not None

    def ask_open(self, title: str, beside: Path, kinds: Sequence[str], chosen: Chosen) -> None:
        """Asks for a file that is there, first among those in the folder of `beside`; `poll` calls `chosen` with it."""
        self._ask(lambda: dialogs.open_file(title, str(beside), list(kinds)), chosen)

    def ask_save(self, title: str, first: Path, kinds: Sequence[str], chosen: Chosen) -> None:
        """Asks where to write, `first` for a start, and whether what is there is to be replaced; `poll` calls `chosen` with it."""
        self._ask(lambda: dialogs.save_file(title, str(first), list(kinds)), chosen)

    def poll(self) -> None:
        """Takes in what the user has chosen. Call once in each frame."""
        if self._open is None or not self._open.ready(0):
            return
        result, chosen = self._open.result(), self._chosen
        self._open = self._chosen = None
        path = result if isinstance(result, str) else next(iter(result), "")
        if path and chosen is not None:
            chosen(Path(path))

    def close(self) -> None:
        """Puts the dialog away."""
        if self._open is not None:
            self._open.kill()
        self._open = self._chosen = None

    def _ask(self, ask: Callable[[], Any], chosen: Chosen) -> None:
        if self._open is None:
            self._open, self._chosen = ask(), chosen
