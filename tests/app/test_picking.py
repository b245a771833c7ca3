"""The outline of what is picked."""

import numpy as np

from blackhole_gl.app import commands, picking
from blackhole_gl.app.state import WindowState
from blackhole_gl.scene import presets


def test_the_outline_lies_just_outside_of_what_it_outlines():
    mask = np.zeros((20, 30), bool)
    mask[8:12, 10:15] = True
    pixels = picking.outlined(mask)
    line, rim = pixels[..., 3] == 255, pixels[..., 3] == 160
    assert not pixels[mask].any(), "the thing itself is as it was"
    whole = np.zeros_like(mask)
    whole[6:14, 8:17] = True
    assert np.array_equal(line, whole & ~mask)
    whole[5:15, 7:18] = True
    assert np.array_equal(rim, whole & ~mask & ~line)


def test_an_outline_at_the_pictures_edge_does_not_come_in_on_the_other_side():
    mask = np.zeros((10, 12), bool)
    mask[0, 0] = True
    pixels = picking.outlined(mask)
    assert not pixels[5:].any() and not pixels[:, 6:].any()


def test_what_is_picked_is_in_the_scene():
    state = WindowState.start(presets.load(["kerr"], {"things.moon.kind": "sphere"}))
    state.pick = "things.moon"
    assert state.picked == "things.moon"
    commands.remove_picked(state)
    assert not state.picked and not state.scene.things
    state.undo()
    assert state.picked == "things.moon", "what comes back is picked as it was"
