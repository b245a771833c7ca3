"""Pictures of the window itself, for `make gallery`: opened without a display, used as a user would, and closed.

    python tools/window_pictures.py path_view FILE.png

A process makes one picture, as Hello ImGui cannot be started twice in one.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from imgui_bundle import hello_imgui, imgui  # noqa: E402  before anything that may load glfw

# isort: split
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

from blackhole_gl.app import window  # noqa: E402
from blackhole_gl.app.paths import Asked  # noqa: E402
from blackhole_gl.app.window import Window  # noqa: E402
from blackhole_gl.scene import presets  # noqa: E402

SIZE = (960, 600)
WITH_PANEL = (1280, 800)
_PATIENCE_S = 300.0
_EULER = {"rays.model": "schwarzschild", "rays.integrator": "euler"}

Steps = Iterator[Callable[[], bool]]
"""What is done, one thing after the other; each yields what is waited for before the next."""


@dataclass(frozen=True)
class WindowShot:
    """One picture: the preset, what differs from it, what is done in the window, the scene time in r_s/c, and the window's size."""

    preset: str
    changes: Mapping[str, Any]
    done: Callable[[Window], Steps]
    time: float = 30.0
    size: tuple[int, int] = SIZE


def _start(app: Window) -> Steps:
    """As it opens."""
    app.state.show_panel = True
    yield lambda: app.picture.is_final and app.picture.samples > 1
    app.begin_start_line()
    yield lambda: True


def _path_view(app: Window) -> Steps:
    """Two rays which steps that are too long take through the hole, and the same rays in truth."""
    view = app.path_view
    yield lambda: app.picture.is_final
    width, height = app.view().area.size
    app.state.show_paths = True
    for across, up in ((0.46, 0.60), (0.60, 0.63)):
        view.paths.ask(Asked(app.state.scene, (width, height), (round(across * width) + 0.5, round(up * height) + 0.5)))
    yield lambda: not view.busy
    view.paths.again(Asked.by_most_accurate)
    yield lambda: not view.busy


def _side_by_side(app: Window) -> Steps:
    app.state.show_sides = True
    app.side_by_side.sides.share = 0.45
    yield lambda: app.picture.is_final and not app.side_by_side.busy(app.state)


SHOTS = {
    "window": WindowShot("kerr", {}, _start, size=WITH_PANEL),
    "path_view": WindowShot("schwarzschild", {**_EULER, "rays.step_control": "fixed", "rays.step_length": 2.0, "camera.distance": 5.0}, _path_view),
    "side_by_side": WindowShot("kerr", {**_EULER, "rays.step_control": "radius", "rays.step_length": 0.5}, _side_by_side),
}


class _User:
    """Does what a shot says; see `blackhole_gl.app.window.Driver`."""

    def __init__(self, shot: WindowShot):
        self.finished = False
        self._shot = shot

    def register(self, app: Window) -> None:
        engine = hello_imgui.get_imgui_test_engine()
        io = imgui.test_engine.get_io(engine)
        io.config_watchdog_warning = io.config_watchdog_kill_test = _PATIENCE_S
        test = imgui.test_engine.register_test(engine, "window", "picture")
        test.test_func = lambda context: self._use(context, app)
        imgui.test_engine.queue_test(engine, test)
        self._test = test

    def _use(self, context: Any, app: Window) -> None:
        app.state.paused, app.state.show_panel, app.state.time = True, False, self._shot.time
        context.yield_(5)
        for reached in self._shot.done(app):
            began = time.monotonic()
            while not reached() and time.monotonic() - began < _PATIENCE_S:
                context.yield_()
        context.yield_(5)
        self.finished = True


def take(shot: WindowShot, path: Path) -> None:
    """Writes the window of `shot` to `path`."""
    with tempfile.TemporaryDirectory() as folder:
        scene = presets.load([shot.preset], dict(shot.changes))
        window.run(scene, preset_names=[shot.preset], null_platform=True, size=shot.size, picture_folder=Path(folder), driver=_User(shot))
    Image.fromarray(np.asarray(hello_imgui.final_app_window_screenshot())[..., :3]).save(path)


if __name__ == "__main__":
    take(SHOTS[sys.argv[1]], Path(sys.argv[2]))
