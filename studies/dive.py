"""A dive into the hole, frame by frame: what neighbours differ by (ꟻLIP), what is dark, and whether anything is no number.

    python -m studies.dive --out build/dive [--frames 600] [--size 320x180] [--rounds 4]

The fall is that of presets/flights/dive.toml, from 30 r_s to 0.1 r_s. What a path explains goes evenly from frame to frame: a difference that stands out from
those before and after it is a jump. Two frames may differ by much and yet not jump: then the moment between them differs from both by less. So pairs that
stand out are halved, again and again; a jump stays what it is in one of the halves.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from blackhole_gl.output import png
from blackhole_gl.output.files import write_whole
from blackhole_gl.physics import flight_files
from blackhole_gl.physics.flight import Flight
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets
from studies import pictures
from studies.flip import flip

FLIGHT = "dive"

STANDS_OUT = 1.5
"""A difference larger than this many times the median of those about it stands out."""

JUMPS = 0.7
"""A pair jumps where a half of its way, halved again and again, still differs by more than this share of the whole."""

LEAST = 0.02
"""Of differences below this none is seen: a star that lights one pixel more."""

_ABOUT = 6  # neighbours on each side that a difference is compared with


@dataclass(frozen=True)
class Seen:
    """One frame.

    Attributes:
        pixels: uint8 (height, width, 3), top row first.
        distance: of the camera, r_s.
        finite: whether all of its light is a number.
        unresolved: share of the rays that ended nowhere.
    """

    pixels: np.ndarray
    distance: float
    finite: bool
    unresolved: float

    @property
    def mean(self) -> float:
        """Of all its pixels, 0…255."""
        return float(self.pixels.mean())


@dataclass(frozen=True)
class Pair:
    """Two moments whose difference stands out.

    Attributes:
        first, second: seconds of the flight.
        differ, halved: mean ꟻLIP of the two; and of the half of the way between them that differs most, halved as often as asked.
    """

    first: float
    second: float
    differ: float
    halved: float

    @property
    def is_jump(self) -> bool:
        """Whether it is one that can be seen."""
        return self.differ > LEAST and self.halved > JUMPS * self.differ


def dive() -> Flight:
    """The flight."""
    path = flight_files.shipped()[FLIGHT]
    return flight_files.read(path, presets.load(list(flight_files.presets_of(path))))


def moments(flown: Flight, frames: int) -> np.ndarray:
    """Seconds of so many frames, float64 (frames,), from the first to the last moment."""
    return np.linspace(0.0, flown.seconds, frames)


def at(renderer: Renderer, flown: Flight, seconds: float, size: tuple[int, int]) -> Seen:
    """The frame at `seconds`, every pixel with a ray of its own."""
    moment = flown.at(seconds)
    renderer.render(moment.scene, moment.time, size)
    fates, _ = renderer.fates_and_steps()
    return Seen(renderer.read_rgb8(), moment.scene.camera.distance, bool(np.isfinite(renderer.radiance()).all()), float(np.mean(fates == 0)))


def difference(one: Seen, other: Seen) -> float:
    """Mean ꟻLIP."""
    return float(flip(one.pixels, other.pixels).mean())


def standing_out(differences: np.ndarray) -> np.ndarray:
    """How many times the median of those about it each difference is, float64 of the same shape."""
    found = np.empty(len(differences))
    for k in range(len(differences)):
        about = np.r_[differences[max(k - _ABOUT, 0) : k], differences[k + 1 : k + 1 + _ABOUT]]
        found[k] = differences[k] / max(float(np.median(about)), 1e-9)
    return found


def halved(see: Callable[[float], Seen], first: float, second: float, rounds: int) -> Pair:
    """The pair of moments, halved `rounds` times, always on towards the half that differs most."""
    left, right = see(first), see(second)
    whole = most = difference(left, right)
    low, high = first, second
    for _ in range(rounds):
        middle = 0.5 * (low + high)
        between = see(middle)
        before, after = difference(left, between), difference(between, right)
        low, high, left, right, most = (low, middle, left, between, before) if before > after else (middle, high, between, right, after)
    return Pair(first, second, whole, most)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--frames", type=int, default=600)
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--rounds", type=int, default=4)
    given = parser.parse_args()
    width, height = (int(side) for side in given.size.split("x"))
    size = width, height
    given.out.mkdir(parents=True, exist_ok=True)
    flown, renderer = dive(), Renderer(create_headless())
    seconds = moments(flown, given.frames)
    frames: list[Seen] = []
    for number, moment in enumerate(seconds):
        frames.append(at(renderer, flown, float(moment), size))
        png.write(given.out / f"frame_{number:04}.png", frames[-1].pixels)
    differences = np.array([difference(one, other) for one, other in zip(frames, frames[1:])])
    ratios = standing_out(differences)
    pairs = [
        halved(lambda moment: at(renderer, flown, moment, size), float(seconds[k]), float(seconds[k + 1]), given.rounds)
        for k in np.flatnonzero((ratios > STANDS_OUT) & (differences > LEAST))
    ]
    _write(given.out, seconds, frames, differences, ratios)
    _plot(given.out / "dive.png", frames, differences)
    _tell(frames, differences, ratios, pairs)


def _write(out: Path, seconds: np.ndarray, frames: list[Seen], differences: np.ndarray, ratios: np.ndarray) -> None:
    lines = ["seconds,distance_rs,mean_grey,unresolved,flip_to_next,times_its_neighbours"]
    for k, seen in enumerate(frames):
        after = f"{differences[k]:.5f},{ratios[k]:.3f}" if k < len(differences) else ","
        lines.append(f"{seconds[k]:.4f},{seen.distance:.5g},{seen.mean:.2f},{seen.unresolved:.6f},{after}")
    write_whole(out / "dive.csv", ("\n".join(lines) + "\n").encode("utf-8"))


def _plot(path: Path, frames: list[Seen], differences: np.ndarray) -> None:
    pyplot = pictures.library()
    figure, (above, below) = pyplot.subplots(2, 1, figsize=(9.0, 6.0), sharex=True)
    above.plot(differences, linewidth=0.9)
    above.set_ylabel("mean ꟻLIP to the next frame".replace("ꟻ", "F"))
    above.set_ylim(0.0)
    below.semilogy([seen.distance for seen in frames], linewidth=0.9)
    below.axhline(1.0, linestyle=":", linewidth=0.8)
    below.set_ylabel("distance, r_s")
    below.set_xlabel("frame")
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def _tell(frames: list[Seen], differences: np.ndarray, ratios: np.ndarray, pairs: list[Pair]) -> None:
    print(f"{len(frames)} frames from {frames[0].distance:.4g} to {frames[-1].distance:.4g} r_s")
    print(f"mean grey {min(seen.mean for seen in frames):.2f} to {max(seen.mean for seen in frames):.2f} of 255")
    print(f"frames with light that is no number: {sum(not seen.finite for seen in frames)}; most rays unresolved {max(seen.unresolved for seen in frames):.2%}")
    print(f"mean FLIP of neighbours: median {np.median(differences):.4f}, largest {differences.max():.4f}; largest over those about it {ratios.max():.2f}")
    for pair in pairs:
        print(f"from {pair.first:.3f} to {pair.second:.3f} s: {pair.differ:.4f}, halved {pair.halved:.4f}{', a jump' if pair.is_jump else ''}")
    print(f"jumps: {sum(pair.is_jump for pair in pairs)}")


if __name__ == "__main__":
    main()
