"""A table's mip levels, made here: a driver asked for them compiles programs of its own, which software renderers keep nowhere (80 ms, at every start)."""

from __future__ import annotations

import ctypes
from typing import Any

import moderngl
import numpy as np

_TEXTURE_2D = 0x0DE1
_UNPACK_ALIGNMENT = 0x0CF5
_FORMATS = (0x1903, 0x8227, 0x1907, 0x1908)  # GL_RED, GL_RG, GL_RGB, GL_RGBA
_TYPES = {  # GL_UNSIGNED_BYTE, GL_HALF_FLOAT, GL_FLOAT, each with the internal formats of 1 to 4 components
    np.dtype(np.uint8): (0x1401, (0x8229, 0x822B, 0x8051, 0x8058)),
    np.dtype(np.float16): (0x140B, (0x822D, 0x822F, 0x881B, 0x881A)),
    np.dtype(np.float32): (0x1406, (0x822E, 0x8230, 0x8815, 0x8814)),
}
_int, _enum = ctypes.c_int, ctypes.c_uint


def build(ctx: moderngl.Context, texture: moderngl.Texture, values: np.ndarray, made: list[np.ndarray] | None = None) -> None:
    """Gives `texture`, which holds `values` (rows, columns, 1 to 4) of uint8, float16 or float32, its smaller levels: those `made`, and means of the last."""
    made = made or []
    levels = [*made, *smaller((made or [values])[-1])]
    loader = getattr(ctx.mglo, "_context", None)
    if loader is None:  # moderngl has no way to a level but this, and need not go on to lead to the driver's functions
        texture.build_mipmaps()
        for number, level in enumerate(made, 1):
            texture.write(level.tobytes(), level=number, alignment=1)
        return
    set_pixels = _function(loader, "glPixelStorei", _enum, _int)
    set_level = _function(loader, "glTexImage2D", _enum, _int, _int, _int, _int, _int, _enum, _enum, ctypes.c_void_p)
    kind, internal = _TYPES[values.dtype]
    components = values.shape[2]
    texture.use()
    set_pixels(_UNPACK_ALIGNMENT, 1)
    for number, level in enumerate(levels, 1):
        rows, columns = level.shape[:2]
        set_level(_TEXTURE_2D, number, internal[components - 1], columns, rows, 0, _FORMATS[components - 1], kind, level.tobytes())


def smaller(values: np.ndarray) -> list[np.ndarray]:
    """The levels under `values` (rows, columns, components), largest first, of its type. Columns are halved before rows, and bytes rounded after either: what
    llvmpipe does, so that its pictures are as they were."""
    levels = [values]
    while max(levels[-1].shape[:2]) > 1:
        levels.append(_halved(_halved(levels[-1], 1), 0))
    return levels[1:]


def _halved(values: np.ndarray, axis: int) -> np.ndarray:
    """`values` at half as many places along `axis`, one at least, read linearly between those that there are."""
    size = values.shape[axis]
    if size == 1:
        return values
    fewer = size // 2
    if size % 2 == 0 and values.dtype == np.uint8:  # the same in whole numbers, in a fifth of the time
        low, high = (values[(slice(None),) * axis + (slice(first, None, 2),)].astype(np.uint16) for first in (0, 1))
        return (low + high + 1 >> 1).astype(np.uint8)
    place = (np.arange(fewer) + 0.5) * (size / fewer) - 0.5
    before = place.astype(int)
    low, high = (values.take(index, axis).astype(np.float32) for index in (before, before + 1))
    share = (place - before).astype(np.float32).reshape([-1 if k == axis else 1 for k in range(3)])
    found = low + share * (high - low)
    return (np.floor(found + 0.5) if values.dtype == np.uint8 else found).astype(values.dtype)


def _function(loader: Any, name: str, *arguments: Any) -> Any:
    return ctypes.CFUNCTYPE(None, *arguments)(loader.load_opengl_function(name))
