"""All plug-ins that there are, shipped and the user's own, and which of them fit together.

A plug-in is one file under ``shaders/``; its header is TOML inside ``/*--- … ---*/``. Its key is the file's stem. The user's lie in the same
folders below the configuration folder's ``shaders/``. A mistake in a shipped header is ours and is raised; one in a user's leaves that
plug-in out, and `mistakes` tells of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal, overload

from ..resources import shaders_dir, user_shaders_dir
from . import plug_in as reading
from .headers import CatalogueError
from .plug_in import KIND, SLOTS, SWITCH, PlugIn, Slot
from .schema import Field, nearest
from .sections import declared
from .traits import DiskLayerTraits, IntegratorTraits, MediumTraits, RayModelTraits, SkyTraits, StepControlTraits, ThingTraits

__all__ = [
    "KIND", "SLOTS", "SWITCH", "Catalogue", "CatalogueError", "PlugIn", "Slot",
    "keys", "layer_fields", "mistakes", "parameter_fields", "plug_ins", "read", "reasons_against",
]  # fmt: skip


@dataclass(frozen=True)
class Catalogue:
    """What was found.

    Attributes:
        plug_ins: slot → key → plug-in, in the headers' ``rank`` (then name) order.
        mistakes: why plug-ins of the user's were left out.
    """

    plug_ins: Mapping[str, Mapping[str, PlugIn[Any]]]
    mistakes: tuple[CatalogueError, ...]


@overload
def plug_ins(slot: Literal["ray_model"]) -> Mapping[str, PlugIn[RayModelTraits]]: ...
@overload
def plug_ins(slot: Literal["integrator"]) -> Mapping[str, PlugIn[IntegratorTraits]]: ...
@overload
def plug_ins(slot: Literal["step_control"]) -> Mapping[str, PlugIn[StepControlTraits]]: ...
@overload
def plug_ins(slot: Literal["disk_layer"]) -> Mapping[str, PlugIn[DiskLayerTraits]]: ...
@overload
def plug_ins(slot: Literal["thing"]) -> Mapping[str, PlugIn[ThingTraits]]: ...
@overload
def plug_ins(slot: Literal["sky"]) -> Mapping[str, PlugIn[SkyTraits]]: ...
@overload
def plug_ins(slot: Literal["medium"]) -> Mapping[str, PlugIn[MediumTraits]]: ...
@overload
def plug_ins(slot: str) -> Mapping[str, PlugIn[Any]]: ...
def plug_ins(slot: str) -> Mapping[str, PlugIn[Any]]:
    """All plug-ins of `slot` by key, in the headers' ``rank`` (then name) order.

    Raises:
        CatalogueError: a shipped header cannot be read, or says what it may not.
    """
    return _catalogue().plug_ins[slot]


def mistakes() -> tuple[CatalogueError, ...]:
    """Why plug-ins in the user's folder were left out, a sentence each."""
    return _catalogue().mistakes


def keys(slot: str) -> tuple[str, ...]:
    """The keys of all plug-ins of `slot`."""
    return tuple(plug_ins(slot))


def parameter_fields() -> dict[str, Field]:
    """The scene fields that plug-ins declare, by dotted key; not those of kinds, which belong to instances."""
    return {
        key: item for slot, place in SLOTS.items() if not place.of_kinds for plug_in in plug_ins(slot).values() for key, item in plug_in.parameters.items()
    }


def layer_fields() -> dict[str, Field]:
    """The switches of the disk's layers, by dotted key."""
    found = {}
    for layer in plug_ins("disk_layer").values():
        key = f"{SLOTS['disk_layer'].section}.{layer.key}"
        physical = False if layer.traits.acts_on_light else None
        found[key] = Field(key, "switch", layer.traits.enabled, help=f"Layer: {layer.summary}", physical=physical, art=True)
    return found


def reasons_against(model: str, integrator: str, step_control: str) -> list[str]:
    """Why the three cannot be combined, a sentence each; empty when they fit."""
    ray_model = plug_ins("ray_model")[model]
    marches_in = ray_model.traits.marches_in
    if marches_in is None:
        return []
    scheme, control = plug_ins("integrator")[integrator].traits, plug_ins("step_control")[step_control].traits
    reasons = []
    for key, fits in ((integrator, scheme.fits), (step_control, control.fits)):
        if marches_in not in fits:
            reasons.append(f"{key} fits models that march in {' or '.join(fits)}; {model} marches in {marches_in}")
    if scheme.second_order and not ray_model.traits.second_order:
        reasons.append(f"{integrator} needs forces that depend on places alone; those of {model} depend on rates too")
    if control.needs_pair and scheme.pair_evaluations is None:
        reasons.append(f"{step_control} needs an integrator with an error estimate of its own; {integrator} has none")
    return reasons


@cache
def _catalogue() -> Catalogue:
    return read(shaders_dir(), user_shaders_dir())


def read(shipped: Path, own: Path) -> Catalogue:
    """All plug-ins below the shader folders `shipped` and `own`, the user's.

    Raises:
        CatalogueError: a shipped one has a mistake.
    """
    reader = _Reader()
    for slot in _READING_ORDER:
        for file in sorted((shipped / SLOTS[slot].folder).glob("*.glsl")):
            reader.add(file, shipped, slot, file.name)
    mistakes = []
    for slot in _READING_ORDER:
        for file in sorted((own / SLOTS[slot].folder).glob("*.glsl")):
            try:
                reader.add(file, own, slot, str(file))
            except CatalogueError as error:
                mistakes.append(error)
    ordered = {slot: dict(sorted(reader.found[slot].items(), key=lambda entry: (entry[1].rank, entry[0]))) for slot in SLOTS}
    return Catalogue(ordered, tuple(mistakes))


# Ray models last: each names a step control, which has to be there.
_READING_ORDER = tuple(sorted(SLOTS, key=lambda slot: slot == "ray_model"))


class _Reader:
    """What has been read, and the names that are taken by it."""

    def __init__(self) -> None:
        self.found: dict[str, dict[str, PlugIn[Any]]] = {slot: {} for slot in SLOTS}
        self._owners = {key.replace(".", "_"): f"the scene's {key}" for key in declared()}

    def add(self, file: Path, root: Path, slot: str, place: str) -> None:
        """Reads one more plug-in, whose names in scenes and in GLSL have to be its own."""
        known = self.found[slot].get(file.stem)
        if known is not None:
            raise CatalogueError(f"{place}: {slot} {file.stem!r} is there already, in {known.file}; another file name makes another key")
        made = reading.read(file, root, slot, place)
        if isinstance(made.traits, RayModelTraits) and made.traits.step_control is not None:
            self._refuse_unknown_control(made.traits.step_control, place)
        names = [] if SLOTS[slot].of_kinds else [f"{SLOTS[slot].section}_{made.key}", *(item.glsl_name for item in made.parameters.values())]
        for name in names:
            if name in self._owners:
                raise CatalogueError(f"{place}: its name {name} in GLSL is that of {self._owners[name]}; another file name or parameter name is needed")
        self._owners |= {name: f"{slot} {made.key!r}, {made.file}" for name in names}
        self.found[slot][made.key] = made

    def _refuse_unknown_control(self, given: str, place: str) -> None:
        known = self.found["step_control"]
        if given not in known:
            raise CatalogueError(f"{place}: step_control: got {given!r}; allowed is one of {', '.join(known)}{nearest(given, known)}")
