"""Mesh files → triangles, or an error that says what is wrong with them. They come from strangers: nothing in one can do more than fail."""

from __future__ import annotations

import io
import re
import warnings
from collections import OrderedDict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..scene import files
from ..scene.schema import SceneError
from ..shapes import Float, Int
from . import gltf, stamps
from .stamps import Stamp, Unusable

MOST_BYTES = 64 << 20
MOST_TRIANGLES = 200_000
ALLOWED = f"an OBJ, glTF, GLB, STL or PLY file of at most 64 MiB and {MOST_TRIANGLES:,} triangles, with nothing it needs outside its own folder"

CREASE_DEG = 45.0
"""A face that is turned from the mean of those round a corner by more than that is flat there."""

_KEPT = 8  # meshes


NO_PLACE = -1e6
"""Texture coordinates of what has none; shaders/things/mesh.glsl then takes longitude and latitude."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """T triangles that lie within the unit ball about the origin, and touch its surface.

    Attributes:
        corners: float32 (T, 3 corners, 3), counter-clockwise from outside. normals: the same, unit vectors.
        colours: float32 (T, 3 corners, 3), linear, 0…1; None where the file has none.
        places: float32 (T, 3 corners, 2), texture coordinates; `NO_PLACE` where the file has none.
    """

    corners: Float[np.ndarray, "T 3 3"]
    normals: Float[np.ndarray, "T 3 3"]
    colours: Float[np.ndarray, "T 3 3"] | None
    places: Float[np.ndarray, "T 3 2"]


class MeshFiles:
    """Meshes that have been read, so that none is read twice while its file stays as it is, and none that cannot be used either."""

    def __init__(self) -> None:
        self._kept: OrderedDict[Stamp, Mesh | str] = OrderedDict()

    def read(self, key: str, value: str) -> tuple[Stamp, Mesh]:
        """The mesh that `value` of the field `key` names, and its file as it stood.

        Raises:
            SceneError: it cannot be used; the text names key and file, and says why and what is allowed.
        """
        path = files.located(key, value)
        try:
            found = stamps.stamp(path, MOST_BYTES)
            kept = self._kept.get(found)
            if kept is None:
                kept = self._kept[found] = _mesh_or_reason(path)
                if len(self._kept) > _KEPT:
                    self._kept.popitem(last=False)
            self._kept.move_to_end(found)
            if isinstance(kept, str):
                raise Unusable(kept)
        except Unusable as error:
            raise SceneError(key, f"the mesh {path} cannot be used: {error}; allowed is {ALLOWED}") from None
        return found, kept


def _mesh_or_reason(path: Path) -> Mesh | str:
    try:
        return _mesh(_loaded(stamps.content(path, MOST_BYTES), path), linear=path.suffix.lower() in (".glb", ".gltf"))
    except Unusable as error:
        return str(error)


def _loaded(data: bytes, path: Path) -> list[Any]:
    """The parts of the file, as trimesh has them, placed."""
    import trimesh  # takes a while, and few scenes have a mesh

    kind = path.suffix.lower().lstrip(".")
    options: dict[str, Any] = {"skip_materials": True} if kind in ("obj", "ply") else {}
    if kind in ("glb", "gltf"):
        data, options["resolver"] = gltf.plain(data, path, MOST_BYTES)
        kind = "gltf"
    elif kind == "ply":
        _refuse_counts(data)
    try:
        with warnings.catch_warnings(action="ignore"), np.errstate(all="ignore"):
            scene = trimesh.load_scene(io.BytesIO(data), file_type=kind, process=False, **options)
            parts = [scene.graph[node] for node in scene.graph.nodes_geometry]
            if sum(len(getattr(scene.geometry[name], "faces", ())) for _, name in parts) > MOST_TRIANGLES:
                raise Unusable(f"it has more than {MOST_TRIANGLES:,} triangles")
            found = [(scene.geometry[name], place) for place, name in parts]
            return [part.copy().apply_transform(place) for part, place in found if len(getattr(part, "faces", ()))]
    except Unusable:
        raise
    except Exception as error:  # readers raise whatever they stumble over in a damaged file
        raise Unusable(f"it is damaged: {str(error)[:200] or type(error).__name__}") from None


def _refuse_counts(data: bytes) -> None:
    """A PLY file says how long it is, and is believed by those who make room for it."""
    header = data[: data.find(b"end_header")]
    for number in re.findall(rb"element\s+\S+\s+(\S+)", header):
        if not number.isdigit() or int(number) > len(data):
            raise Unusable(f"it says that it has {number[:20].decode(errors='replace')} entries")


def _mesh(parts: list[Any], *, linear: bool) -> Mesh:
    triangles, colours, places = [], [], []
    for part in parts:
        vertices, faces = np.asarray(part.vertices, float), np.asarray(part.faces)
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise Unusable("a triangle names a corner that there is not")
        triangles.append(vertices[faces])
        colours.append(_colours(part, faces, linear))
        places.append(_places(part, faces))
    if not triangles:
        raise Unusable("it has no triangles")
    corners = np.concatenate(triangles)
    if not np.all(np.isfinite(corners)):
        raise Unusable("a corner is nowhere: a coordinate of it is no finite number")
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    corners = corners - 0.5 * (low + high)
    size = np.linalg.norm(corners, axis=-1).max()
    if not 0.0 < size < np.inf:
        raise Unusable("all its corners are in one place" if size == 0.0 else "it is too large for numbers")
    corners /= size
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    kept = np.linalg.norm(across, axis=1) > 1e-14  # what has no area is met by no ray
    if not kept.any():
        raise Unusable("no triangle has an area")
    known = all(own is not None for own in colours)
    return Mesh(
        corners[kept].astype(np.float32),
        _normals(corners[kept], across[kept]).astype(np.float32),
        np.concatenate([own for own in colours if own is not None])[kept].astype(np.float32) if known else None,
        np.nan_to_num(np.concatenate(places))[kept].astype(np.float32),
    )


def _normals(corners: Float[np.ndarray, "T 3 3"], across: Float[np.ndarray, "T 3"]) -> Float[np.ndarray, "T 3 3"]:
    """At each corner the mean of the faces round it, by their areas; a face's own where that leans away from it."""
    own = across / np.linalg.norm(across, axis=1, keepdims=True)
    points = corners.reshape(-1, 3)
    _, which = np.unique(np.round(points, 6), axis=0, return_inverse=True)
    total = np.zeros((which.max() + 1, 3))
    np.add.at(total, which.ravel(), np.repeat(across, 3, axis=0))
    mean = total[which.ravel()].reshape(-1, 3, 3)
    mean /= np.maximum(np.linalg.norm(mean, axis=-1, keepdims=True), 1e-300)
    flat = np.broadcast_to(own[:, None], mean.shape)
    leans = (mean * flat).sum(axis=-1, keepdims=True) < np.cos(np.radians(CREASE_DEG))
    return np.where(leans, flat, mean)


def _colours(part: Any, faces: Int[np.ndarray, "T 3"], linear: bool) -> Float[np.ndarray, "T 3 3"] | None:
    kind = getattr(part.visual, "kind", None)
    if kind not in ("vertex", "face"):
        return None
    codes = part.visual.vertex_colors[faces] if kind == "vertex" else np.repeat(part.visual.face_colors[:, None], 3, axis=1)
    shares = np.asarray(codes, float)[..., :3] / 255.0
    return shares if linear else np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)


def _places(part: Any, faces: Int[np.ndarray, "T 3"]) -> Float[np.ndarray, "T 3 2"]:
    found = getattr(part.visual, "uv", None)
    return np.full((*faces.shape, 2), NO_PLACE) if found is None or len(found) != len(part.vertices) else np.asarray(found, float)[faces]
