"""How long the frames of the real window take while its camera rests or moves, from picture to picture, and how coarse they are drawn.

    python tools/time_window.py [--preset kerr] [--set KEY=VALUE] [--size 1280x720] [--seconds 20] [--target-fps 0 --target-fps 30] [--motion orbit]
        [--settle 3] [--no-display]

Opens the window without its panel, so that the picture has `--size`, and holds keys down for it; the window does the rest itself. Motions:
rest (only the disk turns), turn (about the spin axis: rays are kept), orbit (in both angles, to and fro across the disk's plane), zoom (in to 6 r_s and
out to 30), look (the view alone turns to the right), glance (the view rests for two seconds, turns for two, rests, and turns back). Each goes on for `--settle`
seconds before frames count, the first of them not before the scene's own programs are there. A figure stands for the machine and its screen together: on a
display with vertical synchronisation no frame is shorter than the screen's.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time as clock
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field, replace
from statistics import median, quantiles

from imgui_bundle import hello_imgui

from blackhole_gl.app import commands, picture, window
from blackhole_gl.app.state import WindowState
from blackhole_gl.scene import presets

ORBIT_DEG = (60.0, 100.0)
ZOOM_RS = (6.0, 30.0)
LOOK = 0.5  # of a stick's whole way
GLANCE_S = 2.0


class Swing:
    """Holds one key until a value passes the end of a range, then the other until it passes the other end."""

    def __init__(self, value: Callable[[WindowState], float], ends: tuple[float, float], up: str, down: str):
        self._value, self._ends, self._keys, self._upwards = value, ends, (down, up), True

    def __call__(self, state: WindowState) -> tuple[str, ...]:
        low, high = self._ends
        value = self._value(state)
        self._upwards = value < high if self._upwards else value <= low
        return (self._keys[self._upwards],)


def motions() -> dict[str, Callable[[WindowState], Collection[str]]]:
    """The keys held, by what is called a motion."""
    tilt = Swing(lambda state: state.scene.camera.inclination_deg, ORBIT_DEG, "orbit_down", "orbit_up")
    return {
        "rest": lambda state: (),
        "look": lambda state: (),  # with a stick: see `look_of`
        "glance": lambda state: (),
        "turn": lambda state: ("orbit_right",),
        "orbit": lambda state: (*tilt(state), "orbit_right"),
        "zoom": Swing(lambda state: state.scene.camera.distance, ZOOM_RS, "zoom_out", "zoom_in"),
    }


def look_of(motion: str, clock_s: float) -> float:
    """How far a stick is pushed to the right, by the window's clock."""
    if motion == "glance":
        turn, within = divmod(clock_s / GLANCE_S, 2.0)
        return 0.0 if within < 1.0 else LOOK if turn % 2.0 == 0.0 else -LOOK
    return LOOK if motion == "look" else 0.0


@dataclass
class Run:
    """One motion at one frame rate aimed at, and the pictures seen: when each was there and after how much processor time [s], and at which scale."""

    motion: str
    target_fps: float
    stamps: list[float] = field(default_factory=list)
    processor: list[float] = field(default_factory=list)
    scales: list[float] = field(default_factory=list)

    def row(self) -> str:
        """Its row of the table; the first frame of two has no length."""
        lengths = [1e3 * (b - a) for a, b in zip(self.stamps, self.stamps[1:])]
        changes = sum(a != b for a, b in zip(self.scales, self.scales[1:]))
        busy = 1e3 * median(b - a for a, b in zip(self.processor, self.processor[1:]))
        middle, slow = median(lengths), quantiles(lengths, n=20)[-1]
        scale = f"{median(self.scales):.2f} | {min(self.scales):.2f} to {max(self.scales):.2f} | {changes}"
        times = f"{middle:.1f} | {slow:.1f} | {max(lengths):.1f} | {busy:.1f} | {1e3 / middle:.1f}"
        return f"| {self.motion} | {self.target_fps:g} | {len(lengths)} | {times} | {scale} |"


class Conductor:
    """Leads the window through the runs and closes it after the last."""

    def __init__(self, runs: list[Run], seconds: float, settle: float):
        self._todo: Iterator[Run] = iter(runs)
        self._seconds, self._settle, self._keys = seconds, settle, motions()
        self._run: Run | None = None
        self._until = 0.0
        self._begun = False  # whether the scene's own picture has been seen

    def hold(self, state: WindowState) -> Collection[str]:
        """What is held down in this frame."""
        if clock.perf_counter() > self._until:
            self._next(state)
        elif not self._begun:
            self._begin()
        return self._keys[self._run.motion](state) if self._run else ()

    def leads(self, state: WindowState, hand: commands.Hand, dt: float) -> commands.Hand:
        """What the hand does in this frame, `dt` seconds long."""
        held = replace(hand, held=self.hold(state))
        return held if self._run is None else held.turned((look_of(self._run.motion, state.clock), 0.0), dt)

    def saw(self, shown: picture.Picture) -> None:
        """A picture was drawn."""
        now = clock.perf_counter()
        self._begun = self._begun or shown.is_current
        if self._run and (shown.is_current or shown.bridges) and now > self._until - self._seconds:
            self._run.stamps.append(now)
            self._run.processor.append(clock.process_time())
            self._run.scales.append(shown.scale)

    def _next(self, state: WindowState) -> None:
        if self._run:
            print(self._run.row(), flush=True)
        self._run = next(self._todo, None)
        if self._run is None:
            hello_imgui.get_runner_params().app_shall_exit = True
            return
        state.show_panel = False
        state.change({"playback.target_fps": self._run.target_fps})
        self._begin()

    def _begin(self) -> None:
        self._until = clock.perf_counter() + self._settle + self._seconds


def conduct(conductor: Conductor) -> None:
    """Puts the conductor's keys into the window's hands and shows it every picture."""
    advance, update = commands.advance, picture.Picture.update

    def led(state, hand, dt, slept=0.0) -> None:
        advance(state, conductor.leads(state, hand, dt), dt, slept)

    def watched(self, *args, **kwargs) -> bool:
        rendered = update(self, *args, **kwargs)
        if rendered:
            conductor.saw(self)
        return rendered

    commands.advance, picture.Picture.update = led, watched


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--preset", action="append")
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--seconds", type=float, default=20.0, help="of each run that count")
    parser.add_argument("--settle", type=float, default=3.0, help="seconds before that: for programs, and for the scale that the window finds")
    parser.add_argument("--target-fps", type=float, action="append", help="0: full size (default: 0 and 30)")
    parser.add_argument("--motion", action="append", choices=list(motions()), help="(default: all)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--no-display", action="store_true", help="GLFW's null platform, which presents nothing")
    given = parser.parse_args()
    size = tuple(int(side) for side in given.size.split("x"))
    runs = [Run(motion, target) for target in given.target_fps or (0.0, 30.0) for motion in given.motion or motions()]
    conduct(Conductor(runs, given.seconds, given.settle))
    print(f"| {given.size} | fps aimed at | frames | median ms | 95 % ms | longest ms | processor ms | fps | scale | from, to | changes |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |", flush=True)
    with tempfile.TemporaryDirectory() as folder:  # what the user's window keeps, a wider panel say, would change the picture's size
        os.environ["BLACKHOLE_GL_CONFIG_DIR"] = folder
        window.run(presets.load(given.preset or ["kerr"], dict(pair.split("=", 1) for pair in given.set)), null_platform=given.no_display, size=size)


if __name__ == "__main__":
    main()
