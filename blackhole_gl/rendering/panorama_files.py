"""Panoramas of the user's → six tiles on the cube of `sky_cube` with levels of their own, or an error that says what is wrong with them.

They come from strangers, as pictures do (`picture_files`): nothing in one can do more than fail.
"""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path

import numpy as np

from ..scene import files
from ..scene.schema import SceneError
from . import radiance_hdr, stamps
from .picture_files import FORMATS, MOST_ASIDE, MOST_PIXELS
from .sampling import between, halved, packed
from .sky_cube import on_face
from .stamps import Stamp, Unusable

Array = np.ndarray

MOST_BYTES = 256 << 20
ALLOWED = (
    "a PNG, JPEG, WebP, BMP or Radiance .hdr file or a NumPy array .npy (rows, columns, 1, 3 or 4), of at most 256 MiB, 16384 pixels a side and 67 million in "
    "all, twice as wide as high, or of six square faces: 6:1, 1:6 or 3:2 (right, left, up, down, front, back), or a cross 4:3 or 3:4; or one of six square "
    "files whose names end in right, left, up, down, front and back (or px, nx, py, ny, pz, nz; posx, …), in one folder"
)
INNER = 7.0 / 8.0
"""Of a tile is the face; the rest goes on beyond its edges, so that no level is torn there."""

_FACES = (
    ("right", "left", "up", "down", "front", "back"), ("right", "left", "top", "bottom", "front", "back"),
    ("posx", "negx", "posy", "negy", "posz", "negz"), ("px", "nx", "py", "ny", "pz", "nz"),
)  # fmt: skip
"""What the names of six files may end in."""

LEVELS = 7
_LEAST_TILE, _MOST_TILE = 512, 1152
_ROWS = 64
_BRIGHTEST = 6.0e4  # what a half float holds

Light = Callable[[Array], Array]
"""Unit vectors (…, 3) of a panorama's own axes, x to its middle and z up → its light there (…, 3)."""


def stamp(key: str, value: str) -> Stamp:
    """The file that the panorama field `key` of `value` names, as it stands now.

    Raises:
        SceneError: it is not there, or is no file, or has too many bytes.
    """
    path = files.located(key, value)
    try:
        found = stamps.stamp(path, MOST_BYTES)
        faces = [stamps.stamp(face, MOST_BYTES).modified_ns for face in face_files(path)]
        return replace(found, modified_ns=max(faces)) if faces else found
    except Unusable as error:
        raise _error(key, path, str(error)) from None


def read(key: str, stamp: Stamp) -> tuple[Array, ...]:
    """Linear light of the panorama that the field `key` names: float16 (2·tile, 3·tile, 3) of each level, face 2·axis + side at column `axis`, row `side`.

    Raises:
        SceneError: it cannot be used; the text names key and file, and says why and what is allowed.
    """
    found = _read(stamp)
    if isinstance(found, str):
        raise _error(key, stamp.path, found)
    return found


def _error(key: str, path: Path, reason: str) -> SceneError:
    return SceneError(key, f"the panorama {path} cannot be used: {reason}; allowed is {ALLOWED}")


@lru_cache(maxsize=2)
def _read(stamp: Stamp) -> tuple[Array, ...] | str:
    try:
        paths = face_files(stamp.path)
        return _levels(*_seen(_stacked([_light(path) for path in paths]) if paths else _light(stamp.path)))
    except Unusable as error:
        return str(error)


def face_files(path: Path) -> list[Path]:
    """The six files, right, left, up, down, front, back, of which `path` is one; none where it is not, or one of them is not there."""
    for names in _FACES:
        for name in names:
            before = path.stem[: len(path.stem) - len(name)]
            if path.stem.lower().endswith(name):
                found = [path.with_name(f"{before}{other}{path.suffix}") for other in _cased(names, path.stem[len(before) :])]
                if all(one.is_file() for one in found):
                    return found
    return []


def _cased(names: tuple[str, ...], like: str) -> list[str]:
    """`names` in capitals, with a capital, or in small letters, as `like` is."""
    return [name.upper() if like.isupper() else name.capitalize() if like[0].isupper() else name for name in names]


def _stacked(faces: list[Array]) -> Array:
    """Six faces, one below the other."""
    sides = {side for face in faces for side in face.shape[:2]}
    if len(sides) != 1:
        raise Unusable(f"its six files have sides of {', '.join(map(str, sorted(sides)))} pixels, and have to be square and alike")
    return np.concatenate(faces)


