"""The figures of the constellations as tables in which a ray finds the lines near it: what shaders/skies/catalogue.glsl looks up where they are shown."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..resources import assets_dir
from . import star_catalogue
from .sky_cube import place_of

Array = np.ndarray

CELLS = 32
"""Across a face of the cube."""

GAP = 0.008
"""What a line keeps from its stars, rad."""

REACH = 0.012
"""Beside a line, in which rays find it, rad."""

_STEP = 0.004  # rad, between places of a line that are asked for their cells
_MOST = 15

CONSTANTS = {"CONSTELLATION_CELLS": CELLS}


def cells() -> Array:
    """Float32 (rows, columns, 1): 16·first line + number of lines, 0 where there is none. Cell (x, y) of a face is at column face·cells + x and row y."""
    return _made()[0]


def lines() -> Array:
    """Float32 (rows, 2, 4), a row each, those of a cell one below the other: pole of its great circle; middle and cosine of half its length."""
    return _made()[1]


@lru_cache(maxsize=1)
def _made() -> tuple[Array, Array]:
    return tables(*ends())


def ends() -> tuple[Array, Array]:
    """Unit vectors (n, 3) to both ends of each line of the figures.

    Raises:
        FileNotFoundError: they, or the stars, are missing from assets/.
    """
    with np.load(assets_dir() / "constellations.npz") as stored:
        pairs = stored["pairs"]
    numbers, directions = star_catalogue.numbered()
    order = np.argsort(numbers)
    found = directions[order[np.searchsorted(numbers, pairs, sorter=order)]]
    return found[:, 0], found[:, 1]


def tables(first: Array, second: Array) -> tuple[Array, Array]:
    """`cells` and `lines` of those between the unit vectors `first` and `second` (n, 3); what is shorter than both gaps is left out."""
    pole, middle = np.cross(first, second), first + second
    length = np.arctan2(np.linalg.norm(pole, axis=1), np.sum(first * second, axis=1))
    kept = length > 3.0 * GAP
    pole, middle, half = (_unit(pole[kept]), _unit(middle[kept]), 0.5 * length[kept] - GAP)
    where = [_cells_of(*line) for line in zip(pole, middle, half)]
    line, cell = np.repeat(np.arange(len(where)), [len(found) for found in where]), np.concatenate(where)
    order = np.argsort(cell, kind="stable")
    count = np.bincount(cell, minlength=6 * CELLS * CELLS)
    if count.max() > _MOST:
        raise ValueError(f"{count.max()} lines of figures meet in a cell; allowed are {_MOST}")
    numbers = np.where(count > 0, 16.0 * (np.cumsum(count) - count) + count, 0.0)
    entries = np.stack([np.c_[pole, 0.0 * half], np.c_[middle, np.cos(half)]], axis=1)[line[order]]
    return numbers.reshape(CELLS, 6 * CELLS, 1).astype(np.float32), entries.astype(np.float32)


def _cells_of(pole: Array, middle: Array, half: float) -> Array:
    """Cells that come within reach of a line."""
    turn = np.linspace(-half, half, max(int(2.0 * half / _STEP), 2))[:, None]
    on = np.cos(turn) * middle + np.sin(turn) * np.cross(pole, middle)
    face, u, v = place_of(np.concatenate([on + away * pole for away in (-REACH, 0.0, REACH)]))
    x, y = (np.minimum((0.5 * (place + 1.0) * CELLS).astype(int), CELLS - 1) for place in (u, v))
    return np.unique((y * 6 + face) * CELLS + x)


def _unit(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
