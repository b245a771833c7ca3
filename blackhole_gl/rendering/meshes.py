"""The meshes that things of a scene name, as two textures: their hierarchies and their triangles, one mesh behind the other."""

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
from . import hierarchy
from .hierarchy import Hierarchy
from .mesh_files import Mesh, MeshFiles
from .stamps import Stamp

IN_LEAF = 2
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
        roots: value of a mesh field → the first node of its mesh.
        nodes: the texels of all hierarchies. triangles: float32 (rows, columns, 4), `TEXELS` each.
    """

    roots: Mapping[str, int]
    nodes: np.ndarray
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
        _MADE[place] = _made([(value, mesh) for value, _, mesh in read])
    return _MADE[place]


def _made(meshes: list[tuple[str, Mesh]]) -> Meshes:
    roots, trees, leaves, triangles = {"": 0}, [], [], []
    nodes = count = 0
    for value, mesh in meshes:
        tree = hierarchy.build(mesh.corners.min(axis=1).astype(float), mesh.corners.max(axis=1).astype(float), IN_LEAF)
        roots[value] = hierarchy.FIRST + nodes
        trees.append(tree)
        leaves.append(4 * (tree.first + count) + tree.count - 1)
        triangles.append(_texels(mesh)[tree.order])
        nodes, count = nodes + len(tree.beyond), count + len(mesh.corners)
    return Meshes(roots, _joined(trees).texels(np.concatenate([np.zeros(0, int), *leaves])), _rows(triangles))


def _named(scene: Scene) -> FrozenMap[str, str] | None:
    """Value → key of each mesh that things name."""
    return _named_in(scene.things, tuple(met.kinds(scene, "thing")))


@lru_cache(maxsize=met.SCENES_KEPT)
def _named_in(things: Instances, kinds: tuple[PlugIn, ...]) -> FrozenMap[str, str] | None:
    found: dict[str, str] = {}
    fields = {kind.key: [item.key for item in kind.parameters.values() if is_mesh(item)] for kind in kinds}
    for name, instance in things.items():
        for key in fields[instance.kind]:
            found.setdefault(str(instance.values[key]), f"things.{name}.{key}")
    return FrozenMap(found) if found else None


def _joined(trees: list[Hierarchy]) -> Hierarchy:
    parts = [(np.zeros((0, 3)), np.zeros((0, 3)), *(np.zeros(0, int),) * 4)]
    nodes = 0
    for tree in trees:
        parts.append((tree.low, tree.high, np.where(tree.beyond < 0, -1, tree.beyond + nodes), tree.first, tree.count, tree.order))
        nodes += len(tree.beyond)
    return Hierarchy(*(np.concatenate(column) for column in zip(*parts)))


def _texels(mesh: Mesh) -> np.ndarray:
    """float32 (T, TEXELS, 4)."""
    found = np.zeros((len(mesh.corners), TEXELS, 4), np.float32)
    found[:, 0:3, :3], found[:, 3:6, :3] = mesh.corners, mesh.normals
    found[:, 0:6, 3] = mesh.places.reshape(-1, 6)
    found[:, 6:9, :3] = -1.0 if mesh.colours is None else mesh.colours
    return found


def _rows(triangles: list[np.ndarray]) -> np.ndarray:
    texels = np.concatenate([np.zeros((0, TEXELS, 4), np.float32), *triangles])
    rows = max(-(-len(texels) // ROW), 3) | 1  # no power of two (docs/llvmpipe.md)
    return np.concatenate([texels, np.zeros((rows * ROW - len(texels), TEXELS, 4), np.float32)]).reshape(rows, ROW * TEXELS, 4)
