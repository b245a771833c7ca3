"""Every key of the help, struck on the keyboards of eight countries: the window on a virtual display. Needs Xvfb, setxkbmap, xdotool and xkb-data."""

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from blackhole_gl.app.keys import ACTIONS, default_bindings

SCRIPT = Path(__file__).resolve().parent / "typed_on_display.py"
LAYOUTS = ("us", "gb", "de", "fr", "es", "se", "cz", "us(dvorak)")
TOOLS = ("Xvfb", "setxkbmap", "xdotool")
_STARTS_S = 10.0


@pytest.fixture(scope="module")
def display():
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    assert not missing, f"{', '.join(missing)} is not there; on Debian: apt-get install xvfb x11-xkb-utils xkb-data xdotool"
    reader, writer = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-noreset", "-screen", "0", "1000x700x24"], pass_fds=[writer], stderr=subprocess.DEVNULL)
    os.close(writer)
    with os.fdopen(reader) as answer:
        yield ":" + answer.readline().strip()
    server.terminate()
    server.wait(_STARTS_S)


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_key_of_the_help_does_what_it_says(layout, display, tmp_path):
    name, _, variant = layout.rstrip(")").partition("(")
    environment = os.environ | {"DISPLAY": display, "BLACKHOLE_GL_CONFIG_DIR": str(tmp_path)}
    environment.pop("WAYLAND_DISPLAY", None)
    subprocess.run(["setxkbmap", "-layout", name, "-variant", variant], env=environment, check=True)
    time.sleep(0.2)  # the server tells its clients
    done = subprocess.run([sys.executable, str(SCRIPT)], env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    held = {action.name for action in ACTIONS if action.held}
    wanted = {str(chord): [[], [action], True] if action in held else [[action], [], True] for action, chords in default_bindings().items() for chord in chords}
    assert found == wanted | {"closed": True}