def _light(path: Path) -> Array:
    """Linear light (rows, columns, 3) of the file at `path`."""
    data = stamps.content(path, MOST_BYTES)
    kind = path.suffix.lower()
    if kind == ".hdr":
        _refuse_size(*radiance_hdr.size(data))
        return np.clip(radiance_hdr.light(data), 0.0, _BRIGHTEST)
    return _array(data) if kind == ".npy" else _picture(data)


def _array(data: bytes) -> Array:
    """Linear light (rows, columns, 3) of a NumPy file: whole numbers are codes of sRGB, floats are light."""
    stream = io.BytesIO(data)
    try:
        version = np.lib.format.read_magic(stream)
        header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, _, dtype = header(stream)
        if len(shape) != 3 or shape[2] not in (1, 3, 4) or dtype.str[1:] not in ("u1", "u2", "f2", "f4", "f8"):
            raise Unusable(f"it holds {dtype} {shape}")
        _refuse_size(shape[1], shape[0])
        if shape[0] * shape[1] * shape[2] * dtype.itemsize != len(data) - stream.tell():
            raise Unusable("it is cut off")
        values = np.load(io.BytesIO(data), allow_pickle=False)
    except Unusable:
        raise
    except Exception as error:  # whatever a damaged header makes NumPy stumble over
        raise Unusable(f"it is damaged: {error or type(error).__name__}") from None
    if values.dtype.kind == "u":
        return _linear(values, float(np.iinfo(values.dtype).max))
    with np.errstate(over="ignore"):  # beyond what single precision holds is as bright as can be
        light = values.astype(np.float32)
    light = np.nan_to_num(light, nan=0.0, posinf=_BRIGHTEST, neginf=0.0)
    return np.clip(_three(light[..., :3]) * (np.clip(light[..., 3:], 0.0, 1.0) if light.shape[2] == 4 else 1.0), 0.0, _BRIGHTEST)


def _picture(data: bytes) -> Array:
    """Linear light (rows, columns, 3) of a picture file, of all bits that it has."""
    from PIL import Image, UnidentifiedImageError  # most scenes have none, and it takes 10 ms

    try:
        with warnings.catch_warnings(action="ignore"), Image.open(io.BytesIO(data), formats=FORMATS) as image:
            _refuse_size(*image.size)
            deep = image.format == "PNG" and image.tile and image.mode in ("RGB", "RGBA") and image.tile[0].args == f"{image.mode};16B"
            if image.mode.startswith("I;16"):
                return _linear(np.asarray(image)[..., None], 65535.0)
            codes = np.asarray(image if deep else image.convert("RGBA"))
        return _linear(codes.astype(np.uint16) * 256 + _low_bytes(data), 65535.0) if deep else _linear(codes, 255.0)
    except Unusable:
        raise
    except UnidentifiedImageError:
        raise Unusable("it is none of these kinds, whatever its name says") from None
    except Exception as error:  # decoders raise whatever they stumble over in a damaged file
        raise Unusable(f"it is damaged: {error or type(error).__name__}") from None


def _low_bytes(data: bytes) -> Array:
    """Of a PNG of 16 bits a colour, of which Pillow hands on the high bytes: the low ones, which are high where it is told that they come first."""
    from PIL import Image

    with Image.open(io.BytesIO(data), formats=("PNG",)) as image:
        image.tile = [tile._replace(args=f"{image.mode};16L") for tile in image.tile]
        return np.asarray(image)


def _refuse_size(width: int, height: int) -> None:
    if max(width, height) > MOST_ASIDE or width * height > MOST_PIXELS or min(width, height) < 1:
        raise Unusable(f"it has {width}×{height} pixels")


def _linear(codes: Array, most: float) -> Array:
    """Light (rows, columns, 3) of codes of sRGB (rows, columns, 1, 3 or 4), before black where they let it through."""
    code = codes.astype(np.float32) / np.float32(most)
    light = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4).astype(np.float32)
    return _three(light[..., :3]) * (code[..., 3:] if code.shape[2] == 4 else 1.0)


def _three(light: Array) -> Array:
    return light if light.shape[2] == 3 else np.repeat(light[..., :1], 3, axis=2)


