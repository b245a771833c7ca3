"""The stars of a catalogue as textures in which the footprint of a ray finds those that it holds: what shaders/skies/catalogue.glsl looks up.

There are `LEVELS` grids on the cube round the world, each of half as many cells across a face as the one before and for footprints twice as wide. A cell
lists the stars that lie in it or within the reach of a kernel beside it, the brightest first, so that a ray looks into its own cell of one grid and nowhere
else. A coarser grid lists fewer stars: those brighter than `FAINTEST`, of a crowd the brightest `MOST`. Those that it leaves out are the haze of that
level, so that a star seen singly and its haze always add up to its flux.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from . import galaxy_band, star_catalogue
from .sampling import between, halved, packed
from .sky_cube import on_face, place_of, place_on, slope, solid_angle
from .star_catalogue import GALAXY_CENTRE, GALAXY_POLE, Stars
from .star_cells import KELVIN_STEP

Array = np.ndarray

CELLS = 256
"""Across a face, in the finest grid."""

REACH = 0.003
"""Radius of the widest kernel that the finest grid is for, rad; the next one's is twice that."""

FAINTEST = (np.inf, 8.0, 6.8, 5.6, 4.4, 3.2)
"""Hp of the faintest stars in each grid."""

LEVELS = len(FAINTEST)
MOST = 15
"""Stars in a list."""

ROW = 1024
"""Entries of lists in a row of their texture."""

TILE = 512
"""Texels of the haze across a face's tile, an eighth of them beyond the face."""

CONSTANTS = {"CATALOGUE_CELLS": CELLS, "CATALOGUE_LEVELS": LEVELS, "CATALOGUE_MOST": MOST, "CATALOGUE_ROW": ROW}

_INNER = 7.0 / 8.0  # of a tile is the face
_ROUND = 12  # places on a star's rim that are asked for their cells


@dataclass(frozen=True)
class Index:
    """Attributes:
    cells: float32 (rows, columns, 1): 16·first entry + number of entries. Cell (x, y) of a face is at column face·cells + x and row first + y; grids follow.
    entries: float32 (rows, ROW, 4): unit vector and flux, whose ten lowest bits are the temperature in steps of 32 K, negative where the next grid
        does not have the star. The first is of no flux.
    haze: float16 (rows, columns, 4) of each level: the galaxy's radiance, 0…1, and that of the stars which the grid leaves out, in stars of Hp = 0 a steradian.
        Linear, as what lies between two levels has to be their mean.
    """

    cells: Array
    entries: Array
    haze: tuple[Array, ...]


def cells() -> Array:
    """The table of that name."""
    return _shipped().cells


def entries() -> Array:
    """The table of that name."""
    return _shipped().entries


def haze() -> tuple[Array, ...]:
    """The table of that name, level by level."""
    return _shipped().haze


@lru_cache(maxsize=1)
def _shipped() -> Index:
    return index(star_catalogue.continued(star_catalogue.hipparcos()), _galaxy_tiles())


def index(stars: Stars, galaxy: Array) -> Index:
    """Of `stars`, the brightest first, and of a `galaxy` of that radiance, 0…1 on the tiles of the finest haze (6, TILE, TILE, 3)."""
    within, lists, numbers = [], [], []
    first = 1
    for level, faintest in enumerate(FAINTEST):
        across = CELLS >> level
        bright = np.flatnonzero(stars.flux >= 10.0 ** (-0.4 * faintest))
        star, cell = _listed(stars.direction[bright], across, REACH * 2.0**level)
        member = np.zeros(len(stars.flux), bool)
        member[bright] = True
        member[bright[star[_rank(cell) >= MOST]]] = False
        kept = member[bright[star]]
        star, cell = bright[star[kept]], cell[kept]
        count = np.bincount(cell, minlength=6 * across * across)
        start = first + np.cumsum(count) - count
        numbers.append(np.where(count > 0, 16.0 * start + count, 1.0).reshape(across, 6 * across))
        first += len(star)
        lists.append(star)
        within.append(member)
    packed = _packed(stars)
    signs = [np.where(above[star], 1.0, -1.0) for star, above in zip(lists, [*within[1:], np.zeros(len(stars.flux), bool)])]
    return Index(_stacked(numbers), _entries(stars.direction, packed, lists, signs), _haze(stars, within, galaxy))


