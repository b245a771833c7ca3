"""The wall time of a film over the sum of what `render` takes for its frames.

    chrt -f 10 python tools/time_film.py [--path dive] [--size 1280x720] [--fps 30] [--frames 600] [--block 30] [--codec h264]

One renderer in one process. The film is drawn, packed and cleared as the command `video` does it, a block of frames at a time; between two blocks the same
frames are drawn as `render` draws them, once without writing them and once as PNG files as that command does. The three take turns in going first, so that
whatever else the machine does falls on all alike, and what one of them leaves compiled serves all. Printed are the film's time over that of its frames drawn
alone, which is the harsher, and over that of its frames drawn and written; the same of processor time, which other work on the machine disturbs less and
idle cores do not help; and the bytes of a frame in the film.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time as clock
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from fractions import Fraction
from functools import partial
from pathlib import Path

from blackhole_gl import film
from blackhole_gl.asked import renderer_by, size_of
from blackhole_gl.physics import flight_files
from blackhole_gl.rendering import still_files
from blackhole_gl.rendering.annotation import annotated
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets


def main() -> None:
    asked = arguments()
    made, renderer = film_of(asked), renderer_by("auto")
    alone(made, renderer, range(0, made.count, max(made.count // 8, 1)))  # compiles
    with tempfile.TemporaryDirectory(prefix="time_film-") as folder:
        wall, processor = measured(made, renderer, asked, Path(folder))
        out = Path(folder) / "x.mp4"
        count, size = frames_in(out), out.stat().st_size
    assert count == made.count, f"{count} of {made.count} frames are in the film"
    print(f"{made.count} frames of {asked.path} at {asked.size}, {size / count / 1e3:.1f} kB each in the film")
    for of, took in (("wall", wall), ("processor", processor)):
        told = f"{of} time: film {took['film']:.1f} s, frames drawn {took['drawn']:.1f} s, drawn and written as PNG {took['written']:.1f} s"
        print(f"{told}; film / drawn {took['film'] / took['drawn']:.3f}; film / drawn and written {took['film'] / took['written']:.3f}")
    print(f"cores: {os.cpu_count()}, load of the machine: {os.getloadavg()[0]:.1f}")


def film_of(asked: argparse.Namespace) -> film.Film:
    path = flight_files.shipped().get(asked.path, Path(asked.path))
    flight = flight_files.read(path, presets.load(list(flight_files.presets_of(path))), 0.0)
    return film.Film(flight, Fraction(asked.fps), asked.frames, size_of(asked.size))


def measured(made: film.Film, renderer: Renderer, asked: argparse.Namespace, folder: Path) -> tuple[dict[str, float], dict[str, float]]:
    """Seconds by the wall clock, and of processor time, that each of the three took for all frames."""
    frames, out = folder / "frames", folder / "x.mp4"
    wall, processor = ({"film": 0.0, "drawn": 0.0, "written": 0.0} for _ in range(2))

    def timed(name: str, work: Callable[[], object]) -> None:
        start, used = clock.perf_counter(), clock.process_time()
        work()
        wall[name] += clock.perf_counter() - start
        processor[name] += clock.process_time() - used

    with ExitStack() as opened:
        timed("film", lambda: film.begin(made, frames))
        pack = opened.enter_context(film.packing_of(made, out, asked.codec))
        for turn, first in enumerate(range(0, made.count, asked.block)):
            block = range(first, min(first + asked.block, made.count))
            works: list[tuple[str, Callable[[], object]]] = [
                ("film", partial(film.draw, made, frames, block, renderer, None, pack, stays=False)),
                ("drawn", partial(alone, made, renderer, block)),
                ("written", partial(written, made, renderer, block, folder / "y.png")),
            ]
            for name, work in works[turn % 3 :] + works[: turn % 3]:
                timed(name, work)
        timed("film", opened.close)
    timed("film", lambda: film.clear(frames))
    return wall, processor


def alone(made: film.Film, renderer: Renderer, numbers: Sequence[int]) -> None:
    """Frames drawn to their pixels, as the command `render` does it."""
    for number in numbers:
        moment = made.flight.at(float(Fraction(number) / made.fps))
        renderer.render_still(moment.scene, moment.time, made.size, made.samples)
        annotated(renderer.read_rgb8(), moment.scene, renderer.view_of(moment.scene))


def written(made: film.Film, renderer: Renderer, numbers: Sequence[int], path: Path) -> None:
    """Frames drawn and written, as the command `render` does it."""
    for number in numbers:
        moment = made.flight.at(float(Fraction(number) / made.fps))
        still_files.save(renderer, moment.scene, moment.time, made.size, made.samples, path=path)


def frames_in(path: Path) -> int:
    import av

    with av.open(str(path)) as container:
        return sum(1 for _ in container.decode(video=0))


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--path", default="dive")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--fps", default="30")
    parser.add_argument("--frames", type=int, default=600)
    parser.add_argument("--block", type=int, default=30)
    parser.add_argument("--codec", default="h264")
    return parser.parse_args()


if __name__ == "__main__":
    main()
