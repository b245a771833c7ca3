"""Which of the scene's instances a hit is of: hits number kinds and instances, scenes name them."""

from __future__ import annotations

import numpy as np

from ..scene import Scene
from ..scene.instances import SLOTS
from ..shapes import Int
from . import instances

Number = tuple[int, int]
"""A kind, as in `instances.used`, and which of the instances of that kind, in the scene's order."""

_SECTIONS = {slot: section for section, slot in SLOTS.items()}


def path_of(scene: Scene, number: Number) -> str:
    """The key of an instance that a hit map of `scene` numbers so, such as ``things.moon``."""
    kind = instances.used(scene)[number[0]]
    section = _SECTIONS[kind.slot]
    names = [name for name, instance in getattr(scene, section).items() if instance.kind == kind.key]
    return f"{section}.{names[number[1]]}"


def number_of(scene: Scene, path: str) -> Number | None:
    """The other way round; None where `scene` has no such instance."""
    section, _, name = path.partition(".")
    named = getattr(scene, section)
    if name not in named:
        return None
    kind = named[name].kind
    place = next(place for place, used in enumerate(instances.used(scene)) if (used.slot, used.key) == (SLOTS[section], kind))
    return place, [key for key, instance in named.items() if instance.kind == kind].index(name)


def picked(scene: Scene, met: Int[np.ndarray, "meetings 3"] | None) -> str:
    """The key of the thing that a ray meets first, `met` in a hit map of `scene`; of the first medium where it meets no thing; empty for neither."""
    paths = [path_of(scene, (int(kind), int(row))) for kind, row, _ in (met if met is not None else ()) if kind >= 0]
    return next((path for path in paths if path.startswith("things.")), next(iter(paths), ""))
