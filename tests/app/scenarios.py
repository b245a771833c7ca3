"""What a user does in the window, and what must come of it. Items are found by name, never by place.

Each function takes `Hands` and raises AssertionError when something is not as it should be. ``drive.py`` runs them.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from imgui_bundle import imgui  # before glfw: on Linux the first GLFW that is loaded is the one used
from imgui_bundle.glfw_utils import glfw_window_hello_imgui

# isort: split
import glfw
import numpy as np
from hands import Frames, Hands, wait
from PIL import Image

from blackhole_gl import planning
from blackhole_gl.app import compass, mouse_values, overlay, preset_switch
from blackhole_gl.app.live_chart import is_used, use
from blackhole_gl.app.runner import PANEL
from blackhole_gl.physics.space_time import space_time
from blackhole_gl.rendering import labels, polarized_disk, scale_bar
from blackhole_gl.scene import fields, presets

Key = imgui.Key
LONGEST_FRAME_S = 0.6  # twice what is promised: where others share the core, processor time counts double
PICTURES = "pictures"  # the folder that F12 fills, beside the scenarios' own


def orbit_by_drag(hands: Hands) -> None:
    before = hands.scene.camera
    x, y = hands.to_picture()
    hands.context.mouse_down(0)
    hands.context.mouse_move_to_pos((x + 120, y + 60))
    hands.context.mouse_up(0)
    hands.settle()
    after = hands.scene.camera
    height = hands.window.view().height
    assert abs((before.azimuth_deg - after.azimuth_deg) - 180.0 * 120 / height) < 2.0, after
    assert abs((before.inclination_deg - after.inclination_deg) - 180.0 * 60 / height) < 2.0, after
    assert after.distance == before.distance


def look_by_right_drag_and_zoom_by_middle_drag(hands: Hands) -> None:
    before = hands.scene.camera
    height = hands.window.view().height
    for button, way in ((1, (60, 30)), (2, (0, -60))):
        x, y = hands.to_picture()
        hands.context.mouse_down(button)
        hands.context.mouse_move_to_pos((x + way[0], y + way[1]))
        hands.context.mouse_up(button)
    hands.settle()
    after = hands.scene.camera
    # Two pixels' worth: the engine's mouse moves in whole ones.
    assert abs(after.yaw_deg + before.fov_deg * 60 / height) < 2.0 * before.fov_deg / height, after
    assert abs(after.pitch_deg - before.fov_deg * 30 / height) < 2.0 * before.fov_deg / height, after
    assert after.azimuth_deg == before.azimuth_deg and after.distance < before.distance
    hands.context.key_hold(Key.page_down, 0.3)
    hands.settle()
    assert hands.scene.camera.distance > after.distance
    hands.press(Key.r)
    hands.settle()
    assert hands.scene.camera == before


def drag_on_the_panel_does_not_orbit(hands: Hands) -> None:
    before = hands.scene.camera
    hands.context.item_drag_with_delta(hands.item("##hole.spin"), (-40.0, 0.0))
    hands.settle()
    assert hands.scene.camera == before
    assert hands.scene.hole.spin != 0.9


def drag_stops_at_the_pole(hands: Hands) -> None:
    x, y = hands.to_picture()
    hands.context.mouse_down(0)
    hands.context.mouse_move_to_pos((x, y + 2000))
    hands.context.mouse_up(0)
    hands.settle()
    assert hands.scene.camera.inclination_deg == 0.0


def zoom_by_wheel(hands: Hands) -> None:
    before = hands.scene.camera.distance
    hands.to_picture()
    hands.context.mouse_wheel_y(3.0)
    hands.settle()
    nearer = hands.scene.camera.distance
    assert 1.0 < nearer < before
    hands.context.mouse_wheel_y(-3.0)
    hands.settle()
    assert abs(hands.scene.camera.distance - before) < 1e-3 * before


def arrows_and_reset(hands: Hands) -> None:
    before = hands.scene.camera
    hands.context.key_hold(Key.left_arrow, 0.3)
    hands.context.key_hold(Key.up_arrow, 0.2)
    hands.hold(Key.right_bracket, 0.2, character="+")  # where a German keyboard has it
    hands.settle()
    moved = hands.scene.camera
    assert moved.azimuth_deg < before.azimuth_deg and moved.inclination_deg < before.inclination_deg and moved.distance < before.distance
    hands.press(Key.r)
    hands.settle()
    after = hands.scene.camera
    assert abs(after.azimuth_deg) < 1e-6 and abs(after.inclination_deg - 80.0) < 1e-6 and abs(after.distance - before.distance) < 1e-6


def keys_switch(hands: Hands) -> None:
    state = hands.state
    hands.press(Key.space)
    assert not hands.scene.disk.enabled
    hands.press(Key.space)
    assert hands.scene.disk.enabled
    hands.press(Key.s)
    assert hands.scene.hole.spin == 0.0
    hands.press(Key.s)
    assert hands.scene.hole.spin == 0.9 and hands.scene.rays.model == "auto"
    hands.press(Key.p)
    paused_at = state.time
    hands.context.yield_(5)
    assert state.paused and state.time == paused_at
    hands.press(Key.p)
    hands.context.yield_(5)
    assert state.time > paused_at
    hands.press(Key.o)
    assert not state.show_overlay


def compass_goes_with_the_figures(hands: Hands) -> None:
    """One key for both, and what is not shown is not worked out."""
    asked, of = [], compass.of
    compass.of = lambda scene: asked.append(scene) or of(scene)
    try:
        hands.context.yield_(3)
        assert asked[-1] is hands.scene
        hands.press(Key.o)
        asked.clear()
        hands.context.yield_(5)
        assert not hands.state.show_overlay and not asked
    finally:
        compass.of = of


def help_window(hands: Hands) -> None:
    hands.press(Key.h)
    assert hands.state.show_help
    hands.press(Key.escape)
    assert not hands.state.show_help
    hands.press(Key.f1)
    assert hands.state.show_help
    hands.press(Key.f1)
    assert not hands.state.show_help


def escape_closes_a_picker_then_help_then_full_screen(hands: Hands) -> None:
    state = hands.state
    state.full_screen = state.show_help = True
    hands.context.yield_(4)
    hands.context.scroll_to_top(f"//{PANEL}")
    hands.context.item_click(f"//{PANEL}/pickers/##Look preset")
    hands.context.yield_(2)
    found = []
    for _ in range(3):
        hands.context.key_press(Key.escape)
        hands.context.yield_(2)
        found.append((imgui.internal.find_window_by_name("##Combo_00").active, state.show_help, state.full_screen))
    assert found == [(False, True, True), (False, False, True), (False, False, False)], found
    hands.context.yield_(4)


def tab_hides_the_panel(hands: Hands) -> None:
    narrow = hands.window.view().width
    hands.press(Key.tab)
    hands.context.yield_(3)
    assert hands.window.view().width > narrow + 100, "the picture takes the panel's place"
    hands.press(Key.tab)
    hands.context.yield_(3)
    assert abs(hands.window.view().width - narrow) < 2.0


def typing_triggers_no_shortcut(hands: Hands) -> None:
    scene = hands.scene
    hands.click("##filter")
    hands.context.key_chars("sphor ")
    hands.press(Key.space)
    hands.press(Key.s)
    hands.press(Key.left_arrow)
    hands.settle()
    assert hands.scene == scene and not hands.state.show_help and not hands.state.paused
    hands.press(Key.escape)
    hands.press(Key.space)
    assert not hands.scene.disk.enabled, "after ESC the keys work again, and the window is still there"


def panel_edits_and_resets(hands: Hands) -> None:
    hands.context.item_input_value(hands.item("##hole.gravity_strength"), 2.5)
    assert hands.scene.hole.gravity_strength == 2.5
    hands.context.yield_(2)
    hands.click("##departs hole.gravity_strength")
    assert hands.scene.hole.gravity_strength == 1.0
    hands.context.item_input_value(hands.item("##camera.distance"), 33.25)
    assert hands.scene.camera.distance == 33.25
    hands.settle()
    assert hands.scene.camera.distance == 33.25, "the camera stays where it was typed to"
    hands.double_click(hands.item("Distance##name camera.distance"))
    assert hands.scene.camera.distance == 20.0
    hands.click("far##infinite camera.distance")
    assert hands.scene.camera.distance == float("inf")
    hands.click("far##infinite camera.distance")
    assert hands.scene.camera.distance == 20.0


def double_click_on_a_widget_brings_the_presets_value(hands: Hands) -> None:
    """A number, a choice and a switch, of a preset whose values are not the defaults."""
    preset_switch.pick(hands.state, "physics", "thin_disk")
    in_force = hands.scene
    hands.context.item_input_value(hands.item("##disk.outer_radius"), 7.0)
    hands.double_click(hands.item("##disk.outer_radius"))
    assert hands.scene.disk.outer_radius == 10.0
    hands.choose("##disk.temperature_law", "tapered##tapered", table="values of disk/")
    assert hands.scene.disk.temperature_law == "tapered"
    hands.double_click(f"//{PANEL}/values of disk/##disk.temperature_law")
    assert hands.scene.disk.temperature_law == "shakura_sunyaev" != fields()["disk.temperature_law"].default
    assert not imgui.internal.find_window_by_name("##Combo_00").active, "and the list is closed"
    hands.click("##disk.beaming")
    hands.double_click(hands.item("##disk.beaming"))
    assert hands.scene == in_force
    hands.fill("##filter", "orders")
    hands.fill("##rays.orders", 1)
    hands.double_click(hands.item("##rays.orders"))
    assert hands.scene == in_force


def undo_and_redo_by_keys_and_buttons(hands: Hands) -> None:
    """A drag of a slider is one step, and so is one of the mouse."""
    before = hands.scene
    hands.context.item_drag_with_delta(hands.item("##hole.spin"), (-60.0, 0.0))
    hands.context.yield_(2)
    slid = hands.scene
    x, y = hands.to_picture()
    hands.context.mouse_down(0)
    for step in range(6):
        hands.context.mouse_move_to_pos((x + 20 * step, y))
    hands.context.mouse_up(0)
    hands.settle()
    turned = hands.scene
    assert turned.camera != slid.camera and slid.hole.spin != before.hole.spin
    hands.press(Key.mod_ctrl | Key.z)
    assert hands.scene == slid
    hands.press(Key.mod_ctrl | Key.z)
    assert hands.scene == before
    hands.press(Key.mod_ctrl | Key.y)
    assert hands.scene == slid
    hands.click("Redo")
    assert hands.scene == turned
    hands.click("Undo")
    hands.press(Key.mod_ctrl | Key.mod_shift | Key.z)
    assert hands.scene == turned
    hands.click("Reset all")
    assert hands.scene == hands.state.home
    hands.click("Undo")
    assert hands.scene == turned
    hands.hold(Key.mod_shift | Key.r, 0.0, character="R")
    hands.context.yield_(2)
    assert hands.scene == hands.state.home


def nothing_in_the_panel_moves_when_a_value_changes(hands: Hands) -> None:
    def places() -> dict[str, float]:
        hands.context.scroll_to_top(f"//{PANEL}")
        hands.context.yield_(2)
        items = ("##hole.gravity_strength", "##camera.inclination_deg", "##disk.outer_radius")
        return {item: hands.context.item_info(hands.item(item)).rect_full.min.y for item in items}

    before = places()
    for changed in ({"hole.gravity_strength": 2.5}, {"rays.lensing": False, "disk.beaming": False, "disk.redshift": False}, {"hole.spin": 0.0}):
        hands.state.change(changed)
        assert places() == before, changed


def a_picker_without_a_preset_says_so(hands: Hands) -> None:
    shown, begin = {}, imgui.begin_combo
    imgui.begin_combo = lambda label, preview, *rest: shown.update({label: preview}) or begin(label, preview, *rest)
    try:
        hands.context.yield_(2)
        assert shown["##Physics preset"] == "Kerr, a* = 0.9" and shown["##Scene preset"] == "none"
        assert shown["##Look preset"] == "the scene's own", "the preset kerr says nothing of it"
        preset_switch.pick(hands.state, "look", "smooth")
        hands.context.yield_(2)
        assert shown["##Look preset"] == "Smooth"
    finally:
        imgui.begin_combo = begin


def what_is_saved_appears_in_the_picker(hands: Hands) -> None:
    hands.fill("##file", "mine")
    hands.press(Key.mod_ctrl | Key.s)
    assert hands.state.chosen["user"] == "mine"
    hands.choose("##Scene preset", "Luminet 1979##luminet_1979")
    hands.choose("##Scene preset", "mine##mine")
    assert hands.scene.hole.spin == 0.9


def distance_in_the_panel_ends_above_the_horizon(hands: Hands) -> None:
    hands.fill("##camera.distance", 0.6)
    horizon = space_time(hands.scene).horizon_radius
    assert horizon < hands.scene.camera.distance < horizon + 1e-3
    hands.fill("##hole.spin", 0.0)
    hands.fill("##camera.distance", 0.6)
    assert 1.0 < hands.scene.camera.distance < 1.001, "of another hole it is another"


def presets_switched(hands: Hands) -> None:
    hands.context.item_input_value(hands.item("##camera.inclination_deg"), 60.0)
    hands.choose("##Look preset", "Particle Storm##particle_storm")
    assert hands.state.chosen["look"] == "particle_storm"
    assert hands.scene.disk.noise_scale == 1.10
    assert hands.scene.camera.inclination_deg == 60.0, "a look leaves the camera alone"
    hands.choose("##Physics preset", "Schwarzschild##schwarzschild")
    assert hands.scene.hole.spin == 0.0 and hands.scene.camera.inclination_deg == 80.0
    assert hands.scene.disk.noise_scale == 1.10, "physics leaves the look alone"


def save_and_load(hands: Hands) -> None:
    path = hands.folder / "mine.toml"
    hands.context.item_input_value(hands.item("##file"), str(path))
    hands.context.item_input_value(hands.item("##disk.outer_radius"), 7.5)
    hands.click("Save")
    saved = hands.scene
    assert presets.load([path]) == saved
    hands.context.item_input_value(hands.item("##disk.outer_radius"), 9.0)
    hands.click("Save")
    assert presets.load([path]) == saved, "the first click on Save only asks"
    hands.click("Load")
    assert hands.scene == saved
    path.write_text("[disk]\nouter_radius = 900\n")
    hands.click("Load")
    assert hands.state.notice.is_error and "outer_radius" in hands.state.notice.text
    assert hands.scene == saved


def copy_and_paste(hands: Hands) -> None:
    hands.click("Copy as TOML")
    text = imgui.get_clipboard_text()
    copied = hands.scene
    hands.press(Key.s)
    assert hands.scene != copied
    imgui.set_clipboard_text(text)
    hands.click("Paste TOML")
    assert hands.scene == copied
    imgui.set_clipboard_text("no preset = = at all")
    hands.click("Paste TOML")
    assert hands.state.notice.is_error and hands.scene == copied


def picture_saved(hands: Hands) -> None:
    assert presets.from_png(save_picture(hands)) == hands.scene


def renderer_failure_is_shown(hands: Hands) -> None:
    hands.press(Key.p)
    hands.window.picture.renderer.fail = RuntimeError("trace.frag, line 7: no such thing")
    hands.press(Key.s)
    hands.context.yield_(3)
    assert "trace.frag, line 7" in hands.state.render_error
    hands.window.picture.renderer.fail = None
    hands.press(Key.s)
    hands.context.yield_(3)
    assert hands.state.render_error is None


def no_picture_of_what_failed(hands: Hands) -> None:
    before = len(list((hands.folder.parent / PICTURES).glob("*.png")))
    hands.press(Key.p)
    hands.window.picture.renderer.fail = RuntimeError("out of order")
    hands.press(Key.s)
    hands.press(Key.f12)
    hands.context.yield_(4)
    assert not hands.state.picture_wanted
    assert len(list((hands.folder.parent / PICTURES).glob("*.png"))) == before, "the picture kept is not of this scene"
    hands.window.picture.renderer.fail = None


def nothing_is_drawn_while_minimised(hands: Hands) -> None:
    window = glfw_window_hello_imgui()
    calls = hands.window.picture.renderer.calls
    hands.context.yield_(5)
    glfw.iconify_window(window)
    hands.context.yield_(3)
    drawn = len(calls)
    hands.context.yield_(10)
    assert len(calls) == drawn
    glfw.restore_window(window)
    hands.context.yield_(10)
    assert len(calls) > drawn


def full_screen_and_back(hands: Hands) -> None:
    before = hands.window.view()
    hands.press(Key.f11)
    hands.context.yield_(4)
    assert hands.window.view().height > before.height
    hands.press(Key.f11)
    hands.context.yield_(4)
    assert hands.window.view() == before


def still_picture_is_kept(hands: Hands) -> None:
    hands.press(Key.p)
    hands.settle()
    hands.context.yield_(5)
    drawn = len(hands.window.picture.renderer.calls)
    hands.context.yield_(20)
    assert len(hands.window.picture.renderer.calls) == drawn
    assert not hands.state.is_moving


def dear_pictures_are_coarser_while_they_move(hands: Hands) -> None:
    """A renderer that would take 0.2 s for a whole picture: coarser under the hand, whole at rest, and whole always without a target."""
    area = hands.window.view().area
    renderer, picture = hands.window.picture.renderer, hands.window.picture
    hands.press(Key.p)
    renderer.us_per_pixel = 2e5 / (area.width * area.height)
    hands.context.key_down(Key.left_arrow)
    wait(hands, lambda: picture.scale < 0.6, 10.0)  # some frames: costs are the median of a few, and the last are of another scenario
    assert renderer.calls[-1][2][0] < 0.6 * area.width, picture.scale
    hands.context.key_up(Key.left_arrow)
    hands.settle()
    hands.context.yield_(2)
    assert picture.scale == 1.0 and renderer.calls[-1][2] == (area.width, area.height)
    hands.state.change({"playback.target_fps": 0.0})
    hands.context.key_hold(Key.left_arrow, 0.2)
    assert picture.scale == 1.0 and renderer.calls[-1][2] == (area.width, area.height)
    renderer.us_per_pixel = 0.0
    hands.settle()


def real_picture(hands: Hands) -> None:
    hands.press(Key.p)
    hands.state.change({"post.bloom": False})  # whose light reaches into a small shadow
    hands.settle()
    with_disk = np.asarray(Image.open(save_picture(hands)))
    assert hands.state.render_error is None
    assert with_disk.max() > 200, "there is light"
    centre = with_disk[with_disk.shape[0] // 2 - 5 :, with_disk.shape[1] // 2]
    assert centre.min() == 0, "and there is the shadow"
    wait(hands, lambda: hands.window.picture.rays is not None)
    assert hands.window.picture.rays.unresolved == 0 and hands.window.picture.rays.steps > 1
    hands.press(Key.space)
    without_disk = np.asarray(Image.open(save_picture(hands)))
    assert without_disk.mean() < 0.5 * with_disk.mean()


def values_under_the_mouse(hands: Hands) -> None:
    """I tells the values of the pixel that the mouse is over, asked for once while neither moves; none over the panel, or while the camera moves."""
    places = hands.window.picture.renderer.places

    def is_shown() -> bool:
        found = imgui.internal.find_window_by_name("##values")
        return bool(found is not None and found.active)

    places.clear()
    x, y = hands.to_picture()
    hands.context.yield_(3)
    assert not places and not is_shown()
    hands.press(Key.p)  # a clock that stands still
    hands.press(Key.i)
    hands.to_picture()
    hands.context.yield_(8)
    view = hands.window.view()
    assert is_shown() and len(places) == 1, places
    mouse = imgui.get_io().mouse_pos
    assert abs(places[0][0] - (mouse.x - view.left) / view.width) < 1e-6
    assert abs(places[0][1] - (1.0 - (mouse.y - view.top) / view.height)) < 1e-6
    drawn, draw = [], mouse_values._draw
    mouse_values._draw = lambda told, mouse, *given: drawn.append((mouse, places[-1])) or draw(told, mouse, *given)
    hands.context.mouse_move_to_pos((x + 30, y + 10))
    hands.context.yield_(4)
    mouse_values._draw = draw
    assert places[-1][0] > places[0][0] and places[-1][1] < places[0][1]
    assert drawn and all(abs(view.left + view.width * place[0] - mouse[0]) < 1e-3 for mouse, place in drawn), drawn
    hands.context.mouse_move(hands.item("##hole.spin"))
    hands.context.yield_(4)
    assert not is_shown()
    hands.to_picture()
    hands.press(Key.i)
    hands.context.yield_(4)
    assert not is_shown() and not hands.state.show_values


def ticks_of_polarization(hands: Hands) -> None:
    """They lie over the picture and over no view, are those of the scene that is shown, and are worked out once while it rests."""
    asked, ticks = [], polarized_disk.ticks
    polarized_disk.ticks = lambda scene, aspect, moving: asked.append((scene, ticks(scene, aspect, moving=moving))) or asked[-1][1]
    try:
        hands.context.yield_(3)
        assert not asked
        hands.state.change({"polarization.ticks": True, "polarization.field_toroidal": 1.0})
        hands.context.yield_(4)
        assert asked[-1][0] is hands.scene and asked[-1][1].curves and asked[-1][1] is asked[-2][1]
        hands.state.change({"post.view": "steps"})
        hands.context.yield_(2)
        asked.clear()
        hands.context.yield_(3)
        assert not asked
    finally:
        polarized_disk.ticks = ticks


def labels_by_key(hands: Hands) -> None:
    """L names what the picture shows; while the camera moves the labels are those of where it is, and nothing is worked out where it turns about the axis."""
    asked, after = [], labels.after
    labels.after = lambda before, scene, aspect: asked.append(scene) or after(before, scene, aspect)
    try:
        hands.context.yield_(3)
        assert not asked
        hands.press(Key.l)
        hands.context.yield_(3)
        assert hands.scene.post.labels and asked[-1] is hands.scene
        x, y = hands.to_picture()
        hands.context.mouse_down(0)
        hands.context.mouse_move_to_pos((x + 60, y))
        asked.clear()
        hands.context.yield_(3)
        assert hands.state.camera_moves and not asked
        hands.context.mouse_move_to_pos((x + 60, y + 40))
        hands.context.yield_(3)
        assert hands.state.camera_moves and asked and labels.shape_of(asked[-1]) == labels.shape_of(hands.scene)
        hands.context.mouse_up(0)
        hands.settle()
        hands.context.yield_(3)
        assert labels.shape_of(asked[-1]) == labels.shape_of(hands.scene)
        hands.press(Key.l)
        asked.clear()
        hands.context.yield_(3)
        assert not asked and not hands.scene.post.labels
    finally:
        labels.after = after


def labels_stand_beside_the_figures(hands: Hands) -> None:
    """No words lie under the figures, under the compass, or on other words, in a window that is small for them."""
    drawn, corners = [], []
    figures, directions = overlay.figures, overlay.directions
    overlay.figures = lambda *given: drawn.append(figures(*given)) or drawn[-1]
    overlay.directions = lambda *given: drawn.append(directions(*given)) or drawn[-1]
    try:
        hands.state.change({"post.labels": True, "camera.distance": 12.0})
        for inclination in (20.0, 60.0, 85.0):
            hands.state.change({"camera.inclination_deg": inclination})
            hands.settle()
            drawn.clear()
            hands.context.yield_(2)
            corners = [*drawn[-2:], *hands.window._over.labels.words]
            assert len(corners) > 6 and None not in corners, corners
            for one, other in itertools.combinations(corners, 2):
                assert one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1], (inclination, one, other)
    finally:
        overlay.figures, overlay.directions = figures, directions


def scale_bar_of_a_real_object(hands: Hands) -> None:
    """It comes with the labels, as long as the shown picture says, and where the scene stands for no real object there is none."""
    shown, of = [], scale_bar.of
    scale_bar.of = lambda scene, aspect: shown.append((aspect, of(scene, aspect))) or shown[-1][1]
    try:
        hands.state.change({"source.real": True})
        hands.context.yield_(3)
        assert not shown
        hands.state.change({"post.labels": True})
        hands.context.yield_(3)
        view = hands.window.view()
        assert abs(shown[-1][0] - view.width / view.height) < 1e-6 and shown[-1][1].names
        hands.state.change({"source.real": False})
        hands.context.yield_(3)
        assert not shown[-1][1].names
    finally:
        scale_bar.of = of


def save_picture(hands: Hands) -> Path:
    """The picture as F12 saves it; GL itself cannot be asked here, for scenarios run in a thread of their own."""
    folder = hands.folder.parent / PICTURES
    before = set(folder.glob("*.png"))
    hands.press(Key.f12)
    wait(hands, lambda: not hands.state.picture_wanted, seconds=60.0)  # its programs may have to be compiled
    (path,) = set(folder.glob("*.png")) - before
    return path


def way_out_of_a_black_picture(hands: Hands) -> None:
    """What nobody can see anything in names the key that brings it back, and that key does."""
    wait(hands, lambda: hands.window.picture.is_current, seconds=60.0)
    assert not hands.state.way_out
    hands.state.change({"post.exposure": -8.0})
    wait(hands, lambda: bool(hands.state.way_out), seconds=20.0)
    hands.context.yield_(2)
    assert "SHIFT+R" in hands.state.way_out and imgui.internal.find_window_by_name("Way out##message").active
    hands.hold(Key.mod_shift | Key.r, 0.0, character="R")
    wait(hands, lambda: not hands.state.way_out, seconds=20.0)
    assert hands.scene.post.exposure == 0.0
    hands.state.change({"camera.yaw_deg": 120.0})
    wait(hands, lambda: "out of sight" in hands.state.way_out, seconds=20.0)
    hands.press(Key.r)
    wait(hands, lambda: not hands.state.way_out, seconds=20.0)


def diagnostic_views(hands: Hands) -> None:
    """V goes through the views, each with its scale over the picture, and back to the picture."""
    shown = []
    for _ in range(len(fields()["post.view"].options)):
        hands.press(Key.v)
        shown.append(hands.scene.post.view)
        scale = imgui.internal.find_window_by_name("##view scale")
        assert (scale is not None and scale.active) == (shown[-1] != "picture")
        assert shown[-1] == "picture" or not hands.state.is_playing, "nothing in a view changes with time"
    assert tuple(shown) == (*fields()["post.view"].options[1:], "picture")


def shader_edited(hands: Hands) -> None:
    hands.context.yield_(3)
    file = hands.folder.parent / "shaders" / "trace.frag"
    text = file.read_text(encoding="utf-8")
    file.write_text(text + "\nfloat broken = ;\n", encoding="utf-8")
    wait(hands, lambda: hands.state.shader_error is not None)
    assert f"trace.frag:{text.count(chr(10)) + 2}" in hands.state.shader_error, hands.state.shader_error
    assert hands.state.render_error is None, "the last good program goes on"
    file.write_text(text, encoding="utf-8")
    wait(hands, lambda: hands.state.shader_error is None)


def live_chart(hands: Hands) -> None:
    """C opens the chart, which fills by itself while time runs and leaves the picture's own hit map alone; a point's method can be taken."""
    assert hands.state.is_playing, "time runs, and the chart fills all the same"
    hands.state.change({"playback.target_fps": 0.0})  # a picture that has to keep up may change its size, and trace again
    hands.settle()
    wait(hands, lambda: hands.window.picture.is_current and hands.window.picture.is_sharp, seconds=60.0)
    hands.press(Key.c)
    chart, traces = hands.window.live_chart, hands.window.picture.renderer.hit_map.traces
    assert hands.state.show_chart and chart.busy(hands.state)
    wait(hands, lambda: len(chart.points) >= 3, seconds=50.0)
    assert hands.window.picture.renderer.hit_map.traces == traces
    assert not hands.state.render_error and not hands.state.shader_error
    best = min(chart.points, key=lambda point: point.pixels)
    worst = max(chart.points, key=lambda point: point.pixels)
    assert best.method.model == "kerr" and best.pixels < 5.0 < worst.pixels
    use(best, hands.state)
    hands.context.yield_(2)
    assert [is_used(point, hands.scene, planning.plan(hands.scene)) for point in (best, worst)] == [True, False]
    wait(hands, lambda: hands.window.picture.is_current, seconds=60.0)
    assert hands.window.picture.report.method.startswith(best.method.model)
    assert best in chart.points, "another method is no other view"
    hands.state.change({"hole.gravity_strength": 2.0})
    wait(hands, lambda: not chart.points)
    hands.press(Key.c)
    assert not hands.state.show_chart and not chart.busy(hands.state)


def line_plot(hands: Hands) -> None:
    """B opens the plot, which fills while time runs and leaves the picture's own hit map alone; another view or power is plotted anew."""
    hands.state.change({"playback.target_fps": 0.0, "disk.compositing": "additive"})
    hands.settle()
    wait(hands, lambda: hands.window.picture.is_current and hands.window.picture.is_sharp, seconds=60.0)
    hands.press(Key.b)
    plot, traces = hands.window.line_plot, hands.window.picture.renderer.hit_map.traces
    wait(hands, lambda: plot.profile is not None and not plot.busy(hands.state), seconds=60.0)
    assert hands.window.picture.renderer.hit_map.traces == traces
    first = plot.profile
    assert abs(first.flux.sum() - 1.0) < 1e-12 and first.shares[0] > first.shares[1] > first.shares[2] > 0.0
    hands.context.item_input_value("//Line profile/power of the line falls as r to the −q##index", 0.0)
    wait(hands, lambda: plot.profile is not first and not plot.busy(hands.state), seconds=60.0)
    assert plot.profile.shares[1] < first.shares[1], "the outer disk's rings are fainter than the inner one's"
    hands.press(Key.space)
    wait(hands, lambda: plot.profile is None, seconds=20.0)
    hands.press(Key.b)
    assert not hands.state.show_line and not plot.busy(hands.state) and not hands.state.render_error


