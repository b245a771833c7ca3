"""A newcomer's way in: the bar, the line at start, the search, what the window keeps. See ``scenarios.py``."""

from __future__ import annotations

import os
import tempfile
import time

from imgui_bundle import imgui

# isort: split
import glfw
import numpy as np
from hands import Hands, wait
from PIL import Image
from scenarios import save_picture

from blackhole_gl.app import file_dialog, kept
from blackhole_gl.app.runner import PANEL
from blackhole_gl.scene import presets

Key = imgui.Key
BAR = "//##Top_2123243"  # as the runner names it


def press_bar(hands: Hands, action: str) -> None:
    hands.context.item_click(f"{BAR}/###bar {action}")
    hands.context.yield_(2)


def bar_does_what_keys_do(hands: Hands) -> None:
    press_bar(hands, "pause")
    assert hands.state.paused
    press_bar(hands, "pause")
    assert not hands.state.paused
    press_bar(hands, "help")
    assert hands.state.show_help
    press_bar(hands, "help")
    press_bar(hands, "search")
    assert hands.state.show_search
    hands.press(Key.escape)
    press_bar(hands, "picture_window")
    assert hands.state.show_picture_window
    hands.press(Key.escape)
    assert not hands.state.show_picture_window


def bar_goes_with_the_panel(hands: Hands) -> None:
    top = hands.window.view().top
    assert top > 0.0
    hands.press(Key.tab)
    hands.context.yield_(3)
    assert hands.window.view().top == 0.0
    hands.press(Key.tab)
    hands.context.yield_(3)
    assert hands.window.view().top == top


def time_is_shown_and_set(hands: Hands) -> None:
    hands.press(Key.p)
    hands.context.item_input_value(f"{BAR}/##time", 12.5)
    hands.context.yield_(2)
    assert hands.state.time == 12.5
    hands.context.item_drag_with_delta(f"{BAR}/##time", (40.0, 0.0))
    hands.context.yield_(2)
    assert hands.state.time > 13.0
    hands.press(Key.s)
    hands.context.yield_(3)
    assert hands.window.picture.renderer.calls[-1][1] == hands.state.time, "the picture is of that time"


def line_at_start_is_in_no_picture(hands: Hands) -> None:
    line = hands.window._over.start_line
    line.begin(hands.scene)
    hands.context.yield_(2)
    assert line.advance(hands.scene, imgui.get_time()) == 1.0, "it is over the picture now"
    pixels = np.asarray(Image.open(save_picture(hands)))
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) == 1, "the pretended renderer fills the picture with one colour"
    hands.hold(Key.left_arrow, 0.3)
    hands.settle()
    assert line.advance(hands.scene, imgui.get_time() + 1.0) == 0.0


def search_opens_a_group_and_marks_the_row(hands: Hands) -> None:
    hands.fill("##filter", "spin")
    hands.context.key_press(imgui.Key.mod_ctrl | Key.p)
    hands.context.yield_(3)
    assert hands.state.show_search
    hands.context.key_chars("exposure")
    hands.context.yield_(2)
    hands.context.key_press(Key.enter)
    hands.context.yield_(4)
    assert not hands.state.show_search and hands.state.sought.key == "post.exposure"
    row = hands.context.item_info(f"//{PANEL}/values of post/##post.exposure")
    panel = imgui.internal.find_window_by_name(PANEL)
    assert panel.inner_clip_rect.min.y <= row.rect_full.min.y and row.rect_full.max.y <= panel.inner_clip_rect.max.y, "the panel has scrolled to it"
    assert hands.state.sought.until is not None, "and marked it"


def a_notice_lies_above_windows_that_were_opened(hands: Hands) -> None:
    hands.press(Key.h)
    hands.state.say("Something happened.")
    hands.context.yield_(3)
    hands.context.window_focus("//Help")
    hands.context.yield_(2)
    notice, helping = (imgui.internal.find_window_by_name(name) for name in ("Notice##message", "Help"))
    assert notice.active and helping.active
    assert imgui.internal.find_window_display_index(notice) > imgui.internal.find_window_display_index(helping)


