"""Which fields that were measured are at least as hard to march through as another: steps that do in those do in it."""

from __future__ import annotations

from functools import lru_cache

from ..physics.space_time import ray_model
from ..scene import Scene, catalogue, fields
from ..scene.catalogue import PlugIn
from ..scene.schema import Value, number_of

_OF_ALL = ("rays.field_radius", "rays.field_way")  # what every field has


def field_text(scene: Scene) -> str:
    """The parameters of the field of `scene` that are not as they come, as the table names them: ``refraction.size=5.0;…``; empty where all are."""
    keys, plain = _parameters(ray_model(scene))
    values = scene.several(keys)
    if values == plain:
        return ""
    return ";".join(f"{key.removeprefix('rays.')}={value}" for key, value, default in sorted(zip(keys, values, plain)) if value != default)


def as_hard(scene: Scene, measured: frozenset[str]) -> frozenset[str]:
    """Those of the fields `measured`, each as `field_text` has it, that are as hard as that of `scene`, of the same ray model: the same alone where that is
    among them. What the model says of no parameter has to be the same."""
    keys, _ = _parameters(ray_model(scene))
    return _as_hard(scene.rays.model, field_text(scene), tuple(zip(keys, scene.several(keys))), measured)


@lru_cache(maxsize=64)
def _as_hard(model: str, text: str, own: tuple[tuple[str, Value], ...], measured: frozenset[str]) -> frozenset[str]:
    return frozenset([text]) if text in measured else frozenset(other for other in measured if _is_as_hard(other, model, own))


def _is_as_hard(text: str, model: str, own: tuple[tuple[str, Value], ...]) -> bool:
    stated = dict(pair.split("=") for pair in text.split(";") if pair)
    defaults = Scene().with_values({"rays.model": model})
    traits = catalogue.plug_ins("ray_model")[model].traits
    for key, value in own:
        name, theirs = key.rpartition(".")[2], stated.get(key.removeprefix("rays."), str(defaults.get(key)))
        if name in traits.harder_with:
            holds = min(0.0, float(theirs)) <= number_of(value) <= max(0.0, float(theirs))
        else:
            holds = str(value) == theirs or name in traits.milder_with and number_of(value) >= float(theirs)
        if not holds:
            return False
    return True


@lru_cache(maxsize=16)
def _parameters(model: PlugIn) -> tuple[tuple[str, ...], tuple[Value, ...]]:
    """The keys that tell a field of `model` from others, and their values as they come."""
    keys = *model.parameters, *_OF_ALL
    return keys, tuple(fields()[key].default for key in keys)
