"""What scenarios act with and look through: a user's hands, the frames that pass."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from imgui_bundle import hello_imgui, imgui

from blackhole_gl.app.runner import PANEL
from blackhole_gl.app.window import Window
from blackhole_gl.scene import Scene

PATIENT_DOUBLE_CLICK = 3.0  # s, ten times what people get: so long a frame may take

KEYS = frozenset(int(key) for key in imgui.Key)


class Hands:
    """Mouse and keyboard, and what they find."""

    def __init__(self, context, window: Window, folder: Path):
        self.context, self.window, self.folder = context, window, folder
        context.yield_(3)

    @property
    def state(self):
        return self.window.state

    @property
    def scene(self) -> Scene:
        return self.state.scene

    def settle(self) -> None:
        """Waits until the camera rests."""
        for _ in range(400):
            self.context.yield_()
            if self.state.motion.at_rest:
                return
        raise AssertionError("the camera does not come to rest")

    def to_picture(self) -> tuple[float, float]:
        """Moves the mouse to the picture's centre and returns it."""
        view = self.window.view()
        centre = (view.left + 0.5 * view.width, view.top + 0.5 * view.height)
        self.context.mouse_move_to_pos(centre)
        return centre

    def press(self, chord: int) -> None:
        """Presses a key; a letter's types it too, as a keyboard does."""
        self.hold(chord, 0.0)
        self.context.yield_(2)

    def hold(self, chord: int, seconds: float, character: str | None = None) -> None:
        """Holds a key which gives `character`, a letter its own, for so long."""
        name = imgui.Key(chord).name if chord in KEYS else ""
        self.context.key_down(chord)
        self.context.key_chars(character or (name if len(name) == 1 else ""))
        if seconds > 0.0:
            self.context.sleep_no_skip(seconds, 1.0 / 60.0)
        self.context.key_up(chord)

    def item(self, name: str) -> str:
        """The path of the panel's item `name`, wherever in the panel it lies."""
        self.context.scroll_to_top(f"//{PANEL}")  # a table that is out of sight has no items
        return f"//{PANEL}/**/{name}"

    def click(self, name: str) -> None:
        self.context.item_click(self.item(name))
        self.context.yield_(2)

    def double_click(self, item: str) -> None:
        """Clicks twice, as one gesture however long the frames between the clicks take on a busy machine."""
        settings = imgui.get_io()
        usual = settings.mouse_single_click_delay, settings.mouse_double_click_time
        self.context.sleep_no_skip(PATIENT_DOUBLE_CLICK, 0.5)  # or a click before would be this gesture's first
        settings.mouse_single_click_delay, settings.mouse_double_click_time = 2.0 * PATIENT_DOUBLE_CLICK, PATIENT_DOUBLE_CLICK
        self.context.item_double_click(item)
        settings.mouse_single_click_delay, settings.mouse_double_click_time = usual
        self.context.yield_(2)

    def fill(self, name: str, value: float | str) -> None:
        """Types `value` into the panel's item and presses Enter."""
        self.context.item_input_value(self.item(name), value)
        self.context.yield_(2)

    def choose(self, combo: str, option: str, table: str = "pickers/") -> None:
        self.context.scroll_to_top(f"//{PANEL}")
        self.context.item_click(f"//{PANEL}/{table}{combo}")  # a closed combo has no label that a search could find
        self.context.item_click(f"//##Combo_00/{option}")
        self.context.yield_(2)


class Frames:
    """How long the window's frames take, in processor time of the window's own thread: what compiles and what holds the panel up. On a shared
    machine a wall clock would measure others' work. Software renderers draw in threads of their own, and how long that takes is another matter."""

    def __init__(self, window: Window):
        self._own = window.before_frame
        hello_imgui.get_runner_params().callbacks.pre_new_frame = self._begin
        self.restart()

    def restart(self) -> None:
        self.longest, self.count, self._last = 0.0, 0, None

    def leave(self) -> None:
        hello_imgui.get_runner_params().callbacks.pre_new_frame = self._own

    def _begin(self) -> None:
        now = time.thread_time()
        if self._last is not None:
            self.longest = max(self.longest, now - self._last)
            self.count += 1
        self._last = now
        self._own()


def wait(hands: Hands, for_what: Callable[[], bool], seconds: float = 2.0) -> None:
    """Lets frames pass until `for_what`, at most so many seconds; two are twice what an edit of a shader may take.

    Between them it sleeps: frames drawn without end would take the processor from what is waited for.
    """
    started = time.monotonic()
    while not for_what():
        assert time.monotonic() - started < seconds, "nothing happened"
        time.sleep(0.02)
        hands.context.yield_()