def light_plot(hands: Hands) -> None:
    """K opens the plot, which fills while time runs and leaves the picture's own hit map alone; with delays it is another."""
    hands.state.change({"playback.target_fps": 0.0, "disk.hot_spot": True, "sky.enabled": False})
    hands.settle()
    wait(hands, lambda: hands.window.picture.is_current and hands.window.picture.is_sharp, seconds=60.0)
    hands.press(Key.k)
    plot, traces = hands.window.light_plot, hands.window.picture.renderer.hit_map.traces
    wait(hands, lambda: plot.curve is not None and not plot.busy(hands.state), seconds=60.0)
    assert hands.window.picture.renderer.hit_map.traces == traces
    at_once = plot.curve.relative
    hands.state.change({"rays.light_travel": True})
    wait(hands, lambda: not plot.busy(hands.state), seconds=60.0)
    assert abs(plot.curve.relative - at_once).max() > 0.02
    hands.press(Key.k)
    assert not hands.state.show_light and not plot.busy(hands.state) and not hands.state.render_error


def path_view(hands: Hands) -> None:
    """G opens the view. A click on the picture shows the ray of its pixel, a drag only orbits; the same ray by another method comes beside it."""
    paths = hands.window.path_view.paths
    hands.press(Key.p)
    hands.state.change({"rays.model": "schwarzschild", "rays.integrator": "euler", "rays.step_control": "fixed", "rays.step_length": 2.0, "hole.spin": 0.0})
    hands.state.change({"camera.distance": 5.0})
    hands.settle()
    wait(hands, lambda: hands.window.picture.is_current and hands.window.picture.is_sharp, seconds=60.0)
    hands.press(Key.g)
    traces = hands.window.picture.renderer.hit_map.traces
    view = hands.window.view()
    place = view.left + 0.5 * view.width, view.top + 0.4 * view.height
    hands.context.mouse_move_to_pos(place)
    hands.context.mouse_click(0)
    wait(hands, lambda: len(paths.shown) == 1, seconds=20.0)
    assert paths.failure is None and paths.shown[0].path.tunnels == (3,)
    x, y = paths.shown[0].asked.pixel
    assert abs(x - 0.5 * view.area.width) <= 1.0 and abs(y - 0.6 * view.area.height) <= 1.0
    assert hands.window.picture.renderer.hit_map.traces == traces, "the picture keeps its hits"
    hands.context.item_click("//Paths of light/**/Again by the most accurate method")
    wait(hands, lambda: len(paths.shown) == 2, seconds=20.0)
    assert [item.path.fate.name for item in paths.shown] == ["ESCAPED", "CAPTURED"], "the coarse one comes through the hole"
    hands.context.mouse_move_to_pos(place)
    hands.context.mouse_down(0)
    hands.context.mouse_move_to_pos((place[0] + 30.0, place[1]))
    hands.context.mouse_up(0)
    hands.settle()
    assert len(paths.shown) == 2 and not paths.busy and hands.scene.camera.azimuth_deg != 0.0
    hands.context.item_click("//Paths of light/##dots")
    hands.context.item_click("//##Combo_00/$$1/dots: drift of what is conserved")
    hands.context.yield_(3)
    assert hands.window.path_view.coloured_by == 1 and not hands.state.render_error
    hands.context.item_click("//Paths of light/**/x##remove 0")
    hands.context.yield_(2)
    assert [item.path.fate.name for item in paths.shown] == ["CAPTURED"]
    hands.press(Key.g)
    hands.context.mouse_move_to_pos(place)
    hands.context.mouse_click(0)
    hands.context.yield_(4)
    assert not hands.state.show_paths and len(paths.shown) == 1 and not hands.state.render_error


