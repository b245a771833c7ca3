"""What the window keeps from one run to the next, and the file that it is kept in. No imgui here."""

from __future__ import annotations

import os
import sys
import tomllib
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

import tomlkit

from ..output.files import write_whole
from ..resources import user_config_dir
from ..scene import Scene, presets
from ..text_files import read_text
from .state import WindowState

_FILE = "window.toml"
_LAST_SCENE = "last_scene.toml"
SMALLEST_TEXT, LARGEST_TEXT = 0.6, 3.0
LEAST_PANEL_EM, MOST_PANEL_EM = 12.0, 80.0


@dataclass(frozen=True)
class Kept:
    """What is kept.

    Attributes:
        keep_window, keep_panel, keep_scene: whether the next window begins with this one's size, panel and scene.
        start_line: whether a line over the picture says at start how to move.
        text_size: of the text, over that of the screen.
        window_size: width and height in units of a 96 dpi screen.
        panel_shown: whether the panel and the bar are.
        panel_em: width of the panel, in units of the text's size.
    """

    keep_window: bool = True
    keep_panel: bool = True
    keep_scene: bool = False
    start_line: bool = True
    text_size: float = 1.0
    window_size: tuple[int, int] = (1280, 800)
    panel_shown: bool = True
    panel_em: float = 25.6  # in which the longest label of the shipped fields fits

    @property
    def first_size(self) -> tuple[int, int]:
        """Of the window, in units of a 96 dpi screen."""
        return self.window_size if self.keep_window else Kept.window_size

    @property
    def first_panel_em(self) -> float:
        """The panel's first width."""
        return self.panel_em if self.keep_panel else Kept.panel_em


def file() -> Path:
    """Where it is kept; it need not exist."""
    return user_config_dir() / _FILE


def last_scene_file() -> Path:
    """Where the last scene is kept, with its time; there only where it is to be kept."""
    return user_config_dir() / _LAST_SCENE


def load() -> tuple[Kept, str]:
    """What was kept, and what the user is to be told about the file; nothing as a rule.

    A file that cannot be read is set aside and the defaults are taken.
    """
    path = file()
    try:
        entries = tomllib.loads(read_text(path))
    except FileNotFoundError:
        return Kept(), ""
    except (OSError, ValueError) as error:
        return Kept(), _set_aside(path, f"cannot be read: {error}")
    known = {item.name for item in fields(Kept)}
    for name in entries.keys() & known:
        is_fit, allowed = _ALLOWED[name]
        if not is_fit(entries[name]):
            return Kept(), _set_aside(path, f"{name}: got {entries[name]!r}; allowed is {allowed}")
    values: dict[str, Any] = {name: tuple(value) if isinstance(value, list) else value for name, value in entries.items() if name in known}
    unknown = sorted(entries.keys() - known)
    return Kept(**values), f"{path}: {', '.join(unknown)}: unknown here, and left out. A newer version may have written it." if unknown else ""


def save(kept: Kept) -> None:
    """Writes the file.

    Raises:
        OSError: it cannot be written.
    """
    document = tomlkit.document()
    document.add(tomlkit.comment("What the window keeps; written when it closes."))
    for name, value in asdict(kept).items():
        document.add(name, list(value) if isinstance(value, tuple) else value)
    write_whole(file(), tomlkit.dumps(document).encode("utf-8"))


def save_scene(scene: Scene, time: float) -> None:
    """Keeps `scene` at scene time `time`.

    Raises:
        OSError: it cannot be written.
    """
    path = last_scene_file()
    write_whole(path, presets.picture_text(scene, time, path.parent).encode("utf-8"))


def remember(was: Kept, state: WindowState, size: tuple[int, int], panel_em: float) -> None:
    """Keeps what `was` says of a window of this `size` [units of a 96 dpi screen], as wide a panel, and `state`. What cannot be written is told on stderr."""
    window: dict[str, Any] = {"window_size": size} if was.keep_window else {}
    panel: dict[str, Any] = {"panel_shown": state.show_panel, "panel_em": round(panel_em, 2)} if was.keep_panel else {}
    now = replace(was, **window, **panel)
    try:
        if now != Kept() or file().exists():
            save(now)
        if now.keep_scene:
            save_scene(state.scene, state.time)
        else:
            last_scene_file().unlink(missing_ok=True)
    except OSError as error:
        print(f"blackhole-gl: {error.filename}: cannot be written: {error.strerror or error}", file=sys.stderr)


def _set_aside(path: Path, why: str) -> str:
    aside = path.with_name(path.name + ".damaged")
    try:
        os.replace(path, aside)
    except OSError:
        return f"{path}: {why}. The window opens as it comes."
    return f"{path}: {why}. It now lies in {aside.name}, and the window opens as it comes."


def _is_number(low: float, high: float) -> Callable[[Any], bool]:
    return lambda value: isinstance(value, (int, float)) and not isinstance(value, bool) and low <= value <= high


def _is_size(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(isinstance(side, int) and 100 <= side <= 16384 for side in value)


def _is_switch(value: Any) -> bool:
    return isinstance(value, bool)


_SWITCH = _is_switch, "true or false"
_ALLOWED: dict[str, tuple[Callable[[Any], bool], str]] = {
    **dict.fromkeys(("keep_window", "keep_panel", "keep_scene", "start_line", "panel_shown"), _SWITCH),
    "text_size": (_is_number(SMALLEST_TEXT, LARGEST_TEXT), f"a number from {SMALLEST_TEXT:g} to {LARGEST_TEXT:g}"),
    "window_size": (_is_size, "[width, height], each from 100 to 16384"),
    "panel_em": (_is_number(LEAST_PANEL_EM, MOST_PANEL_EM), f"a number from {LEAST_PANEL_EM:g} to {MOST_PANEL_EM:g}"),
}
