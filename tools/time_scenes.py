"""What a frame of each scene takes while the camera moves, drawn as coarsely as given, then enlarged to 1280×720 and given its stars as in the window.

    LP_NUM_THREADS=2 python tools/time_scenes.py [--size 640x360] [--rounds 7] [PRESET ...]

Prints a Markdown table: of each preset (without any named: all scenes) and each --size the median of half a frame's processor time in milliseconds, which is
about what two idle cores take, and the median of its ratio to the frame of `galaxies_through_a_screen_lens` in the same round; and how the rays are traced. The
presets are drawn in turn, so that other work on the machine slows all of them alike.
"""

from __future__ import annotations

import argparse
import time
from statistics import median

from blackhole_gl.app.area import Area
from blackhole_gl.app.targets import Drawing, Targets
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.target import Target
from blackhole_gl.scene import Scene, presets

SHOWN = (1280, 720)
CORES = 2
YARDSTICK = "galaxies_through_a_screen_lens"  # straight rays, and nothing to meet


def moved(scene: Scene, number: int) -> Scene:
    """`scene` with the camera as it is in that frame."""
    camera = scene.camera
    return scene.with_values({"camera.inclination_deg": camera.inclination_deg - 0.3 * number, "camera.azimuth_deg": camera.azimuth_deg + 0.2 * number})


def frame_ms(renderer: Renderer, targets: Targets, scene: Scene, size: tuple[int, int], window: Target, number: int) -> tuple[float, str]:
    """Half the processor time of a frame, and how its rays are traced."""
    drawing = Drawing(moved(scene, number), 3.5 + number / 30.0, size, SHOWN, progressive=True, passes=False)
    renderer.ctx.finish()
    start = time.process_time()
    report = targets.render_into(window.frame, Area(0, 0, *SHOWN), drawing)
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
    scenes = {name: presets.load([name]) for name in dict.fromkeys([YARDSTICK, *names])}
    renderer = Renderer(create_headless())
    targets, window = Targets(renderer.ctx, renderer), Target.of(renderer.ctx, [renderer.ctx.texture(SHOWN, 4)])
    print(f"| scene | {' | '.join(f'{size} [ms] | times' for size in sizes)} | rays |\n| --- |{' ---: | ---: |' * len(sizes)} --- |")
    found: dict[str, list[str]] = {name: [] for name in scenes}
    methods = {}
    for size in (tuple(map(int, text.split("x"))) for text in sizes):
        taken: dict[str, list[float]] = {name: [] for name in scenes}
        for number in range(given.rounds + 2):
            for name, scene in scenes.items():
                ms, methods[name] = frame_ms(renderer, targets, scene, size, window, number)
                taken[name] += [ms] if number > 1 else []  # the first compile, the second finish what the first began
        for name, frames in taken.items():
            found[name].append(f"{median(frames):.0f} | {median(ms / yard for ms, yard in zip(frames, taken[YARDSTICK])):.2f}")
    for name, each in found.items():
        print(f"| `{name}` | {' | '.join(each)} | {methods[name]} |")


if __name__ == "__main__":
    main()
