"""What stands on the two sides of the divider: the scene, and another on the same view. No imgui here."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .. import planning
from ..rendering.diagnostics import most_accurate
from ..scene import Scene, presets
from .preset_switch import LAYERED
from .state import WindowState

MOST_ACCURATE = "the most accurate method"
KEPT = "what was kept"


@dataclass
class Sides:
    """The other scene, and where the divider stands.

    Attributes:
        name: of the other side: `MOST_ACCURATE`, `KEPT`, or a preset's title.
        kept: the scene of the other side; None for that of this side by the most accurate method.
        share: of the picture's width that is left of the divider, 0…1.
    """

    name: str = MOST_ACCURATE
    kept: Scene | None = None
    share: float = 0.5

    def other(self, scene: Scene) -> Scene:
        """The other side's scene where `scene` is shown: of the same camera, the same course of time and the same view.

        Raises:
            SceneError: parts of `scene` do not fit together.
        """
        if self.kept is None:
            exact = most_accurate(planning.plan(scene)).scene
            return replace(scene, rays=exact.rays, parameters=exact.parameters)
        return replace(self.kept, camera=scene.camera, playback=scene.playback).with_values({"post.view": scene.post.view})

    def keep(self, scene: Scene) -> None:
        """From now on the other side shows `scene` as it is now."""
        self.name, self.kept = KEPT, scene

    def take_most_accurate(self) -> None:
        """From now on the other side shows this one by the most accurate method."""
        self.name, self.kept = MOST_ACCURATE, None

    def take_preset(self, info: presets.PresetInfo, scene: Scene) -> None:
        """From now on the other side shows a preset, where it is a layer that of `scene`.

        Raises:
            PresetError: it cannot be read.
        """
        self.kept = presets.read(info.name).over(scene) if info.group in LAYERED else presets.load([info.name])
        self.name = info.title

    def swap(self, state: WindowState) -> None:
        """Each side shows what the other did."""
        here = state.scene
        state.show(self.other(here))
        self.keep(here)
