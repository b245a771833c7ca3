"""Frames of a film drawn by the workers of a Dask cluster, each with a renderer of its own; whoever asked writes them, so that they share no folder."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from .film import Film, FilmError, frame, frame_path, frame_text, missing
from .gl_thread import GlThread
from .output import png
from .output.files import write_whole

_RETRIES = 3
"""Times that a frame is drawn anew whose worker has died."""

_own: GlThread | None = None
"""Of a worker: its renderer, with all that it has compiled."""


def draw(film: Film, folder: Path, numbers: Iterable[int], address: str, progress: Callable[[float], None] | None = None) -> int:
    """As `film.draw`, by the cluster whose scheduler is at `address`, ``tcp://…``.

    Raises:
        FilmError: there is no dask.distributed, or no such cluster.
        SceneError, ValueError: a moment cannot be drawn; KilledWorker: a frame has ended too many workers.
    """
    distributed = _distributed()
    wanted = missing(film, folder, numbers)
    try:
        client = distributed.Client(address, set_as_default=False)
    except (OSError, ValueError) as error:
        raise FilmError(f"--dask: got {address!r}, where no scheduler answers: {error}") from None
    with client:
        drawn = client.map(_drawn, wanted, film=film, folder=folder, retries=_RETRIES, pure=False)
        for done, (_, (number, packed)) in enumerate(distributed.as_completed(drawn, loop=client.loop, with_results=True)):
            write_whole(frame_path(folder, number), packed)
            if progress is not None:
                progress((done + 1) / len(wanted))
    return len(wanted)


# --- in a worker ---


def _drawn(number: int, film: Film, folder: Path) -> tuple[int, bytes]:
    """Frame `number` as a PNG file."""
    global _own
    if _own is None:
        _own = GlThread()
    pixels, shown = _own.call(frame, film, number)
    return number, png.encode(pixels, frame_text(shown, folder))


def _distributed():
    try:
        import distributed
    except ImportError:
        raise FilmError("--dask needs dask.distributed: pip install 'blackhole-gl[cluster]'") from None
    return distributed
