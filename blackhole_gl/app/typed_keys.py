"""Characters that keys give, whatever the keyboard's layout, and the keys that gave them. No imgui here.

A toolkit reports keys and characters apart: *key 27 went down*, *"+" was typed*. Which key is "+" depends on the layout, so a shortcut asks for the
character; but only the key tells how long it is held.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass

_PATIENCE = 3  # frames that a key waits for its character: a mouse that moves in between puts it off by one


@dataclass(frozen=True)
class Press:
    """A character typed, in lower case, and the key that gave it; None where none did, as with an input method."""

    character: str
    key: int | None


class Typing:
    """Finds the key of every character.

    Args:
        printed: key → the character on it on a US keyboard, for every key that may give one.
        keypad: keys whose characters are no presses, as they have names of their own.
    """

    def __init__(self, printed: Mapping[int, str], keypad: Collection[int] = ()):
        self._printed, self._keypad = printed, keypad
        self._waiting: dict[int, int] = {}  # key → frames that it may still wait
        self._gave: set[int] = set()

    def forget(self) -> None:
        """For when what is typed goes elsewhere."""
        self._waiting.clear()
        self._gave.clear()

    def take(self, characters: Iterable[str], new_keys: Iterable[int], is_down: Callable[[int], bool]) -> list[Press]:
        """The presses of one frame.

        Args:
            characters: typed in this frame, those repeated by a key held among them.
            new_keys: that went down in this frame.
        """
        self._gave = {key for key in self._gave if is_down(key)}
        self._waiting = {key: left - 1 for key, left in self._waiting.items() if left > 1} | dict.fromkeys(new_keys, _PATIENCE)
        presses = []
        for character in characters:
            key = self._origin(character)
            if key is None and self._gave:
                continue  # a key that is held repeats itself
            if key is not None:
                del self._waiting[key]
                self._gave.add(key)
            if key not in self._keypad:
                presses.append(Press(latin(character, self._printed.get(key, "") if key is not None else ""), key))
        return presses

    def _origin(self, character: str) -> int | None:
        """The waiting key that has `character` printed on it, or else the newest."""
        by_age = sorted(self._waiting, key=lambda key: -self._waiting[key])
        return next((key for key in by_age if self._printed.get(key) == character.lower()), by_age[0] if by_age else None)


def latin(character: str, printed: str) -> str:
    """`character` in lower case; a letter of another script stands for what a US keyboard has there, `printed`, if anything."""
    foreign = character.isalpha() and not unicodedata.name(character, "").startswith("LATIN")
    return printed if foreign and printed else character.lower()
