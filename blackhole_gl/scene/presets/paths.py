"""Paths in scenes and in files: a preset's relative paths start at its own folder, so that it can be moved together with what it names, and lead to
nowhere else unless the user says so. Names of assets stay as they are."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from .. import files
from ..frozen import FrozenMap
from ..schema import Field, Value


def anchored(item: Field, value: Value, folder: Path) -> Value:
    """`value` of `item` with paths that were relative to `folder`, as a file there has them."""
    return _mapped(item, value, lambda path: str(folder / Path(path).expanduser()))


def relative(item: Field, value: Value, folder: Path) -> Value:
    """`value` of `item` as a file in `folder` is to have it: relative where the path leads below the folder."""

    def as_written(path: str) -> str:
        whole = Path(path).absolute()
        return whole.relative_to(folder).as_posix() if whole.is_relative_to(folder) else str(whole)

    return _mapped(item, value, as_written)


def kept_within(item: Field, value: Value, folder: Path | None) -> Value:
    """The anchored `value` of `item` without the paths that do not lead below `folder`; of no folder, without any."""
    return _mapped(item, value, lambda path: path if _is_within(path, folder) else "")


def outside(item: Field, value: Value, folder: Path | None) -> list[str]:
    """The paths in the anchored `value` of `item` that `kept_within` leaves out."""
    found: list[str] = []

    def look(path: str) -> str:
        if not _is_within(path, folder):
            found.append(path)
        return path

    _mapped(item, value, look)
    return found


def _is_within(path: str, folder: Path | None) -> bool:
    return folder is not None and files.is_within(Path(path), folder)


def _mapped(item: Field, value: Value, change: Callable[[str], str]) -> Value:
    """`value` with `change` made to every path in it; an empty one stays, as does an asset's name."""
    if item.kind == "file" and isinstance(value, str):
        return change(value) if value and not files.is_asset(value) else value
    if not isinstance(value, tuple):
        return value
    if item.element is not None:
        return tuple(_mapped(item.element, entry, change) for entry in value)
    return tuple(FrozenMap((column.key, _mapped(column, entry[column.key], change)) for column in item.columns) for entry in value)
