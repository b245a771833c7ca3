"""What a frame of each scene takes while the camera moves, drawn as coarsely as given and shown at 1280×720, as the window shows it.

    LP_NUM_THREADS=2 python tools/time_scenes.py [--size 640x360] [--rounds 7] [PRESET ...]

Prints a Markdown table: of each preset (without any named: all scenes) and each --size the median of half a frame's processor time in milliseconds, which is
about what two idle cores take; and how the rays are traced. The presets are drawn in turn, so that other work on the machine slows all of them alike.
"""

from __future__ import annotations

import argparse
import time
from statistics import median

from blackhole_gl.render.context import create_headless
from blackhole_gl.render.frame import Renderer
from blackhole_gl.render.target import Target
from blackhole_gl.scene import Scene, presets

SHOWN = (1280, 720)
CORES = 2


def moved(scene: Scene, number: int) -> Scene:
    """`scene` with the camera as it is in that frame."""
    camera = scene.camera
    return scene.with_values({"camera.inclination_deg": camera.inclination_deg - 0.3 * number, "camera.azimuth_deg": camera.azimuth_deg + 0.2 * number})


def frame_ms(renderer: Renderer, scene: Scene, size: tuple[int, int], window: Target, number: int) -> tuple[float, str]:
    """Half the processor time of a frame, and how its rays are traced."""
    turned = moved(scene, number)
    renderer.ctx.finish()
    start = time.process_time()
    report = renderer.render(turned, 3.5 + number / 30.0, size, window.frame, (0, 0, *SHOWN), progressive=True, shown=SHOWN)
    renderer.ctx.finish()
    return 1e3 * (time.process_time() - start) / CORES, report.method


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", action="append", help="of the picture that is drawn; may be given several times")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("presets", nargs="*", metavar="PRESET")
    given = parser.parse_args()
    sizes = given.size or ["640x360"]
    names = given.presets or [info.name for info in presets.available() if info.group == "scene"]
    scenes = {name: presets.load([name]) for name in names}
    renderer = Renderer(create_headless())
    window = Target.of(renderer.ctx, [renderer.ctx.texture(SHOWN, 4)])
    print(f"| scene | {' | '.join(f'{size} [ms]' for size in sizes)} | rays |\n| --- |{' ---: |' * len(sizes)} --- |")
    found: dict[str, list[float]] = {name: [] for name in scenes}
    methods = {}
    for size in (tuple(map(int, text.split("x"))) for text in sizes):
        taken: dict[str, list[float]] = {name: [] for name in scenes}
        for number in range(given.rounds + 2):
            for name, scene in scenes.items():
                ms, methods[name] = frame_ms(renderer, scene, size, window, number)
                taken[name] += [ms] if number > 1 else []  # the first compile, the second finish what the first began
        for name, frames in taken.items():
            found[name].append(median(frames))
    for name, each in found.items():
        print(f"| `{name}` | {' | '.join(f'{ms:.0f}' for ms in each)} | {methods[name]} |")


if __name__ == "__main__":
    main()
