"""What a value of a scene may be: its kind, range, unit and meaning.

A `Field` is the single owner of a key's range. Scene records, plug-in headers, the panel,
the preset loader and the documentation tables all read it.
"""

from __future__ import annotations

import math
import reprlib
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from .frozen import FrozenMap

Kind = Literal["float", "int", "switch", "choice", "text", "file", "list"]
Value: TypeAlias = float | int | bool | str | tuple | FrozenMap

WHOLE_NUMBER_LIMIT = 2**63
"""TOML promises no more; longer ones overflow float(), and Python writes none of more than 4300 digits."""


class SceneError(ValueError):
    """A value that a scene cannot hold. Its text names the key, the value given and what is allowed.

    Attributes:
        key: the dotted key, e.g. ``disk.outer_radius``.
        message: what the text says after the key.
        entry: of a list's value, the number of the entry at fault, from 1; else 0.
    """

    def __init__(self, key: str, message: str, entry: int = 0):
        super().__init__(f"{key}: {message}")
        self.key, self.message, self.entry = key, message, entry

    def __reduce__(self) -> tuple:
        return ValueError.__new__, (type(self), *self.args), vars(self)  # not by __init__, which takes more than the text


def _from_numpy(value: Any) -> Any:
    """`value`, or the number, switch or list of Python's own that a NumPy scalar or array holds."""
    return value.tolist() if hasattr(value, "dtype") and hasattr(value, "tolist") else value


@dataclass(frozen=True)
class Field:
    """One settable value.

    Attributes:
        key: dotted key, e.g. ``hole.spin`` or ``disk.turbulence.strength``.
        kind: ``float``, ``int``, ``switch``, ``choice``, ``text``, ``file`` (a path; whether the file is there is seen when it is used) or
            ``list`` (a tuple in a scene: of values, or of records).
        default: the value when nothing is said.
        low, high: closed range of a number, in `unit`, of a text's length in characters, or of a list's in entries; infinite for the others.
        unit: unit shown to people; empty for dimensionless values.
        help: what the value means physically.
        options: the allowed words of a choice.
        physical: the value at which the scene is physics and not art; None where both are.
        art: whether it is the picture maker's to choose, for no physics names a value.
        allow_infinity: whether ``inf`` is allowed beyond `high`.
        suffixes: what a file's name may end in, e.g. ``.png``.
        element: what each entry of a list of values is.
        columns: what each entry of a list of records holds; the fields' keys are the names in the record.
    """

    key: str
    kind: Kind
    default: Value
    low: float = -math.inf
    high: float = math.inf
    unit: str = ""
    help: str = ""
    options: tuple[str, ...] = ()
    physical: Value | None = None
    allow_infinity: bool = False
    suffixes: tuple[str, ...] = ()
    element: Field | None = None
    columns: tuple[Field, ...] = ()
    art: bool = False

    @property
    def glsl_name(self) -> str:
        """The key as a GLSL identifier, e.g. ``disk_outer_radius``."""
        return self.key.replace(".", "_")

    def allowed(self) -> str:
        """A phrase that says what this field takes."""
        if self.kind == "switch":
            return "true or false"
        if self.kind == "choice":
            return "one of " + ", ".join(self.options)
        if self.kind == "text":
            return f"text of at most {self.high:g} characters"
        if self.kind == "file":
            return f"the path of a file that ends in {' or '.join(self.suffixes)}"
        if self.kind == "list":
            each = self.element.allowed() if self.element else "a table with " + ", ".join(column.key for column in self.columns)
            return f"a list of {self.low:g} to {self.high:g} entries, each {each}"
        number = "a whole number" if self.kind == "int" else "a number"
        unit = f" {self.unit}" if self.unit else ""
        infinity = ", or inf" if self.allow_infinity else ""
        return f"{number} from {self.low:g} to {self.high:g}{unit}{infinity}"

    def check(self, value: Any) -> Value:
        """`value` in the field's own type. Numbers and lists may be NumPy's.

        Raises:
            SceneError: of another type, out of range or not a number.
        """
        value = _from_numpy(value)
        if self.kind == "switch":
            if isinstance(value, bool):
                return value
        elif self.kind in ("choice", "text", "file"):
            if isinstance(value, str) and self._holds(value):
                return value
        elif self.kind == "list":
            if isinstance(value, (list, tuple)):
                return self._entries(value)
        elif isinstance(value, (int, float)) and not isinstance(value, bool):
            if abs(value) < 1e300 and self._in_range(value) or value == math.inf and self.allow_infinity:
                return int(value) if self.kind == "int" else float(value)
        raise SceneError(self.key, f"got {describe(value)}; allowed is {self.allowed()}{self._nearest(value)}")

    def _in_range(self, value: float) -> bool:
        if self.kind == "int" and value != int(value):
            return False
        return self.low <= value <= self.high

    def _holds(self, text: str) -> bool:
        if self.kind == "choice":
            return text in self.options
        if any("\ud800" <= letter <= "\udfff" or letter == "\0" for letter in text):  # no file and no TOML can carry them
            return False
        return len(text) <= self.high if self.kind == "text" else text == "" or text.lower().endswith(self.suffixes)

    def _entries(self, given: list | tuple) -> tuple[Value, ...]:
        if not self.low <= len(given) <= self.high:
            raise SceneError(self.key, f"got {len(given)} entries; allowed is {self.allowed()}")
        return tuple(self._entry(number, entry) for number, entry in enumerate(given, 1))

    def _entry(self, number: int, given: Any) -> Value:
        """Entry `number` of a list's value."""
        if self.element is not None:
            return self._cell(self.element, given, f"entry {number}", number)
        names = [column.key for column in self.columns]
        if not isinstance(given, Mapping):
            raise SceneError(self.key, f"entry {number}: got {describe(given)}; allowed is a table with {', '.join(names)}", number)
        for name in given:
            if name not in names:
                raise SceneError(self.key, f"entry {number}: there is no {name!r}; allowed are {', '.join(names)}{nearest(str(name), names)}", number)
        cells = ((column, given.get(column.key, column.default)) for column in self.columns)
        return FrozenMap((column.key, self._cell(column, value, f"entry {number}, {column.key}", number)) for column, value in cells)

    def _cell(self, item: Field, given: Any, place: str, number: int) -> Value:
        try:
            return item.check(given)
        except SceneError as error:
            raise SceneError(self.key, f"{place}: {error.message}", number) from None

    def _nearest(self, value: Any) -> str:
        return nearest(value, self.options) if isinstance(value, str) else ""

    def parse(self, text: str) -> Value:
        """The value that `text` (from a command line) says; lists are written as in TOML.

        Raises:
            SceneError: `text` does not say a value this field takes.
        """
        word = text.strip()
        if self.kind == "text":
            return self.check(text)
        if self.kind == "switch" and word.lower() in _WORDS:
            return _WORDS[word.lower()]
        if self.kind == "list":
            return self.check(_list_of(word))
        if self.kind in ("float", "int"):
            try:
                return self.check(float(word))
            except ValueError as error:
                if isinstance(error, SceneError):
                    raise
                raise SceneError(self.key, f"got {text!r}; allowed is {self.allowed()}") from None
        return self.check(word)


