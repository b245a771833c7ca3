"""A newcomer's way in: the bar, the line at start, the search, what the window keeps. See ``scenarios.py``."""

from __future__ import annotations

from imgui_bundle import imgui

# isort: split
import numpy as np
from hands import Hands
from PIL import Image
from scenarios import PICTURES, save_picture

from blackhole_gl.app import kept
from blackhole_gl.app.runner import PANEL

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
    before = len(list((hands.folder.parent / PICTURES).glob("*.png")))
    press_bar(hands, "picture")
    hands.context.yield_(3)
    assert len(list((hands.folder.parent / PICTURES).glob("*.png"))) == before + 1


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
    line = hands.window._start_line
    line.__init__(hands.scene, "F1")
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
