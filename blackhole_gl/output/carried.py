"""Preset texts that other files than pictures carry: layers of linear radiance, and films. Read by the libraries that write them, and no further than that."""

from __future__ import annotations

import importlib
import io
import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

SCENE = "blackhole_gl.scene"
"""The attribute of an OpenEXR file that holds the text; elsewhere it is called ``scene``."""

_LONGEST = 4_000_000  # bytes; ours have a few thousand


def _npz(path: Path) -> str | None:
    with zipfile.ZipFile(path) as held:
        if "scene.npy" not in held.namelist() or held.getinfo("scene.npy").file_size > _LONGEST:
            return None
        return str(np.load(io.BytesIO(held.read("scene.npy")), allow_pickle=False))


def _exr(path: Path) -> str | None:
    openexr = _library("OpenEXR", "openexr", "exr")
    with openexr.File(str(path), header_only=True) as held:
        text = held.header().get(SCENE)
    return text.decode() if isinstance(text, bytes) else text


def _fits(path: Path) -> str | None:
    fits = _library("astropy.io.fits", "astropy", "fits")
    with fits.open(path) as hdus:
        found = [hdu for hdu in hdus if hdu.name == "SCENE"]
        return bytes(found[0].data).decode() if found and found[0].size <= _LONGEST else None


def _film(path: Path) -> str | None:
    with _library("av", "av", "film").open(str(path)) as container:
        told = {key.lower(): value for key, value in container.metadata.items()}.get("comment", "")
    return json.loads(told)["scene"] if told.startswith("{") else None


READERS: dict[str, Callable[[Path], str | None]] = {".npz": _npz, ".exr": _exr, ".fits": _fits, **dict.fromkeys((".mp4", ".mov", ".mkv", ".webm"), _film)}
"""What reads the text of a file, by its suffix."""


def read_scene_text(path: str | Path) -> str:
    """The preset that the file at `path` carries, as TOML; of a film the scene that it begins with.

    Raises:
        ValueError: damaged, another kind of file, without a preset, or the library that reads it is not installed.
        OSError: `path` cannot be read.
    """
    path = Path(path)
    with open(path, "rb"):  # what is not there is told as of any other file
        pass
    try:
        text = READERS[path.suffix.lower()](path)
    except _Missing:
        raise
    except Exception as error:  # whatever a library finds wrong with a stranger's file
        raise ValueError(f"cannot be read as {path.suffix}: {str(error).strip() or type(error).__name__}") from None
    if not text:
        raise ValueError(f"it carries no preset; only {path.suffix} files that Blackhole GL wrote do")
    return text


class _Missing(ValueError):
    pass


def _library(module: str, package: str, extra: str) -> Any:
    try:
        return importlib.import_module(module)
    except ImportError:
        raise _Missing(f"to be read it needs the package {package}: pip install 'blackhole-gl[{extra}]'") from None
