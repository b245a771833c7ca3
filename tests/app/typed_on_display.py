"""Strikes every key of the help on the display's keyboard, by its layout of the moment, and says what the window did.

    DISPLAY=:77 python tests/app/typed_on_display.py [quick]

quick: frames take long, and within one a key goes down and the modifiers held before and the key go up; only chords with modifiers are struck.
Leaves by CTRL+Q. One line of JSON: chord → [actions pressed, actions held, whether those held ended with the key],
and whether the window closed. Needs xdotool.
"""

import json
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[2])]

from imgui_bundle import hello_imgui  # noqa: E402  before anything that may load glfw

# isort: split
from fake_renderer import FakeRenderer  # noqa: E402

from blackhole_gl.app import window  # noqa: E402
from blackhole_gl.app.keys import FLYING, Chord, default_bindings  # noqa: E402
from blackhole_gl.scene import presets  # noqa: E402

SLOW_S = 0.25  # a frame, where keys are quick
HELD_S = 0.4  # in which a key would do more than it should
COMES_S = 20.0  # in which what a key does is to be seen: on a busy machine a frame may take seconds
_X_NAMES = {
    "SPACE": "space", "TAB": "Tab", "ESC": "Escape", "PAGE_UP": "Prior", "PAGE_DOWN": "Next", "LEFT": "Left", "RIGHT": "Right", "UP": "Up", "DOWN": "Down",
    "DELETE": "Delete", "PLUS": "plus", "EQUAL": "equal", "MINUS": "minus", "KEYPAD_ADD": "KP_Add", "KEYPAD_SUBTRACT": "KP_Subtract",
}  # fmt: skip


class Recorder:
    """What the window does, action by action, in place of its doing it."""

    def __init__(self):
        self.pressed: list[str] = []
        self.held: list[str] = []
        self.frames = 0
        self.frame_s = 0.0
        self._do = window.Window.do
        window.Window.do = lambda _, action: self.pressed.append(action)
        window.commands.advance = self._advance

    def leave(self) -> None:
        """From now on the window does what it is told."""
        window.Window.do = self._do

    def _advance(self, state, hand, dt, slept) -> None:
        time.sleep(self.frame_s)
        self.frames += 1
        self.held = list(hand.held)
        state.clock += dt


def x_name(chord: Chord) -> str:
    """`chord` as xdotool takes it."""
    key = chord.key if chord.key.startswith("F") and chord.key != "F" else _X_NAMES.get(chord.key, chord.key.lower())
    return "+".join([*(word.lower() for word in chord.modifiers), key])


def strike(chord: Chord, record: Recorder) -> tuple[list[str], list[str], bool]:
    record.pressed.clear()
    subprocess.run(["xdotool", "keydown", x_name(chord)], check=True)
    within(COMES_S, lambda: record.pressed or record.held)
    time.sleep(HELD_S)
    pressed, held = list(record.pressed), list(record.held)
    subprocess.run(["xdotool", "keyup", x_name(chord)], check=True)
    let_go = record.frames
    ended = within(COMES_S, lambda: record.frames > let_go + 1 and not record.held)
    return pressed, held, ended


def strike_quickly(chord: Chord, record: Recorder) -> tuple[list[str], list[str], bool]:
    """As `strike`, with the modifiers down for some frames and all else within one."""
    record.frame_s = SLOW_S
    record.pressed.clear()
    modifiers, key = [word.lower() for word in chord.modifiers], x_name(chord).rpartition("+")[2]
    subprocess.run(["xdotool", *(part for word in modifiers for part in ("keydown", word))], check=True)
    since = record.frames
    within(COMES_S, lambda: record.frames > since + 2)
    subprocess.run(["xdotool", "keydown", key, *(part for word in modifiers for part in ("keyup", word)), "keyup", key], check=True)
    since = record.frames
    within(COMES_S, lambda: record.frames > since + 3)
    record.frame_s = 0.0
    return list(record.pressed), list(record.held), not record.held


def within(seconds: float, has_come: Callable[[], object]) -> bool:
    """Waits until `has_come`, at most so long, and says whether it has."""
    last = time.monotonic() + seconds
    while not has_come() and time.monotonic() < last:
        time.sleep(0.02)
    return bool(has_come())


def main() -> None:
    record, found, closed, quick = Recorder(), {}, threading.Event(), "quick" in sys.argv

    def type_all() -> None:
        try:
            while record.frames < 20:
                time.sleep(0.05)
            chords = dict.fromkeys(chord for name, chords in default_bindings().items() if name not in FLYING for chord in chords)
            for chord in chords:
                if not quick or chord.modifiers:
                    found[str(chord)] = (strike_quickly if quick else strike)(chord, record)
            record.leave()
            leaves = x_name(default_bindings()["quit"][0])
            subprocess.run(["xdotool", "keydown", leaves], check=True)
            found["closed"] = closed.wait(COMES_S)
            subprocess.run(["xdotool", "keyup", leaves], check=True)  # the keyboard is the display's, and the next window's
        finally:
            if not closed.is_set():
                hello_imgui.get_runner_params().app_shall_exit = True

    typist = threading.Thread(target=type_all)
    typist.start()
    window.run(presets.load(["kerr"]), size=(700, 500), make_renderer=FakeRenderer)
    closed.set()
    typist.join()
    print(json.dumps(found))


if __name__ == "__main__":
    main()
