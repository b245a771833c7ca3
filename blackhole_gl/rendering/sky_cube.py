"""The cube round the world that skies divide into cells, as shaders/common/sky_cube.glsl has it: spread so that cells have nearly equal solid angles.

Face 2·axis + (1 on the negative side); a place on it is (u, v), −1…1 each. The same mapping goes on a little beyond a face's edges.
"""

from __future__ import annotations

import numpy as np

Array = np.ndarray


def on_cube(face: Array, u: Array, v: Array) -> Array:
    """Unit vectors (…, 3) of places on the cube's faces."""
    turned = np.stack([np.where(face % 2 == 1, -1.0, 1.0), _flat(u), _flat(v)], axis=-1)
    axis = face // 2
    picked = np.where((axis == 0)[..., None], turned, np.where((axis == 1)[..., None], turned[..., [2, 0, 1]], turned[..., [1, 2, 0]]))
    return picked / np.linalg.norm(picked, axis=-1, keepdims=True)


def on_face(face: int, u: Array, v: Array) -> Array:
    """The same of places on one face, and beside it."""
    found = np.empty((*u.shape, 3), u.dtype)
    axis = face // 2
    found[..., axis] = 1.0 - 2.0 * (face % 2)
    found[..., (axis + 1) % 3] = _flat(u)
    found[..., (axis + 2) % 3] = _flat(v)
    found *= (1.0 / np.sqrt(np.einsum("...k,...k->...", found, found)))[..., None]
    return found


def place_of(direction: Array) -> tuple[Array, Array, Array]:
    """Face, u and v of directions (…, 3)."""
    size = np.abs(direction)
    axis = np.argmax(size, axis=-1)
    along, y, z = (np.take_along_axis(direction, ((axis + turn) % 3)[..., None], -1)[..., 0] for turn in range(3))
    return 2 * axis + (along < 0.0), _spread(y / np.abs(along)), _spread(z / np.abs(along))


def place_on(face: int, direction: Array) -> tuple[Array, Array, Array]:
    """Whether directions (n, 3) lie on the side of one face, and u and v there, beyond ±1 where they lie beside it."""
    axis, sign = face // 2, 1.0 - 2.0 * (face % 2)
    along = sign * direction[:, axis]
    ahead = along > 1e-3
    depth = np.where(ahead, along, 1.0)
    return ahead, _spread(direction[:, (axis + 1) % 3] / depth), _spread(direction[:, (axis + 2) % 3] / depth)


def slope(u: Array, v: Array) -> Array:
    """How fast u changes, where it changes fastest, per rad."""
    squares = _flat(u) ** 2
    return 1.5 * np.sqrt((1.0 + squares) * (1.0 + squares + _flat(v) ** 2)) / (1.0 + np.abs(u))


def solid_angle(u: Array, v: Array) -> Array:
    """dΩ/(du dv) at places on a face, sr."""
    return 4.0 / 9.0 * (1.0 + np.abs(u)) * (1.0 + np.abs(v)) / (1.0 + _flat(u) ** 2 + _flat(v) ** 2) ** 1.5


def cell_share(u: Array, v: Array) -> Array:
    """Solid angle of a cell against the largest there is, 1.4831 of the one at a face's middle."""
    return (1.0 + np.abs(u)) * (1.0 + np.abs(v)) / (1.4831 * (1.0 + _flat(u) ** 2 + _flat(v) ** 2) ** 1.5)


def _flat(place: Array) -> Array:
    return place * (np.abs(place) + 2.0) / 3.0


def _spread(flat: Array) -> Array:
    return np.sign(flat) * (np.sqrt(1.0 + 3.0 * np.abs(flat)) - 1.0)
