"""One plug-in: a GLSL file with a header, as its header describes it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any, Generic, TypeVar

from ..resources import shaders_dir
from ..text_files import TextError, read_text
from . import headers, motion, parameters, surfaces
from .headers import CatalogueError
from .order import disorder
from .schema import Field, nearest
from .tables import Number, Table
from .traits import DiskLayerTraits, IntegratorTraits, MediumTraits, MetTraits, RayModelTraits, SkyTraits, StepControlTraits, ThingTraits, Traits


@dataclass(frozen=True)
class Slot:
    """A place that plug-ins fit.

    Attributes:
        folder: under ``shaders/``.
        section: of the scene, which their parameters belong to.
        traits: the class of what their headers say beside parameters.
        of_kinds: whether a plug-in is a kind of which a scene holds named instances, each with the parameters as its own.
    """

    folder: str
    section: str
    traits: type[Traits]
    of_kinds: bool = False


SLOTS: Mapping[str, Slot] = MappingProxyType(
    {
        "ray_model": Slot("ray_models", "rays", RayModelTraits),
        "integrator": Slot("integrators", "rays", IntegratorTraits),
        "step_control": Slot("step_controls", "rays", StepControlTraits),
        "disk_layer": Slot("disks", "disk", DiskLayerTraits),
        "sky": Slot("skies", "sky", SkyTraits),
        "thing": Slot("things", "things", ThingTraits, of_kinds=True),
        "medium": Slot("media", "media", MediumTraits, of_kinds=True),
    }
)

KIND = "kind"
"""The entry of an instance that names its kind, which no parameter of a kind may be called."""

SWITCH = "enabled"
"""What stands for a layer's own switch among its parameters in a file, which none of them may be called."""

_OF_INSTANCES = (KIND, "count", "bound", "centre", "velocity", "spin", "attitude", "finish", "distance", "crossing", "light", "scale", "matter")
"""What shaders and scenes call something else of an instance."""

_RESERVED: Mapping[str, tuple[str, ...]] = {"disk_layer": (SWITCH,), "thing": _OF_INSTANCES, "medium": _OF_INSTANCES}
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
        file: the file itself.
        label, summary, source: what people read.
        rank: its place in lists, smallest first.
        traits: what else its header says, a record of its slot.
        parameters: its scene fields, by dotted key; those of a kind by name, as each instance has them.
        tables: the textures it looks things up in.
        numbers: what it has worked out for every frame.
    """

    key: str
    slot: str
    path: str
    file: Path
    label: str
    summary: str
    source: str
    rank: float
    traits: T
    parameters: Mapping[str, Field]
    tables: tuple[Table, ...]
    numbers: tuple[Number, ...]

    def __hash__(self) -> int:
        return hash(self.path)  # a kind is a key of what is kept of a scene, in every frame

    @cached_property
    def shipped(self) -> bool:
        """Whether it is ours and not the user's."""
        return self.file.is_relative_to(shaders_dir())


