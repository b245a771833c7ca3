"""What values of kind ``file`` name: a path on disk, or a file that comes with the program, ``asset:NAME``."""

from __future__ import annotations

import os
from functools import lru_cache
from pathlib import Path

from ..resources import assets_dir
from .schema import SceneError

ASSET = "asset:"
"""What a value begins with that names a file below the program's assets, wherever it is installed."""

PICTURES = (".png", ".jpg", ".jpeg", ".webp", ".bmp")
"""What the names of pictures end in. A file parameter with no other endings is a picture, which shaders get as a texture."""

PANORAMAS = (*PICTURES, ".hdr", ".npy")
"""What the names of panoramas end in. A file parameter with these endings is one, which shaders get as the tiles of a cube."""

MESHES = (".obj", ".gltf", ".glb", ".stl", ".ply")
"""What the names of meshes end in."""


def is_asset(value: str) -> bool:
    """Whether `value` names a file that comes with the program."""
    return value.startswith(ASSET)


def located(key: str, value: str) -> Path:
    """The file that `value` of the field `key` names.

    Raises:
        SceneError: it names an asset that there is not.
    """
    return _asset(key, value) if is_asset(value) else Path(value)


@lru_cache(maxsize=64)
def _asset(key: str, value: str) -> Path:
    """Kept where it is found, as each frame asks: what comes with the program stays where it is."""
    folder = assets_dir()
    path = folder / value.removeprefix(ASSET)
    if not is_within(path, folder) or not path.is_file():
        raise SceneError(key, f"got {value!r}; allowed after {ASSET} is the name of a file in {folder}")
    return path


def is_within(path: Path, folder: Path) -> bool:
    """Whether `path` leads below `folder`, links followed. What does not even by its text is not looked up: a name on a network may be that of a stranger."""
    there, home = Path(os.path.normpath(path.absolute())), Path(os.path.normpath(folder.absolute()))
    return there.is_relative_to(home) and there.resolve().is_relative_to(home.resolve())
