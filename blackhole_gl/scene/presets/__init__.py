"""Presets: TOML files ↔ scenes.

A preset is a TOML file: optional `title`, `description`, `group` and `rank` (its place in lists) at the top, then a table
for each section of the scene::

    title = "Kerr, a* = 0.6"
    [hole]
    spin = 0.6
    [disk.turbulence]       # a plug-in's parameters
    enabled = true          # the switch disk.turbulence itself; `turbulence = true` in [disk] says the same
    strength = 0.8
    [things.moon]           # a named instance; a preset layered over this one may change it without saying its kind again
    kind = "sphere"

Presets are layered: physics, then look, then quality, or steps stated by hand instead, then single values; the later one wins. A picture saved by us is a
preset too, and so are layers and a film. Paths in a preset start at its own folder, and files elsewhere are left out unless the caller says `any_file`:
presets and pictures are passed on. Whatever is wrong with one is a `PresetError` that names the file, the key, the value given and what is allowed; but a
key that is not known, as a newer version's file may have, is left out, and `skipped` tells of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...output import carried, jpeg, png
from ...resources import presets_dir, user_config_dir
from ...text_files import decimal_comma, read_text
from .. import Scene, fields, instances
from ..catalogue import KIND
from ..schema import SceneError
from . import paths
from .comparison import departures, differing
from .reading import GROUPS, Preset, PresetError, parse, unknown_key
from .writing import dumps, picture_text, save

__all__ = [
    "DEFAULT_PRESETS", "FILES", "GROUPS", "USER_GROUP", "Preset", "PresetError", "PresetInfo", "available", "departures", "differing", "dumps", "from_png",
    "last_timed", "load", "parse", "parse_assignments", "picture_text", "read", "renamed", "save", "skipped", "user_presets_dir",
]

_CARRIED = {
    ".png": png.read_scene_text,
    **dict.fromkeys(jpeg.SUFFIXES, jpeg.read_scene_text),
    **dict.fromkeys(carried.READERS, carried.read_scene_text),
}
FILES = (".toml", *_CARRIED)
"""How the names of files end that hold a preset: its text, and pictures, layers and films that carry it."""

USER_GROUP = "user"
DEFAULT_PRESETS = ("kerr",)
# What a preset of these groups leaves unsaid is the default preset's, not the bare scene's.
_PARTIAL_GROUPS = ("look", "quality", "steps")


@dataclass(frozen=True)
class PresetInfo:
    """One line of the list of presets; `group` is one of `GROUPS` or ``user``, `moves_camera` whether it says where the camera is, `is_art`
    whether it sets a value that departs from physics."""

    group: str
    name: str
    title: str
    description: str
    path: Path
    moves_camera: bool
    is_art: bool


def available() -> list[PresetInfo]:
    """Every preset that has a name: the shipped ones group by group and by rank, then the user's own.

    A user's file that cannot be read is listed with the reason as its description.
    """
    found = []
    for name, path, shipped in _named():
        try:
            preset = read(path)
        except PresetError as error:
            preset = Preset(title=f"{name} (cannot be read)", description=str(error))
        group = shipped or preset.group or USER_GROUP
        place = (not shipped, (*GROUPS, USER_GROUP).index(group), preset.rank)
        moves_camera = any(key.startswith("camera.") for key in preset.values)
        is_art = any((item := fields().get(key)) is not None and item.physical not in (None, value) for key, value in preset.values.items())
        found.append((place, PresetInfo(group, name, preset.title or name, preset.description, path, moves_camera, is_art)))
    return [info for _, info in sorted(found, key=lambda entry: entry[0])]


def user_presets_dir() -> Path:
    """Where the user's own presets lie; it need not exist."""
    return user_config_dir() / "presets"


def _named() -> list[tuple[str, Path, str]]:
    """(name, path, shipped group or empty) of each preset; a shipped name comes first, because scripts rely on it."""
    shipped = [(path.stem, path, group) for group in GROUPS for path in sorted((presets_dir() / group).glob("*.toml"))]
    return shipped + [(path.stem, path, "") for path in sorted(user_presets_dir().glob("*.toml"))]


def _find(name: str) -> tuple[Path, str]:
    """Path and shipped group of the preset called `name`."""
    named = _named()
    for known, path, group in named:
        if known == name:
            return path, group
    for _, path, group in named:
        if name and group and read(path).formerly == name:
            return path, group
    names = sorted({known for known, _, _ in named})
    import difflib  # only in a mistake

    near = difflib.get_close_matches(name, names, n=1, cutoff=0.4)
    hint = f"; did you mean {near[0]}?" if near else "."
    raise PresetError(f"no preset is called {name!r}{hint} Available are {', '.join(names)}; a file's name ends in {', '.join(FILES[:-1])} or {FILES[-1]}.")


def load(
    names_or_paths: Sequence[str | Path] | str = (), overrides: Mapping[str, Any] | None = None, *, any_file: bool = False, source: str = "--set"
) -> Scene:
    """The scene that the presets say, each over the one before it, and `overrides` over all.

    Where nothing but looks, qualities and steps is named, they lie over `DEFAULT_PRESETS`.

    Args:
        names_or_paths: names (see `available`) or paths of ``.toml`` presets or of pictures, layers and films saved by us (see `FILES`).
        overrides: dotted key → value, or text as typed on a command line, e.g. ``{"disk.outer_radius": "12"}``; lists as in TOML, paths from
            the working folder.
        any_file: the presets may name files outside their own folders, too.
        source: what overrides are called in errors.

    Raises:
        PresetError: see `read`; or an override is wrong.
    """
    scene = Scene()
    for layer in _layers(names_or_paths, any_file):
        scene = layer.over(scene)
    return _overridden(scene, overrides or {}, source)


