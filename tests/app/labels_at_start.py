"""Opens the window on the display, closes it when it has settled, and says which labels of the panel had room.

    DISPLAY=:77 python tests/app/labels_at_start.py [late]

late: the window has half its size for its first frames, as under a window manager that is slow to grant it.
One line of JSON: the scale, and label → [its width, the room for it] in pixels, in the last frame.
"""

import json
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[2])]

from imgui_bundle import hello_imgui, imgui  # noqa: E402  before anything that may load glfw
from imgui_bundle.glfw_utils import glfw_window_hello_imgui  # noqa: E402

# isort: split
import glfw  # noqa: E402
from fake_renderer import FakeRenderer  # noqa: E402

from blackhole_gl.app import window  # noqa: E402
from blackhole_gl.app.kept import Kept  # noqa: E402
from blackhole_gl.scene import presets  # noqa: E402

LATE_FRAMES = 12
LAST_FRAME = 40


class Watch:
    """Measures the labels that are drawn."""

    def __init__(self, late: bool):
        self.late, self.frames, self.labels, self.scale = late, 0, {}, 0.0
        self._selectable, self._before = imgui.selectable, window.Window.before_frame
        imgui.selectable = self._measure
        window.Window.before_frame = lambda app: self._count(app)

    def _measure(self, label: str, *args, **kwargs):
        words, _, name = label.partition("##")
        if name.startswith("name "):
            self.labels[words] = imgui.calc_text_size(words).x, imgui.get_content_region_avail().x
        return self._selectable(label, *args, **kwargs)

    def _count(self, app: window.Window) -> None:
        self.frames += 1
        self.scale, self.labels = hello_imgui.dpi_window_size_factor(), self.labels if self.frames > LAST_FRAME else {}
        size = [round(self.scale * side) for side in Kept.window_size]
        if self.late and self.frames <= LATE_FRAMES + 1:
            part = 0.5 if self.frames <= LATE_FRAMES else 1.0
            glfw.set_window_size(glfw_window_hello_imgui(), *(round(part * side) for side in size))
        hello_imgui.get_runner_params().app_shall_exit = self.frames > LAST_FRAME
        self._before(app)


def main() -> None:
    watch = Watch("late" in sys.argv)
    window.run(presets.load(["kerr"]), make_renderer=FakeRenderer)
    print(json.dumps({"scale": watch.scale, "labels": watch.labels}))


if __name__ == "__main__":
    main()
