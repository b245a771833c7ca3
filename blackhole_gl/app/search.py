"""What a search finds: settings of the scene and of the window, presets, views and commands. No imgui here."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Entry:
    """Something that can be found.

    Attributes:
        title: what it is called.
        kind: what it is, a word or two.
        key: what picks it elsewhere: a setting's key, a command's keys, a preset's name.
        help: what it is for.
        pick: does it, or shows it.
    """

    title: str
    kind: str
    key: str
    help: str
    pick: Callable[[], None]


def found(entries: Iterable[Entry], text: str) -> Sequence[Entry]:
    """The entries that have every word of `text` somewhere, the best first; all of them for no word at all."""
    words = text.lower().split()
    ranked = [(rank, entry) for entry in entries if (rank := _rank(entry, words)) is not None]
    return [entry for _, entry in sorted(ranked, key=lambda pair: pair[0])]


def _rank(entry: Entry, words: Sequence[str]) -> float | None:
    """How far from what is meant `entry` is: the sum over the words of where each is found; None where one is nowhere."""
    places = [_place(entry, word) for word in words]
    return None if None in places else sum(place for place in places if place is not None)


def _place(entry: Entry, word: str) -> int | None:
    title = entry.title.lower()
    where = (
        title.startswith(word),
        any(part.startswith(word) for part in title.split()),
        word in title,
        word in entry.key.lower(),
        word in entry.kind.lower(),
        word in entry.help.lower(),
    )
    return next((place for place, is_there in enumerate(where) if is_there), None)