def flight_in_the_window(hands: Hands) -> None:
    """T opens it. Two keys are taken from the view, and it is played: the camera goes from one to the other, as one step that can be undone."""
    hands.press(Key.t)
    hands.context.item_click("//Flight/Take a key###flight key")
    hands.state.change({"camera.distance": 9.0})
    hands.state.timeline = replace(hands.state.timeline, seconds=0.4)
    hands.context.item_click("//Flight/Take a key###flight key")
    hands.context.item_click("//Flight/Play###flight play")
    wait(hands, lambda: hands.state.timeline.seconds > 0.1 and not hands.state.timeline.plays, seconds=20.0)
    assert hands.scene.camera.distance == 9.0 and len(hands.state.timeline.flight.keys) == 2
    hands.context.item_click("//Flight/Save###flight save")
    assert hands.state.notice.text.startswith("Saved: ")
    hands.press(Key.t)
    assert not hands.state.show_timeline


def side_by_side(hands: Hands) -> None:
    """D divides the picture. Both sides follow the camera, each keeps its hits, and the divider is dragged without tracing anything."""
    hands.press(Key.p)
    hands.state.change({"rays.model": "schwarzschild", "rays.integrator": "euler", "rays.step_control": "radius", "rays.step_length": 0.5})
    hands.press(Key.d)
    divided = hands.window.side_by_side
    wait(hands, lambda: hands.window.picture.is_final and not divided.busy(hands.state), seconds=100.0)
    assert divided.failure is None
    left, right = divided.figures
    assert right.error_px == 0.0 and left.error_px > 5.0 and 1.0 < left.cost and 1.0 < right.cost, (left, right)
    maps = [picture.renderer.hit_map for picture in (hands.window.picture, divided.picture)]
    traces, camera = [kept.traces for kept in maps], hands.scene.camera
    hands.context.item_drag_with_delta("//##divider/handle", (-100.0, 0.0))
    hands.context.yield_(3)
    assert abs(divided.sides.share - (0.5 - 100.0 / hands.window.view().width)) < 0.01
    assert hands.scene.camera == camera and [kept.traces for kept in maps] == traces, "the divider moves, and nothing else"
    both = _pixels(save_picture(hands))
    stills = _pixels(_still(hands, "both.png"))
    for whole, picture in ((both, _alone(hands, save_picture)), (stills, _alone(hands, lambda hands: _still(hands, "left.png")))):
        middle = round(divided.sides.share * whole.shape[1])
        assert np.array_equal(whole[:, : middle - 1], picture[:, : middle - 1]) and len(np.unique(whole[:, middle - 1 : middle + 1])) == 3, "a grey line"
        assert np.abs(whole[:, middle + 1 :].astype(int) - picture[:, middle + 1 :]).max() > 50, "what the other side shows"
    hands.context.key_hold(Key.left_arrow, 0.3)
    hands.settle()
    wait(hands, lambda: hands.window.picture.is_sharp and divided.picture.is_sharp, seconds=60.0)
    assert hands.scene.camera.azimuth_deg != camera.azimuth_deg
    assert divided.sides.other(hands.scene).camera == hands.scene.camera
    hands.context.item_click("//Side by side/Keep this picture there")
    hands.state.change({"hole.spin": 0.2, "rays.model": "auto", "rays.integrator": "auto"})
    assert divided.sides.other(hands.scene).hole.spin == 0.9
    hands.context.item_click("//Side by side/Swap")
    hands.context.yield_(2)
    assert hands.scene.hole.spin == 0.9 and divided.sides.other(hands.scene).hole.spin == 0.2
    hands.context.item_click("//Side by side/##other side")
    hands.context.item_click("//##Combo_00/Schwarzschild##schwarzschild")
    wait(hands, lambda: hands.window.picture.is_current and divided.picture.is_current and divided.failure is None, seconds=60.0)
    assert divided.sides.other(hands.scene).hole.spin == 0.0 and divided.sides.other(hands.scene).camera == hands.scene.camera
    hands.press(Key.d)
    assert not hands.state.show_sides and not divided.busy(hands.state) and not hands.state.render_error


