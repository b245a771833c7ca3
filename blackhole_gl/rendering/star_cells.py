"""The stars of the procedural sky, one in each cell of four grids on a cube round the world: made once, as a table that the sky looks up.

Flux F is distributed as N(>F) ∝ F^(−4/3) between a grid's limits; the fainter the grid, the finer. All randomness is from integers
(`hash_bits`, the mixer of shaders/common/noise.glsl), so that every machine has the same stars.
"""

from __future__ import annotations

import numpy as np

from .sky_cube import cell_share, on_cube

Array = np.ndarray

GRIDS = ((7, 1.0, 20.0), (16, 0.2536, 1.0), (34, 0.0783, 0.2536), (60, 0.0309, 0.0783))
"""(cells across a face, least flux, largest flux); shaders/skies/procedural.glsl names the same."""
MARGIN = 0.16
"""Of a cell, that a star keeps from its border."""
POLE = np.array([0.284464, 0.562425, 0.776375])
KELVIN_STEP = 32.0


def table() -> Array:
    """All grids, float32 (rows, columns, 4): the star of cell (x, y) of a face is at row first + y, column face·cells + x; the grids' rows follow each other.

    Each entry is the unit vector to the star and its flux, 0 where there is none. The flux' ten lowest bits hold its temperature in steps of 32 K.
    """
    found = np.zeros((sum(cells for cells, _, _ in GRIDS), 6 * GRIDS[-1][0], 4), np.float32)
    row = 0
    for cells, low, high in GRIDS:
        y, face, x = np.meshgrid(np.arange(cells), np.arange(6), np.arange(cells), indexing="ij")
        stars = _stars(x, y, face, cells, low, high).reshape(cells, 6 * cells, 4)
        found[row : row + cells, : 6 * cells] = stars
        row += cells
    return found


def _stars(x: Array, y: Array, face: Array, cells: int, low: float, high: float) -> Array:
    mixed = hash_bits(_u32(x * 0x9E3779B1) + _u32(y * 0x85EBCA77) + _u32(face * 0xC2B2AE3D) + np.uint32(cells * 0x27D4EB2F & 0xFFFFFFFF))
    jitter, draw = _three(mixed), _three(hash_bits(mixed + np.uint32(1)))
    place = [(cell + MARGIN + (1.0 - 2.0 * MARGIN) * shift) / cells * 2.0 - 1.0 for cell, shift in ((x, jitter[0]), (y, jitter[1]))]
    direction = on_cube(face, *place)
    height = direction @ POLE
    richness = 0.25 + 0.75 / (1.0 + 20.0 * height * height)
    exists = richness * cell_share(*place) >= draw[0]
    tail = (low / high) ** (4.0 / 3.0)
    flux = np.where(exists, low * (1.0 + (tail - 1.0) * draw[1]) ** -0.75, 0.0)
    kelvin = 2900.0 + 5500.0 * draw[2] + 18000.0 * draw[2] ** 8
    bits = flux.astype(np.float32).view(np.uint32) & np.uint32(0xFFFFFC00) | np.rint(kelvin / KELVIN_STEP).astype(np.uint32)
    packed = np.where(exists, bits, np.uint32(0)).view(np.float32)
    return np.concatenate([direction, packed[..., None]], axis=-1).astype(np.float32)


def hash_bits(h: Array) -> Array:
    """The mixer of shaders/common/noise.glsl on uint32."""
    h = (h ^ (h >> np.uint32(16))) * np.uint32(0x7FEB352D)
    h = (h ^ (h >> np.uint32(15))) * np.uint32(0x846CA68B)
    return h ^ (h >> np.uint32(16))


def _u32(value: Array) -> Array:
    return (np.asarray(value, np.int64) & 0xFFFFFFFF).astype(np.uint32)


def _three(h: Array) -> tuple[Array, Array, Array]:
    first, second, third = ((h >> np.uint32(shift) & np.uint32(1023)) / 1023.0 for shift in (0, 10, 20))
    return first, second, third
