"""TOML text → checked values of a scene, and the errors that say what is wrong with it."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from ...text_files import decimal_comma
from .. import FrozenMap, Scene, catalogue, fields, instances, lengths
from ..catalogue import KIND, SWITCH
from ..headers import is_name
from ..schema import WHOLE_NUMBER_LIMIT, Field, SceneError, Value, describe, nearest, nearest_key
from . import paths

GROUPS = ("physics", "look", "quality", "steps", "scene")
_TEXT_ENTRIES = ("title", "description", "group", "formerly", "version", "lengths")
_NUMBER_ENTRIES = ("rank", "time")
_SWITCH_ENTRIES = ("paused",)
_ABOUT = _TEXT_ENTRIES + _NUMBER_ENTRIES + _SWITCH_ENTRIES


class PresetError(SceneError):
    """A preset that cannot be found, read or used.

    Attributes:
        key: the dotted key at fault; empty where no single key is.
        source: the file, or the words ``--set``; empty where there is none.
        line: line in the file, from 1; None where unknown.
    """

    def __init__(self, message: str, *, key: str = "", source: str = "", line: int | None = None):
        place = f"{source}, line {line}" if line else source
        ValueError.__init__(self, ": ".join(part for part in (place, key, message) if part))
        self.key, self.message, self.entry, self.source, self.line = key, message, 0, source, line


@dataclass(frozen=True)
class Preset:
    """What a preset says.

    Attributes:
        group: one of `GROUPS`, or empty.
        formerly: the name it had, by which it is still found; empty where it had no other.
        rank: place in lists of its group, smallest first.
        lengths: the unit that lengths have in the file, one of `lengths.UNITS`; here all are in r_s.
        time: scene time at which it was saved, r_s/c; None for presets of no time.
        paused: whether time stood still then.
        values: the scene's values it sets, by dotted key, checked; but those of an instance whose kind it leaves to other presets are as they
            stand in the file.
        skipped: a sentence for each entry that this version does not know, as a newer one's file may have; the rest counts.
        source: what errors call it.
        folder: where its relative paths start, and below which all files that it names have to lie; None: it may name assets alone.
        any_file: whether it may name files that lie elsewhere, too.
        text: the TOML it was made from.
    """

    title: str = ""
    description: str = ""
    group: str = ""
    formerly: str = ""
    version: str = ""
    lengths: str = "r_s"
    rank: float = 100.0
    time: float | None = None
    paused: bool = False
    values: Mapping[str, Any] = field(default_factory=dict)
    skipped: tuple[str, ...] = ()
    source: str = "preset"
    folder: Path | None = None
    any_file: bool = False
    text: str = field(default="", repr=False)

    def over(self, scene: Scene) -> Scene:
        """`scene` with what this preset sets put in, but for files that it may not name: see `refused`.

        Raises:
            PresetError: it sets values of an instance that is not there, or that the instance's kind does not have or take.
        """
        made = self._anchored_over(scene)
        if self.any_file:
            return made
        return self._with_paths(made, lambda item, value: paths.kept_within(item, value, self.folder))

    def refused(self, scene: Scene) -> tuple[str, ...]:
        """What `over` leaves out because it is a file outside the preset's own folder, a sentence each.

        Raises:
            PresetError: as `over`.
        """
        if self.any_file:
            return ()
        made = self._anchored_over(scene)
        refused = [(key, path) for key in self.values for path in paths.outside(made.field(key), made.get(key), self.folder)]
        allowed = f"files below {self.folder}" if self.folder else "assets of the program"
        return tuple(str(self._error(key, f"left out: the file {path}; allowed without asking are {allowed}")) for key, path in refused)

    def _anchored_over(self, scene: Scene) -> Scene:
        try:
            made = scene.with_values(self.values)
        except SceneError as error:
            raise self._error(error.key, error.message, error.entry) from None
        folder = self.folder
        return made if folder is None else self._with_paths(made, lambda item, value: paths.anchored(item, value, folder))

    def _with_paths(self, scene: Scene, change: Callable[[Field, Value], Value]) -> Scene:
        """`scene` with `change` made to the paths among what this preset sets."""
        old = {key: scene.get(key) for key in self.values}
        new = {key: change(scene.field(key), value) for key, value in old.items()}
        return scene.with_values({key: value for key, value in new.items() if value != old[key]})

    def _error(self, key: str, message: str, entry: int = 0) -> PresetError:
        return PresetError(message, key=key, source=self.source, line=_line_of(key, self.text, entry))


def parse(text: str, source: str = "preset", folder: Path | None = None) -> Preset:
    """The preset in the TOML `text`.

    Args:
        source: what errors call it.
        folder: where its relative paths start; None leaves them as they are.

    Raises:
        PresetError: not TOML, or a value that a scene cannot hold.
    """
    try:
        data = tomllib.loads(text)
    except RecursionError:
        raise PresetError("not TOML that can be read: nested too deeply", source=source) from None
    except ValueError as error:
        # tomllib's own errors name line and column; Python's (a number of 5000 digits, say) are ValueErrors as well
        raise PresetError(f"not TOML: {error}{_comma_in_line(text, str(error))}", source=source) from None
    return _Reader(source, text).read(data, folder)


class _Reader:
    """Checks one parsed TOML document, entry by entry."""

    def __init__(self, source: str, text: str):
        self._source, self._text = source, text
        self._unit = "r_s"
        self._values: dict[str, Any] = {}
        self._skipped: list[str] = []

    def read(self, data: Mapping[str, Any], folder: Path | None) -> Preset:
        about: dict[str, Any] = {}
        if "lengths" in data:
            self._unit = str(self._about("lengths", data["lengths"]))  # wherever it stands
        for name, value in data.items():
            if name in _ABOUT:
                about[name] = self._about(name, value)
            elif name in instances.SLOTS:
                self._section_of_instances(name, value)
            else:
                self._walk(_quoted(name), value)
        if "time" in about:
            about["time"] /= lengths.factor(self._unit)
        return Preset(**about, values=self._values, skipped=tuple(self._skipped), source=self._source, folder=folder, text=self._text)

    def _about(self, name: str, value: Any) -> str | float | bool:
        if name in _NUMBER_ENTRIES:
            allowed = "a finite number"
            if type(value) in (int, float) and abs(value) < WHOLE_NUMBER_LIMIT:
                return float(value)
        elif name in _SWITCH_ENTRIES:
            allowed = "true or false"
            if isinstance(value, bool):
                return value
        elif name in ("group", "lengths"):
            words = GROUPS if name == "group" else lengths.UNITS
            allowed = "one of " + ", ".join(words)
            if value in words:
                return value
        else:
            allowed = "text in quotes"
            if isinstance(value, str):
                return value
        raise self._error(name, f"got {describe(value)}; allowed is {allowed}")

    def _walk(self, key: str, value: Any) -> None:
        item = fields().get(key)
        switch = item if item is not None and item.kind == "switch" else None
        if isinstance(value, dict) and (key in tables() or switch is not None):
            for name, entry in value.items():
                if switch is not None and name == SWITCH:
                    self._put(switch, entry)
                else:
                    self._walk(f"{key}.{_quoted(name)}", entry)
        elif item is not None:
            self._put(item, value)
        elif key in tables():
            raise self._error(key, f"got {describe(value)}; allowed is a table, [{key}]")
        else:
            self._skip(key, nearest(key, _all_keys()))

    def _put(self, item: Field, value: Any) -> None:
        try:
            self._values[item.key] = self._checked(item, self._of_known_columns(item, value))
        except SceneError as error:
            raise self._error(item.key, error.message + _comma_in(value), error.entry) from None

    def _checked(self, item: Field, value: Any) -> Any:
        """`value`, which is in the file's unit of lengths, as the scene has it."""
        return lengths.in_rs(item, lengths.field_in(item, self._unit).check(value), self._unit)

    def _section_of_instances(self, section: str, value: Any) -> None:
        if not isinstance(value, dict):
            raise self._error(section, f"got {describe(value)}; allowed is a table for each of them, [{section}.NAME]")
        for name, entries in value.items():
            place = instances.Place(section, name)
            try:
                instances.check_name(place)
            except SceneError as error:
                raise self._error(error.key, error.message) from None
            if not isinstance(entries, dict):
                raise self._error(place.path, f"got {describe(entries)}; allowed is a table, [{place.path}]")
            self._instance(place, entries)

    def _instance(self, place: instances.Place, entries: Mapping[str, Any]) -> None:
        """What is said of one instance; without its kind no more can be seen here than that the names may be some."""
        if self._unit != "r_s" and KIND not in entries:
            raise self._error(place.path, f"no kind; with lengths = \"{self._unit}\" one file has to say both kind and values of it")
        kind, kinds = entries.get(KIND), catalogue.plug_ins(instances.SLOTS[place.section])
        known = instances.fields_of(place, kind) if isinstance(kind, str) and kind in kinds else None
        for name in entries:
            if known is not None and name not in known:
                self._skip(f"{place.path}.{_quoted(name)}", nearest(name, known))
            elif not is_name(name):
                self._skip(f"{place.path}.{_quoted(name)}", "")
        entries = {name: value for name, value in entries.items() if is_name(name) and (known is None or name in known)}
        if known is not None:
            entries = {name: self._of_known_columns(known[name], value) for name, value in entries.items()}
        if KIND in entries:
            try:
                given = {instances.Place(place.section, place.name, name): self._of_instance(known, name, value) for name, value in entries.items()}
                made = instances.changed(place.section, FrozenMap(), given.items())[place.name]
            except SceneError as error:
                raise self._error(error.key, error.message + _comma_in(entries.get(error.key.rpartition(".")[2])), error.entry) from None
            entries = {name: made.kind if name == KIND else made.values[name] for name in entries}
        self._values |= {f"{place.path}.{name}": value for name, value in entries.items()}

    def _of_instance(self, known: Mapping[str, Field] | None, name: str, value: Any) -> Any:
        """`value` of an instance as the scene has it, where its kind is known."""
        return value if known is None or name == KIND else self._checked(known[name], value)

    def _of_known_columns(self, item: Field, value: Any) -> Any:
        """`value` less what its records have beside the columns of `item`, if it is a list of records."""
        if not item.columns or not isinstance(value, list):
            return value
        names = [column.key for column in item.columns]
        for number, record in enumerate(value, 1):
            for name in record if isinstance(record, dict) else ():
                if name not in names:
                    told = f"entry {number}: {_quoted(name)} skipped, for this version has no such entry in it{nearest(name, names)}"
                    self._skipped.append(str(self._error(item.key, told, number)))
        return [{name: entry for name, entry in record.items() if name in names} if isinstance(record, dict) else record for record in value]

    def _skip(self, key: str, hint: str) -> None:
        self._skipped.append(str(self._error(key, f"skipped, for this version has no such key{hint}")))

    def _error(self, key: str, message: str, entry: int = 0) -> PresetError:
        return PresetError(message, key=key, source=self._source, line=_line_of(key, self._text, entry))


