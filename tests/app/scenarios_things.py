"""Things under the hand: picked by a click in the picture, taken away, copied. See ``scenarios.py``."""

from __future__ import annotations

from imgui_bundle import imgui

# isort: split
from hands import Hands, wait

from blackhole_gl.app.runner import PANEL

Key = imgui.Key
MOON = {"things.moon.kind": "sphere", "things.moon.x": 9.0, "things.moon.z": 2.0, "things.moon.radius": 1.0}  # before the hole
FAR = {"things.far.kind": "sphere", "things.far.x": -6.0, "things.far.z": 3.0, "things.far.radius": 1.0}  # behind it


def click_the_picture(hands: Hands, x: float, y: float) -> None:
    """At a place counted 0…1 from the top left of the picture."""
    view = hands.window.view()
    hands.context.mouse_move_to_pos((view.left + x * view.width, view.top + y * view.height))
    hands.context.mouse_click(0)
    hands.context.yield_(3)


def a_click_picks_a_thing(hands: Hands) -> None:
    """It is outlined and the panel shows it; ESC or a click elsewhere lets it go, DELETE removes it. A drag and clicks that are others' pick nothing."""
    hands.press(Key.p)
    hands.state.change({**FAR, **MOON})
    hands.settle()
    wait(hands, lambda: hands.window.picture.is_current and hands.window.picture.is_sharp, seconds=100.0)
    click_the_picture(hands, 0.5, 0.5)
    assert hands.state.picked == "things.moon"
    hands.context.yield_(4)
    row = hands.context.item_info(f"//{PANEL}/values of things.moon/##things.moon.kind")
    panel = imgui.internal.find_window_by_name(PANEL)
    assert panel.inner_clip_rect.min.y <= row.rect_full.min.y and row.rect_full.max.y <= panel.inner_clip_rect.max.y, "the panel has scrolled to it"
    x, y = hands.window._picking._outline._top
    assert abs(x - 0.5) < 0.03 and 0.2 < y < 0.45, "its name stands over it"
    hands.to_picture()
    hands.context.mouse_down(0)
    hands.context.mouse_move_to_pos((hands.window.view().left + 40.0, hands.window.view().top + 0.5 * hands.window.view().height))
    hands.context.mouse_up(0)
    hands.settle()
    hands.press(Key.r)
    hands.settle()
    wait(hands, lambda: hands.window.picture.is_sharp, seconds=100.0)
    assert hands.state.picked == "things.moon", "a drag is no click"
    click_the_picture(hands, 0.05, 0.9)
    assert not hands.state.picked
    click_the_picture(hands, 0.5, 0.5)
    assert hands.state.picked == "things.moon"
    hands.press(Key.escape)
    assert not hands.state.picked
    hands.press(Key.g)
    click_the_picture(hands, 0.5, 0.45)
    hands.press(Key.g)
    hands.press(Key.d)
    click_the_picture(hands, 0.3, 0.5)
    hands.press(Key.d)
    assert not hands.state.picked and hands.window.path_view.paths.shown
    wait(hands, lambda: hands.window.picture.is_sharp, seconds=100.0)
    click_the_picture(hands, 0.5, 0.5)
    hands.press(Key.delete)
    assert list(hands.scene.things) == ["far"] and not hands.state.picked
    hands.press(Key.delete)
    assert list(hands.scene.things) == ["far"] and "picked" in hands.state.notice.text
    hands.context.key_press(imgui.Key.mod_ctrl | Key.z)
    hands.context.yield_(3)
    assert list(hands.scene.things) == ["far", "moon"]
    assert hands.state.render_error is None


def things_are_copied(hands: Hands) -> None:
    """A copy has a free name and a place beside the first; what is new is picked, and a new name keeps it so."""
    hands.state.change(MOON | {"things.moon.squares_around": 6})
    hands.click("###things.moon")
    hands.click("Duplicate##things.moon")
    first, second = hands.scene.things.values()
    assert list(hands.scene.things) == ["moon", "moon2"] and hands.state.picked == "things.moon2"
    assert second.values["squares_around"] == 6 and second.values["x"] - first.values["x"] > 2.0 * first.values["radius"]
    hands.fill("##name of things.moon2", "io")
    assert hands.state.picked == "things.io"
    hands.state.change({"things.io.path": "geodesic", "things.io.orbit_phase_deg": 350.0})
    hands.click("Duplicate##things.io")
    assert list(hands.scene.things) == ["moon", "io", "io2"] and hands.scene.get("things.io2.orbit_phase_deg") == 20.0
    hands.click("Remove##things.io2")
    assert not hands.state.picked
    hands.context.key_press(imgui.Key.mod_ctrl | Key.z)
    hands.context.yield_(3)
    assert list(hands.scene.things) == ["moon", "io", "io2"]
    hands.click("Add##things")
    assert hands.state.picked == "things.sphere"


WITH_THE_REAL_RENDERER = (a_click_picks_a_thing,)
