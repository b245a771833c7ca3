"""How a frame grows with the things in it: frames with many, and with few, in turn.

    LP_NUM_THREADS=1 python tools/time_things.py --size 640x360 --rounds 8

Prints a Markdown table: milliseconds of a whole frame whose rays are traced anew, processor time, the least of the rounds; and how many times the second
of its kind that is, the median of the rounds' own ratios.
"""

from __future__ import annotations

import argparse
import shutil
import statistics
import tempfile
import time
from pathlib import Path

import numpy as np

from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets

SPHERES = (10, 100, 1000)
GLOBES = ((3, 3), (50, 101))  # of 12 and of 10,000 triangles
SIZE = 4.0  # r_s


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


def globe(folder: Path, around: int, along: int) -> dict[str, object]:
    """A ball of 2 (`along` − 1) `around` triangles, written to a file in `folder`, before the hole."""
    phi, theta = 2.0 * np.pi * np.arange(around) / around, np.pi * (np.arange(along) + 0.5) / along
    corners = np.stack([np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi)), np.outer(np.cos(theta), np.ones(around))], axis=-1)
    ring, place = np.meshgrid(np.arange(along - 1) * around, np.arange(around), indexing="ij")
    a, b = ring + place, ring + (place + 1) % around
    faces = np.stack([np.stack([a, a + around, b], axis=-1), np.stack([b, a + around, b + around], axis=-1)], axis=2).reshape(-1, 3) + 1
    file = folder / f"{len(faces)}.obj"
    file.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners.reshape(-1, 3)) + "".join(f"f {i} {j} {k}\n" for i, j, k in faces))
    return {"things.globe.kind": "mesh", "things.globe.file": str(file), "things.globe.size": SIZE, "things.globe.x": 8.0, "things.globe.z": 2.0}


def scenes(folder: Path) -> dict[str, list[tuple[str, Scene]]]:
    """What is timed, by what is compared with what."""
    plain = {"rays.edges": 1}
    few = [("nothing", presets.load(["kerr"], plain))]
    few += [(f"{count} spheres", presets.load(["kerr"], plain | spheres(count))) for count in SPHERES]
    meshes = [few[0], *((f"{2 * (n - 1) * m:,} triangles", presets.load(["kerr"], plain | globe(folder, m, n))) for m, n in GLOBES)]
    made = {"Kerr, and spheres": few, "Kerr, and a mesh": meshes}
    straight = {"rays.lensing": False}
    return made | {name.replace("Kerr", "straight rays"): [(what, scene.with_values(straight)) for what, scene in own] for name, own in made.items()}


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
    folder = Path(tempfile.mkdtemp())
    for rays, compared in scenes(folder).items():
        for _, scene in compared:
            frame_ms(renderer, scene, size)
        rounds = [[frame_ms(renderer, scene, size) for _, scene in compared] for _ in range(given.rounds)]
        for place, (name, _) in enumerate(compared):
            ratio = statistics.median(row[place] / row[1] for row in rounds)
            print(f"| {rays} | {name} | {min(row[place] for row in rounds):.0f} | {ratio:.2f} |", flush=True)
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
