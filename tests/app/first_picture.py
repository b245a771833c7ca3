"""Opens the window without a display, closes it after the first picture, and says what that took.

    python tests/app/first_picture.py

Prints JSON: seconds since this file began, by the wall and by the processor, programs compiled, and modules loaded. The second run in a row finds the
driver's cache on disk filled.
"""

import time

BEGAN = time.perf_counter()

import json  # noqa: E402
import sys  # noqa: E402
from pathlib import Path  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from imgui_bundle import hello_imgui  # noqa: E402

from blackhole_gl.app import picture, window  # noqa: E402
from blackhole_gl.scene import presets  # noqa: E402, F401  the command line is part of every start

NAMES = ["kerr"]


def main() -> None:
    said, update = {}, picture.Picture.update

    def watched(self, *args, **kwargs) -> bool:
        rendered = update(self, *args, **kwargs)
        if rendered and not said:
            said.update(wall=time.perf_counter() - BEGAN, processor=time.process_time(), programs=self.renderer.programs.compiled, modules=sorted(sys.modules))
            hello_imgui.get_runner_params().app_shall_exit = True
        return rendered

    picture.Picture.update = watched
    window.run(presets.load(NAMES), preset_names=NAMES, null_platform=True)
    print(json.dumps(said))


if __name__ == "__main__":
    main()