def _alone(hands: Hands, save) -> np.ndarray:
    """The picture that `save` saves with the divider put away."""
    hands.press(Key.d)
    found = _pixels(save(hands))
    hands.press(Key.d)
    return found


def _pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path).convert("RGB"))


def _still(hands: Hands, name: str) -> Path:
    """A small picture by the picture window."""
    path, window = hands.folder / name, hands.window.picture_window
    hands.state.show_picture_window = True
    hands.context.yield_(2)
    for item, value in (("##width", 90), ("##height", 60), ("##rays", 1), ("##path", str(path))):
        hands.context.item_input_value(f"//Picture/{item}", value)
    hands.context.item_click("//Picture/Save")
    wait(hands, lambda: not window.busy and path.exists(), seconds=60.0)
    hands.press(Key.escape)
    return path


def sides_hide_nothing(hands: Hands) -> None:
    """The colour scale has a place of its own, and the window that chooses is whole where large letters leave it little room."""
    hands.press(Key.v)
    hands.press(Key.d)

    def shown() -> list:
        found = [imgui.internal.find_window_by_name(name) for name in ("##view scale", "##side 1")]
        return found if all(window is not None and window.active for window in found) else []

    wait(hands, lambda: bool(shown()), seconds=20.0)  # the scale comes with the picture that it is of, whose programs have to be made
    hands.context.yield_(4)
    scale, side = shown()
    assert side.pos.y + side.size.y <= scale.pos.y
    hands.press(Key.d)
    was, hands.window.kept = hands.window.kept, replace(hands.window.kept, text_size=1.3)
    hands.context.yield_(4)
    hands.press(Key.d)
    hands.context.yield_(4)
    choices = imgui.internal.find_window_by_name("Side by side")
    assert choices.pos.x >= hands.window.view().left
    hands.window.kept = was
    hands.press(Key.d)


