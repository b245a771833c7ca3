"""A display without a screen, for tests of what only a real window has: keyboards, scales."""

import contextlib
import os
import shutil
import subprocess

TOOLS = {"Xvfb": "xvfb", "setxkbmap": "x11-xkb-utils", "xdotool": "xdotool", "xprop": "x11-utils"}
_STARTS_S = 10.0


@contextlib.contextmanager
def opened(tools, size="1000x700", dpi=0):
    """Environment variables in which a window opens on a display of `size` pixels, which says that `dpi` of them are an inch, or nothing.

    `tools`: of `TOOLS`, which are needed.
    """
    missing = [tool for tool in tools if not shutil.which(tool)]
    assert not missing, f"{', '.join(missing)} is not there; on Debian: apt-get install {' '.join(TOOLS[tool] for tool in missing)}"
    reader, writer = os.pipe()
    command = ["Xvfb", "-displayfd", str(writer), "-noreset", "-screen", "0", f"{size}x24"]
    server = subprocess.Popen(command, pass_fds=[writer], stderr=subprocess.DEVNULL)
    os.close(writer)
    with os.fdopen(reader) as answer:
        environment = os.environ | {"DISPLAY": ":" + answer.readline().strip()}
        environment.pop("WAYLAND_DISPLAY", None)
        if dpi:
            said = ["-format", "RESOURCE_MANAGER", "8s", "-set", "RESOURCE_MANAGER", f"Xft.dpi: {dpi}\n"]
            subprocess.run(["xprop", "-root", *said], env=environment, check=True)
        yield environment
    server.terminate()
    server.wait(_STARTS_S)
