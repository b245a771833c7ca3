"""The shipped flights by name, each through the scene that it is made for. No imgui here."""

from __future__ import annotations

import tomllib
from functools import cache

from ..physics import flight_files
from ..scene import presets
from . import preset_switch, timeline
from .state import WindowState


@cache
def titles() -> dict[str, str]:
    """Name → title."""
    return {name: str(tomllib.loads(path.read_text(encoding="utf-8"))["title"]) for name, path in flight_files.shipped().items()}


def fly(state: WindowState, name: str) -> None:
    """Takes the flight of that name with its scene, and lets it run."""
    path = flight_files.shipped()[name]
    names = flight_files.presets_of(path)
    state.put_in_force(presets.load(list(names)), preset_switch.chosen_among(names))
    timeline.open_file(state, str(path))
    timeline.play(state)
