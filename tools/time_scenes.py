"""What a frame of each scene takes while the camera moves, drawn as coarsely as given, then enlarged to 1280×720 and given its stars as in the window.

    LP_NUM_THREADS=1 python tools/time_scenes.py [--size 640x360] [--rounds 9] [PRESET ...]
    LP_NUM_THREADS=2 python tools/time_scenes.py                               (on an idle machine: the wall clock counts)

Prints a Markdown table of each preset (without any named: all scenes), medians of the rounds: the processor time of a frame; of it, that of a frame of next to
no pixels, which one core has to take alone; what two idle cores would take of a frame drawn with one thread, as they share all but that; the wall clock; how
many times the processor time is that of a frame of `galaxies_through_a_screen_lens` in the same round; and how the rays are traced. A scene's frames follow
each other, each after one of that yardstick, which has a renderer of its own: a window shows one scene, and neither the programs of more than a few nor the
pictures of another would be kept from frame to frame.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from statistics import median

import moderngl

from blackhole_gl.app.area import Area
from blackhole_gl.app.targets import Drawing, Targets
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.target import Target
from blackhole_gl.scene import Scene, presets

SHOWN = (1280, 720)
NEXT_TO_NONE = (64, 36)
YARDSTICK = "galaxies_through_a_screen_lens"  # straight rays, and nothing to meet


def moved(scene: Scene, number: float) -> Scene:
    """`scene` with the camera as it is in that frame."""
    camera = scene.camera
    return scene.with_values({"camera.inclination_deg": camera.inclination_deg - 0.3 * number, "camera.azimuth_deg": camera.azimuth_deg + 0.2 * number})


@dataclass(frozen=True)
class Stage:
    """What frames are drawn with, and how large they are drawn and shown."""

    targets: Targets
    window: Target
    size: tuple[int, int]

    @classmethod
    def of(cls, renderer: Renderer, size: tuple[int, int], shown: tuple[int, int]) -> Stage:
        return cls(Targets(renderer.ctx, renderer), Target.of(renderer.ctx, [renderer.ctx.texture(shown, 4)]), size)

    def frame(self, ctx: moderngl.Context, scene: Scene, number: float) -> tuple[float, float, str]:
        """Milliseconds of processor time and by the wall clock, and how its rays are traced."""
        shown = self.window.size
        drawing = Drawing(moved(scene, number), 3.5 + number / 30.0, self.size, shown, progressive=True, passes=False)
        ctx.finish()
        processor, wall = time.process_time(), time.perf_counter()
        report = self.targets.render_into(self.window.frame, Area(0, 0, *shown), drawing)
        ctx.finish()
        return 1e3 * (time.process_time() - processor), 1e3 * (time.perf_counter() - wall), report.method


def row_of(renderer: Renderer, scene: Scene, yardstick: Stage, size: tuple[int, int], rounds: int) -> str:
    """The figures of one scene; `yardstick` draws that."""
    ctx, by = renderer.ctx, presets.load([YARDSTICK])
    whole, least = Stage.of(renderer, size, SHOWN), Stage.of(renderer, NEXT_TO_NONE, NEXT_TO_NONE)
    few = [least.frame(ctx, scene, number)[0] for number in range(rounds + 2)][2:]
    pairs = [(yardstick.frame(ctx, by, number), whole.frame(ctx, scene, number + 0.5)) for number in range(rounds + 2)]
    pairs = pairs[2:]  # the first compile, the second finish what the first began
    processor, alone = median(own[0] for _, own in pairs), median(few)
    shared = alone + 0.5 * max(processor - alone, 0.0)
    times = median(own[0] / other[0] for other, own in pairs)
    return f"{processor:.0f} | {alone:.0f} | {shared:.0f} | {median(own[1] for _, own in pairs):.0f} | {times:.2f} | {pairs[-1][1][2]}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="640x360", help="of the picture that is drawn")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("presets", nargs="*", metavar="PRESET")
    given = parser.parse_args()
    width, height = (int(side) for side in given.size.split("x"))
    names = given.presets or [info.name for info in presets.available() if info.group == "scene"]
    renderer = Renderer(create_headless())
    yardstick = Stage.of(Renderer(renderer.ctx), (width, height), SHOWN)
    print("| scene | processor ms | of it one core's alone | two cores, ms | wall clock, ms | times | rays |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | --- |", flush=True)
    for name in names:
        print(f"| `{name}` | {row_of(renderer, presets.load([name]), yardstick, (width, height), given.rounds)} |", flush=True)


if __name__ == "__main__":
    main()
