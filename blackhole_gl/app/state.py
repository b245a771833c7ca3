"""The one mutable record of the window; all else is functions of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..scene import Scene, SceneError
from .camera_control import Motion, pose_of, values_of

NOTICE_SECONDS = 6.0
MOST_TOLD = 5
"""Sentences in one notice about what was skipped: with more it would hide the picture."""


@dataclass(frozen=True)
class Notice:
    """A sentence for the user, with the clock time [s] at which it leaves; None stays until replaced."""

    text: str
    is_error: bool = False
    until: float | None = None


@dataclass
class WindowState:
    """What the window shows and does.

    Attributes:
        scene: the scene shown now.
        home: the scene whose camera R returns to.
        motion: the camera on its way.
        chosen: preset group → name of the preset last picked in it.
        time: scene time in r_s/c.
        clock: the window's own clock in seconds, advanced by each frame.
        holes: spinning or not → the values that S brings back.
        file: what the panel's file field says.
        replace_file: the path that the next Save may overwrite.
        shader_error: what is wrong with the shaders on disk, or None.
        render_error: why the last picture could not be made, or None.
    """

    scene: Scene
    home: Scene
    motion: Motion
    chosen: dict[str, str] = field(default_factory=dict)
    time: float = 0.0
    clock: float = 0.0
    paused: bool = False
    dragging: bool = False
    holes: dict[bool, Mapping[str, Any]] = field(default_factory=dict)
    show_panel: bool = True
    show_help: bool = False
    show_overlay: bool = True
    show_chart: bool = False
    show_paths: bool = False
    full_screen: bool = False
    picture_wanted: bool = False
    file: str = "scene.toml"
    replace_file: str = ""
    notice: Notice | None = None
    shader_error: str | None = None
    render_error: str | None = None

    @classmethod
    def start(cls, scene: Scene, chosen: Mapping[str, str] | None = None) -> WindowState:
        """The state of a window that has just opened on `scene`."""
        return cls(scene=scene, home=scene, motion=Motion.at(scene), chosen=dict(chosen or {}))

    def show(self, scene: Scene, *, as_home: bool = False) -> None:
        """Shows `scene`; the camera jumps only where `scene` has it elsewhere. `as_home` makes it the scene that R returns to."""
        if pose_of(scene) != pose_of(self.scene):
            self.motion = Motion.at(scene)
        self.scene = scene
        if as_home:
            self.home = scene

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
        return not self.paused and scene.playback.rate > 0.0 and scene.disk.enabled and bool(scene.disk_layers())

    @property
    def camera_moves(self) -> bool:
        """Whether the camera is on its way or under the hand."""
        return self.dragging or not self.motion.at_rest

    @property
    def is_moving(self) -> bool:
        """Whether the next frame differs from this one without anybody touching anything."""
        return self.is_playing or self.camera_moves
