"""What the GLSL plug-ins declare in their headers, and which of them fit together.

A plug-in is one file under ``shaders/``; its header is TOML inside ``/*--- … ---*/``. Its key is the file's stem.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from ..resources import shaders_dir
from .schema import Field

SLOTS: Mapping[str, tuple[str, str]] = {
    # slot: (folder under shaders/, section of the scene its parameters belong to)
    "ray_model": ("ray_models", "rays"),
    "integrator": ("integrators", "rays"),
    "step_control": ("step_controls", "rays"),
    "disk_layer": ("disks", "disk"),
    "sky": ("skies", "sky"),
}


class CatalogueError(ValueError):
    """A plug-in's header is missing or wrong; the text names the file and the key."""


@dataclass(frozen=True)
class PlugIn:
    """One GLSL plug-in.

    Attributes:
        key: the file's stem, as scenes name it.
        slot: the place it fits, a key of `SLOTS`.
        path: path below ``shaders/``, with forward slashes.
        label, summary, source: what people read.
        parameters: its scene fields, by dotted key.
        traits: every other entry of the header (``kind``, ``space_time``, ``evaluations``, ``fits``, …).
    """

    key: str
    slot: str
    path: str
    label: str
    summary: str
    source: str
    parameters: Mapping[str, Field] = field(default_factory=dict)
    traits: Mapping[str, Any] = field(default_factory=dict)


@cache
def plug_ins(slot: str) -> Mapping[str, PlugIn]:
    """All plug-ins of `slot` by key, in the headers' ``rank`` (then name) order.

    Raises:
        CatalogueError: a header cannot be read.
    """
    folder, section = SLOTS[slot]
    found = [_read(path, slot, section) for path in sorted((shaders_dir() / folder).glob("*.glsl"))]
    found.sort(key=lambda plug_in: (plug_in.traits.get("rank", 100), plug_in.key))
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
    if ray_model.traits["kind"] == "closed":
        return []
    scheme, control = plug_ins("integrator")[integrator], plug_ins("step_control")[step_control]
    reasons = []
    marches_in = ray_model.traits["marches_in"]
    if marches_in not in control.traits.get("fits", (marches_in,)):
        reasons.append(f"{step_control} fits models that march in {' or '.join(control.traits['fits'])}; {model} marches in {marches_in}")
    if scheme.traits.get("second_order") and not ray_model.traits.get("second_order"):
        reasons.append(f"{integrator} needs forces that depend on places alone; those of {model} depend on rates too")
    if control.traits.get("needs_pair") and "pair_evaluations" not in scheme.traits:
        reasons.append(f"{step_control} needs an integrator with an error estimate of its own; {integrator} has none")
    return reasons


def read_header(text: str, name: str) -> dict[str, Any]:
    """The TOML header of a plug-in's `text`; `name` is used in errors.

    Raises:
        CatalogueError: no header, or not TOML.
    """
    start, end = text.find("/*---"), text.find("---*/")
    if start < 0 or end < start:
        raise CatalogueError(f"{name}: no header; a plug-in begins with /*--- TOML ---*/")
    if "*/" in text[start : end + 3]:
        raise CatalogueError(f"{name}: the header holds */, which ends the GLSL comment it lives in")
    try:
        return tomllib.loads(text[start + 5 : end])
    except tomllib.TOMLDecodeError as error:
        raise CatalogueError(f"{name}: the header is not TOML: {error}") from None


def _read(path: Path, slot: str, section: str) -> PlugIn:
    header = read_header(path.read_text(encoding="utf-8"), path.name)
    try:
        stated = header.pop("slot")
        label, summary, source = header.pop("label"), header.pop("summary"), header.pop("source")
    except KeyError as missing:
        raise CatalogueError(f"{path.name}: the header lacks {missing}") from None
    if stated != slot:
        raise CatalogueError(f"{path.name}: slot is {stated!r}, but its folder holds {slot!r}")
    declared = header.pop("parameters", {})
    parameters = [_parameter(f"{section}.{path.stem}.{name}", entry, path.name) for name, entry in declared.items()]
    relative = path.relative_to(shaders_dir()).as_posix()
    return PlugIn(path.stem, slot, relative, label, summary, source, {p.key: p for p in parameters}, header)


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
