"""The scene: what is to be seen, as frozen records with ranges and units.

Every value has a dotted key: ``<section>.<name>``, for a plug-in's parameter ``<section>.<plug-in>.<name>``, for an instance's
``things.<instance>.<name>``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, lru_cache, partial
from itertools import compress
from operator import attrgetter
from types import MappingProxyType
from typing import Any, ClassVar

from . import catalogue, instances, sections
from .frozen import FrozenMap, changed
from .instances import Instances, Place
from .order import refuse_disorder
from .schema import Field, SceneError, Value, describe, nearest_key
from .sections import Camera, Disk, Hole, Playback, Polarization, Post, Rays, Sky, Source


@dataclass(frozen=True)
class Scene:
    """All that a picture depends on but the time and the size.

    Attributes:
        parameters: values of plug-in parameters and of the disk's layers' switches by dotted key; those not listed have their defaults.
        things, media: named instances, of kinds that plug-ins are.
    """

    hole: Hole = Hole()
    camera: Camera = Camera()
    rays: Rays = Rays()
    disk: Disk = Disk()
    sky: Sky = Sky()
    post: Post = Post()
    playback: Playback = Playback()
    parameters: Mapping[str, Value] = field(default_factory=lambda: MappingProxyType({}), hash=False)
    things: Instances = FrozenMap()
    media: Instances = FrozenMap()
    source: Source = Source()
    polarization: Polarization = Polarization()

    as_png: ClassVar[Callable[[Scene], bytes] | None] = None
    """Draws a scene that a notebook shows; set by what can draw, which stands above this."""

    def _repr_png_(self) -> bytes | None:
        draw = type(self).as_png
        return None if draw is None else draw(self)

    def get(self, key: str) -> Value:
        """The value of `key`.

        Raises:
            SceneError: no such key.
        """
        getter = _getters().get(key)
        if getter is not None:
            return getter(self)
        known = fields().get(key)
        if known is not None:
            return self.parameters.get(key, known.default)
        place = instances.place_of(key)
        if place is None:
            raise _unknown(key)
        named = getattr(self, place.section)
        instances.field_of(place, named)  # says so where there is none
        instance = named[place.name]
        return instance.kind if place.parameter == catalogue.KIND else instance.values[place.parameter]

    def several(self, keys: tuple[str, ...]) -> tuple[Value, ...]:
        """The values of `keys`, of none of an instance: every frame asks for hundreds.

        Raises:
            SceneError: no such key.
        """
        return tuple([read(self) for read in _readers(keys)])

    def field(self, key: str) -> Field:
        """What `key` may be in this scene.

        Raises:
            SceneError: no such key; the nearest known one is named.
        """
        place = instances.place_of(key)
        return _field(key) if place is None else instances.field_of(place, getattr(self, place.section))

    def fields(self) -> Mapping[str, Field]:
        """Every settable field of this scene by dotted key: the module function's `fields`, then those of its instances."""
        if not self.things and not self.media:
            return fields()
        return _fields_with(self.things, self.media)

    def keys(self) -> tuple[str, ...]:
        """Every key, in the order of `fields`."""
        return tuple(self.fields())

    def values(self) -> dict[str, Value]:
        """Every key's value, in the order of `fields`."""
        return {key: self.get(key) for key in self.fields()}

    def with_values(self, values: Mapping[str, Any]) -> Scene:
        """This scene with `values` (dotted key → value) put in. An instance is made by its kind, ``things.moon.kind``.

        Raises:
            SceneError: an unknown key (the nearest known one is named), a value that its field does not take, or values that have an order out of it.
        """
        records: dict[str, dict[str, Value]] = {}
        placed: dict[str, list[tuple[Place, Any]]] = {}
        parameters: dict[str, Value] = {}
        for key, given in values.items():
            place = instances.place_of(key)
            if place is not None:
                placed.setdefault(place.section, []).append((place, given))
                continue
            value = _field(key).check(given)
            if key in _getters():
                section, name = key.split(".")
                records.setdefault(section, {})[name] = value
            else:
                parameters[key] = value
        made: dict[str, Any] = {section: changed(getattr(self, section), **entries) for section, entries in records.items()}
        for section, record in made.items():
            refuse_disorder(section, sections.INCREASING.get(section, ()), partial(getattr, record), records[section])
        made |= {section: instances.changed(section, getattr(self, section), entries) for section, entries in placed.items()}
        if parameters:
            plain = {key for key, value in parameters.items() if value == _field(key).default}
            stated = {key: value for key, value in {**self.parameters, **parameters}.items() if key not in plain}
            made["parameters"] = MappingProxyType(stated)
        return changed(self, **made)

    def without(self, path: str) -> Scene:
        """This scene less the instance ``things.moon``.

        Raises:
            SceneError: there is no such instance.
        """
        place = _instance(path)
        return changed(self, **{place.section: instances.without(place, getattr(self, place.section))})

    def renamed(self, path: str, name: str) -> Scene:
        """This scene with the instance ``things.moon`` called `name`.

        Raises:
            SceneError: there is no such instance, or the name is taken or no name.
        """
        place = _instance(path)
        return changed(self, **{place.section: instances.renamed(place, getattr(self, place.section), name)})

    def disk_layers(self) -> tuple[str, ...]:
        """The keys of the disk's layers that are switched on."""
        layers, switches = _layer_switches()
        return tuple(compress(layers, self.several(switches)))

    @property
    def disk_moves(self) -> bool:
        """Whether the disk looks otherwise at another time."""
        known = catalogue.plug_ins("disk_layer")
        return self.disk.enabled and any(known[key].traits.moves for key in self.disk_layers())

    def __reduce__(self):
        return _restore, (self.values(),)


