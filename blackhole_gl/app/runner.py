"""What the window's library, Hello ImGui, is told before it opens a window."""

from __future__ import annotations

from typing import Protocol

from imgui_bundle import hello_imgui, imgui, immapp

from . import fonts, theme
from .failure import Failure
from .opening import WindowError, open_platform

TITLE = "Blackhole GL"
PANEL = "Parameters"
DOCK_SPACE = "MainDockSpace"
IDLE_FPS = 4.0  # often enough to notice an edited shader within a second
_PANEL_SHARE = 0.30  # of the window's width, before `PanelWidth` knows better


class Callbacks(Protocol):
    """What the library calls, in the order of a frame; `failure` keeps from it what they raise."""

    failure: Failure

    def start(self) -> None: ...
    def before_frame(self) -> None: ...
    def draw_bar(self) -> None: ...
    def draw_panel(self) -> None: ...
    def frame(self) -> None: ...
    def draw_picture(self) -> None: ...


def set_up(params: hello_imgui.RunnerParams) -> None:
    """Opens the window.

    Raises:
        WindowError: it cannot be.
    """
    try:
        immapp.manual_render.setup_from_runner_params(params, immapp.AddOnsParams(with_implot=True, with_implot3d=True))
    except RuntimeError as error:
        raise WindowError(f"no window with OpenGL 3.3 can be opened ({error}). `blackhole-gl check` says what is missing.") from None


def parameters(window: Callbacks, size: tuple[int, int]) -> hello_imgui.RunnerParams:
    """Everything about the window.

    Args:
        size: width and height in units of a 96 dpi screen.
    """
    params = _bare_parameters()
    params.app_window_params.window_title = TITLE
    params.app_window_params.window_geometry.size = size
    params.imgui_window_params.default_imgui_window_type = hello_imgui.DefaultImGuiWindowType.provide_full_screen_dock_space
    params.fps_idling.fps_idle = IDLE_FPS
    params.fps_idling.time_active_after_last_event = 0.5
    params.fps_idling.enable_idling = False  # until the first picture is there
    params.docking_params.main_dock_space_node_flags = (imgui.DockNodeFlags_.passthru_central_node | imgui.DockNodeFlags_.auto_hide_tab_bar).value
    params.docking_params.docking_splits = [hello_imgui.DockingSplit(DOCK_SPACE, "Right", imgui.Dir.right, _PANEL_SHARE)]
    panel = hello_imgui.DockableWindow(PANEL, "Right", window.failure.kept_from(window.draw_panel))
    panel.imgui_window_flags = imgui.WindowFlags_.no_nav_inputs.value  # TAB belongs to the key table
    panel.can_be_closed = False  # TAB hides it, and is the way to get it back
    params.docking_params.dockable_windows = [panel]
    callbacks = params.callbacks
    callbacks.setup_imgui_config = _setup_imgui
    callbacks.load_additional_fonts = fonts.load
    callbacks.setup_imgui_style = theme.apply
    callbacks.post_init = window.start
    callbacks.pre_new_frame = window.failure.kept_from(window.before_frame)
    callbacks.show_gui = window.failure.kept_from(window.frame)
    callbacks.custom_background = window.failure.kept_from(window.draw_picture)
    return params


def work_by_keys(panel: bool, opened_list: bool) -> None:
    """Gives TAB, the arrows, SPACE and ENTER to the panel or to a list that is open, beginning with the frame to come, or takes them back. Call before each
    frame."""
    io, docking = imgui.get_io(), hello_imgui.get_runner_params().docking_params
    keyboard, no_keys = imgui.ConfigFlags_.nav_enable_keyboard.value, imgui.WindowFlags_.no_nav_inputs.value
    window = docking.dockable_window_of_name(PANEL)
    had_panel, window.imgui_window_flags = window.imgui_window_flags != no_keys, 0 if panel else no_keys
    io.config_flags = io.config_flags | keyboard if panel or opened_list else io.config_flags & ~keyboard
    if panel and not had_panel:
        docking.focus_dockable_window(PANEL)
        imgui.internal.set_nav_cursor_visible_after_move()


def try_out() -> str:
    """Opens a window as the viewer does, but hidden, closes it after a frame of nothing, and says what draws in it. To be called in a process of its own.

    Raises:
        WindowError: no display, or no OpenGL 3.3.
    """
    described = open_platform(null_platform=False)
    params = _bare_parameters()
    params.app_window_params.hidden = True
    set_up(params)
    immapp.manual_render.render()
    immapp.manual_render.tear_down()
    return described


def _bare_parameters() -> hello_imgui.RunnerParams:
    params = hello_imgui.RunnerParams()
    params.ini_disable = True
    # Multisampling would only smooth the panel's edges, and costs a factor of 3 on software renderers.
    params.renderer_backend_options.open_gl_options = hello_imgui.OpenGlOptions(
        glsl_version="330", major_version=3, minor_version=3, use_core_profile=True, use_forward_compat=True, anti_aliasing_samples=0
    )
    return params


def _setup_imgui() -> None:
    hello_imgui.imgui_default_settings.setup_default_imgui_config()
    # With keyboard navigation SPACE and the arrows would move a focus rectangle about the panel.
    io = imgui.get_io()
    io.config_flags &= ~imgui.ConfigFlags_.nav_enable_keyboard.value
