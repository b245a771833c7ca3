"""How a frame grows with the things in it: frames with many, and with few, in turn.

    LP_NUM_THREADS=1 python tools/time_things.py --size 640x360 --rounds 8

Prints a Markdown table: milliseconds of a whole frame whose rays are traced anew, processor time, the least of the rounds; and how many times the second
of its kind that is, the median of the rounds' own ratios.
"""

from __future__ import annotations

import argparse
import statistics
import time

import numpy as np

from blackhole_gl.render.context import create_headless
from blackhole_gl.render.frame import Renderer
from blackhole_gl.scene import Scene, presets

SPHERES = (10, 100, 1000)


def spheres(count: int) -> dict[str, object]:
    """As many spheres between 3 and 12 r_s from the hole, of the same volume in all."""
    rng, found = np.random.default_rng(1), {}
    for number in range(count):
        n = rng.normal(size=3)
        place = n / np.linalg.norm(n) * rng.uniform(3.0, 12.0)
        name = f"things.sphere_{number}"
        found |= {f"{name}.kind": "sphere", **{f"{name}.{axis}": float(x) for axis, x in zip("xyz", place)}}
        found[f"{name}.radius"] = float(rng.uniform(0.3, 0.8) * (10.0 / count) ** (1.0 / 3.0))
    return found


def scenes() -> dict[str, list[tuple[str, Scene]]]:
    """What is timed, by what is compared with what."""
    plain = {"rays.edges": 1}
    few = [("nothing", presets.load(["kerr"], plain))]
    few += [(f"{count} spheres", presets.load(["kerr"], plain | spheres(count))) for count in SPHERES]
    return {"Kerr and its disk": few, "straight rays": [(name, scene.with_values({"rays.lensing": False})) for name, scene in few]}


def frame_ms(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> float:
    """Processor time of one frame."""
    renderer.hit_map.forget()
    renderer.ctx.finish()
    start = time.process_time()
    renderer.render(scene, 0.0, size)
    renderer.ctx.finish()
    return 1e3 * (time.process_time() - start)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--rounds", type=int, default=8)
    given = parser.parse_args()
    size = tuple(map(int, given.size.split("x")))
    renderer = Renderer(create_headless())
    print("| rays | with | ms | times |\n| --- | --- | ---: | ---: |")
    for rays, compared in scenes().items():
        for _, scene in compared:
            frame_ms(renderer, scene, size)
        rounds = [[frame_ms(renderer, scene, size) for _, scene in compared] for _ in range(given.rounds)]
        for place, (name, _) in enumerate(compared):
            ratio = statistics.median(row[place] / row[1] for row in rounds)
            print(f"| {rays} | {name} | {min(row[place] for row in rounds):.0f} | {ratio:.2f} |")


if __name__ == "__main__":
    main()