def preset_switches_never_freeze(hands: Hands) -> None:
    """Another look and things that move, with nothing compiled before: no frame is long, and the old picture stays until the new one is there."""
    _switches_never_freeze(hands, ("gargantua_s1", "orbiting_star"))


def all_preset_switches_never_freeze(hands: Hands) -> None:
    """Every shipped preset in turn."""
    _switches_never_freeze(hands, [info.name for info in presets.available()])


def _switches_never_freeze(hands: Hands, chosen: Sequence[str]) -> None:
    picture, frames = hands.window.picture, Frames(hands.window)
    wait(hands, lambda: picture.is_current, seconds=60.0)
    waited, longest = 0, (0.0, "")
    for info in sorted((info for info in presets.available() if info.name in chosen), key=lambda info: chosen.index(info.name)):
        before = picture.report
        frames.restart()
        preset_switch.pick(hands.state, info.group, info.name)
        hands.context.yield_()
        while picture.preparation.since is not None:
            waited += 1
            time.sleep(0.02)  # leaves the processor to the one that compiles; it is not counted
            hands.context.yield_()
        wait(hands, lambda: picture.is_current, seconds=60.0)
        hands.context.yield_(2)
        assert hands.state.render_error is None and picture.report is not before
        longest = max(longest, (frames.longest, info.name))
        assert frames.longest <= LONGEST_FRAME_S, f"{info.name}: {frames.longest:.2f} s"
    print(f"longest frame of a switch: {longest[0]:.2f} s, to {longest[1]}")
    assert waited > 0, "nothing had to be compiled: the driver's cache was not empty"
    frames.leave()


