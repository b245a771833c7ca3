"""Runs one scenario of `scenarios.py` in a window without a display, and says by its exit status whether all checks held.

    python tests/app/drive.py orbit_by_drag

Each scenario has a process of its own: Hello ImGui cannot be started twice in one.
"""

import sys
import tempfile
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[2])]

from imgui_bundle import hello_imgui, imgui  # noqa: E402  before anything that may load glfw

import scenarios  # noqa: E402
from fake_renderer import FakeRenderer  # noqa: E402

from blackhole_gl import presets  # noqa: E402
from blackhole_gl.app import window  # noqa: E402

SIZE = (900, 640)


class TestDriver:
    """Hands a scenario to the ImGui test engine; see `blackhole_gl.app.window.Driver`."""

    def __init__(self, scenario, folder: Path):
        self._scenario, self._folder, self._test = scenario, folder, None
        self.finished = self.passed = False

    def register(self, app: window.Window) -> None:
        engine = hello_imgui.get_imgui_test_engine()
        imgui.test_engine.get_io(engine).config_run_speed = imgui.test_engine.TestRunSpeed.fast
        self._test = imgui.test_engine.register_test(engine, "window", self._scenario.__name__)
        self._test.test_func = lambda context: self._run(scenarios.Hands(context, app, self._folder))
        imgui.test_engine.queue_test(engine, self._test)

    def _run(self, hands: scenarios.Hands) -> None:
        try:
            self._scenario(hands)
            # What the engine could not find or click is an error of its own, which raises nothing.
            self.passed = not hands.context.is_error()
        finally:
            self.finished = True
            if not self.passed:
                print(self._test.output.log.get_text())


def main() -> int:
    scenario = getattr(scenarios, sys.argv[1])
    renderer = None if getattr(scenario, "needs_renderer", False) else FakeRenderer
    with tempfile.TemporaryDirectory() as folder:
        driver = TestDriver(scenario, Path(folder))
        scene = presets.load(["kerr", "low"])
        window.run(scene, preset_names=["kerr", "low"], null_platform=True, size=SIZE, picture_folder=Path(folder), make_renderer=renderer, driver=driver)
    return 0 if driver.passed else 1


if __name__ == "__main__":
    sys.exit(main())
