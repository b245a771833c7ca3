"""Key chords as imgui and GLFW see them. A field that is typed in keeps its keys."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from imgui_bundle import imgui

# isort: split
import glfw

from .keys import ACTIONS, FLYING, Bindings, Chord
from .typed_keys import Press, Typing, latin

_RENAMED = {"LEFT": "left_arrow", "RIGHT": "right_arrow", "UP": "up_arrow", "DOWN": "down_arrow"}
_MODIFIERS = {"CTRL": imgui.Key.mod_ctrl, "SHIFT": imgui.Key.mod_shift, "ALT": imgui.Key.mod_alt, "SUPER": imgui.Key.mod_super}
_FUNCTION_KEY = re.compile(r"F\d+")
_HELD = frozenset(action.name for action in ACTIONS if action.held)
_SIGNS = {
    "apostrophe": "'", "comma": ",", "minus": "-", "period": ".", "slash": "/", "semicolon": ";", "equal": "=", "left_bracket": "[", "backslash": "\\",
    "right_bracket": "]", "grave_accent": "`",
}  # fmt: skip
_OTHERS = {"oem102": "world_2"}  # keys that a US keyboard has not, by imgui's names and GLFW's
_PRINTED = {name: name for name in "abcdefghijklmnopqrstuvwxyz"} | {f"_{digit}": digit for digit in "0123456789"} | _SIGNS
_PRINTED_KEYS = {int(imgui.Key[name]): character for name, character in _PRINTED.items()} | {int(imgui.Key[name]): "" for name in _OTHERS}
_GLFW_KEYS = {int(imgui.Key[name]): getattr(glfw, f"KEY_{_OTHERS.get(name, name).strip('_').upper()}") for name in (*_PRINTED, *_OTHERS)}
_KEYPAD = tuple(int(key) for key in imgui.Key if str(key.name).startswith("keypad") and key.name != "keypad_enter")


def imgui_chord(chord: Chord) -> int:
    """`chord`, of a key with a name, as the number that `imgui.shortcut` takes."""
    code = _imgui_key(chord)
    for word in chord.modifiers:
        code |= int(_MODIFIERS[word])
    return code


def _imgui_key(chord: Chord) -> int:
    if chord.key.startswith("KEYPAD_") and chord.key[-1].isdigit():
        return int(imgui.Key[chord.key.lower().replace("_", "")])
    return int(imgui.Key[_RENAMED.get(chord.key, chord.key.lower())])


class Layout:
    """What the keyboard's keys give alone.

    Args:
        name_of: GLFW's key → the character, or None.
        is_down: whether a key of GLFW's is down.
    """

    def __init__(self, name_of: Callable[[int], str | None], is_down: Callable[[int], bool]):
        self._name_of, self._is_down = name_of, is_down

    def alone(self, key: int) -> str:
        """What imgui's `key` gives with no other key down.

        imgui names a key by its character where it has a name for that, else by its place, so that two keys of a layout may be one of imgui's.
        """
        names = {glfw_key: self._name_of(glfw_key) or "" for glfw_key in _GLFW_KEYS.values()}
        called = {glfw_key: _NAMED_SO.get(names[glfw_key].lower(), place) for place, glfw_key in _GLFW_KEYS.items()}
        possible = [glfw_key for glfw_key, name in called.items() if name == key]
        found = next(iter([glfw_key for glfw_key in possible if self._is_down(glfw_key)] or possible), None)
        printed = _PRINTED_KEYS[key]
        return latin(names[found], printed) if found is not None and len(names[found]) == 1 else printed


_NAMED_SO = {character: key for key, character in _PRINTED_KEYS.items() if character}


class Shortcuts:
    """Turns key presses into names of actions.

    Args:
        bindings: action → chords.
        layout: that of the keyboard.
    """

    def __init__(self, bindings: Bindings, layout: Layout):
        chords = [(name, chord) for name, chords in bindings.items() for chord in chords]
        self._by_character = [(name, chord) for name, chord in chords if chord.character is not None]
        self._by_key = [(name, chord, imgui_chord(chord)) for name, chord in chords if chord.character is None]
        self._layout = layout
        self._typing = Typing(_PRINTED_KEYS, _KEYPAD)
        self._down: dict[str, int] = {}
        self._held_before: frozenset[str] = frozenset()

    def poll(self, panel_keys: bool = False, flying: bool = False) -> tuple[list[str], list[str]]:
        """The actions pressed in this frame, and those held. Call once in each frame.

        Args:
            panel_keys: whether the keys without a character work the panel, or a list that is open.
            flying: whether keys are those of free flight first.
        """
        if imgui.get_io().want_text_input:
            self._down.clear()
            self._typing.forget()
            return [], []
        now = _modifiers_down()
        # Let go in the frame in which a key was struck, they were down with it: a frame may be long. They may also have been let go before it, and nobody can
        # tell: of the events of a frame imgui keeps the order, but what it gives Python of each is its kind alone.
        meant = now | self._held_before
        pressed, held = [], {name for name, key in self._down.items() if imgui.is_key_down(imgui.Key(key))}
        self._down = {name: self._down[name] for name in held}
        begun = list(self._begun(panel_keys, meant, now))
        of_flight = {name for name, _ in begun if name in FLYING} if flying else set()
        held = {name for name in held if flying or name not in FLYING}
        for name, key in begun:
            if (name in FLYING) != bool(of_flight):
                continue
            if name not in _HELD:
                pressed.append(name)
                continue
            held.add(name)  # for this frame at least
            if key is not None:
                self._down[name] = key
        self._held_before = now
        return pressed, list(held)

    def _begun(self, panel_keys: bool, meant: frozenset[str], now: frozenset[str]) -> Iterator[tuple[str, int | None]]:
        """The actions whose chord was struck in this frame, and the key to be let go; `meant` are the modifiers that count, `now` those still down."""
        for name, chord, code in self._by_key:
            if panel_keys and not (chord.modifiers or _FUNCTION_KEY.fullmatch(chord.key)):
                continue
            if _is_struck(chord, code, meant, now):
                yield name, _imgui_key(chord)
        presses, modifiers = self._presses(meant)
        for press in presses:
            for name, chord in self._by_character:
                if is_meant(chord, press, modifiers):
                    yield name, press.key

    def _presses(self, down: frozenset[str]) -> tuple[list[Press], tuple[str, ...]]:
        """What was struck in this frame: characters, or keys while the modifiers `down` give none; and the modifiers with it."""
        io = imgui.get_io()
        modifiers = tuple(word for word in _MODIFIERS if word in down)
        new = [key for key in (*_PRINTED_KEYS, *_KEYPAD) if imgui.is_key_pressed(imgui.Key(key), False)]
        characters = [character for character in map(chr, io.input_queue_characters) if character.isprintable() and character != " "]
        mute = {"CTRL", "ALT", "SUPER"} & set(modifiers) and not characters
        presses = self._typing.take(characters, () if mute else new, lambda key: imgui.is_key_down(imgui.Key(key)))
        if mute:
            return [Press(self._layout.alone(key), key) for key in new if key in _PRINTED_KEYS], modifiers
        # A character has used up the modifiers that it took, but for SHIFT.
        return presses, ("SHIFT",) if "SHIFT" in down else ()


def _modifiers_down() -> frozenset[str]:
    io = imgui.get_io()
    states = {"CTRL": io.key_ctrl, "SHIFT": io.key_shift, "ALT": io.key_alt, "SUPER": io.key_super}
    return frozenset(word for word, is_down in states.items() if is_down)


def _is_struck(chord: Chord, code: int, meant: frozenset[str], now: frozenset[str]) -> bool:
    """Whether `chord`, of a key with a name and imgui's `code`, was struck in this frame with the modifiers `meant`, of which those `now` are still down."""
    if meant == now:
        return imgui.shortcut(code, imgui.InputFlags_.route_global.value)
    return set(chord.modifiers) == meant and imgui.is_key_pressed(imgui.Key(_imgui_key(chord)), False)


def is_meant(chord: Chord, press: Press, modifiers: tuple[str, ...]) -> bool:
    """Whether `press`, with `modifiers` held, is that of `chord`, which asks for a character.

    SHIFT is part of what makes a sign or a digit a sign or a digit, so that only a letter's chord is another with it. Where modifiers keep a key from
    giving its character, "+" is SHIFT and the key of "=" too, as on most keyboards, and a digit the key in its place.
    """
    if not {"CTRL", "ALT", "SUPER"} & set(modifiers):
        shift = chord.character is not None and chord.character.isalpha() or bool(chord.modifiers)
        return press.character == chord.character and (not shift or modifiers == chord.modifiers)
    if modifiers == chord.modifiers:
        return press.character == chord.character or (press.key is not None and chord.key.isdigit() and _PRINTED_KEYS[press.key] == chord.key)
    return chord.key == "PLUS" and press.character == "=" and modifiers == tuple(word for word in _MODIFIERS if word in (*chord.modifiers, "SHIFT"))