def unknown_key(key: str) -> str:
    """What to say of a key that no scene has: the nearest one, and those of its table."""
    if key in instances.SLOTS:
        kinds = ", ".join(catalogue.plug_ins(instances.SLOTS[key])) or "none"
        return f"it holds any number of named {key}; allowed is {key}.NAME.kind=KIND, which makes one (kinds: {kinds}), then {key}.NAME.PARAMETER=VALUE"
    if key in tables():
        return f"it is a table and has no value of its own; allowed here are {', '.join(known for known in fields() if known.startswith(key + '.'))}"
    near, section = nearest_key(key, _all_keys()), key.split(".")[0]
    hint = f"; did you mean {near}?" if near else "."
    if section in tables():
        allowed = [known for known in fields() if known.startswith(section + ".")]
    else:
        named = (f"[{section}.NAME]" for section in instances.SLOTS)
        allowed = [*(f"[{table}]" for table in tables() if "." not in table), *named, *_ABOUT]
    return f"no such key{hint} Allowed here are {', '.join(allowed)}"


def _all_keys() -> tuple[str, ...]:
    return (*fields(), *tables(), *instances.SLOTS)


@cache
def tables() -> tuple[str, ...]:
    """Dotted names of the tables that all scenes have, sections before what lies in them."""
    tables: dict[str, None] = {}  # a set in order
    for key in fields():
        parts = key.split(".")
        for depth in range(1, len(parts)):
            tables[".".join(parts[:depth])] = None
    return tuple(sorted(tables, key=lambda table: table.count(".")))


