"""Every key of the help, struck on the keyboards of eight countries: the window on a virtual display. Needs Xvfb, setxkbmap, xdotool and xkb-data."""

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

from blackhole_gl.app.keys import ACTIONS, FLYING, default_bindings
from tests.app import virtual_display

pytestmark = pytest.mark.display

SCRIPT = Path(__file__).resolve().parent / "typed_on_display.py"
LAYOUTS = ("us", "gb", "de", "fr", "es", "se", "cz", "us(dvorak)")


@pytest.fixture(scope="module")
def display():
    with virtual_display.opened(["Xvfb", "setxkbmap", "xdotool"]) as environment:
        yield environment


@pytest.mark.slow
@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_key_of_the_help_does_what_it_says(layout, display, tmp_path):
    name, _, variant = layout.rstrip(")").partition("(")
    environment = display | {"BLACKHOLE_GL_CONFIG_DIR": str(tmp_path)}
    subprocess.run(["setxkbmap", "-layout", name, "-variant", variant], env=environment, check=True)
    time.sleep(0.2)  # the server tells its clients
    done = subprocess.run([sys.executable, str(SCRIPT)], env=environment, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")
    found = json.loads(done.stdout.splitlines()[-1])
    held = {action.name for action in ACTIONS if action.held}
    bound = {action: chords for action, chords in default_bindings().items() if action not in FLYING}  # with the right mouse button held, which it is not here
    wanted = {str(chord): [[], [action], True] if action in held else [[action], [], True] for action, chords in bound.items() for chord in chords}
    assert found == wanted | {"closed": True}


@pytest.mark.slow
def test_modifiers_count_that_are_let_go_in_the_frame_in_which_a_key_is_struck(display, tmp_path):
    """SHIFT+F12 was F12, and CTRL+S nothing, where a frame was as long as a hand is quick."""
    environment = display | {"BLACKHOLE_GL_CONFIG_DIR": str(tmp_path)}
    subprocess.run(["setxkbmap", "-layout", "us", "-variant", ""], env=environment, check=True)
    done = subprocess.run([sys.executable, str(SCRIPT), "quick"], env=environment, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")
    wanted = {str(chord): [[action], [], True] for action, chords in default_bindings().items() for chord in chords if chord.modifiers}
    assert json.loads(done.stdout.splitlines()[-1]) == wanted | {"closed": True}
