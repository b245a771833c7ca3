"""The window: Hello ImGui's runner around the picture, the panel and the keys."""

from __future__ import annotations

import contextlib
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Protocol

from imgui_bundle import hello_imgui, imgui, immapp  # before glfw: on Linux the first GLFW that is loaded is the one used

# isort: split
import glfw
import moderngl

from ..rendering.context import hear_glfw
from ..resources import user_config_dir
from ..scene import Scene
from . import (
    bar,
    commands,
    file_commands,
    gamepad,
    glfw_window,
    help_window,
    kept,
    keys,
    preset_switch,
    recorder,
    runner,
    scene_files,
    search_window,
    shader_watch,
    timeline_window,
    widgets,
    window_settings,
)
from .area import Area, FreePart
from .ending import Ending
from .escape import Escape
from .failure import Failure
from .file_dialog import FileDialog
from .full_screen import FullScreen
from .gesture import Editing, Gesture
from .light_plot import LightPlot
from .line_plot import LinePlot
from .live_chart import LiveChart
from .mouse import Mouse
from .opening import WindowError, open_platform
from .over_picture import OverPicture
from .panel import Panel
from .panel_width import PanelWidth
from .path_view import PathView
from .picking import Picking
from .picture import Picture
from .picture_window import PictureWindow
from .preparation import Preparation
from .search_window import SearchWindow
from .shader_watch import ShaderWatch
from .shortcuts import Layout, Shortcuts
from .side_by_side import SideBySide
from .state import WindowState
from .thumbnails import Thumbnails
from .warm_up import WarmUp
from .way_out import WayOut

_PREPARING_FPS = 20.0  # while another process compiles: it has the processor, and the panel still answers
_FIRST_FRAME_S = 1.0 / 60.0  # a movement that begins now has not been going on while the window slept
_LONGEST_FRAME_S = 0.5


class Driver(Protocol):
    """Something that drives the window in place of a user, as tests do."""

    finished: bool

    def register(self, window: Window) -> None:
        """Called once, when the ImGui test engine can take tests."""


def run(
    scene: Scene,
    *,
    preset_names: Sequence[str] = (),
    any_file: bool = False,
    null_platform: bool = False,
    time: float | None = None,
    size: tuple[int, int] | None = None,
    picture_folder: Path | None = None,
    make_renderer: Callable[[moderngl.Context], Any] | None = None,
    driver: Driver | None = None,
) -> WindowState:
    """Opens the window on `scene` and returns when it is closed.

    Args:
        preset_names: the presets that `scene` was made from, shown in the panel's pickers.
        any_file: whether these may name files outside their own folders.
        null_platform: no display at all: GLFW's null platform on EGL.
        time: scene time at which it begins, in r_s/c; that of the presets when None.
        size: width and height in units of a 96 dpi screen; those kept from the last window, or the usual ones, when None.
        picture_folder: where F12 puts pictures; the working folder when None.
        make_renderer: makes the renderer from the window's context; ``rendering.frame.Renderer`` when None.
        driver: drives the window through the ImGui test engine.

    Returns:
        The state at the end.

    Raises:
        WindowError: no display, no OpenGL 3.3, or a frame failed.
        KeyboardInterrupt, SystemExit: the window was closed by a signal; see `ending`.
    """
    open_platform(null_platform)
    window = Window(scene, preset_names, picture_folder or Path.cwd(), make_renderer or _default_renderer, any_file=any_file, may_idle=not null_platform)
    if time is not None:
        window.state.time = time
    params = runner.parameters(window, size or window.kept.first_size)
    if driver is not None:
        params.use_imgui_test_engine = True
        params.callbacks.register_tests = lambda: driver.register(window)
    with Ending() as ending:
        runner.set_up(params)
        with contextlib.ExitStack() as at_end:  # from last to first, whatever goes wrong in one
            at_end.callback(immapp.manual_render.tear_down)
            at_end.callback(window.remember)
            at_end.callback(window.warm_up.close)
            at_end.callback(window.live_chart.close)
            at_end.callback(window.picture_window.close)
            at_end.callback(window.recorder.close)
            at_end.callback(window.dialog.close)
            while not (params.app_shall_exit or ending.signal or window.failure.error or (driver is not None and driver.finished)):
                immapp.manual_render.render()
    window.failure.tell()
    return window.state