def instances_are_made_edited_and_removed(hands: Hands) -> None:
    """Things in the panel, of the kinds in tests/unit/kinds.py: every kind of value, a new name, another kind, and gone."""
    hands.choose("##kind of new things", "Globe##globe", table="")
    hands.fill("##name of new things", "moon")
    hands.click("Add##things")
    assert hands.scene.things["moon"].kind == "globe"
    hands.fill("##things.moon.radius", 2.5)
    hands.fill("##things.moon.number", 4)
    hands.click("##things.moon.glows")
    hands.choose("##things.moon.pattern", "chequered##chequered", table="values of things.moon/")
    hands.fill("##things.moon.caption", "The moon")
    hands.fill("##things.moon.image", "moon.gif")
    assert hands.state.notice.is_error and "things.moon.image: got 'moon.gif'" in hands.state.notice.text
    hands.fill("##things.moon.image", "moon.png")
    values = hands.scene.things["moon"].values
    assert {name: values[name] for name in ("radius", "number", "glows", "pattern", "caption", "image")} == {
        "radius": 2.5, "number": 4, "glows": True, "pattern": "chequered", "caption": "The moon", "image": "moon.png",
    }  # fmt: skip
    hands.fill("##things.moon.radii[1]", 4.0)
    hands.click("+##things.moon.radii")
    hands.click("-##things.moon.radii[0]")
    assert hands.scene.get("things.moon.radii") == (4.0, 4.0)
    hands.click("+##things.moon.path")
    hands.click("+##things.moon.path")
    hands.fill("##things.moon.path[1].time", 7.0)
    hands.choose("##things.moon.path[1].ease", "linear##linear", table="values of things.moon/")
    assert [(entry["time"], entry["ease"]) for entry in hands.scene.get("things.moon.path")] == [(0.0, "smooth"), (7.0, "linear")]
    saved = hands.scene
    hands.click("Copy as TOML")
    hands.fill("##name of things.moon", "luna")
    assert list(hands.scene.things) == ["luna"] and hands.scene.get("things.luna.radius") == 2.5
    hands.choose("##things.luna.kind", "Cube##cube", table="values of things.luna/")
    assert dict(hands.scene.things["luna"].values) == {"edge": 2.0, "radius": 0.5, "glows": True}
    hands.click("Add##things")  # the kind picked last
    assert list(hands.scene.things) == ["luna", "globe"], "a name that is free is given where none is typed"
    hands.fill("##name of things.globe", "luna")
    assert hands.state.notice.is_error and "things.luna: there is one already" in hands.state.notice.text
    hands.click("Remove##things.luna")
    assert list(hands.scene.things) == ["globe"]
    hands.click("Paste TOML")
    assert hands.scene.get("things.moon.image") == "" and "left out: the file moon.png" in hands.state.notice.text
    hands.click("Paste TOML")
    assert hands.scene == saved, "pasted again, it may name files anywhere"
    hands.choose("##kind of new media", "Cloud##cloud", table="")
    hands.click("Add##media")
    assert hands.scene.media["cloud"].kind == "cloud"


