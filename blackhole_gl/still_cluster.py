"""Tiles of a still drawn by the workers of a Dask cluster; whoever asked develops and writes them, in order and while others are drawn."""

from __future__ import annotations

from collections import deque
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from .cluster import OWN, RETRIES, connected
from .rendering import tiles
from .rendering.frame import Renderer
from .rendering.tiles import Kind, Light, Tile
from .scene import Scene

if TYPE_CHECKING:
    from distributed import Client

AHEAD = 3
"""Pieces of work that are under way for each thread of a worker. What is drawn ahead lies there: so no more is held, there and here, of a larger picture."""


@contextmanager
def spreading(renderer: Renderer, address: str) -> Generator[None]:
    """Meanwhile the tiles of what `renderer` draws as a still, or as a mean, are drawn by the cluster whose scheduler is at `address`, ``tcp://…``.

    A worker opens the files that a scene names under the same paths.

    Raises:
        ClusterError: as `connected`. Drawing raises what it raises without a cluster.
    """
    with connected(address) as client:
        renderer.spread = partial(_spread, client)
        try:
            yield
        finally:
            renderer.spread = None


def _spread(
    client: Client, moments: Sequence[tuple[Scene, float]], size: tuple[int, int], samples: int, side: int, wanted: Iterable[Tile], kind: Kind
) -> Iterator[Light]:
    pieces, ahead = _pieces(wanted, tiles.in_a_square(moments[0][0].camera, side)), deque()
    while True:
        most = AHEAD * max(sum(client.nthreads().values()), 1)  # workers come and go
        for piece in islice(pieces, max(most - len(ahead), 0)):
            ahead.append(client.submit(_drawn, moments, size, samples, side, piece, kind, retries=RETRIES, pure=False))
        if not ahead:
            return
        for light in ahead.popleft().result():
            yield 1.0, light


def _pieces(wanted: Iterable[Tile], number: int) -> Iterator[list[Tile]]:
    rest = iter(wanted)
    while piece := list(islice(rest, number)):
        yield piece


# --- in a worker ---


def _drawn(moments: Sequence[tuple[Scene, float]], size: tuple[int, int], samples: int, side: int, wanted: list[Tile], kind: Kind) -> list[np.ndarray]:
    return OWN.call(Renderer.tiles, moments, size, samples, side, wanted, kind)
