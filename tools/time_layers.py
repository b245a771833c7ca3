"""What each disk layer takes of a still frame: processor time over that of the same disk without any, the layers in turn, and the medians of the rounds.

    LP_NUM_THREADS=1 python tools/time_layers.py [--size 1280x720] [--rounds 30] [--preset kerr]
"""

from __future__ import annotations

import argparse
import time as clock
from statistics import median

from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, catalogue, presets

STEP = 0.13  # r_s/c between frames: 30 frames a second at the default rate


def alone(scene: Scene, layer: str | None) -> Scene:
    """`scene` with no disk layer but that one."""
    return scene.with_values({f"disk.{key}": key == layer for key in catalogue.keys("disk_layer")})


def spent(renderer: Renderer, scene: Scene, number: int, size: tuple[int, int]) -> float:
    """Milliseconds of processor time of the second of two frames of a running clock: the first traces, where the last scene was another."""
    renderer.render(scene, STEP * number, size)
    renderer.ctx.finish()
    begun = clock.process_time()
    renderer.render(scene, STEP * (number + 1), size)
    renderer.ctx.finish()
    return 1e3 * (clock.process_time() - begun)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--rounds", type=int, default=30)
    parser.add_argument("--preset", action="append")
    given = parser.parse_args()
    width, height = (int(side) for side in given.size.split("x"))
    renderer, scene = Renderer(create_headless()), presets.load(given.preset or ["kerr"])
    scenes = {layer: alone(scene, layer) for layer in (None, *catalogue.keys("disk_layer"))}
    taken: dict[str | None, list[float]] = {layer: [] for layer in scenes}
    for number in range(-2, given.rounds):
        for layer, seen in scenes.items():
            found = spent(renderer, seen, number, (width, height))
            if number >= 0:
                taken[layer].append(found)
    plain = taken.pop(None)
    print(f"no layer: {median(plain):.1f} ms")
    for layer, times in taken.items():
        print(f"{layer}: {median(a - b for a, b in zip(times, plain)):+.1f} ms, {median(a / b for a, b in zip(times, plain)):.2f} of the frame without")


if __name__ == "__main__":
    main()
