"""Free flight in the window. See ``scenarios.py``."""

from __future__ import annotations

from imgui_bundle import imgui

# isort: split
import numpy as np
from hands import Hands, wait

from blackhole_gl.physics.observer import observe
from blackhole_gl.physics.space_time import space_time
from blackhole_gl.scene import Scene

Key = imgui.Key


def _world(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """The camera's place in r_s, and the axes of its view: backwards, down and right."""
    seen = observe(scene)
    return 0.5 / seen.w * seen.n, seen.axes


def letters_fly_while_the_right_button_is_held(hands: Hands) -> None:
    """W goes where the view goes, S back, and the view stays as it is; let go, S is Schwarzschild or Kerr again. All of it is one step to be undone."""
    hands.press(Key.p)
    before = hands.scene
    x, y = hands.to_picture()
    hands.context.mouse_down(1)
    hands.context.mouse_move_to_pos((x + 50, y - 20))
    place, axes = _world(hands.scene)
    hands.hold(Key.w, 0.5)
    wait(hands, lambda: hands.state.flight.at_rest, seconds=20.0)
    ahead, turned = _world(hands.scene)
    way = ahead - place
    assert np.linalg.norm(way) > 2.0 and way @ -axes[0] > 0.999 * np.linalg.norm(way), way
    assert np.abs(turned - axes).max() < 1e-6, "the view is not turned in space"
    hands.hold(Key.s, 0.3)
    wait(hands, lambda: hands.state.flight.at_rest, seconds=20.0)
    assert (_world(hands.scene)[0] - ahead) @ axes[0] > 0.5, "S goes back"
    assert hands.scene.hole == before.hole, "and is not Schwarzschild meanwhile"
    hands.hold(Key.e, 0.3)
    wait(hands, lambda: hands.state.flight.at_rest, seconds=20.0)
    hands.context.mouse_up(1)
    hands.context.yield_(3)
    hands.press(Key.s)
    assert (hands.scene.hole.spin == 0.0) != (before.hole.spin == 0.0)
    hands.press(Key.s)
    there = hands.scene.camera
    hands.press(Key.w)
    assert hands.scene.camera == there, "without the button W is no key of flight"


def a_flight_ends_above_the_horizon(hands: Hands) -> None:
    hands.state.change({"camera.distance": 1.2})
    hands.to_picture()
    hands.context.mouse_down(1)
    hands.hold(Key.w, 1.5)
    hands.context.mouse_up(1)
    wait(hands, lambda: hands.state.flight.at_rest, seconds=20.0)
    assert space_time(hands.scene).horizon_radius < hands.scene.camera.distance < 1.0
    assert hands.state.render_error is None
