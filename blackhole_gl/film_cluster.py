"""Frames of a film drawn by the workers of a Dask cluster, each with a renderer of its own; whoever asked writes them, so that they share no folder."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from .cluster import OWN, RETRIES, connected
from .film import Film, frame, frame_path, frame_text, missing
from .output import png
from .output.files import write_whole


def draw(film: Film, folder: Path, numbers: Iterable[int], address: str, progress: Callable[[float], None] | None = None) -> int:
    """As `film.draw`, by the cluster whose scheduler is at `address`, ``tcp://…``.

    Raises:
        ClusterError: as `connected`.
        SceneError, ValueError: a moment cannot be drawn.
    """
    wanted = missing(film, folder, numbers)
    with connected(address) as client:
        from distributed import as_completed

        drawn = client.map(_drawn, wanted, film=film, folder=folder, retries=RETRIES, pure=False)
        for done, (_, (number, packed)) in enumerate(as_completed(drawn, loop=client.loop, with_results=True)):
            write_whole(frame_path(folder, number), packed)
            if progress is not None:
                progress((done + 1) / len(wanted))
    return len(wanted)


# --- in a worker ---


def _drawn(number: int, film: Film, folder: Path) -> tuple[int, bytes]:
    """Frame `number` as a PNG file."""
    pixels, shown = OWN.call(frame, film, number)
    return number, png.encode(pixels, frame_text(shown, folder))
