"""Takes up shader files that are edited while the window is open. No imgui here."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..scene import catalogue

_PERIOD_S = 0.5


class ShaderWatch:
    """Looks at the files now and then."""

    def __init__(self) -> None:
        self._next = 0.0

    def takes_up(self, programs: Any, now: float) -> bool:
        """Whether something was edited since the last look, at `now` on any clock in seconds. Programs with a mistake in them stay as they were."""
        if now < self._next:
            return False
        self._next = now + _PERIOD_S
        before = programs.errors
        try:
            return programs.reload() is not before  # the very list: no file has changed
        except OSError:  # an editor is replacing the file: the next look finds it whole
            return False


def mistakes(errors: Iterable[Exception] = ()) -> str | None:
    """What is wrong with the shaders on disk: plug-ins of the user's that were left out at the start, and `errors`; None when nothing is."""
    left_out = (f"{mistake}. It is left out until it is mended and the program started again." for mistake in catalogue.mistakes())
    return "\n\n".join([*left_out, *map(str, errors)]) or None