def what_glfw_complains_of_is_not_on_the_terminal(hands: Hands) -> None:
    """As of a clipboard that is empty; here of a key that there is not."""
    kept = os.dup(2)
    with tempfile.TemporaryFile() as said:
        os.dup2(said.fileno(), 2)
        try:
            glfw.get_key_scancode(-5)
        finally:
            os.dup2(kept, 2)
            os.close(kept)
        said.seek(0)
        assert said.read() == b""


def keys_struck_while_the_search_opens_are_no_commands(hands: Hands) -> None:
    spin, search = hands.scene.hole.spin, hands.window._search
    draw, search.draw = search.draw, lambda *_: None  # as in the frame after a click on the bar: the field is not there yet
    hands.state.show_search = True
    hands.press(Key.s)
    search.draw = draw
    hands.context.yield_(4)
    assert hands.state.show_search and hands.scene.hole.spin == spin
    hands.context.key_press(Key.escape)
    hands.context.yield_(4)
    assert not hands.state.show_search
    hands.press(Key.s)
    assert hands.scene.hole.spin != spin


def search_finds_values_of_things(hands: Hands) -> None:
    hands.state.change({"things.ring.kind": "annulus"})
    hands.context.yield_(2)
    key = next(key for key in hands.scene.fields() if key.startswith("things.ring.") and key.endswith("radius"))
    press_bar(hands, "search")
    hands.context.key_chars(key)
    hands.context.yield_(2)
    hands.context.key_press(Key.enter)
    hands.context.yield_(4)
    row = hands.context.item_info(f"//{PANEL}/values of things.ring/##{key}")
    panel = imgui.internal.find_window_by_name(PANEL)
    assert panel.inner_clip_rect.min.y <= row.rect_full.min.y and row.rect_full.max.y <= panel.inner_clip_rect.max.y
    assert hands.state.sought.key == key and hands.state.sought.until is not None


def search_runs_commands_presets_and_views(hands: Hands) -> None:
    for text, has_come in (
        ("save the scene", lambda: hands.state.notice is not None),
        ("f11", lambda: hands.state.full_screen),
        ("luminet", lambda: "luminet_1979" in hands.state.chosen.values()),
        ("g factor", lambda: hands.scene.post.view == "g_factor"),
    ):
        press_bar(hands, "search")
        hands.context.key_chars(text)
        hands.context.yield_(2)
        hands.context.key_press(Key.enter)
        hands.context.yield_(3)
        assert has_come(), text
    hands.state.full_screen = False
    hands.context.yield_(4)
    press_bar(hands, "search")
    hands.context.key_chars("copy toml")
    hands.context.yield_(2)
    hands.context.item_click("//Search/**/Copy the scene as TOML###command CTRL+SHIFT+C")
    hands.context.yield_(2)
    assert "clipboard" in hands.state.notice.text and not hands.state.show_search


def text_size_is_chosen_and_kept(hands: Hands) -> None:
    was, font = hands.window.kept, imgui.get_font_size()
    width = imgui.internal.find_window_by_name(PANEL).size.x
    hands.click("Window##window")
    hands.choose("##window.text_size", "130 %", table="values of window/")
    hands.context.yield_(3)
    assert abs(imgui.get_font_size() / font - 1.3) < 0.05, "to whole pixels"
    assert imgui.internal.find_window_by_name(PANEL).size.x > 1.2 * width, "the panel grows with its labels"
    hands.click("##window.keep_scene")
    hands.window.remember()
    found, told = kept.load()
    assert (found.text_size, found.keep_scene, told) == (1.3, True, "") and kept.last_scene_file().exists()
    hands.window.kept = was
    hands.window.remember()
    assert not kept.last_scene_file().exists()
    hands.click("Window##window")


