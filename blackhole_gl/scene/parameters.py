"""``[parameters.NAME]`` of a plug-in's header → the scene's field. The type of its ``default`` is the parameter's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any

from . import headers
from .headers import Between, CatalogueError
from .schema import Field, Kind, SceneError


@dataclass(frozen=True)
class _Number:
    default: int | float
    range: tuple[int | float, ...]
    help: str
    unit: str = ""
    physical: int | float | None = None

    def __post_init__(self) -> None:
        _two_in_order("range", self.range)

    def field(self, key: str, place: str) -> Field:
        kind: Kind = "int" if isinstance(self.default, int) else "float"
        low, high = self.range
        return Field(key, kind, self.default, low, high, self.unit, self.help, physical=self.physical)


@dataclass(frozen=True)
class _Switch:
    default: bool
    help: str
    physical: bool | None = None

    def field(self, key: str, place: str) -> Field:
        return Field(key, "switch", self.default, help=self.help, physical=self.physical)


@dataclass(frozen=True)
class _Choice:
    default: str
    options: tuple[str, ...]
    help: str
    physical: str | None = None

    def __post_init__(self) -> None:
        wrong = next((word for word in self.options if not headers.is_name(word)), None)
        if wrong is not None:
            raise ValueError(f"options: got {wrong!r}; allowed are {headers.NAMES}")

    def field(self, key: str, place: str) -> Field:
        return Field(key, "choice", self.default, help=self.help, options=self.options, physical=self.physical)


@dataclass(frozen=True)
class _Text:
    default: str
    length: Annotated[int, Between(1, 10_000)]
    help: str

    def field(self, key: str, place: str) -> Field:
        return Field(key, "text", self.default, 0, self.length, help=self.help)


@dataclass(frozen=True)
class _File:
    default: str
    suffixes: tuple[str, ...]
    help: str

    def __post_init__(self) -> None:
        if not self.suffixes or any(not word.startswith(".") or word != word.lower() for word in self.suffixes):
            raise ValueError(f'suffixes: got {list(self.suffixes)}; allowed is a list like [".png", ".jpg"], in small letters')

    def field(self, key: str, place: str) -> Field:
        return Field(key, "file", self.default, help=self.help, suffixes=self.suffixes)


@dataclass(frozen=True)
class _List:
    default: list
    length: tuple[int, ...]
    help: str
    element: dict | None = None
    columns: dict | None = None

    def __post_init__(self) -> None:
        _two_in_order("length", self.length)
        if (self.element is None) == (self.columns is None):
            raise ValueError("a list needs either an element = {…}, one number or word, or columns.NAME = {…}, what each of its records holds")

    def field(self, key: str, place: str) -> Field:
        element = None if self.element is None else _cell("", {"help": self.help, **self.element}, f"{place}.element")
        columns = tuple(_cell(name, headers.table(entry, f"{place}.{name}"), f"{place}.{name}") for name, entry in (self.columns or {}).items())
        least, most = self.length
        return Field(key, "list", tuple(self.default), least, most, help=self.help, element=element, columns=columns)


_Parameter = _Number | _Switch | _Choice | _Text | _File | _List

_STRINGS: Mapping[str, type[_Parameter]] = {"options": _Choice, "suffixes": _File, "length": _Text}
_OTHERS: Mapping[type, type[_Parameter]] = {bool: _Switch, int: _Number, float: _Number, list: _List}


def field_of(key: str, entry: Mapping[str, Any], place: str) -> Field:
    """The field `key` that the header's `entry` declares; `place` is what errors begin with.

    Raises:
        CatalogueError: an entry is missing, unknown or of the wrong kind, or the default is not allowed.
    """
    if "default" not in entry:
        raise CatalogueError(f"{place}: the header lacks 'default', whose type is the parameter's")
    item = headers.record(_class_of(entry, place), entry, place).field(key, place)
    try:
        default, physical = item.check(item.default), None if item.physical is None else item.check(item.physical)
    except SceneError as error:
        raise CatalogueError(f"{place}: default or physical: {error.message}") from None
    return replace(item, default=default, physical=physical)


def _class_of(entry: Mapping[str, Any], place: str) -> type[_Parameter]:
    default = entry["default"]
    if isinstance(default, str):
        found = [kind for name, kind in _STRINGS.items() if name in entry]
        if len(found) != 1:
            raise CatalogueError(f"{place}: a default in quotes needs one of {', '.join(_STRINGS)}: a choice's words, a file's endings, a text's length")
        return found[0]
    return _OTHERS.get(type(default), _Number)


def _cell(name: str, entry: Mapping[str, Any], place: str) -> Field:
    """What a list's entries are, or hold under `name`."""
    if name and not headers.is_name(name):
        raise CatalogueError(f"{place}: got the name {name!r}; allowed are {headers.NAMES}")
    found = field_of(name, entry, place)
    if found.kind == "list":
        raise CatalogueError(f"{place}: got a list in a list; allowed are all other parameters")
    return found


def _two_in_order(name: str, given: tuple[float, ...]) -> None:
    if len(given) != 2 or not given[0] <= given[1]:
        raise ValueError(f"{name}: got {list(given)}; allowed is {name} = [least, most]")
