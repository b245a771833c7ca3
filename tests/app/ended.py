"""The command line's `view` with its other process started, for tests of how it ends.

    python tests/app/ended.py [shown] view

Without a display, or on that of the environment: `shown`. Says the other process's id once a picture is there.
"""

import functools
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from blackhole_gl import cli  # noqa: E402


def main() -> None:
    from blackhole_gl.app import picture, window

    if sys.argv[1] == "shown":
        del sys.argv[1]
    else:
        window.run = functools.partial(window.run, null_platform=True)
        os.environ["DISPLAY"] = ":0"  # the null platform looks at none
    start, update, said = window.Window.start, picture.Picture.update, []

    def started(self: window.Window) -> None:
        start(self)
        said.append(self.warm_up._worker.submit(os.getpid))

    def updated(self, *args, **named) -> bool:
        rendered = update(self, *args, **named)
        if rendered and said:
            print(said.pop().result(), flush=True)
        return rendered

    window.Window.start, picture.Picture.update = started, updated
    cli.main()


if __name__ == "__main__":
    main()
