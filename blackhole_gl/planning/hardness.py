"""Which fields that were measured are at least as hard to march through as another: steps that do in those do in it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from ..physics.space_time import ray_model
from ..scene import Scene, catalogue
from ..scene.schema import Value, number_of

_OF_ALL = ("rays.field_radius", "rays.field_way")  # what every field has


def field_text(scene: Scene) -> str:
    """The parameters of the field of `scene` that are not as they come, as the table names them: ``refraction.size=5.0;…``; empty where all are."""
    return ";".join(f"{key.removeprefix('rays.')}={value}" for key, value in sorted(_values(scene).items()) if value != scene.field(key).default)


def as_hard(scene: Scene, measured: frozenset[str]) -> frozenset[str]:
    """Those of the fields `measured`, each as `field_text` has it, that are as hard as that of `scene`, of the same ray model: the same alone where that is
    among them. What the model says of no parameter has to be the same."""
    return _as_hard(scene.rays.model, field_text(scene), tuple(_values(scene).items()), measured)


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


def _values(scene: Scene) -> Mapping[str, Value]:
    return {key: scene.get(key) for key in (*ray_model(scene).parameters, *_OF_ALL)}
