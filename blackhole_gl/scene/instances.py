"""Named instances of a scene: ``things.moon``, each of a kind whose header says what values it has."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from . import catalogue
from .catalogue import KIND
from .frozen import FrozenMap
from .order import disorder, refuse_disorder
from .schema import Field, SceneError, Value, describe, nearest

SLOTS: Mapping[str, str] = {slot.section: key for key, slot in catalogue.SLOTS.items() if slot.of_kinds}
"""Section of a scene → the catalogue slot whose plug-ins are the kinds of its instances."""

LONGEST_NAME = 32

_NAME = re.compile(rf"[A-Za-z][A-Za-z0-9_]{{0,{LONGEST_NAME - 1}}}")


@dataclass(frozen=True)
class Instance:
    """One thing or medium.

    Attributes:
        kind: the plug-in's key.
        values: the value of every parameter of the kind, by name.
    """

    kind: str
    values: FrozenMap[str, Value]


Instances = FrozenMap[str, Instance]
"""Name → instance, in the order in which they were made."""


@dataclass(frozen=True)
class Place:
    """Where an instance's key leads: ``things.moon.radius`` is (things, moon, radius); without a parameter, ``things.moon``, it is the instance itself."""

    section: str
    name: str
    parameter: str = ""

    @property
    def path(self) -> str:
        """The key of the instance."""
        return f"{self.section}.{self.name}"


def place_of(key: str) -> Place | None:
    """The place that `key` names; None where it is no key of an instance or in one."""
    section, *rest = key.split(".")
    if section not in SLOTS or not 1 <= len(rest) <= 2:
        return None
    return Place(section, *rest)


def fields_of(place: Place, kind: str) -> Mapping[str, Field]:
    """The fields of an instance of `kind` by name, its kind the first."""
    return _fields_of(place.section, place.name, kind)


@lru_cache(maxsize=4096)  # more than a scene has: what is asked of each in turn would otherwise be made anew at every round
def _fields_of(section: str, name: str, kind: str) -> Mapping[str, Field]:
    kinds = catalogue.plug_ins(SLOTS[section])
    chosen = Field(f"{section}.{name}.{KIND}", "choice", kind, help=kinds[kind].summary, options=tuple(kinds))
    return {KIND: chosen} | {key: replace(item, key=f"{section}.{name}.{key}") for key, item in kinds[kind].parameters.items()}


def field_of(place: Place, instances: Instances) -> Field:
    """The field that `place` names among `instances`.

    Raises:
        SceneError: no such instance, or its kind has no such parameter.
    """
    kind = _existing(place, instances).kind
    known = fields_of(place, kind)
    if place.parameter not in known:
        raise _unknown_parameter(place, kind)
    return known[place.parameter]


def changed(section: str, instances: Instances, values: Iterable[tuple[Place, Any]]) -> Instances:
    """`instances` of `section` with `values` put in, each instance's kind first: a new one has its kind's defaults, another kind keeps what both have.

    Raises:
        SceneError: a name, kind, parameter or value that cannot be; the key is in the text.
    """
    by_name: dict[str, dict[str, Any]] = {}
    new: dict[str, Instance] = {}  # put in together: a mapping made anew for each of them would take time that grows as their number squared
    for place, value in values:
        by_name.setdefault(place.name, {})[place.parameter] = value
    for name, given in by_name.items():
        place = Place(section, name)
        kind = given.pop(KIND, None)
        made = _existing(replace(place, parameter=next(iter(given), "")), instances) if kind is None else _of_kind(place, kind, instances.get(name))
        entries = {}
        for parameter, value in given.items():
            known = fields_of(place, made.kind)
            if parameter not in known:
                raise _unknown_parameter(replace(place, parameter=parameter), made.kind)
            entries[parameter] = known[parameter].check(value)
        made = Instance(made.kind, made.values.updated(entries))
        refuse_disorder(place.path, _increasing(section, made.kind), made.values.__getitem__, entries)
        new[name] = made
    return instances.updated(new)


def renamed(place: Place, instances: Instances, name: str) -> Instances:
    """`instances` with the one at `place` called `name`, at its old rank.

    Raises:
        SceneError: there is no such instance, or the name is taken or no name.
    """
    _existing(place, instances)
    check_name(Place(place.section, name))
    if name in instances and name != place.name:
        raise SceneError(f"{place.section}.{name}", f"there is one already; {place.path} needs another name")
    return FrozenMap((name if key == place.name else key, instance) for key, instance in instances.items())


def without(place: Place, instances: Instances) -> Instances:
    """`instances` less the one at `place`.

    Raises:
        SceneError: there is no such instance.
    """
    _existing(place, instances)
    return instances.without(place.name)


def _of_kind(place: Place, given: Any, old: Instance | None) -> Instance:
    check_name(place)
    kinds = catalogue.plug_ins(SLOTS[place.section])
    if not isinstance(given, str) or given not in kinds:
        allowed = f"one of {', '.join(kinds)}" if kinds else f"nothing: there is no kind of {SLOTS[place.section]}"
        hint = nearest(given, kinds) if isinstance(given, str) else ""
        raise SceneError(f"{place.path}.{KIND}", f"got {describe(given)}; allowed is {allowed}{hint}")
    values = {name: item.default for name, item in kinds[given].parameters.items()}
    if old is not None:
        kept = {name: value for name, value in old.values.items() if name in values and _takes(kinds[given].parameters[name], value)}
        while wrong := {name for pair in disorder(_increasing(place.section, given), (values | kept).__getitem__) for name in pair} & kept.keys():
            kept = {name: value for name, value in kept.items() if name not in wrong}
        values |= kept
    return Instance(given, FrozenMap(values))


def _increasing(section: str, kind: str) -> tuple[str, ...]:
    return catalogue.plug_ins(SLOTS[section])[kind].traits.increasing


def _takes(item: Field, value: Value) -> bool:
    try:
        item.check(value)
    except SceneError:
        return False
    return True


def check_name(place: Place) -> None:
    """Refuses a name that no instance can have.

    Raises:
        SceneError: the name is none.
    """
    if not _NAME.fullmatch(place.name):
        raise SceneError(place.path, f"got the name {place.name!r}; allowed are letters, digits and _, beginning with a letter, at most {LONGEST_NAME} of them")


def _existing(place: Place, instances: Instances) -> Instance:
    if place.name in instances:
        return instances[place.name]
    check_name(place)
    known = f"allowed here are {', '.join(instances)}{nearest(place.name, instances)}" if instances else "there is none in this scene"
    key = f"{place.path}.{place.parameter}" if place.parameter else place.path
    slot = SLOTS[place.section]
    raise SceneError(key, f"there is no {slot} {place.name!r}; {known}. Allowed to make one is its {KIND}: {place.path}.{KIND} = …")


def _unknown_parameter(place: Place, kind: str) -> SceneError:
    known = fields_of(place, kind)
    key = f"{place.path}.{place.parameter}" if place.parameter else place.path
    if not place.parameter:
        return SceneError(key, f"an instance has no value of its own; allowed are {', '.join(known)}")
    return SceneError(key, f"a {kind} has no {place.parameter!r}; allowed are {', '.join(known)}{nearest(place.parameter, known)}")
