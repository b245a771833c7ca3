"""A Dask cluster that draws: who connects to one, and the renderer that each of its workers has, for frames of films and for tiles of stills."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from . import VERSION
from .gl_thread import GlThread

if TYPE_CHECKING:
    from distributed import Client

RETRIES = 3
"""Times that a piece of work is done anew whose worker has died, or that has failed there."""

OWN = GlThread()
"""Of a worker: its renderer, with all that it has compiled. There is none before something is drawn."""


class ClusterError(ValueError):
    """There is no cluster to draw with; the text says why."""


@contextmanager
def connected(address: str) -> Generator[Client]:
    """The cluster whose scheduler is at `address`, ``tcp://…``; at the end what is left to do there is called off.

    Raises:
        ClusterError: there is no dask.distributed, no such cluster, or a worker there has another version of this program; or a piece of work has
            ended one worker after the other.
    """
    try:
        import distributed
    except ImportError:
        raise ClusterError("--dask needs dask.distributed: pip install 'blackhole-gl[cluster]'") from None
    try:
        client = distributed.Client(address, set_as_default=False)
    except (OSError, ValueError) as error:
        raise ClusterError(f"--dask: got {address!r}, where no scheduler answers: {error}") from None
    with client:
        for worker, version in client.run(_version, on_error="ignore").items():
            if version != VERSION:
                raise ClusterError(f"--dask: the worker {worker} has version {version}; allowed is {VERSION}, as here")
        try:
            yield client
        except distributed.KilledWorker:
            raise ClusterError("--dask: the same piece of work has ended one worker after the other; their logs say why") from None


def _version() -> str:
    return VERSION