def a_colour_is_edited_in_one_row(hands: Hands) -> None:
    """Three shares of light as numbers, without buttons that would make the list longer or shorter."""
    hands.choose("##kind of new things", "Sphere##sphere", table="")
    hands.fill("##name of new things", "ball")
    hands.click("Add##things")
    hands.fill("##things.ball.colour/##X", 0.25)
    assert hands.scene.get("things.ball.colour") == (0.25, 0.8, 0.7)
    hands.fill("##things.ball.colour/##Z", 3.0)
    assert hands.scene.get("things.ball.colour") == (0.25, 0.8, 1.0), "kept within its range"
    hands.click("Remove##things.ball")


def a_mistake_in_a_users_header_is_shown(hands: Hands) -> None:
    """tests/app/test_window.py puts it there; the window opened all the same."""
    assert "wrong.glsl: got the entry 'colour'" in hands.state.shader_error and "started again" in hands.state.shader_error
    hands.context.yield_(40)
    assert hands.state.shader_error and hands.state.render_error is None


WITH_KINDS = (instances_are_made_edited_and_removed, a_colour_is_edited_in_one_row, a_mistake_in_a_users_header_is_shown)
WITH_THE_REAL_RENDERER = (
    real_picture, way_out_of_a_black_picture, shader_edited, live_chart, line_plot, light_plot, path_view, side_by_side, sides_hide_nothing,
    preset_switches_never_freeze, all_preset_switches_never_freeze,
)  # fmt: skip