def read(file: Path, root: Path, slot: str, place: str) -> PlugIn[Any]:
    """The plug-in in `file`, below the shader folder `root`.

    Args:
        place: what errors call the file.

    Raises:
        CatalogueError: it cannot be read, has no header, or an entry is missing, unknown or of the wrong kind.
    """
    try:
        header = headers.read_header(read_text(file), place)
    except OSError as error:
        raise CatalogueError(f"{place}: cannot be read: {error.strerror or error}") from None
    except TextError as error:
        raise CatalogueError(f"{place}: {error}") from None
    if not headers.is_name(file.stem) or file.stem == "auto":
        raise CatalogueError(f"{place}: the file's name is the plug-in's key; allowed are {headers.NAMES}, other than auto")
    kind = SLOTS[slot].traits
    of_all, of_slot = headers.entry_names(_About), headers.entry_names(kind)
    headers.refuse_unknown(header, (*of_all, *of_slot, *_DECLARED), place)
    about = headers.record(_About, {name: entry for name, entry in header.items() if name in of_all}, place)
    if about.slot != slot:
        raise CatalogueError(f"{place}: slot is {about.slot!r}, but its folder holds {slot!r}")
    traits = headers.record(kind, {name: entry for name, entry in header.items() if name in of_slot}, place)
    declared = {part: _declared(header, part, place) for part in _DECLARED}
    known = _parameters(declared["parameters"], slot, file.stem, place)
    if isinstance(traits, MetTraits):
        for entry, group in groups(traits).items():
            known = _with_group(known, entry, group, place)
        for entry in ("reach", "centre", "increasing"):
            _refuse_unknown_numbers(entry, getattr(traits, entry), known, place)
        _refuse_disordered_defaults(traits.increasing, known, place)
    if isinstance(traits, RayModelTraits):
        own = {key.rpartition(".")[2]: item for key, item in known.items()}
        for entry in ("harder_with", "milder_with"):
            _refuse_unknown_numbers(entry, getattr(traits, entry), own, place)
        for name in traits.harder_with:
            if name in traits.milder_with:
                raise CatalogueError(f"{place}: milder_with: got {name!r}, which is in harder_with too; a parameter is allowed in one of them")
    if isinstance(traits, MediumTraits):
        _refuse_unknown_numbers("parts", traits.parts, known, place)
    if isinstance(traits, MediumTraits) and traits.phenomenological:
        known = MappingProxyType({name: replace(item, art=True) for name, item in known.items()})
    path = file.relative_to(root).as_posix()
    return PlugIn(
        file.stem,
        slot,
        path,
        file,
        about.label,
        about.summary,
        about.source,
        about.rank,
        traits,
        known,
        tuple(headers.record(Table, entries, f"{place}: {name}", name=name, file=place) for name, entries in declared["tables"].items()),
        tuple(headers.record(Number, entries, f"{place}: {name}", name=name, file=place) for name, entries in declared["numbers"].items()),
    )


def groups(traits: MetTraits) -> Mapping[str, Mapping[str, Field]]:
    """Parameters that kinds have in common, by the entry of the header that asks for them: those that `traits` ask for."""
    known = {"moves": motion.FIELDS, "surface": surfaces.SURFACE, "shines": surfaces.LAMP}
    return {entry: group for entry, group in known.items() if getattr(traits, entry, False)}


def _with_group(known: Mapping[str, Field], entry: str, group: Mapping[str, Field], place: str) -> Mapping[str, Field]:
    """`known` parameters, and behind them those that `entry` brings."""
    for name in known:
        if name in group:
            raise CatalogueError(f"{place}: parameters.{name}: a kind with {entry} = true has a {name!r} already; the parameter needs another name")
    return MappingProxyType({**known, **group})


def _refuse_unknown_numbers(entry: str, names: tuple[str, ...], known: Mapping[str, Field], place: str) -> None:
    numbers = [name for name, item in known.items() if item.kind in ("float", "int")]
    for name in names:
        if name not in numbers:
            raise CatalogueError(f"{place}: {entry}: got {name!r}; allowed are its parameters that are numbers: {', '.join(numbers)}{nearest(name, numbers)}")


def _refuse_disordered_defaults(increasing: tuple[str, ...], known: Mapping[str, Field], place: str) -> None:
    for smaller, larger in disorder(increasing, lambda name: known[name].default):
        raise CatalogueError(f"{place}: increasing: the default of {smaller!r} is larger than that of {larger!r}")


def _declared(header: Mapping[str, Any], part: str, place: str) -> Mapping[str, Mapping[str, Any]]:
    """The tables below ``[parameters]``, ``[tables]`` or ``[numbers]``, by name."""
    entries = headers.table(header.get(part, {}), f"{place}: {part}")
    for name in entries:
        if not headers.is_name(name):
            raise CatalogueError(f"{place}: {part}: got {name!r}; allowed are {headers.NAMES}")
    return {name: headers.table(entry, f"{place}: {part}.{name}") for name, entry in entries.items()}


def _parameters(declared: Mapping[str, Mapping[str, Any]], slot: str, key: str, place: str) -> Mapping[str, Field]:
    prefix = "" if SLOTS[slot].of_kinds else f"{SLOTS[slot].section}.{key}."
    found = {}
    for name, entry in declared.items():
        if name in _RESERVED.get(slot, ()):
            raise CatalogueError(f"{place}: parameters.{name}: {name!r} has another meaning here; the parameter needs another name")
        found[prefix + name] = parameters.field_of(prefix + name, entry, f"{place}: parameters.{name}")
    return MappingProxyType(found)