def _default_renderer(gl: moderngl.Context) -> Any:
    from ..rendering.frame import Renderer

    return Renderer(gl)


class Window:
    """The callbacks of the runner, around one state.

    Args:
        scene: the first scene.
        preset_names, any_file: what it was made from, and whether these may name files outside their own folders.
        picture_folder: where pictures go.
        make_renderer: see `run`.
        may_idle: whether to sleep while nothing moves; a driver's input would not wake the window.
    """

    def __init__(
        self,
        scene: Scene,
        preset_names: Sequence[str],
        picture_folder: Path,
        make_renderer: Callable[[moderngl.Context], Any],
        *,
        any_file: bool = False,
        may_idle: bool,
    ):
        self.open(scene, preset_names, any_file=any_file)
        self.kept, told = kept.load()
        if told:
            self.state.complain(told)
        self.state.show_panel = self.kept.panel_shown or not self.kept.keep_panel
        self.key_file = user_config_dir() / "keys.toml"
        self.bindings = self._read_keys()
        self._picture: Picture | None = None
        self._shortcuts = Shortcuts(self.bindings, Layout(glfw_window.key_name, glfw_window.is_key_down))
        self._mouse = Mouse()
        self._panel_width = PanelWidth(self.kept.first_panel_em)
        self._gesture = Gesture()
        self._way_out = WayOut(self.bindings)
        self._over = OverPicture(scene, keys.shown(self.bindings["help"][:1]))
        self._search = SearchWindow()
        self.dialog = FileDialog()
        self.picture_window = PictureWindow(picture_folder, make_renderer, self.dialog)
        self.recorder = recorder.Recorder(picture_folder)
        self._escape = Escape()
        self.failure = Failure()
        self._bar = bar.toolbar(self.failure.kept_from(self.draw_bar))
        self._picture_folder = picture_folder
        self._make_renderer = make_renderer
        self.live_chart, self.line_plot, self.light_plot = LiveChart(make_renderer), LinePlot(make_renderer), LightPlot(make_renderer)
        self._plots = self.live_chart, self.line_plot, self.light_plot
        self.path_view = PathView()
        self._picking = Picking()
        self.warm_up = WarmUp()
        self.side_by_side = SideBySide(make_renderer, self.warm_up.submit)
        self._may_idle = may_idle
        self._shader_watch = ShaderWatch()
        self._was_moving = False
        self._looked_ahead = 0  # programs that the window had compiled when the other process was last asked for more
        self._editing = Editing(scene)

    def open(self, scene: Scene, preset_names: Sequence[str] = (), *, any_file: bool = False) -> None:
        """Starts afresh on `scene`, made from the presets of these names, or from none."""
        self.state = preset_switch.start(scene, preset_names, any_file=any_file)
        self.state.shader_error = shader_watch.mistakes()
        self._panel = Panel()

    def _read_keys(self) -> keys.Bindings:
        try:
            return keys.load_bindings(self.key_file)
        except keys.KeysError as error:
            self.state.complain(f"{error}. The keys are as they come.")
            return keys.default_bindings()

    # --- callbacks, in the order of a frame ---

    def start(self) -> None:
        """Once, when the context is there."""
        self._gl = moderngl.create_context(require=330)
        self._picture = Picture(self._gl, self._make_renderer(self._gl), Preparation(self.warm_up.submit))
        self._full_screen = FullScreen(glfw_window.handle())
        hear_glfw(glfw)  # the window's library prints what GLFW says, as of a clipboard that is empty
        self._thumbnails = Thumbnails(self._gl)

    @property
    def picture(self) -> Picture:
        """What shows the scene.

        Raises:
            WindowError: the window has no context yet.
        """
        if self._picture is None:
            raise WindowError("the window has no picture before the runner has made its context and called `start`")
        return self._picture

    def begin_start_line(self) -> None:
        """Shows the line of the start anew."""
        self._over.start_line.begin(self.state.scene)

    def before_frame(self) -> None:
        """Before imgui begins a frame: what the runner is to do follows the state."""
        params = hello_imgui.get_runner_params()
        params.docking_params.dockable_window_of_name(runner.PANEL).is_visible = self.state.show_panel
        params.callbacks.edges_toolbars = {hello_imgui.EdgeToolbarType.top: self._bar} if self.state.show_panel else {}
        imgui.get_style().font_scale_main = self.kept.text_size
        runner.work_by_keys(self.state.panel_keys, widgets.list_is_open())
        by_view = any(part.busy(self.state) for part in (*self._plots, self.side_by_side))
        measuring = by_view or self.path_view.busy or self.picture_window.busy or self.recorder.busy
        busy = self.state.is_moving or self._over.start_line.fades or measuring or self._has_more_to_draw()
        preparing = self.picture.preparation.since is not None and not self.picture.bridges
        params.fps_idling.enable_idling = self._may_idle and (glfw_window.is_minimised() or preparing or not busy)
        params.fps_idling.fps_idle = _PREPARING_FPS if preparing else runner.IDLE_FPS
        self._full_screen.set(self.state.full_screen)

    def frame(self) -> None:
        """The hand's doings, and what is written over the picture."""
        state, view = self.state, self.view()
        passed = imgui.get_io().delta_time
        dt = self.recorder.dt(min(passed, _LONGEST_FRAME_S if self._was_moving else _FIRST_FRAME_S))
        ways, sticks = self._mouse.poll(view.height), gamepad.poll()
        pressed, held = self._shortcuts.poll(state.panel_keys or widgets.list_is_open(), self._mouse.looks)
        if self._search.expects_keys(state):
            pressed, held = [], []
        for name in pressed:
            self.do(name)
        self._escape.poll(state)
        hand = commands.Hand(*ways, held, sticks.fly).turned(sticks.look, dt)
        state.dragging = self._mouse.drags
        commands.advance(state, hand, dt, 0.0 if self.recorder.exact else passed - dt)
        if not (state.timeline.plays or self._gesture.lasts(hand, state.clock)):
            state.record()
        self._was_moving = state.is_moving or bool(held)
        self._reload_shaders()
        foot = self._over.draw(state, self.picture, view, hello_imgui.em_size(), start_line=self.kept.start_line)
        self._picking.frame(state, (view.left, view.top), (view.width, view.height))
        self._search.draw(state, lambda: search_window.entries(state, self._panel.shown_fields(state.scene), self.bindings, self.do))
        self.dialog.poll()
        self.picture_window.draw(state, self.side_by_side.right_side)
        help_window.draw(state, self.bindings, self.key_file)
        for plot in self._plots:
            plot.draw(state)
        timeline_window.draw(state)
        self.path_view.frame(state, (view.left, view.top), (view.width, view.height), view.area)
        self.side_by_side.frame(state, self.picture, (view.left, view.top), (view.width, view.height), foot)

    def draw_bar(self) -> None:
        """The bar above picture and panel."""
        bar.draw(self.state, self.bindings, self.do)

    def draw_panel(self) -> None:
        """The panel's own window."""
        if self.state.sought is not None:
            self._panel.clear_filter()
        self._panel_width.keep()
        report = self.picture.report
        self._panel.draw(self.state, report.reasons if report else (), report.warnings if report else (), self._thumbnails)
        self.kept = window_settings.draw(self.state, self.kept)

    def draw_picture(self) -> None:
        """Renders what changed and fills the free part of the window."""
        view = self.view()
        if view.area.is_empty or glfw_window.is_minimised():
            return
        window = self._gl.detect_framebuffer()
        self._render(view.area, window)
        for plot in self._plots:
            plot.advance(self._gl, self.state, glfw.get_time())
        self.path_view.advance(self._gl, self.picture.renderer)
        self.picture_window.advance(self._gl, self.state)
        self._picking.advance(self._gl, self.state, self.picture)
        self.picture.draw(window, view.area)
        if self.picture.is_current:
            self.recorder.take(self.state, window, view.area)
        if self.picture.is_current and self.state.render_error is None:
            self._way_out.advance(self.state, window, view.area)
        self.side_by_side.draw(self.state, window, view.area)

    def remember(self) -> None:
        """Keeps what the user wants kept, before the window closes."""
        kept.remember(self.kept, self.state, self._full_screen.size, self._panel_width.ems)

    # --- parts of a frame ---

    def do(self, action: str) -> None:
        """Does what the key of `action` does."""
        self.state.record()
        if action in file_commands.NAMES:
            file_commands.do(action, self.state, self.dialog)
        elif action in recorder.NAMES:
            self.recorder.do(action, self.state)
        elif action == "quit":
            hello_imgui.get_runner_params().app_shall_exit = True
        else:
            commands.COMMANDS[action](self.state)

    def view(self) -> FreePart:
        """Where the picture goes now."""
        io = imgui.get_io()
        docking = hello_imgui.get_runner_params().docking_params
        dock_space = docking.dock_space_id_from_name(runner.DOCK_SPACE)
        node = imgui.internal.dock_builder_get_central_node(dock_space) if dock_space else None
        left, top, width, height = (node.pos.x, node.pos.y, node.size.x, node.size.y) if node else (0.0, 0.0, io.display_size.x, io.display_size.y)
        scale = io.display_framebuffer_scale
        return FreePart(left, top, width, height, Area.of_screen(left, top, width, height, io.display_size.y, (scale.x, scale.y)))

    def _has_more_to_draw(self) -> bool:
        """Whether the picture that rests is still to come."""
        return self.state.render_error is None and not self.picture.is_final

    def _render(self, area: Area, window: moderngl.Framebuffer) -> None:
        state = self.state
        editing = self._editing.lasts(state.scene)
        exact = state.picture_wanted or self.recorder.exact
        moving = (state.is_moving or editing) and not exact
        camera_moving = editing or state.camera_moves
        self.side_by_side.advance(self._gl, state, area, glfw.get_time(), moving=moving, camera_moving=moving and camera_moving)
        try:
            rendered = self.picture.update(
                state.scene, state.time, area, moving=moving, camera_moving=moving and camera_moving, exact=exact, window=window
            )
        except Exception as error:  # whatever the renderer cannot do, the window stays, with the last good picture and the reason
            text = str(error) or type(error).__name__
            if text != state.render_error:  # once, and not for every frame of a drag
                traceback.print_exc()
            state.render_error = text
            rendered = False
        if rendered:
            state.render_error = None
        failed = state.render_error is not None
        if not (failed or self.picture.is_current):
            return
        compiled = self.picture.renderer.programs.compiled
        if self._may_idle and not (failed or camera_moving) and compiled != self._looked_ahead:
            self._looked_ahead = compiled  # the programs of another scene, at the start those of the first
            self.warm_up.look_ahead(state.scene, area.size)
        if state.show_overlay and not failed and not (rendered and self.picture.samples == 1 and self.picture.report.traced):
            self.picture.count_rays()
        if state.picture_wanted:
            pixels = None if failed else self.side_by_side.joined(state, self.picture.read_rgb8())
            if pixels is not None:
                scene_files.save_picture(state, pixels, self.picture.renderer.view_of(state.scene), self._picture_folder)
            state.picture_wanted = pixels is None and not failed

    def _reload_shaders(self) -> None:
        """Takes up shader files that were edited. The mistakes in them are shown."""
        programs = self.picture.renderer.programs
        if self._shader_watch.takes_up(programs, glfw.get_time()):
            self.state.shader_error = shader_watch.mistakes(programs.errors)
            self.picture.forget()
            self.side_by_side.reload()
