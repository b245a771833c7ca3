"""What one way of drawing a frame takes of another's processor time: the two in turn, and the median of the pairs' ratios.

    LP_NUM_THREADS=1 python tools/time_pairs.py [--size 1280x720] [--rounds 40] [--preset kerr]

glow: a picture at rest while time runs, its glow made for every second frame, against one made for each.
"""

from __future__ import annotations

import argparse
import time as clock
from collections.abc import Callable
from statistics import median, quantiles

from blackhole_gl.render.context import create_headless
from blackhole_gl.render.frame import Renderer
from blackhole_gl.scene import Scene, presets

FRAME_S = 1.0 / 30.0  # between frames, of the window's time

Frames = Callable[[int], None]  # draws the frames of a round


def glow(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """Two frames of a running clock, as one with a new glow and one without make a pair."""

    def frames(number: int, *, lasts: bool) -> None:
        for k in range(2):
            renderer.render(scene, FRAME_S * scene.playback.rate * (2 * number + k), size, glow_may_last=lasts)

    return lambda number: frames(number, lasts=True), lambda number: frames(number, lasts=False)


def spent(renderer: Renderer, frames: Frames, number: int) -> float:
    """Milliseconds of processor time."""
    renderer.ctx.finish()
    begun = clock.process_time()
    frames(number)
    renderer.ctx.finish()
    return 1e3 * (clock.process_time() - begun)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--rounds", type=int, default=40)
    parser.add_argument("--preset", action="append")
    given = parser.parse_args()
    width, height = (int(side) for side in given.size.split("x"))
    renderer, scene = Renderer(create_headless()), presets.load(given.preset or ["kerr"])
    for compare in (glow,):
        new, old = compare(renderer, scene, (width, height))
        taken = [(spent(renderer, new, number), spent(renderer, old, number)) for number in range(-3, given.rounds)][3:]
        low, _, high = quantiles((a / b for a, b in taken), n=4)
        print(f"{compare.__name__}: {median(a / b for a, b in taken):.3f} of the time, half of the pairs within {low:.3f} to {high:.3f}")


if __name__ == "__main__":
    main()