def _listed(direction: Array, across: int, reach: float) -> tuple[Array, Array]:
    """(star, cell) of every cell that comes within `reach` of a star, cell by cell and in each in the order of the stars. A few come a little less near."""
    face, u, v = place_of(direction)
    low_x, high_x, inner_x = _spanned(u, reach * slope(u, v), across)
    low_y, high_y, inner_y = _spanned(v, reach * slope(v, u), across)
    inner = inner_x & inner_y
    stars, cells = _beyond_edges(direction, np.flatnonzero(~inner), across, reach)
    for right in range(3):
        for up in range(3):
            star = np.flatnonzero(inner & (low_x + right <= high_x) & (low_y + up <= high_y))
            stars.append(star)
            cells.append(((low_y + up) * 6 + face)[star] * across + (low_x + right)[star])
    star, cell = np.concatenate(stars), np.concatenate(cells)
    order = np.argsort(cell * len(direction) + star)
    return star[order], cell[order]


def _spanned(place: Array, reach: Array, across: int) -> tuple[Array, Array, Array]:
    """First and last of the cells between place ± reach, and whether all of that is on the face."""
    low, high = (np.floor((0.5 * (place + side * reach + 1.0)) * across).astype(int) for side in (-1.0, 1.0))
    return low, high, (low >= 0) & (high < across)


def _beyond_edges(direction: Array, which: Array, across: int, reach: float) -> tuple[list[Array], list[Array]]:
    """The same of stars whose reach is on several faces, by places on their rims."""
    e1, e2 = _beside(direction[which])
    found = np.empty((len(which), _ROUND + 1), np.int64)
    for k in range(_ROUND + 1):
        turn = 2.0 * np.pi * k / _ROUND
        off = 0.0 if k == _ROUND else reach
        face, u, v = place_of(direction[which] + off * (np.cos(turn) * e1 + np.sin(turn) * e2))
        x, y = (np.minimum((0.5 * (place + 1.0) * across).astype(int), across - 1) for place in (u, v))
        found[:, k] = (y * 6 + face) * across + x
    found.sort(axis=1)
    new = np.ones(found.shape, bool)
    new[:, 1:] = found[:, 1:] != found[:, :-1]
    return [which[np.nonzero(new)[0]]], [found[new]]


