"""TOML text → checked values of a scene, and the errors that say what is wrong with it."""

from __future__ import annotations

import json
import re
import reprlib
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from .. import fields
from ..schema import Field, SceneError, Value, nearest_key

GROUPS = ("physics", "look", "quality", "scene")
# A switch that has a plug-in's parameters below it is written as this entry of their table.
SWITCH_ENTRY = "enabled"
_TEXT_ENTRIES = ("title", "description", "group", "version")
_NUMBER_ENTRIES = ("rank", "time")
# TOML promises no more; longer ones overflow float().
_WHOLE_NUMBER_LIMIT = 2**63


class PresetError(SceneError):
    """A preset that cannot be found, read or used.

    Attributes:
        key: the dotted key at fault; empty where no single key is.
        source: the file, or the words ``--set``; empty where there is none.
        line: line in the file, from 1; None where unknown.
    """

    def __init__(self, message: str, *, key: str = "", source: str = "", line: int | None = None):
        place = f"{source}, line {line}" if line else source
        ValueError.__init__(self, ": ".join(part for part in (place, key, message) if part))
        self.key, self.source, self.line = key, source, line


@dataclass(frozen=True)
class Preset:
    """What a preset says.

    Attributes:
        group: one of `GROUPS`, or empty.
        rank: place in lists of its group, smallest first.
        time: scene time of the picture it came from, r_s/c; None for other presets.
        values: the scene's values it sets, by dotted key, checked.
    """

    title: str = ""
    description: str = ""
    group: str = ""
    version: str = ""
    rank: float = 100.0
    time: float | None = None
    values: Mapping[str, Value] = field(default_factory=dict)


def parse(text: str, source: str = "preset") -> Preset:
    """The preset in the TOML `text`; `source` is what errors call it.

    Raises:
        PresetError: not TOML, or an entry that a scene does not have or cannot hold.
    """
    try:
        data = tomllib.loads(text)
    except RecursionError:
        raise PresetError("not TOML that can be read: nested too deeply", source=source) from None
    except ValueError as error:
        # tomllib's own errors name line and column; Python's (a number of 5000 digits, say) are ValueErrors as well
        raise PresetError(f"not TOML: {error}", source=source) from None
    return _Reader(source, text).read(data)


class _Reader:
    """Checks one parsed TOML document, entry by entry."""

    def __init__(self, source: str, text: str):
        self._source, self._text = source, text
        self._values: dict[str, Value] = {}

    def read(self, data: Mapping[str, Any]) -> Preset:
        about: dict[str, Any] = {}
        for name, value in data.items():
            if name in _TEXT_ENTRIES + _NUMBER_ENTRIES:
                about[name] = self._about(name, value)
            else:
                self._walk(_quoted(name), value)
        return Preset(**about, values=self._values)

    def _about(self, name: str, value: Any) -> str | float:
        if name in _NUMBER_ENTRIES:
            allowed = "a finite number"
            if type(value) in (int, float) and abs(value) < _WHOLE_NUMBER_LIMIT:
                return float(value)
        elif name == "group":
            allowed = "one of " + ", ".join(GROUPS)
            if value in GROUPS:
                return value
        else:
            allowed = "text in quotes"
            if isinstance(value, str):
                return value
        raise self._error(name, f"got {_describe(value)}; allowed is {allowed}")

    def _walk(self, key: str, value: Any) -> None:
        item = fields().get(key)
        is_switch = item is not None and item.kind == "switch"
        if isinstance(value, dict) and (key in tables() or is_switch):
            for name, entry in value.items():
                if is_switch and name == SWITCH_ENTRY:
                    self._put(item, entry)
                else:
                    self._walk(f"{key}.{_quoted(name)}", entry)
        elif item is not None:
            self._put(item, value)
        elif key in tables():
            raise self._error(key, f"got {_describe(value)}; allowed is a table, [{key}]")
        else:
            raise self._error(key, unknown_key(key))

    def _put(self, item: Field, value: Any) -> None:
        try:
            self._values[item.key] = check_value(item, value)
        except SceneError as error:
            raise self._error(item.key, message_of(error)) from None

    def _error(self, key: str, message: str) -> PresetError:
        return PresetError(message, key=key, source=self._source, line=_line_of(key, self._text))


def check_value(item: Field, value: Any) -> Value:
    """`value` in the field's own type; types that no field takes are refused here, with a short name for what was given."""
    scalar = isinstance(value, (bool, float, str)) or (isinstance(value, int) and abs(value) < _WHOLE_NUMBER_LIMIT)
    if not scalar:
        raise SceneError(item.key, f"got {_describe(value)}; allowed is {item.allowed()}")
    return item.check(value)


def message_of(error: SceneError) -> str:
    """What `error` says after its key."""
    return str(error).removeprefix(f"{error.key}: ")


def _describe(value: Any) -> str:
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list):
        return "a list"
    if isinstance(value, int) and abs(value) >= _WHOLE_NUMBER_LIMIT:
        return "a whole number of more than 64 bits"
    return reprlib.repr(value) if isinstance(value, (str, int, float)) else str(value)


def unknown_key(key: str) -> str:
    """What to say of a key that no scene has: the nearest one, and those of its table."""
    near = nearest_key(key, [*fields(), *tables()])
    hint = f"; did you mean {near}?" if near else "."
    section = key.split(".")[0]
    if section in tables():
        allowed = [known for known in fields() if known.startswith(section + ".")]
    else:
        allowed = [*(f"[{table}]" for table in tables() if "." not in table), *_TEXT_ENTRIES, *_NUMBER_ENTRIES]
    return f"no such key{hint} Allowed here are {', '.join(allowed)}"


@cache
def tables() -> tuple[str, ...]:
    """Dotted names of all tables, sections before what lies in them."""
    tables = {}
    for key in fields():
        parts = key.split(".")
        for depth in range(1, len(parts)):
            tables[".".join(parts[:depth])] = None
    return tuple(sorted(tables, key=lambda table: table.count(".")))


def _line_of(key: str, text: str) -> int | None:
    """Line (from 1) of `text` that sets `key`, else that opens its table; None when neither is plain to see."""
    key, table, opened = _plain(key), "", None
    for number, line in enumerate(text.splitlines(), start=1):
        header = re.match(r"\s*\[\[?([^\[\]]+)\]", line)
        entry = re.match(r"\s*([\w\-.\"' ]+?)\s*=", line)
        if header:
            table = _plain(header[1])
            if opened is None and (key == table or key.startswith(table + ".")):
                opened = number
        elif entry:
            full = f"{table}.{_plain(entry[1])}".lstrip(".")
            if key == full or key.startswith(full + ".") or full == f"{key}.{SWITCH_ENTRY}":
                return number
    return opened


def _quoted(name: str) -> str:
    """`name` as TOML writes it in a key, so that ``"hole.spin"`` is not taken for ``hole.spin``."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name, ensure_ascii=False)


def _plain(name: str) -> str:
    return re.sub(r"[\s\"']", "", name)
