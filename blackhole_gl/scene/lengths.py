"""Lengths in Schwarzschild radii, as scenes have them, or in M = GM/c², as papers do: converted where files are read and written alone. r_s = 2 M."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from .frozen import FrozenMap
from .schema import Field, SceneError

UNITS = ("r_s", "M")

_M_PER_RS = 2.0
_POWERS = {"r_s": 1, "1/r_s": -1, "(r_s/c)/s": 1, "rad/(r_s/c)": -1, "rad·c/r_s": -1, "rad c/r_s": -1}
"""What power of a length a unit has; those that do not name one have none."""


def factor(unit: str) -> float:
    """How many of `unit` one r_s is."""
    return 1.0 if unit == "r_s" else _M_PER_RS


def field_in(item: Field, unit: str) -> Field:
    """`item` as a file in `unit` has it: default, range and unit.

    Raises:
        SceneError: its own unit is one of a length that cannot be told in another.
    """
    if unit == "r_s":
        return item
    scale = factor(unit) ** _power(item)
    element = None if item.element is None else field_in(item.element, unit)
    columns = tuple(field_in(column, unit) for column in item.columns)
    if scale == 1.0 or item.kind == "list":  # whose range is that of its entries' number
        return replace(item, element=element, columns=columns)
    default = item.default * scale if isinstance(item.default, (int, float)) else item.default
    return replace(item, low=item.low * scale, high=item.high * scale, default=default, unit=item.unit.replace("r_s", unit))


def in_rs(item: Field, value: Any, unit: str) -> Any:
    """A file's `value` of `item`, in r_s where its lengths are in `unit`; what is no number, or has another shape than the field, stays as it is."""
    return _scaled(item, value, 1.0 / factor(unit))


def in_unit(item: Field, value: Any, unit: str) -> Any:
    """A scene's `value` of `item` as a file in `unit` has it."""
    return _scaled(item, value, factor(unit))


def _scaled(item: Field, value: Any, length: float) -> Any:
    if length == 1.0:
        return value
    if isinstance(value, (list, tuple)):
        return type(value)(_entry(item, entry, length) for entry in value)
    power = _power(item)
    return value * length**power if power and isinstance(value, (int, float)) and not isinstance(value, bool) else value


def _entry(item: Field, entry: Any, length: float) -> Any:
    if item.element is not None:
        return _scaled(item.element, entry, length)
    columns = {column.key: column for column in item.columns}
    if not isinstance(entry, Mapping):
        return entry
    scaled = {name: _scaled(columns[name], value, length) if name in columns else value for name, value in entry.items()}
    return FrozenMap(scaled.items()) if isinstance(entry, FrozenMap) else scaled


def _power(item: Field) -> int:
    if item.unit not in _POWERS and "r_s" in item.unit:
        raise SceneError(item.key, f"its unit {item.unit} cannot be told in M; allowed are files whose lengths are in r_s")
    return _POWERS.get(item.unit, 0)
