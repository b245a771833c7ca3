"""Colours and spacings of the window."""

from __future__ import annotations

from imgui_bundle import ImVec2, ImVec4, imgui

FONT_SIZE = 15.0  # at 96 dpi; the runner scales it for the screen at hand

ACCENT = ImVec4(0.95, 0.62, 0.25, 1.0)
PICKED = ImVec4(0.47, 0.84, 1.0, 1.0)
DEPARTS = ImVec4(0.98, 0.52, 0.22, 1.0)
ERROR = ImVec4(1.0, 0.45, 0.40, 1.0)
DIM = ImVec4(0.62, 0.64, 0.68, 1.0)
QUIET = ImVec4(0.78, 0.79, 0.82, 1.0)
TEXT = ImVec4(0.90, 0.91, 0.93, 1.0)
FAINT = ImVec4(0.42, 0.43, 0.46, 1.0)
BAR = ImVec4(0.075, 0.077, 0.081, 1.0)
HOLE = ImVec4(0.0, 0.0, 0.0, 1.0)
BACKDROP = ImVec4(0.075, 0.077, 0.081, 0.6)


def _grey(value: float, alpha: float = 1.0) -> ImVec4:
    return ImVec4(value, value * 1.02, value * 1.08, alpha)


def _accent(alpha: float) -> ImVec4:
    return ImVec4(ACCENT.x, ACCENT.y, ACCENT.z, alpha)


def apply() -> None:
    """Sets the style of the current imgui context: near-black, so that the picture is the brightest thing in the window."""
    imgui.style_colors_dark()
    style = imgui.get_style()
    col = imgui.Col_
    colours = {
        col.text: TEXT, col.text_disabled: DIM, col.window_bg: _grey(0.075), col.popup_bg: _grey(0.10, 0.98), col.border: _grey(0.22, 0.6),
        col.frame_bg: _grey(0.145), col.frame_bg_hovered: _grey(0.20), col.frame_bg_active: _grey(0.23),
        col.title_bg: _grey(0.06), col.title_bg_active: _grey(0.085), col.title_bg_collapsed: _grey(0.06),
        col.slider_grab: _accent(0.5), col.slider_grab_active: _accent(0.8), col.check_mark: ACCENT,
        col.button: _grey(0.17), col.button_hovered: _grey(0.25), col.button_active: _accent(0.55),
        col.header: _grey(0.14), col.header_hovered: _grey(0.21), col.header_active: _accent(0.40),
        col.tab: _grey(0.085), col.tab_hovered: _grey(0.22), col.tab_selected: _grey(0.14), col.tab_dimmed: _grey(0.07), col.tab_dimmed_selected: _grey(0.12),
        col.tab_selected_overline: ACCENT, col.separator: _grey(0.20), col.separator_hovered: _accent(0.5), col.separator_active: ACCENT,
        col.resize_grip: _grey(0.2), col.resize_grip_hovered: _accent(0.5), col.resize_grip_active: ACCENT,
        col.scrollbar_bg: _grey(0.075, 0.0), col.scrollbar_grab: _grey(0.22), col.text_selected_bg: _accent(0.35), col.docking_empty_bg: ImVec4(0, 0, 0, 0),
    }  # fmt: skip
    for which, colour in colours.items():
        style.set_color_(which, colour)
    # In pixels of a 96 dpi screen: there is no font yet, and the runner scales all of them for the screen at hand.
    style.frame_rounding = style.grab_rounding = style.popup_rounding = 3.0
    style.window_rounding = 5.0
    style.frame_padding = ImVec2(7.0, 3.5)
    style.item_spacing = ImVec2(7.0, 5.0)
    style.window_padding = ImVec2(10.0, 9.0)
    style.cell_padding = ImVec2(4.0, 1.5)
    style.scrollbar_size = 11.0
    style.grab_min_size = 9.0
    style.window_border_size = 0.0