def refuse_other(value: object) -> None:
    """Refuses what is no scene, as a preset's name where one is asked for.

    Raises:
        TypeError: it is none.
    """
    if not isinstance(value, Scene):
        raise TypeError(f"scene: got {describe(value)}; allowed is a Scene, as load('kerr') makes one")


def _restore(values: Mapping[str, Value]) -> Scene:
    return Scene().with_values(values)


def _instance(path: str) -> Place:
    place = instances.place_of(path)
    if place is None or place.parameter:
        raise SceneError(path, f"no instance; allowed are names like {', '.join(f'{section}.NAME' for section in instances.SLOTS)}")
    return place


@cache
def fields() -> Mapping[str, Field]:
    """Every field that all scenes have by dotted key: the records' own and the disk's layers' switches, then the plug-ins' parameters."""
    found: dict[str, Field] = {}
    for section in sections.SECTIONS:
        found |= {key: item for key, item in _record_fields().items() if key.startswith(f"{section}.")}
        if section == catalogue.SLOTS["disk_layer"].section:
            found |= catalogue.layer_fields()
    return MappingProxyType({**found, **catalogue.parameter_fields()})


@lru_cache(maxsize=64)
def _fields_with(things: Instances, media: Instances) -> Mapping[str, Field]:
    found = dict(fields())
    for section, named in (("things", things), ("media", media)):
        for name, instance in named.items():
            found |= {item.key: item for item in instances.fields_of(Place(section, name), instance.kind).values()}
    return MappingProxyType(found)


@cache
def _record_fields() -> Mapping[str, Field]:
    found = {}
    for key, facts in sections.declared().items():
        options = facts.get("options", ())
        if isinstance(options, str):
            options = (("auto",) if facts["default"] == "auto" else ()) + catalogue.keys(options)
        found[key] = Field(key, **{**facts, "options": options})
    return MappingProxyType(found)


@cache
def _getters() -> Mapping[str, Callable[[Scene], Value]]:
    """What reads the value of each of the records' own fields. Every frame asks for all of them."""
    return {key: attrgetter(key) for key in _record_fields()}


@cache
def _readers(keys: tuple[str, ...]) -> tuple[Callable[[Scene], Value], ...]:
    """What reads the value of each of `keys`."""
    return tuple(_getters().get(key) or partial(_parameter, key, _field(key).default) for key in keys)


def _parameter(key: str, default: Value, scene: Scene) -> Value:
    return scene.parameters.get(key, default)


@cache
def _layer_switches() -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Every layer of the disk, and the key of its switch."""
    return tuple(catalogue.keys("disk_layer")), tuple(catalogue.layer_fields())


def _field(key: str) -> Field:
    known = fields()
    if key in known:
        return known[key]
    raise _unknown(key)


def _unknown(key: str) -> SceneError:
    near = nearest_key(key, fields())
    hint = f"; did you mean {near}?" if near else ""
    return SceneError(key, f"no such key{hint}")
