"""The meshes that things of a scene name, as two textures: trees of boxes and triangles, one mesh behind the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..scene import FrozenMap, Scene, met
from ..scene.files import MESHES
from ..scene.instances import Instances
from ..scene.plug_in import PlugIn
from ..scene.schema import Field
from ..shapes import Float, Int
from . import box_pairs, hierarchy
from .box_pairs import IN_LEAF, BoxPairs
from .mesh_files import Mesh, MeshFiles
from .stamps import Stamp

TEXELS = 9  # of a triangle; shaders/things/mesh.glsl says what they hold
ROW = 64  # triangles in a row of the texture

_FILES = MeshFiles()
_MADE: dict[tuple[tuple[str, Stamp], ...], Meshes] = {}  # the last few: neither a slider nor going to and fro between scenes builds anything anew
_MOST_MADE = 3


def is_mesh(item: Field) -> bool:
    """Whether `item` names mesh files."""
    return item.kind == "file" and set(item.suffixes) <= set(MESHES)


@dataclass(frozen=True, eq=False)
class Meshes:
    """What shaders read of the meshes of a scene.

    Attributes:
        roots: value of a mesh field → 32 times the nodes before those of its mesh, and the levels of its tree; 0 without a mesh.
        nodes: int32 (rows, columns, 4), the trees' (shaders/common/box_pairs.glsl).
        places: value → its file as it was read, and the first of its triangles: hits, which number these, are others where either is.
        triangles: float32 (rows, columns, 4), `TEXELS` each.
    """

    roots: Mapping[str, int]
    nodes: np.ndarray
    places: Mapping[str, tuple[Stamp, int]]
    triangles: np.ndarray


def of(scene: Scene) -> Meshes | None:
    """The meshes of `scene`; None where no thing may have one.

    Raises:
        SceneError: a file cannot be used.
    """
    named = _named(scene)
    if named is None:
        return None
    read = [(value, *_FILES.read(key, value)) for value, key in named.items() if value]
    place = tuple((value, stamp) for value, stamp, _ in read)
    if place not in _MADE:
        while len(_MADE) >= _MOST_MADE:
            _MADE.pop(next(iter(_MADE)))
        _MADE[place] = _made(read)
    return _MADE[place]


def _made(meshes: list[tuple[str, Stamp, Mesh]]) -> Meshes:
    roots: dict[str, int] = {"": 0}
    places: dict[str, tuple[Stamp, int]] = {}
    nodes, triangles = [np.zeros((0, 4), np.int32)], [np.zeros((0, TEXELS, 4), np.float32)]
    before = 0
    for value, stamp, mesh in meshes:
        tree = box_pairs.build(mesh.corners)
        roots[value] = 32 * before + tree.levels
        places[value] = stamp, IN_LEAF * before
        nodes.append(tree.texels)
        triangles.append(_texels(mesh, tree, IN_LEAF * before))
        before += len(tree.texels)
    return Meshes(roots, _rows(np.concatenate(nodes)[:, None], hierarchy.ROW), places, _rows(np.concatenate(triangles), ROW))


def _named(scene: Scene) -> FrozenMap[str, str] | None:
    """Value → key of each mesh that things name."""
    return _named_in(scene.things, met.kinds(scene, "thing"))


@lru_cache(maxsize=met.SCENES_KEPT)
def _named_in(things: Instances, kinds: tuple[PlugIn, ...]) -> FrozenMap[str, str] | None:
    found: dict[str, str] = {}
    fields = {kind.key: [item.key for item in kind.parameters.values() if is_mesh(item)] for kind in kinds}
    for name, instance in things.items():
        for key in fields[instance.kind]:
            found.setdefault(str(instance.values[key]), f"things.{name}.{key}")
    return FrozenMap(found) if found else None


def _texels(mesh: Mesh, tree: BoxPairs, before: int) -> np.ndarray:
    """float32 (places, TEXELS, 4), the triangles where the `tree` has them, behind so many places of others; nothing where it has none."""
    found = np.zeros((IN_LEAF * len(tree.texels), TEXELS, 4), np.float32)
    own = np.zeros((len(mesh.corners), TEXELS, 4), np.float32)
    own[:, 0:3, :3], own[:, 3:6, :3] = mesh.corners, mesh.normals
    own[:, 0:6, 3] = mesh.places.reshape(-1, 6)
    own[:, 6:9, :3] = -1.0 if mesh.colours is None else mesh.colours
    beyond = beyond_sides(mesh.corners)
    own[:, 6:9, 3] = np.where(beyond < 0, -1, before + tree.places[beyond])
    found[tree.places] = own
    return found


def beyond_sides(corners: Float[np.ndarray, "T 3 3"]) -> Int[np.ndarray, "T 3"]:
    """The triangle with which each of these shares the side opposite to each of its `corners`, if it runs the same way round; −1 where there is none.

    Corners are the same where they are in the same place: files have them apart where normals or colours change.
    """
    points = corners.reshape(-1, 3)
    same = np.zeros(len(points), int)
    for along in points.T:
        same = np.unique(same * len(points) + np.unique(along, return_inverse=True)[1], return_inverse=True)[1]
    begin, end = same.reshape(-1, 3)[:, [1, 2, 0]].ravel(), same.reshape(-1, 3)[:, [2, 0, 1]].ravel()
    sides, back = begin * len(points) + end, end * len(points) + begin
    order = np.argsort(sides, kind="stable")
    place = order[np.minimum(np.searchsorted(sides[order], back), len(sides) - 1)] if len(sides) else order
    return np.where((sides[place] == back) & (begin != end), place // 3, -1).reshape(-1, 3)


def _rows(texels: np.ndarray, in_row: int) -> np.ndarray:
    """Of items of some texels each (items, texels, 4) rows with so many of them."""
    rows = max(-(-len(texels) // in_row), 3) | 1  # no power of two (docs/llvmpipe.md)
    found = np.zeros((rows * in_row, *texels.shape[1:]), texels.dtype)
    found[: len(texels)] = texels
    return found.reshape(rows, -1, 4)
