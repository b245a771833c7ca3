"""Which key does what, and the text file that changes it.

``keys.toml`` in the user's configuration folder holds lines such as ``disk = "SPACE"`` or ``zoom_in = ["PLUS", "CTRL+UP"]``;
actions it does not name keep their keys. ESC is not for the taking: it leaves a field, a list, full screen.

A letter, a digit or a sign is the *character* of that name, wherever the keyboard's layout has it; any other character can be written as itself,
``"#"``. With a modifier held a key counts by the character that it gives alone. The other names are keys.
"""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..text_files import read_text

MODIFIERS = ("CTRL", "SHIFT", "ALT", "SUPER")


class KeysError(ValueError):
    """A key file that cannot be used; the text names the file, the entry and what is allowed."""


@dataclass(frozen=True)
class Chord:
    """A key with the modifiers held, both by the names used in the file; `key` may be a character too."""

    key: str
    modifiers: tuple[str, ...] = ()

    @property
    def character(self) -> str | None:
        """The character asked for, in lower case; None for a key with a name."""
        return _SIGNS.get(self.key) or (self.key.lower() if len(self.key) == 1 else None)

    def __str__(self) -> str:
        return "+".join((*self.modifiers, self.key))


@dataclass(frozen=True)
class Action:
    """Something a key does.

    Attributes:
        name: as the key file names it.
        keys: the chords it has when no file says otherwise.
        help: what people read.
        held: whether it goes on while the key is down.
        flying: whether it is one of free flight: its keys are its own while the right mouse button is held, and others' else.
    """

    name: str
    keys: tuple[str, ...]
    help: str
    held: bool = False
    flying: bool = False


ACTIONS: tuple[Action, ...] = (
    Action("disk", ("SPACE",), "Disk on or off"),
    Action("spin", ("S",), "Schwarzschild (no spin) or Kerr"),
    Action("pause", ("P",), "Pause or go on"),
    Action("orbit_left", ("LEFT",), "Orbit to the left", held=True),
    Action("orbit_right", ("RIGHT",), "Orbit to the right", held=True),
    Action("orbit_up", ("UP",), "Orbit upwards", held=True),
    Action("orbit_down", ("DOWN",), "Orbit downwards", held=True),
    Action("zoom_in", ("PLUS", "EQUAL", "KEYPAD_ADD", "PAGE_UP"), "Move closer", held=True),
    Action("zoom_out", ("MINUS", "KEYPAD_SUBTRACT", "PAGE_DOWN"), "Move away", held=True),
    Action("fly_forward", ("W",), "With the right mouse button held: fly forward", held=True, flying=True),
    Action("fly_back", ("S",), "… back", held=True, flying=True),
    Action("fly_left", ("A",), "… to the left", held=True, flying=True),
    Action("fly_right", ("D",), "… to the right", held=True, flying=True),
    Action("fly_up", ("E",), "… up", held=True, flying=True),
    Action("fly_down", ("Q",), "… down", held=True, flying=True),
    Action("reset", ("R",), "Camera back to where the preset has it"),
    Action("reset_all", ("SHIFT+R",), "Everything back to the presets in force"),
    Action("undo", ("CTRL+Z",), "Undo"),
    Action("redo", ("CTRL+SHIFT+Z", "CTRL+Y"), "Redo"),
    Action("remove", ("DELETE",), "Remove the thing that is picked"),
    Action("help", ("F1", "H"), "This window"),
    Action("search", ("CTRL+P",), "Search settings, presets, views and commands"),
    Action("picture", ("F12",), "Save the picture (PNG with the scene inside)"),
    Action("picture_window", ("SHIFT+F12",), "Save a picture of any size, with any number of rays a pixel"),
    Action("record", ("F9",), "Record what the window shows as a film, or stop"),
    Action("record_exact", ("SHIFT+F9",), "Record frame by frame, every picture exact, however long each takes; or stop"),
    Action("full_screen", ("F11",), "Full screen"),
    Action("view", ("V",), "Next view: picture, steps, orders, g-factor, temperature, difference, conservation, unresolved"),
    Action("labels", ("L",), "Show or hide labels: shadow, rings, innermost stable orbit, sides"),
    Action("values", ("I",), "Show or hide the values of the pixel under the mouse: r, φ, g, temperature, order, λ"),
    Action("panel", ("TAB",), "Show or hide panel and bar"),
    Action("panel_keys", ("F6",), "Panel by keys: arrows and TAB go, SPACE and ENTER take, ESC leaves"),
    Action("overlay", ("O",), "Show or hide figures and compass"),
    Action("chart", ("C",), "Show or hide the live chart: error and cost of the methods on this view"),
    Action("line", ("B",), "Show or hide the profile of a line that the disk emits, of each order of image"),
    Action("light", ("K",), "Show or hide the light curve: the light of the whole picture over a turn of what moves"),
    Action("paths", ("G",), "Show or hide the path view: a click on the picture shows that ray in space, step by step"),
    Action("sides", ("D",), "Divide the picture or not: another method or preset on the right, with the error and cost of both"),
    Action("timeline", ("T",), "Show or hide the flight: open one, play and scrub it, take keys from the view"),
    Action("save", ("CTRL+S",), "Save the scene"),
    Action("save_as", ("CTRL+SHIFT+S",), "Save the scene where you choose"),
    Action("open", ("CTRL+O",), "Open a scene or a picture that was saved here"),
    Action("copy", ("CTRL+SHIFT+C",), "Copy the scene as TOML"),
    Action("paste", ("CTRL+SHIFT+V",), "Take the scene from the clipboard"),
    Action("quit", ("CTRL+Q",), "Close the viewer"),
)

