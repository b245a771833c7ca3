"""What every draw of a frame costs: processor time and wall clock, still and moving, by shader.

    python tools/profile_frame.py [--size 1280x720] [--rounds 12] [--preset kerr] [--set hole.spin=0]

Each draw is waited for, so the sum is a little more than a frame of its own; what is left of the frame is Python, copies and clears. The least of the
rounds counts: what else a machine does can only lengthen a draw.
"""

from __future__ import annotations

import argparse
import time as clock
from collections import defaultdict
from functools import partial

from blackhole_gl.rendering import draw, frame, programs
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.scene import presets

TURN_DEG = 0.5  # between frames, in both angles
WAYS = ("draw", "draw_boxes", "draw_squares", "draw_patches", "draw_mesh", "draw_points")


class Profile:
    """Times the draws of every module of the renderer."""

    def __init__(self, renderer: frame.Renderer):
        self._ctx = renderer.ctx
        self._path: dict[int, str] = {}
        self.times: dict[str, list[tuple[float, float]]] = defaultdict(list)
        self._name_programs(renderer.programs)
        self._draws = False  # one way to draw may use another
        for way in WAYS:
            self._time_draws(way)

    def _time_draws(self, way: str) -> None:
        plain = getattr(draw.Draw, way)

        def timed(prepared, *arguments):
            if self._draws:
                return plain(prepared, *arguments)
            self._draws = True
            self.timed(self._path.get(prepared.serial, "?"), lambda: plain(prepared, *arguments))
            self._draws = False

        setattr(draw.Draw, way, timed)

    def _name_programs(self, kept: programs.Programs) -> None:
        plain = kept.get

        def named(path, *arguments, **more):
            prepared = plain(path, *arguments, **more)
            self._path[prepared.serial] = path
            return prepared

        kept.get = named

    def timed(self, name, work):
        """Does `work` and keeps what it took, in milliseconds."""
        self._ctx.finish()
        wall, processor = clock.perf_counter(), clock.process_time()
        work()
        self._ctx.finish()
        self.times[name].append((1e3 * (clock.process_time() - processor), 1e3 * (clock.perf_counter() - wall)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--rounds", type=int, default=12)
    parser.add_argument("--preset", action="append")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    given = parser.parse_args()
    size = tuple(int(side) for side in given.size.split("x"))
    scene = presets.load(given.preset or ["kerr"], dict(pair.split("=", 1) for pair in given.set))
    renderer = frame.Renderer(create_headless())
    profile = Profile(renderer)
    for motion in ("still", "moving"):
        profile.times.clear()
        rows = []
        for number in range(-3, given.rounds):
            turn = TURN_DEG * number if motion == "moving" else 0.0
            seen = scene.with_values({"camera.azimuth_deg": turn, "camera.inclination_deg": scene.camera.inclination_deg + turn})
            drawn_before = {name: len(times) for name, times in profile.times.items()}
            profile.timed("whole frame", partial(renderer.render, seen, 0.1 * number, size, progressive=motion == "moving"))
            if number >= 0:
                rows.append({name: [sum(column) for column in zip(*times[drawn_before.get(name, 0) :])] for name, times in profile.times.items()})
        _print(f"{motion}, {size[0]}×{size[1]}", rows)


def _print(title: str, rows: list[dict[str, list[float]]]) -> None:
    print(f"\n| {title} | processor ms | wall ms |\n| --- | ---: | ---: |")
    names = [name for name in rows[-1] if all(row.get(name) for row in rows)]
    for name in sorted(names, key=lambda name: -min(row[name][0] for row in rows)):
        print(f"| {name} | {min(row[name][0] for row in rows):.1f} | {min(row[name][1] for row in rows):.1f} |")


if __name__ == "__main__":
    main()
