"""Files that a preset names outside its own folder: left out, and opened when it is taken a second time, as that is how the user says so."""

from __future__ import annotations

from collections.abc import Sequence

from ..scene.presets import Preset
from .state import WindowState


def allowed(state: WindowState, source: str) -> bool:
    """Whether what `source` names was just told of, so that taking it again means that its files may be opened."""
    return state.asked_for_files == source


def tell(state: WindowState, done: str, source: str, preset: Preset, refused: Sequence[str], again: str) -> None:
    """Says that what `source` names was `done`, and what of it was left out.

    Args:
        refused: of `Preset.refused`.
        again: how it is taken a second time.
    """
    state.asked_for_files = source if refused else ""
    state.tell(done, (*preset.skipped, *refused, *([f"{again} to have them opened all the same."] if refused else [])))
