"""What rays can meet in a scene beside the disk: the kinds of its things and media, and how far from the hole they reach."""

from __future__ import annotations

from collections.abc import Iterator

from . import catalogue
from .instances import Instance
from .plug_in import PlugIn
from .records import Scene
from .schema import number_of

SLOTS = ("thing", "medium")


def instances(scene: Scene, slot: str) -> Iterator[Instance]:
    """The scene's instances of the kinds of `slot`."""
    yield from (scene.things if slot == "thing" else scene.media).values()


def kinds(scene: Scene, slot: str) -> list[PlugIn]:
    """The kinds of `slot` that the scene has instances of, in the catalogue's order."""
    used = {instance.kind for instance in instances(scene, slot)}
    return [plug_in for key, plug_in in catalogue.plug_ins(slot).items() if key in used]


def is_empty(scene: Scene) -> bool:
    """Whether there is nothing to meet but the disk."""
    return not scene.things and not scene.media


def reach(scene: Scene) -> float:
    """Radius in r_s beyond which no part of any of them lies; 0 where there is none."""
    found = 0.0
    for slot in SLOTS:
        known = catalogue.plug_ins(slot)
        for instance in instances(scene, slot):
            found = max(found, sum(abs(number_of(instance.values[name])) for name in known[instance.kind].traits.reach))
    return found
