"""What a frame takes of the processor time that it took at another commit: two processes, frame by frame in turn, and the median of the pairs' ratios.

    python tools/time_against.py COMMIT [--motion moving|still] [--size 1280x720] [--rounds 60]
        [--scene kerr|kerr_0998|table|marched …]

All four scenes unless some are named. Moving frames are those of a camera that turns by half a degree a frame in both angles.
Still ones are the window's while only time runs, in which a glow may stand for three frames; with `--every-glow` each has its own.
The commit is checked out into a folder of its own, and goes again. Each process has one thread of llvmpipe's (`LP_NUM_THREADS=1`).
"""

from __future__ import annotations

import argparse
import importlib
import inspect
import os
import subprocess
import sys
import tempfile
import time as clock
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from statistics import median, quantiles
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SCENES: dict[str, dict[str, str]] = {
    "kerr": {},
    "kerr_0998": {"hole.spin": "0.998"},
    "table": {"hole.spin": "0", "rays.model": "schwarzschild_table"},
    "marched": {"hole.spin": "0", "rays.model": "schwarzschild"},
}
FIRST_ROUNDS = 4  # not counted: programs are made ready in them


def draw_frames(name: str, size: tuple[int, int], motion: str, *, every_glow: bool) -> None:
    """The drawing process: for each number of a frame on standard input, its milliseconds of processor time.

    Packages are looked for where older commits have them, too.
    """
    frame, context, presets = (
        _first_of(*names) for names in (("rendering.frame", "render.frame"), ("rendering.context", "render.context"), ("scene.presets", "presets"))
    )
    scene, renderer = presets.load(["kerr"], SCENES[name]), frame.Renderer(context.create_headless())
    glow = {"glow_may_last": True} if motion == "still" and not every_glow and "glow_may_last" in inspect.signature(renderer.render).parameters else {}
    print("ready", flush=True)
    for line in sys.stdin:
        number = int(line)
        turn = 0.5 * number if motion == "moving" else 0.0
        seen = scene.with_values({"camera.azimuth_deg": turn, "camera.inclination_deg": scene.camera.inclination_deg + turn % 20})
        renderer.ctx.finish()
        begun = clock.process_time()
        renderer.render(seen, 0.1 * number, size, progressive=motion == "moving", **glow)
        renderer.ctx.finish()
        print(1e3 * (clock.process_time() - begun), flush=True)


def _first_of(*names: str) -> Any:
    for name in names:
        with suppress(ModuleNotFoundError):
            return importlib.import_module(f"blackhole_gl.{name}")
    raise ModuleNotFoundError(f"blackhole_gl has none of {names}")


class Drawer:
    """A process that draws frames with the checkout in `folder`."""

    def __init__(self, folder: Path, scene: str, given: argparse.Namespace):
        command = [sys.executable, __file__, "--draw", scene, "--motion", given.motion, "--size", given.size]
        self._process = subprocess.Popen(
            [*command, *(["--every-glow"] if given.every_glow else [])],
            cwd=folder, env={**os.environ, "PYTHONPATH": str(folder), "LP_NUM_THREADS": "1"}, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        assert self._process.stdin and self._process.stdout
        self._asked, self._told = self._process.stdin, self._process.stdout
        if self._told.readline().strip() != "ready":
            raise SystemExit(f"no frame can be drawn with {folder}")

    def spent(self, number: int) -> float:
        """Milliseconds of processor time of frame `number`."""
        self._asked.write(f"{number}\n")
        self._asked.flush()
        return float(self._told.readline())

    def end(self) -> None:
        self._asked.close()
        self._process.wait()


@contextmanager
def checked_out(commit: str) -> Iterator[Path]:
    """A folder with the files of `commit`."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["git", "-C", ROOT, "worktree", "add", "--detach", "--quiet", folder, commit], check=True)
        try:
            yield Path(folder)
        finally:
            subprocess.run(["git", "-C", ROOT, "worktree", "remove", "--force", folder], check=True)


def pairs(before: Drawer, now: Drawer, rounds: int) -> list[tuple[float, float]]:
    """Milliseconds of each frame, before and now; who draws first changes from frame to frame."""
    taken = []
    for number in range(-FIRST_ROUNDS, rounds):
        if number % 2:
            old, new = before.spent(number), now.spent(number)
        else:
            new, old = now.spent(number), before.spent(number)
        taken.append((old, new))
    return taken[FIRST_ROUNDS:]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("commit", nargs="?")
    parser.add_argument("--scene", action="append", choices=SCENES)
    parser.add_argument("--motion", choices=("moving", "still"), default="moving")
    parser.add_argument("--every-glow", action="store_true")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--rounds", type=int, default=60)
    parser.add_argument("--draw", choices=SCENES, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.draw:
        width, height = (int(side) for side in given.size.split("x"))
        draw_frames(given.draw, (width, height), given.motion, every_glow=given.every_glow)
        return
    with checked_out(given.commit) as folder:
        for scene in given.scene or SCENES:
            before, now = Drawer(folder, scene, given), Drawer(ROOT, scene, given)
            taken = pairs(before, now, given.rounds)
            before.end()
            now.end()
            low, _, high = quantiles((new / old for old, new in taken), n=4)
            old_ms, new_ms = zip(*taken, strict=True)
            print(
                f"{given.motion} {scene}: {median(new / old for old, new in taken):.3f} of the time, half of the pairs within {low:.3f} to {high:.3f}; "
                f"means {sum(new_ms) / sum(old_ms):.3f}; medians {median(old_ms):.1f} and {median(new_ms):.1f} ms",
                flush=True,
            )


if __name__ == "__main__":
    main()
