"""Runs scenarios of ``scenarios.py``, one after the other, in a window without a display.

    python tests/app/drive.py orbit_by_drag help_window

Says which failed, and by its exit status whether any did. It is a process of its own because Hello ImGui cannot be started
twice in one. Scenarios with the real renderer and those without do not mix.
"""

import shutil
import sys
import tempfile
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[2])]

from imgui_bundle import hello_imgui, imgui  # noqa: E402  before anything that may load glfw

# isort: split
import scenarios  # noqa: E402
import scenarios_entry  # noqa: E402
import scenarios_flight  # noqa: E402
import scenarios_things  # noqa: E402
from fake_renderer import FakeRenderer  # noqa: E402
from hands import Hands  # noqa: E402

from blackhole_gl.app import window  # noqa: E402
from blackhole_gl.scene import presets  # noqa: E402

MODULES = (scenarios, scenarios_entry, scenarios_flight, scenarios_things)
SIZE = (900, 640)
SIZE_OF_REAL = (720, 480)  # a picture of a third of the pixels
PRESETS = ["kerr", "blackholegpu_low"]
TIMEOUT_S = 200.0  # of a scenario; most take a second


class EngineDriver:
    """Hands scenarios to the ImGui test engine; see `blackhole_gl.app.window.Driver`."""

    def __init__(self, chosen, folder: Path):
        self._left, self._folder = list(chosen), folder
        self.failed: list[str] = []

    @property
    def finished(self) -> bool:
        return not self._left

    def register(self, app: window.Window) -> None:
        engine = hello_imgui.get_imgui_test_engine()
        io = imgui.test_engine.get_io(engine)
        io.config_run_speed = imgui.test_engine.TestRunSpeed.fast
        io.config_watchdog_warning = io.config_watchdog_kill_test = TIMEOUT_S
        self._tests = [self._queue(engine, scenario, app) for scenario in self._left]

    def _queue(self, engine, scenario, app: window.Window):
        test = imgui.test_engine.register_test(engine, "window", scenario.__name__)
        test.test_func = lambda context: self._run(scenario, context, test, app)
        imgui.test_engine.queue_test(engine, test)
        return test

    def _run(self, scenario, context, test, app: window.Window) -> None:
        folder = self._folder / scenario.__name__
        folder.mkdir()
        self.failed.append(scenario.__name__)
        try:
            app.open(presets.load(PRESETS), PRESETS)
            scenario(Hands(context, app, folder))
            # What the engine could not find or click is an error of its own, which raises nothing.
            if not context.is_error():
                self.failed.remove(scenario.__name__)
        finally:
            if scenario.__name__ in self.failed:
                print(f"{scenario.__name__} failed. {test.output.log.get_text()}")
            self._left.remove(scenario)


def real_renderer(folder: Path):
    """A maker of the renderer that draws with a copy of the shaders, ``folder/shaders``, which a scenario may edit."""
    from blackhole_gl import resources
    from blackhole_gl.rendering import frame, programs

    copy = shutil.copytree(resources.shaders_dir(), folder / "shaders")
    programs.shaders_dir = lambda: copy
    return frame.Renderer


def main() -> int:
    chosen = [next(getattr(module, name) for module in MODULES if hasattr(module, name)) for name in sys.argv[1:]]
    with tempfile.TemporaryDirectory() as folder:
        real = any(scenario in (*scenarios.WITH_THE_REAL_RENDERER, *scenarios_things.WITH_THE_REAL_RENDERER) for scenario in chosen)
        maker = real_renderer(Path(folder)) if real else FakeRenderer
        driver = EngineDriver(chosen, Path(folder))
        size = SIZE_OF_REAL if real else SIZE
        window.run(presets.load(PRESETS), null_platform=True, size=size, picture_folder=Path(folder) / scenarios.PICTURES, make_renderer=maker, driver=driver)
    return len(driver.failed)


if __name__ == "__main__":
    sys.exit(main())
