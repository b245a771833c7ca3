"""The one mutable record of the window; all else is functions of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..scene import Scene, SceneError
from ..scene.presets import Preset
from ..scene.schema import Field, Value
from .camera_control import Motion, clear_of_horizon, pose_of, values_of
from .free_flight import FreeFlight
from .history import History, Moment
from .timeline import Timeline

NOTICE_SECONDS = 6.0
MOST_TOLD = 5
"""Sentences in one notice about what was skipped: with more it would hide the picture."""


@dataclass(frozen=True)
class Notice:
    """A sentence for the user, with the clock time [s] at which it leaves; None stays until replaced."""

    text: str
    is_error: bool = False
    until: float | None = None


@dataclass(frozen=True)
class Sought:
    """A setting that a search has found, by its key; `until` what time its mark stays, in seconds, once the panel shows it."""

    key: str
    until: float | None = None


@dataclass
class WindowState:
    """What the window shows and does.

    Attributes:
        scene: the scene shown now.
        home: the scene as the presets in force or the opened file have it, which resets go back to.
        motion: the camera on its way. flight: how it flies by hand. timeline: the flight that it follows.
        looks: whether the hand turned the view in this frame.
        chosen: preset group → name of the preset in force.
        history: what can be undone and redone.
        time: scene time in r_s/c.
        clock: the window's own clock in seconds, advanced by each frame.
        holes: spinning or not → the values that S brings back.
        file: what the panel's file field says.
        panel_keys: whether TAB, arrows, SPACE and ENTER work the panel.
        sought: the setting that the panel is to show.
        pick: the key of the thing or medium that was clicked, ``things.moon``; empty for none.
        replace_file: the path that the next Save may overwrite.
        asked_for_files: the preset whose files outside its folder were just left out; see `files_outside`.
        way_out: a line for where nothing is to be seen; empty elsewhere.
        recording: a line on the film that is recorded; empty while none is.
        shader_error: what is wrong with the shaders on disk, or None.
        render_error: why the last picture could not be made, or None.
    """

    scene: Scene
    home: Scene
    motion: Motion
    history: History
    chosen: dict[str, str] = field(default_factory=dict)
    time: float = 0.0
    clock: float = 0.0
    paused: bool = False
    dragging: bool = False
    looks: bool = False
    flight: FreeFlight = FreeFlight()
    timeline: Timeline = Timeline()
    holes: dict[bool, Mapping[str, Any]] = field(default_factory=dict)
    show_panel: bool = True
    show_help: bool = False
    show_overlay: bool = True
    show_chart: bool = False
    show_line: bool = False
    show_light: bool = False
    show_values: bool = False
    show_paths: bool = False
    show_sides: bool = False
    show_timeline: bool = False
    show_search: bool = False
    show_picture_window: bool = False
    panel_keys: bool = False
    sought: Sought | None = None
    pick: str = ""
    full_screen: bool = False
    picture_wanted: bool = False
    file: str = "scene.toml"
    replace_file: str = ""
    asked_for_files: str = ""
    notice: Notice | None = None
    way_out: str = ""
    recording: str = ""
    shader_error: str | None = None
    render_error: str | None = None

    @classmethod
    def start(cls, scene: Scene, chosen: Mapping[str, str] | None = None, home: Scene | None = None) -> WindowState:
        """The state of a window that has just opened on `scene`; `home` is `scene` where it is not given."""
        chosen, home = dict(chosen or {}), home or scene
        state = cls(scene, home, Motion.at(scene), History(Moment(scene, home, chosen)), chosen)
        state.show(scene)
        state.history = History(Moment(state.scene, home, chosen))
        return state

    def put_in_force(self, home: Scene, chosen: Mapping[str, str], scene: Scene | None = None) -> None:
        """Shows `scene`, or `home` itself, where `home` is what the presets `chosen` say: one step, whatever a gesture has done before."""
        self.record()
        self.home, self.chosen = home, dict(chosen)
        self.show(scene or home)
        self.record()

    def show(self, scene: Scene) -> None:
        """Shows `scene`; the camera jumps only where `scene` has it elsewhere, or where it would be inside the hole."""
        shown = clear_of_horizon(scene)
        if pose_of(shown) != pose_of(self.scene):
            self.motion = Motion.at(shown)
        self.scene = shown
        if shown is not scene:
            self.say(f"The camera would be inside this hole: it is moved out to {shown.camera.distance:.4g} r_s.")

    def play_from(self, preset: Preset) -> None:
        """Goes to the scene time that `preset` was saved at, running or paused as it was; one that says no time leaves both alone."""
        if preset.time is not None:
            self.time, self.paused = preset.time, preset.paused

    def in_force(self, item: Field) -> Value:
        """The value of `item` that the presets in force say; the default of one that they know nothing of."""
        try:
            return self.home.get(item.key)
        except SceneError:
            return item.default

    @property
    def picked(self) -> str:
        """`pick`, unless that is in the scene no more: then empty."""
        section, _, name = self.pick.partition(".")
        return self.pick if name and name in getattr(self.scene, section) else ""

    def record(self) -> None:
        """Makes what has changed since the last step a step that can be undone. The camera counts as where it is bound for."""
        scene = self.scene
        if not self.motion.at_rest:
            scene = scene.with_values(values_of(self.motion.target, scene))
        self.history = self.history.followed_by(Moment(scene, self.home, dict(self.chosen)))

    def undo(self) -> None:
        """Takes the last step back. Time, which runs by itself, goes on."""
        self.record()
        self._return_to(self.history.undone())

    def redo(self) -> None:
        """Takes the step again that was last undone."""
        self.record()
        self._return_to(self.history.redone())

    def _return_to(self, history: History) -> None:
        moment = history.present
        self.history, self.home, self.chosen = history, moment.home, dict(moment.chosen)
        self.show(moment.scene)

    def change(self, values: Mapping[str, Any]) -> None:
        """Puts `values` (dotted key → value) into the scene; what a field refuses becomes a notice."""
        self.edit(lambda scene: scene.with_values(values))

    def edit(self, made: Callable[[Scene], Scene]) -> bool:
        """Shows what `made` makes of the scene, and says whether it could; what a scene refuses becomes a notice."""
        try:
            self.show(made(self.scene))
        except SceneError as error:
            self.complain(str(error))
            return False
        return True

    def move_camera(self, motion: Motion) -> None:
        """Puts the camera where `motion` has it now."""
        if motion.current != self.motion.current:
            self.scene = self.scene.with_values(values_of(motion.current, self.scene))
        self.motion = motion

    def say(self, text: str) -> None:
        """Shows `text` for a few seconds."""
        self.notice = Notice(text, until=self.clock + NOTICE_SECONDS)

    def complain(self, text: str) -> None:
        """Shows `text` as an error, until something else is shown or the user dismisses it."""
        self.notice = Notice(text, is_error=True)

    def tell(self, done: str, skipped: Sequence[str]) -> None:
        """Says what was done; with what was skipped, a sentence each, until the user dismisses it."""
        if not skipped:
            self.say(done)
            return
        rest = [f"… and {len(skipped) - MOST_TOLD} more."] if len(skipped) > MOST_TOLD else []
        self.complain("\n".join([done, *skipped[:MOST_TOLD], *rest]))

    @property
    def is_playing(self) -> bool:
        """Whether the picture changes by itself."""
        scene = self.scene
        if scene.post.view != "picture":  # diagnostic views know no time
            return False
        return not self.paused and scene.playback.rate > 0.0 and scene.disk_moves

    @property
    def camera_moves(self) -> bool:
        """Whether the camera is on its way or under the hand."""
        return self.dragging or self.looks or self.timeline.plays or not (self.motion.at_rest and self.flight.at_rest)

    @property
    def is_moving(self) -> bool:
        """Whether the next frame differs from this one without anybody touching anything."""
        return self.is_playing or self.camera_moves