def _seen(light: Array) -> tuple[Light, int]:
    """What one sees of a picture (rows, columns, 3) from within, by its shape, and how many pixels a face has across."""
    rows, columns = light.shape[:2]
    if columns == 2 * rows:
        return partial(_on_sphere, packed(light), columns), columns // 4
    for across, down, places in _LAYOUTS:
        side = columns // across
        if (columns, rows) == (across * side, down * side):
            faces = np.concatenate([_cut(light, side, *place) for place in places])
            return partial(_on_faces, packed(faces), side), side
    raise Unusable(f"it has {columns}×{rows} pixels")


_LAYOUTS = (  # squares across and down; place and whether upside down of right, left, up, down, front, back
    (6, 1, tuple((k, 0, False) for k in range(6))),
    (1, 6, tuple((0, k, False) for k in range(6))),
    (3, 2, tuple((k % 3, k // 3, False) for k in range(6))),
    (4, 3, ((2, 1, False), (0, 1, False), (1, 0, False), (1, 2, False), (1, 1, False), (3, 1, False))),
    (3, 4, ((2, 1, False), (0, 1, False), (1, 0, False), (1, 2, False), (1, 1, False), (1, 3, True))),
)


def _cut(light: Array, side: int, x: int, y: int, turned: bool) -> Array:
    face = light[y * side : (y + 1) * side, x * side : (x + 1) * side]
    return face[::-1, ::-1] if turned else face


def _on_sphere(pixels: Array, columns: int, direction: Array) -> Array:
    """Of an equirectangular picture: longitude grows to the left, as one sees it from within."""
    rows = columns // 2
    x = (0.5 - np.arctan2(direction[..., 1], direction[..., 0]) / (2.0 * np.pi)) * columns - 0.5
    y = (0.5 - np.arcsin(np.clip(direction[..., 2], -1.0, 1.0)) / np.pi) * rows - 0.5
    return between(pixels, columns, np.where(x < 0.0, x + columns, x), np.clip(y, 0.0, rows - 1.0), around=True)


def _on_faces(pixels: Array, side: int, direction: Array) -> Array:
    """Of right, left, up, down, front and back, one below the other, each as it is seen from within; above and below join the front."""
    front, right, up = direction[..., 0], -direction[..., 1], direction[..., 2]
    towards = np.stack([right, up, front])
    axis = np.argmax(np.abs(towards), axis=0)
    along = np.take_along_axis(towards, axis[None], 0)[0]
    behind = along < 0.0
    across = np.select([axis == 0, axis == 1], [np.where(behind, front, -front), right], np.where(behind, -right, right))
    above = np.where(axis == 1, np.where(behind, front, -front), up)
    x, y = (np.clip((0.5 * sign * place / np.abs(along) + 0.5) * side - 0.5, 0.0, side - 1.0) for place, sign in ((across, 1.0), (above, -1.0)))
    return between(pixels, side, x, (2 * axis + behind) * side + y, around=False)


def _levels(light: Light, side: int) -> tuple[Array, ...]:
    """The tiles of a panorama whose faces have `side` pixels across, and their halves, `LEVELS` in all."""
    step = 1 << (LEVELS - 1)
    tile = min(max(-(-int(side / INNER) // step) * step, _LEAST_TILE), _MOST_TILE)
    finer = max(round(side / (INNER * tile)), 1)  # of what has more pixels than are kept, means
    tiles = np.stack([_tile(light, face, tile, finer) for face in range(6)])
    found = []
    for level in range(LEVELS):
        found.append(_atlas(tiles))
        if level < LEVELS - 1:
            tiles = halved(tiles)
    return tuple(found)


def _tile(light: Light, face: int, tile: int, finer: int) -> Array:
    """One face's tile (tile, tile, 3), each texel the mean of `finer`² places."""
    place = (((np.arange(tile * finer) + 0.5) / (tile * finer) * 2.0 - 1.0) / INNER).astype(np.float32)
    found = np.empty((tile, tile, 3), np.float32)
    for row in range(tile // _ROWS):  # what is worked on stays small
        u, v = np.meshgrid(place, place[row * _ROWS * finer : (row + 1) * _ROWS * finer])
        part = light(on_face(face, u, v))
        found[row * _ROWS : (row + 1) * _ROWS] = part if finer == 1 else part.reshape(_ROWS, finer, tile, finer, 3).mean(axis=(1, 3))
    return found


def _atlas(tiles: Array) -> Array:
    tile = tiles.shape[1]
    return np.ascontiguousarray(tiles.reshape(3, 2, tile, tile, 3).transpose(1, 2, 0, 3, 4).reshape(2 * tile, 3 * tile, 3).astype(np.float16))
