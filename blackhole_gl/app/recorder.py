"""A film of what the window shows, without what is written over it: at the window's rate, or frame by frame, every picture exact. No imgui here."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import AbstractContextManager, ExitStack
from datetime import datetime
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from ..output.film_file import FilmError, packing
from ..scene import presets
from .area import Area
from .state import WindowState

NAMES = ("record", "record_exact")
FPS = 30
_WAITING = 8  # pictures that are still to be packed; where there are more the window waits


class Recorder:
    """Records into a new film in `folder` from one press of its key to the next.

    Attributes:
        exact: whether the window draws for a film now, frame by frame.
    """

    def __init__(self, folder: Path):
        self._folder = folder
        self.exact = False
        self._film: _Film | None = None
        self._took = False

    @property
    def busy(self) -> bool:
        """Whether a film is being recorded."""
        return self._film is not None

    def do(self, action: str, state: WindowState) -> None:
        """Begins, by the action of `NAMES`, or stops whichever runs."""
        if self._film is not None:
            self._stop(state)
            return
        self.exact = action == "record_exact"
        self._film = _Film(self._folder, state)

    def dt(self, passed: float) -> float:
        """What a frame of the window takes of time: as much as `passed`, or a film's frame when the last one has been taken."""
        if not self.exact:
            return passed
        due, self._took = self._took, False
        return 1.0 / FPS if due else 0.0

    def take(self, state: WindowState, window: Any, area: Area) -> None:
        """Takes the picture that `area` of `window` shows, where the film has one due; what goes wrong ends it with a notice."""
        if self._film is None:
            return
        try:
            frames = self._film.take(state.clock, window, area)
        except (FilmError, OSError, ValueError) as error:
            self._film.abandon()
            self._film, self.exact, state.recording = None, False, ""
            state.complain(f"The film ends: {error}")
            return
        self._took = True
        how = "frame by frame" if self.exact else "as the window shows it"
        state.recording = f"Recording {how}: {frames} frames, {frames / FPS:.1f} s"

    def close(self) -> None:
        """Ends a film that is being recorded, and keeps it."""
        if self._film is not None:
            self._film.end()
        self._film, self.exact = None, False

    def _stop(self, state: WindowState) -> None:
        film, self._film, self.exact, state.recording = self._film, None, False, ""
        try:
            state.say(f"Saved {film.end()}" if film is not None else "")
        except (FilmError, OSError, ValueError) as error:
            state.complain(f"The film was not saved: {error}")


class _Film:
    """One film on its way. It has a frame for every 1/FPS s of the window's clock: a picture that is shown for longer is repeated, one shown for shorter
    left out."""

    def __init__(self, folder: Path, state: WindowState):
        self.path = folder / datetime.now().strftime("blackhole-%Y%m%d-%H%M%S.mp4")
        self._text = presets.picture_text(state.scene, state.time, folder.absolute(), paused=state.paused)
        self._begun, self._frames = state.clock, 0
        self._size: tuple[int, int] | None = None
        self._pack: Callable[[np.ndarray], None] | None = None
        self._open = ExitStack()
        self._packer = ThreadPoolExecutor(1)
        self._waiting: deque[Future[None]] = deque()

    def take(self, clock: float, window: Any, area: Area) -> int:
        """Takes a picture, as often as it is due at `clock`; returns how many frames there are.

        Raises:
            FilmError: there is no PyAV, or the window has another size now.
        """
        due = int((clock - self._begun) * FPS + 0.5) + 1 - self._frames
        if due < 1:
            return self._frames
        size = area.width - area.width % 2, area.height - area.height % 2  # colours have half the resolution
        if self._pack is None:
            self._size = size
            made: AbstractContextManager[Callable[[np.ndarray], None]] = packing(self.path, "h264", size, Fraction(FPS), self.path.stem, self._text)
            self._pack = self._open.enter_context(made)
        if size != self._size:
            raise FilmError(f"the picture's size changed from {self._size} to {size}")
        read = np.frombuffer(window.read(viewport=(area.x, area.y, *size), components=3, alignment=1), np.uint8)
        pixels = np.ascontiguousarray(read.reshape(size[1], size[0], 3)[::-1])
        for _ in range(due):
            self._waiting.append(self._packer.submit(self._pack, pixels))
        self._frames += due
        while self._waiting and (len(self._waiting) > _WAITING or self._waiting[0].done()):
            self._waiting.popleft().result()
        return self._frames

    def end(self) -> Path:
        """Packs what is left, and closes the file.

        Raises:
            FilmError, OSError: it could not be written.
        """
        with self._open:
            self._packer.shutdown()
            for packed in self._waiting:
                packed.result()
            if self._pack is None:
                raise FilmError("no picture was shown")
        return self.path

    def abandon(self) -> None:
        """Lets go of it, as something is wrong: what there is so far is kept where it can be."""
        try:
            self.end()
        except (FilmError, OSError, ValueError):
            return
