"""What the GLSL plug-ins declare in their headers, and which of them fit together.

A plug-in is one file under ``shaders/``; its header is TOML inside ``/*--- … ---*/``. Its key is the file's stem.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, Generic, Literal, TypeVar, overload

from ..resources import shaders_dir
from . import headers
from .headers import CatalogueError
from .schema import Field, nearest
from .tables import Number, Table
from .traits import IntegratorTraits, NoTraits, RayModelTraits, StepControlTraits, Traits


@dataclass(frozen=True)
class Slot:
    """A place that plug-ins fit.

    Attributes:
        folder: under ``shaders/``.
        section: of the scene, which their parameters belong to.
        traits: the class of what their headers say beside parameters.
    """

    folder: str
    section: str
    traits: type[Traits] = NoTraits


SLOTS: Mapping[str, Slot] = {
    "ray_model": Slot("ray_models", "rays", RayModelTraits),
    "integrator": Slot("integrators", "rays", IntegratorTraits),
    "step_control": Slot("step_controls", "rays", StepControlTraits),
    "disk_layer": Slot("disks", "disk"),
    "sky": Slot("skies", "sky"),
}

_DECLARED = ("parameters", "tables", "numbers")

T = TypeVar("T", bound=Traits)


@dataclass(frozen=True)
class _About:
    """The entries that every header has."""

    label: str
    summary: str
    source: str
    slot: str
    rank: float = 100.0


@dataclass(frozen=True)
class PlugIn(Generic[T]):
    """One GLSL plug-in.

    Attributes:
        key: the file's stem, as scenes name it.
        slot: the place it fits, a key of `SLOTS`.
        path: path below ``shaders/``, with forward slashes.
        label, summary, source: what people read.
        rank: its place in lists, smallest first.
        traits: what else its header says, a record of its slot.
        parameters: its scene fields, by dotted key.
        tables: the textures it looks things up in.
        numbers: what it has worked out for every frame.
    """

    key: str
    slot: str
    path: str
    label: str
    summary: str
    source: str
    rank: float
    traits: T
    parameters: Mapping[str, Field] = field(default_factory=dict)
    tables: tuple[Table, ...] = ()
    numbers: tuple[Number, ...] = ()


@overload
def plug_ins(slot: Literal["ray_model"]) -> Mapping[str, PlugIn[RayModelTraits]]: ...
@overload
def plug_ins(slot: Literal["integrator"]) -> Mapping[str, PlugIn[IntegratorTraits]]: ...
@overload
def plug_ins(slot: Literal["step_control"]) -> Mapping[str, PlugIn[StepControlTraits]]: ...
@overload
def plug_ins(slot: str) -> Mapping[str, PlugIn[Any]]: ...
def plug_ins(slot: str) -> Mapping[str, PlugIn[Any]]:
    """All plug-ins of `slot` by key, in the headers' ``rank`` (then name) order.

    Raises:
        CatalogueError: a header cannot be read, or says what it may not.
    """
    return _plug_ins(slot)


@cache
def _plug_ins(slot: str) -> Mapping[str, PlugIn[Any]]:
    found = [_read(path, slot) for path in sorted((shaders_dir() / SLOTS[slot].folder).glob("*.glsl"))]
    found.sort(key=lambda plug_in: (plug_in.rank, plug_in.key))
    return {plug_in.key: plug_in for plug_in in found}


def keys(slot: str) -> tuple[str, ...]:
    """The keys of all plug-ins of `slot`."""
    return tuple(plug_ins(slot))


def parameter_fields() -> dict[str, Field]:
    """The scene fields that plug-ins declare, by dotted key."""
    return {key: item for slot in SLOTS for plug_in in plug_ins(slot).values() for key, item in plug_in.parameters.items()}


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


def _read(path: Path, slot: str) -> PlugIn[Any]:
    header = headers.read_header(path.read_text(encoding="utf-8"), path.name)
    place, kind = SLOTS[slot], SLOTS[slot].traits
    of_all, of_slot = headers.entry_names(_About), headers.entry_names(kind)
    headers.refuse_unknown(header, (*of_all, *of_slot, *_DECLARED), path.name)
    about = headers.record(_About, {name: entry for name, entry in header.items() if name in of_all}, path.name)
    if about.slot != slot:
        raise CatalogueError(f"{path.name}: slot is {about.slot!r}, but its folder holds {slot!r}")
    traits = headers.record(kind, {name: entry for name, entry in header.items() if name in of_slot}, path.name)
    if isinstance(traits, RayModelTraits):
        _refuse_unknown_control(traits, path.name)
    declared = {part: _declared(header, part, path.name) for part in _DECLARED}
    parameters = [_parameter(f"{place.section}.{path.stem}.{name}", entry, path.name) for name, entry in declared["parameters"].items()]
    return PlugIn(
        path.stem,
        slot,
        path.relative_to(shaders_dir()).as_posix(),
        about.label,
        about.summary,
        about.source,
        about.rank,
        traits,
        {parameter.key: parameter for parameter in parameters},
        *(
            tuple(headers.record(kind, entries, f"{path.name}: {name}", name=name, file=path.name) for name, entries in declared[part].items())
            for part, kind in (("tables", Table), ("numbers", Number))
        ),
    )


def _declared(header: Mapping[str, Any], part: str, file: str) -> Mapping[str, Mapping[str, Any]]:
    """The tables below ``[parameters]``, ``[tables]`` or ``[numbers]``, by name."""
    entries = headers.table(header.get(part, {}), f"{file}: {part}")
    return {name: headers.table(entry, f"{file}: {part}.{name}") for name, entry in entries.items()}


def _refuse_unknown_control(traits: RayModelTraits, file: str) -> None:
    known = keys("step_control")
    if traits.step_control is not None and traits.step_control not in known:
        raise CatalogueError(f"{file}: step_control: got {traits.step_control!r}; allowed is one of {', '.join(known)}{nearest(traits.step_control, known)}")


def _parameter(key: str, entry: Mapping[str, Any], file: str) -> Field:
    try:
        default = entry["default"]
        text = entry["help"]
    except KeyError as missing:
        raise CatalogueError(f"{file}: parameter {key} lacks {missing}") from None
    physical = entry.get("physical")
    if isinstance(default, bool):
        return Field(key, "switch", default, help=text, physical=physical)
    kind = "int" if isinstance(default, int) else "float"
    try:
        low, high = entry["range"]
    except (KeyError, ValueError):
        raise CatalogueError(f"{file}: parameter {key} needs range = [low, high]") from None
    item = Field(key, kind, default, low, high, entry.get("unit", ""), text, physical=physical)
    item.check(default)
    return item