def _line_of(key: str, text: str, entry: int = 0) -> int | None:
    """Line (from 1) of `text` that sets `key`, or begins that `entry` of its list, else that opens its table; None when none is plain to see."""
    key, table, opened, begun = _plain(key), "", None, 0
    for number, line in enumerate(text.splitlines(), start=1):
        header = re.match(r"\s*\[\[?([^\[\]]+)\]", line)
        assignment = re.match(r"\s*([\w\-.\"' ]+?)\s*=", line)
        if header:
            table = _plain(header[1])
            begun += table == key
            if entry and begun == entry:
                return number
            if opened is None and (f"{key}.".startswith(f"{table}.") or table.startswith(f"{key}.")):
                opened = number
        elif assignment:
            full = f"{table}.{_plain(assignment[1])}".lstrip(".")
            if key == full or key.startswith(full + ".") or full == f"{key}.{SWITCH}":
                return number
    return opened


def _quoted(name: str) -> str:
    """`name` as TOML writes it in a key, so that ``"hole.spin"`` is not taken for ``hole.spin``."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name, ensure_ascii=False)


def _plain(name: str) -> str:
    return re.sub(r"[\s\"']", "", name)


def _comma_in(value: Any) -> str:
    return decimal_comma(value) if isinstance(value, str) else ""


def _comma_in_line(text: str, message: str) -> str:
    """A hint where tomllib's `message` is about a line of `text` whose value has a decimal comma."""
    place = re.search(r"at line (\d+)", message)
    line = text.split("\n")[int(place[1]) - 1] if place else ""
    return decimal_comma(line.partition("=")[2].partition("#")[0])
