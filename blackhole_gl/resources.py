"""Where shaders, presets and assets lie, in a checkout or in an installed wheel, and where a user's own files go."""

from __future__ import annotations

import os
from pathlib import Path

import platformdirs

_PACKAGE = Path(__file__).resolve().parent


def shaders_dir() -> Path:
    """The folder that `#include` paths in GLSL start from."""
    return _data_dir("shaders")


def presets_dir() -> Path:
    """The folder of the shipped presets, with one folder in it for each group (physics, look, quality, steps, scene)."""
    return _data_dir("presets")


def flights_dir() -> Path:
    """The folder of the shipped flights."""
    return presets_dir() / "flights"


def assets_dir() -> Path:
    """The folder of derived tables and data."""
    return _data_dir("assets")


def user_config_dir() -> Path:
    """The folder of the user's key map, saved presets and plug-ins; it need not exist yet.

    The environment variable BLACKHOLE_GL_CONFIG_DIR names another one, as a test or a portable copy wants.
    """
    chosen = os.environ.get("BLACKHOLE_GL_CONFIG_DIR")
    return Path(chosen) if chosen else platformdirs.user_config_path("blackhole-gl", appauthor=False)


def user_shaders_dir() -> Path:
    """The folder of the user's own plug-ins, cut like `shaders_dir`; it need not exist."""
    return user_config_dir() / "shaders"


def desktop_data_dir() -> Path:
    """Where a desktop by freedesktop.org's rules looks for the user's own menu entries, icons and kinds of files (XDG_DATA_HOME)."""
    return platformdirs.user_data_path()


def user_cache_dir() -> Path:
    """The folder for what can be made again; it need not exist yet."""
    return platformdirs.user_cache_path("blackhole-gl", appauthor=False)


def _data_dir(name: str) -> Path:
    """A wheel carries its data inside the package; a checkout has it beside the package.

    The wheel's place is looked at first: beside an installed package lie other people's packages.
    """
    shipped = _PACKAGE / "data"
    folder = (shipped if shipped.is_dir() else _PACKAGE.parent) / name
    if not folder.is_dir():
        raise FileNotFoundError(
            f"the folder {name}/ of Blackhole GL is missing: looked for {folder}. Install the package again, or run from a whole checkout."
        )
    return folder
