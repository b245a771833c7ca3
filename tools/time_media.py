"""What scenes with media cost: processor time of whole frames, still (time runs, the camera rests) and moving, over the flat frame of the preset `kerr`.

    LP_NUM_THREADS=1 python tools/time_media.py [--size 1280x720] [--rounds 3]

Scenes take turns in one process, and each round's frames are divided by those of the flat scene in the same round. A still frame is the mean of an even
number, as grid and edges take turns in it, and comes after those in which samples along its rays are told.
"""

from __future__ import annotations

import argparse
import statistics
import time as clock
from collections import defaultdict

from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets

FRAMES = 2  # of a scene in a round
FIRST = 24  # before the rounds
TURN_DEG = 0.5  # between the frames of a moving camera, in both angles
FOG = {"media.fog.kind": "ball", "media.fog.radius": 4.0, "media.fog.depth": 0.4}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    size = tuple(int(side) for side in given.size.split("x"))
    kerr = presets.load(["kerr"])
    scenes = {"flat": kerr.with_values({"rays.lensing": False}), "kerr": kerr, "kerr with fog": presets.load(["kerr"], FOG)}
    scenes |= {name: presets.load([name]) for name in ("polish_doughnut", "cloudy_slab", "jet")}
    scenes["cloudy_slab with lanes and grain"] = presets.load(["cloudy_slab"], {"media.slab.lanes": 1.0, "media.slab.grain": 1.0})
    took: dict[tuple[str, str], list[float]] = defaultdict(list)
    renderers = {(name, motion): Renderer(create_headless()) for name in scenes for motion in ("still", "moving")}
    for number in range(-1, given.rounds):
        for (name, motion), renderer in renderers.items():
            frames = range(FIRST) if number < 0 else range(FIRST + FRAMES * number, FIRST + FRAMES * (number + 1))
            seconds = timed(renderer, scenes[name], size, frames, moving=motion == "moving")
            if number >= 0:
                took[name, motion].append(1e3 * seconds / FRAMES)
    print("| scene | motion | processor ms | × flat |\n| --- | --- | ---: | ---: |")
    for (name, motion), own in took.items():
        ratio = statistics.median(a / b for a, b in zip(own, took["flat", motion]))
        print(f"| {name} | {motion} | {min(own):.0f} | {ratio:.2f} |")


def timed(renderer: Renderer, scene: Scene, size: tuple[int, int], frames: range, *, moving: bool) -> float:
    """Processor seconds of the frames with those numbers."""
    renderer.ctx.finish()
    start = clock.process_time()
    for number in frames:
        turn = TURN_DEG * number if moving else 0.0
        seen = scene.with_values({"camera.azimuth_deg": turn, "camera.inclination_deg": scene.camera.inclination_deg + (turn % 4.0 if moving else 0.0)})
        renderer.render(seen, 0.1 * number, size, progressive=moving, glow_may_last=not moving)
    renderer.ctx.finish()
    return clock.process_time() - start


if __name__ == "__main__":
    main()
