"""What rays can meet in a scene beside the disk: the kinds of its things and media, and how far from the hole they reach."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache

from . import catalogue
from .frozen import FrozenMap, changed
from .instances import Instance, Instances
from .plug_in import PlugIn
from .records import Scene
from .schema import number_of
from .traits import MetTraits

SLOTS = ("thing", "medium")

SCENES_KEPT = 16
"""Lots of instances of which is kept what was worked out for all of one: they are the same objects while only the camera moves."""


def named(scene: Scene, slot: str) -> Instances:
    """The scene's instances of the kinds of `slot`, by name."""
    return scene.things if slot == "thing" else scene.media


def instances(scene: Scene, slot: str) -> Iterator[Instance]:
    """The scene's instances of the kinds of `slot`."""
    yield from named(scene, slot).values()


def kinds(scene: Scene, slot: str) -> tuple[PlugIn, ...]:
    """The kinds of `slot` that the scene has instances of, in the catalogue's order."""
    return _kinds(named(scene, slot), slot)


@lru_cache(maxsize=2 * SCENES_KEPT)
def _kinds(lot: Instances, slot: str) -> tuple[PlugIn, ...]:
    used = {instance.kind for instance in lot.values()}
    return tuple(plug_in for key, plug_in in catalogue.plug_ins(slot).items() if key in used)


def seen_kinds(scene: Scene, slot: str) -> tuple[PlugIn, ...]:
    """Those of `kinds` of which any instance may be met: of a lamp that has no size nothing is. All of them, where that would be none."""
    all_kinds = kinds(scene, slot)
    return tuple(kind for kind in all_kinds if kind.key in _with_size(named(scene, slot), all_kinds)) or all_kinds


@lru_cache(maxsize=SCENES_KEPT)
def _with_size(lot: Instances, used: tuple[PlugIn, ...]) -> frozenset[str]:
    traits = {kind.key: kind.traits for kind in used}
    return frozenset(one.kind for one in lot.values() if not traits[one.kind].reach or extent(one, traits[one.kind]) > 0.0)


def is_empty(scene: Scene) -> bool:
    """Whether there is nothing to meet but the disk."""
    return not scene.things and not scene.media


def without_any(scene: Scene) -> Scene:
    """`scene` without its things and media: the ways of its light are the same."""
    return scene if is_empty(scene) else changed(scene, things=FrozenMap(), media=FrozenMap())


def with_thickness(scene: Scene) -> Scene:
    """`scene` with the thickness of its disks with depth stated: where an instance has none of its own, it is ``disk.thickness``."""
    parameters = {kind.key: kind.traits.thickness for kind in kinds(scene, "medium") if kind.traits.thickness}
    open_ones = [(name, parameters[one.kind]) for name, one in scene.media.items() if one.kind in parameters and not one.values[parameters[one.kind]]]
    return scene.with_values({f"media.{name}.{parameter}": scene.disk.thickness for name, parameter in open_ones}) if open_ones else scene


def extent(instance: Instance, traits: MetTraits) -> float:
    """Distance in r_s from the centre of `instance`, whose kind has `traits`, beyond which no part of it lies."""
    return sum(abs(number_of(instance.values[name])) for name in traits.reach)


def reach(scene: Scene) -> float:
    """Radius in r_s about the hole beyond which no part of any of them lies, at any time; 0 where there is none."""
    return max(reach_of(scene, slot) for slot in SLOTS)


def reach_of(scene: Scene, slot: str) -> float:
    """The same of the instances of one `slot`."""
    return _reach(named(scene, slot), kinds(scene, slot))


@lru_cache(maxsize=SCENES_KEPT)
def _reach(lot: Instances, used: tuple[PlugIn, ...]) -> float:
    traits = {kind.key: kind.traits for kind in used}
    return max((_distance(one, traits[one.kind]) + extent(one, traits[one.kind]) for one in lot.values()), default=0.0)


def _distance(instance: Instance, traits: MetTraits) -> float:
    """Of its centre from the hole, in r_s, at any time."""
    if traits.moves and instance.values["path"] != "fixed":
        return number_of(instance.values["orbit_radius"])
    return math.hypot(*(number_of(instance.values[name]) for name in ("xyz" if traits.moves else traits.centre)))
