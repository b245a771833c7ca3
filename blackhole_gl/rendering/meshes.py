"""The meshes that things of a scene name, as two textures: their hierarchies and their triangles, one mesh behind the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..physics import motion
from ..physics.observer import cos_sin_deg
from ..planning import Plan
from ..scene import FrozenMap, Scene, met
from ..scene.files import MESHES
from ..scene.instances import Instances
from ..scene.plug_in import PlugIn
from ..scene.schema import Field
from ..shapes import Float, Int
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
_MOST_SEEN = 4  # of their hierarchies, each as seen from another side


def is_mesh(item: Field) -> bool:
    """Whether `item` names mesh files."""
    return item.kind == "file" and set(item.suffixes) <= set(MESHES)


@dataclass(frozen=True, eq=False)
class Meshes:
    """What shaders read of the meshes of a scene.

    Attributes:
        roots: value of a mesh field → the first node of its mesh.
        trees: value → its hierarchy, and what its leaves hold.
        places: value → its file as it was read, and the first of its triangles: hits, which number these, are others where either is.
        triangles: float32 (rows, columns, 4), `TEXELS` each.
    """

    roots: Mapping[str, int]
    trees: Mapping[str, _Tree]
    places: Mapping[str, tuple[Stamp, int]]
    triangles: np.ndarray

    def nodes(self, plan: Plan, time: float) -> np.ndarray:
        """The texels of all hierarchies, those boxes first that are nearest to the camera at scene time `time`."""
        return _nodes(self, tuple(_towards_camera(plan, time, value) for value in self.trees))


@dataclass(frozen=True, eq=False)
class _Tree:
    """A mesh's hierarchy, and the number of its first triangle in the texture."""

    boxes: Hierarchy
    first: int


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
    trees: dict[str, _Tree] = {}
    places: dict[str, tuple[Stamp, int]] = {}
    triangles = []
    nodes = count = 0
    for value, stamp, mesh in meshes:
        tree = hierarchy.build(mesh.corners.min(axis=1).astype(float), mesh.corners.max(axis=1).astype(float), IN_LEAF)
        roots[value] = hierarchy.FIRST + nodes
        trees[value], places[value] = _Tree(tree, count), (stamp, count)
        triangles.append(_texels(mesh, tree.order, count))
        nodes, count = nodes + len(tree.beyond), count + len(mesh.corners)
    return Meshes(roots, trees, places, _rows(triangles))


@lru_cache(maxsize=_MOST_SEEN)
def _nodes(meshes: Meshes, towards: tuple[tuple[int, int, int], ...]) -> np.ndarray:
    trees = [(tree.boxes.nearest_first(np.array(direction)), tree.first) for tree, direction in zip(meshes.trees.values(), towards)]
    leaves = [4 * (tree.first + first) + tree.count - 1 for tree, first in trees]
    return _joined([tree for tree, _ in trees]).texels(np.concatenate([np.zeros(0, int), *leaves]))


def _towards_camera(plan: Plan, time: float, value: str) -> tuple[int, int, int]:
    """The direction from the first thing with that mesh to the camera, in the axes of the mesh: the nearest of a cube's middles, edges and corners.

    Which box hides which changes little within it.
    """
    camera, things = plan.scene.camera, plan.scene.things
    name = (_named(plan.scene) or {})[value].split(".")[1]
    bound, _, _, attitude = motion.rows(plan.scene, "thing", plan.space_time, time)[list(things).index(name)]
    (c, s), (cos_azimuth, sin_azimuth) = cos_sin_deg(camera.inclination_deg), cos_sin_deg(plan.azimuth_deg)
    distance, (*axis, w), place = min(camera.distance, 1e9), attitude.tolist(), bound.tolist()
    towards = [distance * along - middle for along, middle in zip((s * cos_azimuth, s * sin_azimuth, c), place)]
    turned = _cross(axis, [across - w * along for across, along in zip(_cross(axis, towards), towards)])
    x, y, z = (along + 2.0 * more for along, more in zip(towards, turned))
    if things[name].values.get("up") == "y":
        y, z = z, -y
    most = max(abs(x), abs(y), abs(z), 1e-12)
    return round(x / most), round(y / most), round(z / most)


def _cross(a: list[float], b: list[float]) -> list[float]:
    """NumPy's takes ten times as long for a single one."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


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


def _joined(trees: list[Hierarchy]) -> Hierarchy:
    parts = [(np.zeros((0, 3)), np.zeros((0, 3)), *(np.zeros(0, int),) * 4)]
    nodes = 0
    for tree in trees:
        parts.append((tree.low, tree.high, np.where(tree.beyond < 0, -1, tree.beyond + nodes), tree.first, tree.count, tree.order))
        nodes += len(tree.beyond)
    return Hierarchy(*(np.concatenate(column) for column in zip(*parts)))


def _texels(mesh: Mesh, order: np.ndarray, first: int) -> np.ndarray:
    """float32 (T, TEXELS, 4), the triangles in that order, their numbers from `first` on."""
    found = np.zeros((len(mesh.corners), TEXELS, 4), np.float32)
    found[:, 0:3, :3], found[:, 3:6, :3] = mesh.corners, mesh.normals
    found[:, 0:6, 3] = mesh.places.reshape(-1, 6)
    found[:, 6:9, :3] = -1.0 if mesh.colours is None else mesh.colours
    number = np.empty(len(order), int)
    number[order] = first + np.arange(len(order))
    beyond = beyond_sides(mesh.corners)
    found[:, 6:9, 3] = np.where(beyond < 0, -1, number[beyond])
    return found[order]


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


def _rows(triangles: list[np.ndarray]) -> np.ndarray:
    texels = np.concatenate([np.zeros((0, TEXELS, 4), np.float32), *triangles])
    rows = max(-(-len(texels) // ROW), 3) | 1  # no power of two (docs/llvmpipe.md)
    return np.concatenate([texels, np.zeros((rows * ROW - len(texels), TEXELS, 4), np.float32)]).reshape(rows, ROW * TEXELS, 4)
