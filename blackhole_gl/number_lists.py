"""Lists of numbers that people give: CSV files whose columns have names, read as editors of all systems write them."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .shapes import Float
from .text_files import TextError, decimal_comma, read_text


class ListError(ValueError):
    """A list that cannot be used; the text names file, line and column."""


@dataclass(frozen=True)
class Allowed:
    """What a column takes: in words, and as a closed range."""

    words: str = "a finite number"
    low: float = -math.inf
    high: float = math.inf


@dataclass(frozen=True)
class NumberList:
    """A list of N rows as it was read.

    Attributes:
        values: (N, columns): of the columns asked for, in that order.
        names: all columns of the file.
        texts: a row of the file: what stands in its columns.
    """

    values: Float[np.ndarray, "N columns"]
    names: tuple[str, ...]
    texts: tuple[tuple[str, ...], ...]


def read(path: Path, wanted: tuple[str, ...], needed_by: str, allowed: Mapping[str, Allowed], taken: Collection[str] = ()) -> NumberList:
    """The numbers in the columns `wanted` of the CSV file at `path`.

    Args:
        needed_by: who needs these columns, for the message.
        allowed: of columns that do not take every finite number.
        taken: names that no column may have.

    Raises:
        ListError: no such columns, a row that has not as many values as there are columns, or a value that is not allowed.
        OSError: the file cannot be read.
    """
    try:
        reader = csv.reader(io.StringIO(read_text(path)), skipinitialspace=True)
        names = tuple(name.strip() for name in next(reader, ()))
        _refuse_names(names, wanted, needed_by, taken, path)
        rows = [(reader.line_num, row) for row in reader if row]
    except (csv.Error, TextError) as error:
        raise ListError(f"{path}: {error}") from None
    places = [names.index(name) for name in wanted]
    for line, row in rows:
        if len(row) != len(names):
            raise ListError(f"{path}, line {line}: {len(row)} values for {len(names)} columns; the decimal mark is a point: 0.5, not 0,5")
    values = [[_number(row[place], path, line, names[place], allowed.get(names[place], Allowed())) for place in places] for line, row in rows]
    return NumberList(np.array(values, float).reshape(-1, len(wanted)), names, tuple(tuple(row) for _, row in rows))


def _refuse_names(names: tuple[str, ...], wanted: tuple[str, ...], needed_by: str, taken: Collection[str], path: Path) -> None:
    if missing := [name for name in wanted if name not in names]:
        found = ",".join(names) or "nothing"
        hint = "; columns are separated by commas" if any(mark in found for mark in ";\t") else ""
        raise ListError(f"{path}: column {missing[0]} is missing; {needed_by} needs {','.join(wanted)}, the file has {found}{hint}")
    if twice := [name for name in names if name in taken or names.count(name) > 1]:
        raise ListError(f"{path}: column {twice[0]} is there twice in what is written; allowed is any other name")


def _number(text: str, path: Path, line: int, column: str, allowed: Allowed) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and allowed.low <= value <= allowed.high):
        raise ListError(f"{path}, line {line}, column {column}: got {text!r}; allowed is {allowed.words}{decimal_comma(text)}")
    return value