FLYING = frozenset(action.name for action in ACTIONS if action.flying)
"""The actions of free flight."""

_SIGNS = {
    "PLUS": "+", "MINUS": "-", "EQUAL": "=", "COMMA": ",", "PERIOD": ".", "SLASH": "/", "SEMICOLON": ";", "APOSTROPHE": "'", "BACKSLASH": "\\",
    "LEFT_BRACKET": "[", "RIGHT_BRACKET": "]", "GRAVE_ACCENT": "`",
}  # fmt: skip
_NAMED = ("SPACE", "TAB", "ENTER", "BACKSPACE", "INSERT", "DELETE", "HOME", "END", "PAGE_UP", "PAGE_DOWN", "LEFT", "RIGHT", "UP", "DOWN")
_KEYPAD = ("KEYPAD_ADD", "KEYPAD_SUBTRACT", "KEYPAD_MULTIPLY", "KEYPAD_DIVIDE", "KEYPAD_ENTER", *(f"KEYPAD_{n}" for n in range(10)))
_SPELT = {"KEYPAD_ADD": "keypad +", "KEYPAD_SUBTRACT": "keypad -", "PAGE_UP": "PAGE UP", "PAGE_DOWN": "PAGE DOWN"}
KEY_NAMES = (*"ABCDEFGHIJKLMNOPQRSTUVWXYZ", *"0123456789", *(f"F{n}" for n in range(1, 13)), *_NAMED, *_SIGNS, *_KEYPAD)

Bindings = Mapping[str, tuple[Chord, ...]]


def shown(chords: tuple[Chord, ...]) -> str:
    """`chords` as people read them; nothing for none."""
    return "   ".join("+".join((*chord.modifiers, (chord.character or _SPELT.get(chord.key, chord.key)).upper())) for chord in chords)


def parse_chord(text: str) -> Chord:
    """The chord that `text` says, e.g. ``"CTRL+S"`` or ``"CTRL+#"``; case does not matter.

    Raises:
        KeysError: unknown key or modifier.
    """
    said = text.replace(" ", "")
    if said == "+" or said.endswith("++"):
        said = said[:-1] + "PLUS"
    *modifiers, key = said.split("+")
    modifiers = [word.upper() for word in modifiers]
    for word in modifiers:
        if word not in MODIFIERS:
            raise KeysError(f"{text!r}: no such modifier {word!r}; allowed are {', '.join(MODIFIERS)}")
    name = _names_of_signs().get(key, key.upper())
    if name not in KEY_NAMES and not (len(key) == 1 and key.isprintable()):
        raise KeysError(f"{text!r}: no such key {name!r}{_nearest(name, KEY_NAMES) or '; use names such as SPACE, F5, A, PLUS, KEYPAD_ADD, or a character'}")
    key = name if name in KEY_NAMES else key.lower()
    return Chord(key, tuple(word for word in MODIFIERS if word in modifiers))


def _names_of_signs() -> Mapping[str, str]:
    return {sign: name for name, sign in _SIGNS.items()}


def default_bindings() -> Bindings:
    """Every action with the chords of `ACTIONS`."""
    return {action.name: tuple(parse_chord(text) for text in action.keys) for action in ACTIONS}


def load_bindings(path: Path) -> Bindings:
    """The bindings that the file at `path` gives; the defaults when there is no file.

    Raises:
        KeysError: not TOML, an unknown action or key, or one key for two actions.
    """
    if not path.is_file():
        return default_bindings()
    try:
        entries = tomllib.loads(read_text(path))
    except (OSError, ValueError) as error:
        raise KeysError(f"{path}: cannot be read: {error}") from None
    bindings = dict(default_bindings())
    for name, given in entries.items():
        if name not in bindings:
            raise KeysError(f"{path}: {name}: no such action{_nearest(name, bindings) or '; allowed are ' + ', '.join(bindings)}")
        try:
            bindings[name] = _chords(given)
        except KeysError as error:
            raise KeysError(f"{path}: {name}: {error}") from None
    _refuse_doubles(bindings, path)
    return bindings


def template() -> str:
    """A key file that says what is so without one, with every line explained."""
    lines = ["# Keys of the viewer. A line gives one chord or a list; [] leaves the action without a key.", ""]
    for action in ACTIONS:
        chords = ", ".join(f'"{text}"' for text in action.keys)
        lines.append(f"{action.name} = [{chords}]  # {action.help}")
    return "\n".join(lines) + "\n"


def _chords(given: Any) -> tuple[Chord, ...]:
    texts = [given] if isinstance(given, str) else given
    if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
        raise KeysError(f'got {given!r}; allowed is a chord such as "CTRL+S" or a list of chords')
    return tuple(parse_chord(text) for text in texts)


def _refuse_doubles(bindings: Bindings, path: Path) -> None:
    owner: dict[tuple[bool, Chord], str] = {}
    for name, chords in bindings.items():
        for chord in chords:
            where = name in FLYING, chord
            if owner.setdefault(where, name) != name:
                raise KeysError(f"{path}: {name}: {chord} already belongs to {owner[where]}; give one of the two another key")


def _nearest(word: str, known: Any) -> str:
    near = difflib.get_close_matches(word, list(known), n=1)
    return f"; did you mean {near[0]}?" if near else ""
