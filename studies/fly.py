"""Flies round the hole for ten seconds, refined and with every pixel exact, and writes how far the two lie apart; `make flight`.

Writes data/flight.csv and pictures/flight.png into the folder --out. --keep FOLDER also keeps the frames whose displacement and ꟻLIP are largest: refined,
exact and the error map.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from blackhole_gl.output import png
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets
from studies import flight, pictures, table
from studies.flight import FlightFrame
from studies.flip import flip

DOCS = Path(__file__).resolve().parents[1] / "docs"


def size_of(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    return int(width), int(height)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-p", "--preset", action="append", default=[], help="as in blackhole-gl; several in layers")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a value that differs from the presets', e.g. rays.model=schwarzschild")
    parser.add_argument("--size", type=size_of, default=(640, 360), metavar="WIDTHxHEIGHT")
    parser.add_argument("--fps", type=float, default=flight.FPS, help="frames a second")
    parser.add_argument("--out", type=Path, default=DOCS)
    parser.add_argument("--keep", type=Path, metavar="FOLDER")
    return parser.parse_args()


def reported(frames: Iterator[FlightFrame], count: int) -> Iterator[FlightFrame]:
    """The frames as they come, with a word now and then."""
    for done, frame in enumerate(frames, 1):
        if done % max(1, count // 10) == 0:
            print(f"{done}/{count}  {frame.largest_px:.3f} px, mean FLIP {frame.flip_mean:.4f}", flush=True)
        yield frame


def keep_worst(renderer: Renderer, scene: Scene, frames: Sequence[FlightFrame], size: tuple[int, int], folder: Path) -> None:
    for kind in ("largest_px", "flip_mean", "flip_largest"):
        worst = max(range(len(frames)), key=lambda index: getattr(frames[index], kind))
        pair = flight.drawn(renderer, flight.camera_at(scene, worst / len(frames)), scene.playback.rate * frames[worst].time, size)
        shade = np.repeat(np.rint(255.0 * flip(pair.exact, pair.refined))[..., None], 3, axis=-1).astype(np.uint8)
        for name, picture in (("refined", pair.refined), ("exact", pair.exact), ("flip", shade)):
            png.write(folder / f"{kind}_{worst:03d}_{name}.png", picture)


def summary(frames: Sequence[FlightFrame]) -> str:
    names = ("largest_px", "px_99", "fates_off_edge", "fates_wrong", "flip_mean", "flip_largest")
    largest = {name: max(getattr(frame, name) for frame in frames) for name in names}
    mean = {name: float(np.mean([getattr(frame, name) for frame in frames])) for name in ("flip_mean", "own_rays")}
    return (
        f"{len(frames)} frames: displacement ≤ {largest['largest_px']:.3f} px, 99 % ≤ {largest['px_99']:.3f} px; "
        f"wrong fates ≤ {largest['fates_wrong']} a frame, off an edge ≤ {largest['fates_off_edge']}; "
        f"FLIP mean ≤ {largest['flip_mean']:.4f} ({mean['flip_mean']:.4f} over the flight), largest {largest['flip_largest']:.3f}; "
        f"{100 * mean['own_rays']:.1f} % of the pixels had rays of their own"
    )


def main() -> None:
    given = arguments()
    pictures.library()  # says that it is missing before anything is measured
    scene = presets.load(given.preset, presets.parse_assignments(given.set))
    renderer = Renderer(create_headless())
    count = round(flight.SECONDS * given.fps)
    frames = list(reported(flight.fly(renderer, scene, given.size, count), count))
    where = table.origin(renderer.ctx.info["GL_RENDERER"])
    table.write_records(given.out / "data" / "flight.csv", flight.COLUMNS, ([getattr(frame, name) for name in flight.COLUMNS] for frame in frames), where)
    pictures.draw_flight(given.out / "pictures" / "flight.png", frames, scene.rays.tolerance)
    if given.keep:
        keep_worst(renderer, scene, frames, given.size, given.keep)
    print(summary(frames))


if __name__ == "__main__":
    main()