_WORDS = {"true": True, "on": True, "yes": True, "1": True, "false": False, "off": False, "no": False, "0": False}


def _list_of(text: str) -> Any:
    """The list that TOML `text` says; the text itself where it says none."""
    try:
        found = tomllib.loads(f"list = {text}")
    except (ValueError, RecursionError):
        return text
    return found["list"] if len(found) == 1 else text


def describe(value: Any) -> str:
    """A short name for what was given in the place of a value."""
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, (list, tuple)):
        return "a list"
    if isinstance(value, int) and abs(value) >= WHOLE_NUMBER_LIMIT:
        return "a whole number of more than 64 bits"
    return reprlib.repr(value) if value is None or isinstance(value, (str, int, float)) else str(value)


def number_of(value: Value) -> float:
    """A scene's `value` whose field takes numbers, or is a switch, as a number.

    Raises:
        TypeError: it is something else.
    """
    if not isinstance(value, (int, float)):
        raise TypeError(f"got {describe(value)}; allowed is the value of a field that takes numbers")
    return value


def nearest(word: str, known: Iterable[str]) -> str:
    """What to add to an error: the known word most like `word`; empty when none is alike."""
    near = _close(word, list(known), 0.6)
    return f"; did you mean {near[0]}?" if near else ""


def nearest_key(key: str, known: Iterable[str]) -> str | None:
    """The known key most like `key`, or None when none is alike."""
    known = list(known)
    near = _close(key, known, 0.5)
    if near:
        return near[0]
    last = key.rsplit(".", 1)[-1]
    tails = {k.rsplit(".", 1)[-1]: k for k in known}
    near = _close(last, list(tails), 0.6)
    return tails[near[0]] if near else None


def _close(word: str, known: list[str], cutoff: float) -> list[str]:
    import difflib  # only in a mistake

    return difflib.get_close_matches(word, known, n=1, cutoff=cutoff)
