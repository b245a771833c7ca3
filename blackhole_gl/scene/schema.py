"""What a value of a scene may be: its kind, range, unit and meaning.

A `Field` is the single owner of a key's range. Scene records, plug-in headers, the panel,
the preset loader and the documentation tables all read it.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

Kind = Literal["float", "int", "switch", "choice"]
Value = float | int | bool | str


class SceneError(ValueError):
    """A value that a scene cannot hold. Its text names the key, the value given and what is allowed.

    Attributes:
        key: the dotted key, e.g. ``disk.outer_radius``.
    """

    def __init__(self, key: str, message: str):
        super().__init__(f"{key}: {message}")
        self.key = key


@dataclass(frozen=True)
class Field:
    """One settable value.

    Attributes:
        key: dotted key, e.g. ``hole.spin`` or ``disk.turbulence.strength``.
        kind: ``float``, ``int``, ``switch`` or ``choice``.
        default: the value when nothing is said.
        low, high: closed range of a number, in `unit`; None for switches and choices.
        unit: unit shown to people; empty for dimensionless values.
        help: what the value means physically.
        options: the allowed words of a choice.
        physical: the value at which the scene is physics and not art; None where both are.
        allow_infinity: whether ``inf`` is allowed beyond `high`.
    """

    key: str
    kind: Kind
    default: Value
    low: float | None = None
    high: float | None = None
    unit: str = ""
    help: str = ""
    options: tuple[str, ...] = ()
    physical: Value | None = None
    allow_infinity: bool = False

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
        number = "a whole number" if self.kind == "int" else "a number"
        unit = f" {self.unit}" if self.unit else ""
        infinity = ", or inf" if self.allow_infinity else ""
        return f"{number} from {self.low:g} to {self.high:g}{unit}{infinity}"

    def check(self, value: Any) -> Value:
        """`value` in the field's own type.

        Raises:
            SceneError: of another type, out of range or not a number.
        """
        if self.kind == "switch":
            if isinstance(value, bool):
                return value
        elif self.kind == "choice":
            if isinstance(value, str) and value in self.options:
                return value
        elif isinstance(value, (int, float)) and not isinstance(value, bool):
            if abs(value) < 1e300 and self._in_range(value) or value == math.inf and self.allow_infinity:
                return int(value) if self.kind == "int" else float(value)
        raise SceneError(self.key, f"got {value!r}; allowed is {self.allowed()}{self._nearest(value)}")

    def _in_range(self, value: float) -> bool:
        if self.kind == "int" and value != int(value):
            return False
        return self.low <= value <= self.high

    def _nearest(self, value: Any) -> str:
        return nearest(value, self.options) if isinstance(value, str) else ""

    def parse(self, text: str) -> Value:
        """The value that `text` (from a command line) says.

        Raises:
            SceneError: `text` does not say a value this field takes.
        """
        word = text.strip()
        if self.kind == "switch" and word.lower() in _WORDS:
            return _WORDS[word.lower()]
        if self.kind in ("float", "int"):
            try:
                return self.check(float(word))
            except ValueError as error:
                if isinstance(error, SceneError):
                    raise
                raise SceneError(self.key, f"got {text!r}; allowed is {self.allowed()}") from None
        return self.check(word)


_WORDS = {"true": True, "on": True, "yes": True, "1": True, "false": False, "off": False, "no": False, "0": False}


def nearest(word: str, known: Iterable[str]) -> str:
    """What to add to an error: the known word most like `word`; empty when none is alike."""
    near = difflib.get_close_matches(word, list(known), n=1)
    return f"; did you mean {near[0]}?" if near else ""


def nearest_key(key: str, known: Iterable[str]) -> str | None:
    """The known key most like `key`, or None when none is alike."""
    known = list(known)
    near = difflib.get_close_matches(key, known, n=1, cutoff=0.5)
    if near:
        return near[0]
    last = key.rsplit(".", 1)[-1]
    tails = {k.rsplit(".", 1)[-1]: k for k in known}
    near = difflib.get_close_matches(last, tails, n=1, cutoff=0.6)
    return tails[near[0]] if near else None
