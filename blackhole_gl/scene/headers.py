"""Plug-in headers: TOML inside ``/*--- … ---*/`` → frozen records whose annotations say what each entry may be."""

from __future__ import annotations

import dataclasses
import re
import tomllib
import types
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

from .schema import nearest

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

T = TypeVar("T", bound="DataclassInstance")

NAMES = "names of letters, digits and single _ between them, that begin with a letter"
"""What `is_name` allows, in words."""


class CatalogueError(ValueError):
    """A plug-in's header is missing or wrong; the text names the file and the entry, what was given and what is allowed."""


@dataclass(frozen=True)
class Between:
    """For ``Annotated[float, Between(low, high)]``: the closed range of a number."""

    low: float
    high: float


def read_header(text: str, name: str) -> dict[str, Any]:
    """The TOML header of a plug-in's `text`; `name` is used in errors.

    Raises:
        CatalogueError: no header, or not TOML.
    """
    start, end = text.find("/*---"), text.find("---*/")
    if start < 0 or end < start:
        raise CatalogueError(f"{name}: no header; a plug-in begins with /*--- TOML ---*/")
    if "*/" in text[start : end + 3]:
        raise CatalogueError(f"{name}: the header holds */, which ends the GLSL comment it lives in")
    try:
        return tomllib.loads(text[start + 5 : end])
    except tomllib.TOMLDecodeError as error:
        raise CatalogueError(f"{name}: the header is not TOML: {error}") from None


def record(kind: type[T], entries: Mapping[str, Any], place: str, **known: Any) -> T:
    """The frozen record of class `kind` that `entries` say; a class may refuse them as a whole with a ValueError.

    Args:
        place: what errors begin with, e.g. ``kerr.glsl``.
        known: values that the header does not say.

    Raises:
        CatalogueError: an entry is missing, unknown, or not of the kind that the class's annotation says.
    """
    refuse_unknown(entries, (name for name in entry_names(kind) if name not in known), place)
    hints = _hints(kind)
    values = dict(known)
    for field in dataclasses.fields(kind):
        if field.name in entries:
            values[field.name] = _checked(hints[field.name], entries[field.name], f"{place}: {field.name}")
        elif field.default is dataclasses.MISSING and field.name not in known:
            raise CatalogueError(f"{place}: the header lacks {field.name!r}; allowed is {_allowed(hints[field.name])}")
    try:
        return kind(**values)
    except ValueError as error:
        raise CatalogueError(f"{place}: {error}") from None


@cache
def _hints(kind: type) -> Mapping[str, Any]:
    """The annotations of a class. Kept: working them out took half of the time that the headers take at the start."""
    return get_type_hints(kind, include_extras=True)


def is_name(text: str) -> bool:
    """Whether `text` can be part of a scene's key and of a GLSL identifier."""
    return re.fullmatch(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*", text) is not None


def entry_names(kind: type) -> tuple[str, ...]:
    """The names of the entries that a record of class `kind` is made from."""
    return tuple(field.name for field in dataclasses.fields(kind))


def refuse_unknown(entries: Iterable[str], known: Iterable[str], place: str) -> None:
    """Raises a CatalogueError for the first of `entries` that is not `known`."""
    known = tuple(known)
    for name in entries:
        if name not in known:
            raise CatalogueError(f"{place}: got the entry {name!r}; allowed are {', '.join(known)}{nearest(name, known)}")


def table(entries: Any, place: str) -> Mapping[str, Any]:
    """`entries`, which has to be a table.

    Raises:
        CatalogueError: it is none.
    """
    if not isinstance(entries, dict):
        raise CatalogueError(f"{place}: got {entries!r}; allowed is a table")
    return entries


def _checked(hint: Any, given: Any, place: str) -> Any:
    value = _fitted(hint, given)
    if value is None:
        hint_word = nearest(given, _words(hint)) if isinstance(given, str) else ""
        raise CatalogueError(f"{place}: got {given!r}; allowed is {_allowed(hint)}{hint_word}")
    return value


def _fitted(hint: Any, given: Any) -> Any:
    """`given` in the type that `hint` says, or None where it does not fit: TOML has no null."""
    origin = get_origin(hint)
    if origin in (Union, types.UnionType):
        return next((value for part in get_args(hint) if part is not type(None) and (value := _fitted(part, given)) is not None), None)
    if origin is Annotated:
        kind, bounds = get_args(hint)
        value = _fitted(kind, given)
        return value if value is not None and bounds.low <= value <= bounds.high else None
    if origin is Literal:
        return given if isinstance(given, str) and given in get_args(hint) else None
    if origin is tuple:
        values = [_fitted(get_args(hint)[0], entry) for entry in given] if isinstance(given, list) else [None]
        return None if any(value is None for value in values) else tuple(values)
    if hint is float:
        return float(given) if type(given) in (int, float) else None
    return given if type(given) is hint else None


def _allowed(hint: Any) -> str:
    """A phrase that says what an entry of this type takes."""
    origin = get_origin(hint)
    if origin in (Union, types.UnionType):
        return " or ".join(_allowed(part) for part in get_args(hint) if part is not type(None))
    if origin is Annotated:
        kind, bounds = get_args(hint)
        return f"{_allowed(kind)} from {bounds.low:g} to {bounds.high:g}"
    if origin is Literal:
        return "one of " + ", ".join(get_args(hint))
    if origin is tuple:
        return f"a list, each of it {_allowed(get_args(hint)[0])}"
    return _WORDS_FOR[hint]


_WORDS_FOR = {bool: "true or false", int: "a whole number", float: "a number", str: "text in quotes", list: "a list", dict: "a table"}


def _words(hint: Any) -> tuple[str, ...]:
    if get_origin(hint) is Literal:
        return get_args(hint)
    return tuple(word for part in get_args(hint) for word in _words(part))
