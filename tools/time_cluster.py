"""How many frames a minute one and two Dask workers draw, in turn, with LP_NUM_THREADS=1 each; and whether they draw the same. With --still:
stills of one moment, each spread over all workers.

    python tools/time_cluster.py [--preset kerr] [--size 640x360] [--frames 24] [--rounds 3] [--still]

Every worker has drawn once before the clock runs. On a machine that is busy otherwise the figure says little: it prints the load, too.
"""

from __future__ import annotations

import argparse
import os
import shutil
import tempfile
import time as clock
from fractions import Fraction
from pathlib import Path
from statistics import median

from distributed import LocalCluster

from blackhole_gl import film, film_cluster, still_cluster
from blackhole_gl.asked import renderer_by, size_of
from blackhole_gl.physics.flight import Flight
from blackhole_gl.rendering import still_files
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets


def main() -> None:
    asked = arguments()
    os.environ["LP_NUM_THREADS"] = "1"  # which workers inherit
    made = film.Film(Flight(presets.load([asked.preset]), rate=4.0, start=0.0), Fraction(24), asked.frames, size_of(asked.size))
    folder = Path(tempfile.mkdtemp(prefix="time_cluster-"))
    renderer = renderer_by("auto") if asked.still else None
    with cluster(1) as one, cluster(2) as two:
        seconds: dict[int, list[float]] = {1: [], 2: []}
        for turn in range(asked.rounds + 1):
            for workers, found in ((1, one), (2, two)):
                took = timed(made, folder / f"{workers}", found.scheduler_address, renderer)
                if turn:  # the first compiles
                    seconds[workers].append(took)
        same = all(film.frame_path(folder / "1", k).read_bytes() == film.frame_path(folder / "2", k).read_bytes() for k in range(asked.frames))
    shutil.rmtree(folder)
    rates = {workers: 60.0 * asked.frames / median(took) for workers, took in seconds.items()}
    print(f"frames a minute: {rates[1]:.0f} by one worker, {rates[2]:.0f} by two, {rates[2] / rates[1]:.2f} times; the same frames: {'yes' if same else 'NO'}")
    print(f"cores: {os.cpu_count()}, load of the machine: {os.getloadavg()[0]:.1f}")


def timed(made: film.Film, folder: Path, address: str, renderer: Renderer | None) -> float:
    """Seconds that all frames take, drawn anew, as a film or with a `renderer` that develops them as stills."""
    shutil.rmtree(folder, ignore_errors=True)
    film.begin(made, folder)
    start = clock.perf_counter()
    if renderer is None:
        film_cluster.draw(made, folder, range(made.count), address)
    else:
        with still_cluster.spreading(renderer, address):
            for number in range(made.count):
                still_files.save(renderer, made.flight.scene, made.flight.start, made.size, made.samples, path=film.frame_path(folder, number))
    return clock.perf_counter() - start


def cluster(workers: int) -> LocalCluster:
    return LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--preset", default="kerr")
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--still", action="store_true")
    return parser.parse_args()


if __name__ == "__main__":
    main()
