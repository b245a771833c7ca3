"""Scene → TOML text and files."""

from __future__ import annotations

from collections.abc import Mapping, Set
from functools import lru_cache
from pathlib import Path

import tomlkit
import tomlkit.items

from ... import VERSION
from ...output import files
from .. import Scene, catalogue, fields, instances, lengths
from ..catalogue import KIND, SWITCH
from ..schema import Field, Value
from ..sections import declared
from . import paths
from .reading import GROUPS, PresetError, tables


def dumps(
    scene: Scene,
    full: bool = False,
    *,
    title: str = "",
    description: str = "",
    group: str = "",
    time: float | None = None,
    paused: bool = False,
    folder: Path | None = None,
    unit: str = "r_s",
) -> str:
    """`scene` as a preset's TOML: what differs from the defaults, or with `full` everything, units as comments; of instances always the kind.

    Lengths and times are in `unit`, one of `lengths.UNITS`. Reading it gives back exactly `scene`; from a file in `folder`, too, which paths below it are made
    relative to. With the `time` (r_s/c) it gives back the picture.
    """
    moment = _moment(None if time is None else time * lengths.factor(unit), paused)
    stated = {} if unit == "r_s" else {"lengths": unit}
    return _dump(scene, full, {"title": title, "description": description, "group": group, **stated, **moment}, folder, unit=unit)


def picture_text(scene: Scene, time: float, folder: Path | None = None, *, paused: bool = False) -> str:
    """The whole of `scene`, the time (r_s/c), whether it stood still, and our version as TOML: what a picture saved in `folder` carries.

    What plug-ins of the user's have that the picture does not use is left out: it is to open where there are none.
    """
    return _dump(scene, True, {**_moment(time, paused), "version": VERSION}, folder, _idle(scene))


def _moment(time: float | None, paused: bool) -> dict[str, str | float | bool]:
    return {} if time is None else {"time": float(time), **({"paused": True} if paused else {})}


def save(
    scene: Scene,
    path: str | Path,
    *,
    title: str = "",
    description: str = "",
    group: str = "",
    time: float | None = None,
    paused: bool = False,
    full: bool = False,
    unit: str = "r_s",
) -> Path:
    """Writes `scene` as a preset to `path`, whole or not at all, and returns the path.

    Raises:
        PresetError: `path` does not end in ``.toml``, cannot be written, or a text could not be read back.
    """
    path = Path(path)
    if path.suffix.lower() != ".toml":
        raise PresetError("a preset's file name ends in .toml", source=str(path))
    if group and group not in GROUPS:
        raise PresetError(f"got {group!r}; allowed is one of {', '.join(GROUPS)}", key="group", source=str(path))
    try:
        text = dumps(scene, full, title=title, description=description, group=group, time=time, paused=paused, folder=path.absolute().parent, unit=unit)
        files.write_whole(path, text.encode("utf-8"))
    except OSError as error:
        raise PresetError(f"cannot be written: {error.strerror or error}", source=str(path)) from None
    except ValueError as error:
        raise PresetError(f"cannot be written: {error}", source=str(path)) from None
    return path


def _dump(
    scene: Scene, full: bool, about: Mapping[str, str | float | bool], folder: Path | None, idle: Set[str] = frozenset(), unit: str = "r_s"
) -> str:
    document = tomlkit.document()
    for name, said in about.items():
        if said != "":
            document.add(name, said)
    texts = [tomlkit.dumps(document)] if document else []
    written = _entries_by_table(scene, full, idle)
    sections = list(dict.fromkeys(table.partition(".")[0] for table in written))
    for table, entries in sorted(written.items(), key=lambda table: sections.index(table[0].partition(".")[0])):
        found = []
        for name, item in sorted(entries.items(), key=lambda entry: bool(entry[1].columns)):  # in TOML, what stands below [[path]] belongs to it
            value = lengths.in_unit(item, scene.get(item.key), unit)
            said = lengths.field_in(item, unit).unit if full and item.unit else ""
            found.append((name, item, value if folder is None else paths.relative(item, value, folder), said))
        texts.append(_table(table, tuple(found)))
    return "\n".join(texts)


@lru_cache(512)  # most of a film's scene is that of the frame before, and writing all of it takes 8 ms
def _table(table: str, entries: tuple[tuple[str, Field, Value, str], ...]) -> str:
    """The TOML of one table with the `entries` (name, field, value, unit to tell)."""
    document = tomlkit.document()
    place: tomlkit.TOMLDocument | tomlkit.items.Table = document
    for part in table.split("."):
        place.add(part, inner := tomlkit.table())
        place = inner
    for name, item, value, said in entries:
        written = _written(item, value)
        if said:
            written.comment(said)
        place.add(name, written)
    return tomlkit.dumps(document)


def _written(item: Field, value: Value) -> tomlkit.items.Item:
    if not isinstance(value, tuple):
        return tomlkit.item(value)
    if not item.columns or not value:
        return tomlkit.item(list(value))
    records = tomlkit.aot()
    for record in value:
        records.append(tomlkit.item(dict(record)))
    return records


def _idle(scene: Scene) -> frozenset[str]:
    """The keys that plug-ins of the user's have which `scene` does not use."""
    found: set[str] = set()
    for slot, place in catalogue.SLOTS.items():
        for key, plug_in in catalogue.plug_ins(slot).items():
            if not plug_in.shipped and not place.of_kinds and key not in _used(scene, slot):
                found |= {f"{place.section}.{key}", *plug_in.parameters}  # the first is a layer's switch
    return frozenset(found)


def _used(scene: Scene, slot: str) -> tuple[Value, ...]:
    """The keys of the plug-ins of `slot` that `scene` names."""
    if slot == "disk_layer":
        return scene.disk_layers()
    return tuple(scene.get(key) for key, facts in declared().items() if facts.get("options") == slot)


def _entries_by_table(scene: Scene, full: bool, idle: Set[str]) -> dict[str, dict[str, Field]]:
    """Table → name in it → field, for the fields to be written; of those in `idle` only what is not as it comes. Empty tables are left out."""
    entries: dict[str, dict[str, Field]] = {table: {} for table in tables()}
    for key, item in fields().items():
        if full and key not in idle or scene.get(key) != item.default:
            table, name = (key, SWITCH) if key in entries else key.rsplit(".", 1)
            entries[table][name] = item
    for section in instances.SLOTS:
        for instance, made in getattr(scene, section).items():
            place = instances.Place(section, instance)
            known = instances.fields_of(place, made.kind)
            entries[place.path] = {name: item for name, item in known.items() if full or name == KIND or made.values[name] != item.default}
    return {table: items for table, items in entries.items() if items}