def panel_edge_stays_where_it_is_drawn(hands: Hands) -> None:
    view = hands.window.view()
    edge, width = view.left + view.width + 1.0, view.width
    hands.context.mouse_move_to_pos((edge, view.top + 0.5 * view.height))
    hands.context.mouse_down(0)
    hands.context.mouse_move_to_pos((edge - 60.0, view.top + 0.5 * view.height))
    hands.context.yield_(2)
    hands.context.mouse_up(0)
    hands.context.yield_(5)
    assert abs(hands.window.view().width - (width - 60.0)) < 4.0
    hands.window.remember()
    assert kept.load()[0].panel_em > hands.window.kept.panel_em + 2.0


def picture_of_any_size(hands: Hands) -> None:
    """Width, height, rays and name as typed; frames go on meanwhile; what is there is replaced only when asked a second time."""
    path = hands.folder / "日本.png"
    press_bar(hands, "picture_window")
    for name, value in (("##width", 300), ("##height", 200), ("##rays", 8), ("##path", str(path))):
        hands.context.item_input_value(f"//Picture/{name}", value)
    hands.context.item_click("//Picture/Save")
    frames, shares, window = 0, set(), hands.window.picture_window
    while window.busy:
        frames, shares = frames + 1, shares | {window._still.share if window._still else 0.0}
        hands.context.yield_()
    assert frames > 4 and len(shares) > 3, "drawn between frames"
    assert Image.open(path).size == (300, 200) and presets.from_png(path) == hands.scene
    assert str(path) in hands.state.notice.text
    written = path.stat().st_mtime_ns
    hands.context.item_click("//Picture/Save")
    hands.context.yield_(3)
    assert not window.busy and path.stat().st_mtime_ns == written
    hands.context.item_input_value("//Picture/##rays", 16)
    hands.context.item_click("//Picture/Save")
    hands.context.yield_(2)
    hands.context.item_click("//Picture/Stop")
    hands.context.yield_(2)
    assert not window.busy and path.stat().st_mtime_ns == written, "stopped, and the old picture is there"
    hands.context.item_input_value("//Picture/##path", str(hands.folder / "no.jpg"))
    hands.context.item_click("//Picture/Save")
    hands.context.yield_(2)
    assert not window.busy and "PNG" in window._said
    hands.press(Key.escape)


def picture_that_cannot_be_written_is_told(hands: Hands) -> None:
    (hands.folder / "file").write_text("")
    press_bar(hands, "picture_window")
    hands.context.item_input_value("//Picture/##path", str(hands.folder / "file" / "a.png"))
    hands.context.item_click("//Picture/Save")
    wait(hands, lambda: hands.state.notice is not None and hands.state.notice.is_error, seconds=20.0)
    assert str(hands.folder / "file" / "a.png") in hands.state.notice.text
    hands.press(Key.escape)


def scenes_by_the_systems_dialog(hands: Hands) -> None:
    """tests/app/test_window.py puts a `zenity` there that answers with the text of a file."""
    answer = kept.file().parent / "answer"
    path = hands.folder / "ünï 日本"
    answer.write_text(f"{path}\n", encoding="utf-8")
    hands.context.key_press(Key.mod_ctrl | Key.mod_shift | Key.s)
    wait(hands, lambda: path.with_name(path.name + ".toml").exists())
    saved = hands.scene
    answer.write_text(f"{path}.toml\n", encoding="utf-8")
    hands.press(Key.s)
    assert hands.scene != saved
    press_bar(hands, "open")
    wait(hands, lambda: hands.scene == saved)
    press_bar(hands, "picture_window")
    answer.write_text(f"{hands.folder / 'chosen'}\n", encoding="utf-8")
    hands.context.item_click("//Picture/Choose …")
    wait(hands, lambda: hands.window.picture_window._path == str(hands.folder / "chosen.png"))
    answer.write_text("", encoding="utf-8")
    press_bar(hands, "open")
    wait(hands, lambda: not hands.window.dialog.is_open)
    assert hands.scene == saved, "nothing was chosen"
    hands.press(Key.escape)