def skipped(names_or_paths: Sequence[str | Path], *, any_file: bool = False) -> list[str]:
    """What `load` leaves out of these presets because this version does not know it, or because it is a file elsewhere, a sentence each.

    Raises:
        PresetError: see `read`.
    """
    found: list[str] = []
    scene = Scene()
    for layer in _layers(names_or_paths, any_file):
        found += (*layer.skipped, *layer.refused(scene))
        scene = layer.over(scene)
    return found


def _layers(names_or_paths: Sequence[str | Path] | str, any_file: bool) -> list[Preset]:
    wanted = [names_or_paths] if isinstance(names_or_paths, (str, Path)) else list(names_or_paths)
    layers = [read(item, any_file=any_file) for item in wanted]
    return [read(item) for item in DEFAULT_PRESETS] + layers if _are_partial(layers) else layers


def last_timed(names_or_paths: Iterable[str | Path]) -> Preset | None:
    """The last of these presets that was saved at a scene time; None where there is none.

    Raises:
        PresetError: see `read`.
    """
    return next((preset for preset in reversed([read(item) for item in names_or_paths]) if preset.time is not None), None)


def with_default(names_or_paths: Sequence[str | Path]) -> list[str | Path]:
    """`names_or_paths`, over `DEFAULT_PRESETS` where nothing but looks, qualities and steps is among them.

    Raises:
        PresetError: see `read`.
    """
    return [*(DEFAULT_PRESETS if _are_partial(read(item) for item in names_or_paths) else ()), *names_or_paths]


def _are_partial(layers: Iterable[Preset]) -> bool:
    return all(layer.group in _PARTIAL_GROUPS for layer in layers)


def renamed(names_or_paths: Sequence[str | Path]) -> dict[str, str]:
    """Former → present name of those of `names_or_paths` that are former names of presets.

    Raises:
        PresetError: see `read`.
    """
    found = {}
    for name in names_or_paths:
        if isinstance(name, str) and not _is_path(name):
            path, _ = _find(name)
            if path.stem != name:
                found[name] = path.stem
    return found


def parse_assignments(assignments: Iterable[str]) -> dict[str, str]:
    """``["disk.outer_radius=12"]`` as the overrides that `load` takes; of two for one key the later wins.

    Raises:
        PresetError: an assignment has no ``=`` or no key.
    """
    overrides = {}
    for assignment in assignments:
        key, equals, text = assignment.partition("=")
        if not equals or not key.strip():
            raise PresetError(f"got {assignment!r}; allowed is key=value, e.g. disk.outer_radius=12", source="--set")
        overrides[key.strip()] = text.strip()
    return overrides


def from_png(path: str | Path) -> Scene:
    """The scene of a picture saved by us.

    Raises:
        PresetError: no such picture, or it carries no preset, or one that this version cannot use.
    """
    return read(Path(path)).over(Scene())


def read(name_or_path: str | Path, *, any_file: bool = False) -> Preset:
    """The preset of that name, or in that ``.toml`` file, or that such another of `FILES` carries; `any_file`: it may name files outside its own folder.

    Raises:
        PresetError: not found, not readable, not TOML, or a value that a scene cannot hold.
    """
    if _is_path(name_or_path):
        path, group = Path(name_or_path), ""
    else:
        path, group = _find(str(name_or_path))
    source = str(path)
    try:
        text = _CARRIED.get(path.suffix.lower(), read_text)(path)
    except OSError as error:
        raise PresetError(f"cannot be read: {error.strerror or error}", source=source) from None
    except ValueError as error:
        raise PresetError(str(error), source=source) from None
    preset = parse(text, source, path.absolute().parent)
    return replace(preset, group=group or preset.group, any_file=any_file)


def _is_path(name_or_path: str | Path) -> bool:
    return isinstance(name_or_path, Path) or name_or_path.lower().endswith(FILES)


def _overridden(scene: Scene, overrides: Mapping[str, Any], source: str) -> Scene:
    """`scene` with the overrides put in, kinds first: they make the instances that others may be about."""
    if strange := [key for key in overrides if not isinstance(key, str)]:
        raise PresetError(f"got the key {strange[0]!r}; allowed are keys in words, as hole.spin", source=source)
    kinds = {key for key in overrides if (place := instances.place_of(key)) is not None and place.parameter == KIND}
    values: dict[str, Any] = {}
    for key in sorted(overrides, key=lambda key: key not in kinds):
        given = overrides[key]
        if instances.place_of(key) is None and key not in fields():
            raise PresetError(unknown_key(key), key=key, source=source)
        try:
            if key in kinds:
                scene = scene.with_values({key: given})
                continue
            item = scene.field(key)
            values[key] = paths.anchored(item, item.parse(given) if isinstance(given, str) else item.check(given), Path.cwd())
        except SceneError as error:
            hint = decimal_comma(given) if isinstance(given, str) else ""
            raise PresetError(error.message + hint, key=key, source=source) from None
    try:
        return scene.with_values(values)  # all at once: what one of them may be can depend on another
    except SceneError as error:
        raise PresetError(error.message, key=error.key, source=source) from None