def _beside(direction: Array) -> tuple[Array, Array]:
    """Two unit vectors at right angles to each of `direction`, and to each other."""
    side = np.where(np.abs(direction[:, 2:]) < 0.9, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
    e1 = np.cross(direction, side)
    e1 /= np.linalg.norm(e1, axis=1, keepdims=True)
    return e1, np.cross(direction, e1)


def _rank(cell: Array) -> Array:
    """Of each entry of sorted `cell`, how many of the same cell stand before it."""
    place = np.arange(len(cell))
    begins = np.ones(len(cell), bool)
    begins[1:] = cell[1:] != cell[:-1]
    return place - np.maximum.accumulate(np.where(begins, place, 0))


def _packed(stars: Stars) -> Array:
    """Fluxes with their temperatures in their ten lowest bits, float32 (n,)."""
    kelvin = np.clip(np.rint(stars.kelvin / KELVIN_STEP), 0, 1023).astype(np.uint32)
    return (stars.flux.astype(np.float32).view(np.uint32) & np.uint32(0xFFFFFC00) | kelvin).view(np.float32)


def _stacked(numbers: list[Array]) -> Array:
    found = np.ones((sum(len(part) for part in numbers), numbers[0].shape[1], 1), np.float32)
    row = 0
    for part in numbers:
        found[row : row + len(part), : part.shape[1], 0] = part
        row += len(part)
    return found


def _entries(direction: Array, packed: Array, lists: list[Array], signs: list[Array]) -> Array:
    star, sign = np.concatenate(lists), np.concatenate(signs)
    found = np.zeros((-(-(len(star) + 1 + MOST) // ROW), ROW, 4), np.float32)
    flat = found.reshape(-1, 4)
    flat[0, 0] = 1.0
    flat[1 : len(star) + 1, :3] = direction[star]
    flat[1 : len(star) + 1, 3] = packed[star] * sign
    return found


def _haze(stars: Stars, within: list[Array], galaxy: Array) -> tuple[Array, ...]:
    levels = []
    faces = [_near_face(face, stars.direction) for face in range(6)]
    for level, member in enumerate([*within, np.zeros(len(stars.flux), bool)]):
        tile = TILE >> level
        left = np.where(member, 0.0, stars.flux)
        starlight = np.stack([_starlight(*near, left, tile) for near in faces])
        levels.append(_atlas(np.concatenate([galaxy, starlight[..., None]], axis=-1).astype(np.float16)))
        galaxy = halved(galaxy)
    return tuple(levels)


def _places(tile: int) -> Array:
    """u or v of a tile's texels."""
    return ((np.arange(tile) + 0.5) / tile * 2.0 - 1.0) / _INNER


def _near_face(face: int, direction: Array) -> tuple[Array, Array, Array]:
    """Which stars lie on a face's tile, and where: 0…1 across it and up."""
    ahead, u, v = place_on(face, direction)
    near = np.flatnonzero(ahead & (np.abs(u) < 1.0 / _INNER) & (np.abs(v) < 1.0 / _INNER))
    return near, 0.5 * (u[near] * _INNER + 1.0), 0.5 * (v[near] * _INNER + 1.0)


def _starlight(near: Array, across: Array, up: Array, flux: Array, tile: int) -> Array:
    """Flux a steradian, (tile, tile): that of each star `near`, spread over the four texels about it."""
    place = _places(tile)
    area = solid_angle(place[None, :], place[:, None]) * (place[1] - place[0]) ** 2
    bright = flux[near] > 0.0
    x, y, light = across[bright] * tile + 0.5, up[bright] * tile + 0.5, flux[near[bright]]  # in texels, of a tile with a rim of one
    i, j = x.astype(int), y.astype(int)
    s, t = x - i, y - j
    rows = tile + 2
    found = np.zeros(rows * rows)
    for beside, share in ((0, (1 - s) * (1 - t)), (1, s * (1 - t)), (rows, (1 - s) * t), (rows + 1, s * t)):
        found += np.bincount(j * rows + i + beside, share * light, rows * rows)
    return found.reshape(rows, rows)[1:-1, 1:-1] / area


def _galaxy_tiles() -> Array:
    """Radiance of the galaxy's band in its place, (6, TILE, TILE, 3), 0…1."""
    root = galaxy_band.table().astype(np.float32) / np.float32(255.0)
    pixels, columns = packed(root), root.shape[1]
    u, v = np.meshgrid(*2 * [_places(TILE).astype(np.float32)])
    return np.stack([_band_at(pixels, columns, on_face(face, u, v)) for face in range(6)])


def _band_at(pixels: Array, columns: int, direction: Array) -> Array:
    """Radiance of the band towards `direction` (…, 3). Longitude grows to the left in the sky, as astronomers count it."""
    rows = len(pixels) // columns
    pole, centre = (axis.astype(np.float32) for axis in (GALAXY_POLE, GALAXY_CENTRE))
    height = direction @ pole
    longitude = np.arctan2(direction @ np.cross(pole, centre), direction @ centre)
    x = (longitude * np.float32(0.5 / np.pi) + np.float32(0.5)) * columns - np.float32(0.5)
    y = np.clip((height + np.float32(0.5)) * rows - np.float32(0.5), 0.0, rows - 1.0)
    root = between(pixels, columns, np.where(x < 0.0, x + columns, x), y, around=True)
    return np.where(np.abs(height)[..., None] < 0.5, root, np.float32(0.0)) ** 2


def _atlas(tiles: Array) -> Array:
    """Six tiles in one picture, three across: face 2·axis + side at column `axis`, row `side`."""
    tile = tiles.shape[1]
    return tiles.reshape(3, 2, tile, tile, 4).transpose(1, 2, 0, 3, 4).reshape(2 * tile, 3 * tile, 4)