def without_a_dialog_the_path_is_typed(hands: Hands) -> None:
    there, file_dialog.is_there = file_dialog.is_there, lambda: False
    try:
        press_bar(hands, "open")
        assert "zenity" in hands.state.notice.text and "file field" in hands.state.notice.text and not hands.window.dialog.is_open
    finally:
        file_dialog.is_there = there


def a_list_that_the_mouse_opened_has_the_arrows(hands: Hands) -> None:
    before = hands.scene
    hands.context.item_click(f"//{PANEL}/values of camera/##camera.observer")
    hands.context.yield_(3)
    assert imgui.internal.find_window_by_name("##Combo_00").active
    for key in (Key.down_arrow, Key.enter):
        hands.context.key_press(key)
        hands.context.yield_(3)
    assert not imgui.internal.find_window_by_name("##Combo_00").active
    assert hands.scene.camera.observer != before.camera.observer
    assert hands.scene.camera.inclination_deg == before.camera.inclination_deg and not hands.state.panel_keys
    hands.press(Key.down_arrow)
    hands.settle()
    assert hands.scene.camera.inclination_deg != before.camera.inclination_deg, "closed, it lets them turn the camera again"


def panel_by_keys_alone(hands: Hands) -> None:
    """F6, then arrows to the disk's switch, SPACE; a list opens, is left and the keys are the picture's again."""
    before = hands.scene
    hands.press(Key.f6)
    hands.context.yield_(3)
    assert hands.state.panel_keys and "ESC leaves" in hands.state.notice.text
    goes_to(hands, f"//{PANEL}/values of disk/##disk.enabled")
    hands.context.key_press(Key.space)
    hands.context.yield_(2)
    assert not hands.scene.disk.enabled
    hands.context.key_press(Key.space)
    hands.context.yield_(2)
    assert hands.scene == before, "and no arrow has moved the camera"
    goes_to(hands, f"//{PANEL}/values of camera/##camera.observer")
    hands.context.key_press(Key.space)
    hands.context.yield_(3)
    assert imgui.internal.find_window_by_name("##Combo_00").active
    hands.context.key_press(Key.escape)
    hands.context.yield_(3)
    assert not imgui.internal.find_window_by_name("##Combo_00").active and hands.state.panel_keys
    hands.context.key_press(Key.escape)
    hands.context.yield_(2)
    assert not hands.state.panel_keys
    hands.press(Key.space)
    assert not hands.scene.disk.enabled, "SPACE is the picture's again"


def goes_to(hands: Hands, item: str) -> None:
    """Goes to the top of the panel, and strikes the arrow until `item` has the keyboard."""
    hands.context.scroll_to_top(f"//{PANEL}")
    wanted = hands.context.item_info(item).id_
    hands.context.key_press(Key.home)
    hands.context.yield_(3)
    for _ in range(80):
        if imgui.get_current_context().nav_id == wanted:
            return
        hands.context.key_press(Key.down_arrow)
        hands.context.yield_(2)
    raise AssertionError(f"{item} is not reached")


def letters_of_other_scripts(hands: Hands) -> None:
    """tests/app/test_window.py puts a font with Georgian and Armenian letters into the configuration folder; ours has neither."""
    font = imgui.get_font()
    assert all(font.is_glyph_in_font(ord(letter)) for letter in "აԱя₀")
    assert not font.is_glyph_in_font(0xE123), "a private letter, which nobody has"


def a_sideways_wheel_does_nothing(hands: Hands) -> None:
    before = hands.scene
    hands.to_picture()
    hands.context.mouse_wheel_x(3.0)
    hands.settle()
    assert hands.scene == before


def a_notice_leaves_in_time_while_the_window_sleeps(hands: Hands) -> None:
    hands.press(Key.p)
    hands.state.say("Saved")
    before = hands.state.clock
    time.sleep(0.5)  # a frame as long as those of a window that idles
    hands.context.yield_(2)
    assert 0.5 < hands.state.clock - before < 2.0, hands.state.clock - before


LOOKING = (line_at_start_is_in_no_picture,)  # at pixels, though the renderer is pretended
