"""How far a scene is what presets say: the comparison behind every name that is shown for it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from .. import Scene
from ..schema import SceneError, Value
from .reading import Preset

_MISSING = object()


def differing(scene: Scene, said: Scene) -> tuple[str, ...]:
    """The keys whose values in the two scenes differ, or that only one of them has."""
    return _differing(scene, said, {**said.fields(), **scene.fields()})


def departures(scene: Scene, layers: Sequence[Preset], place: int) -> tuple[str, ...]:
    """The keys that the preset at `place` sets, no later one of `layers` sets too, and that have another value in `scene`."""
    later = {key for layer in layers[place + 1 :] for key in layer.values}
    keys = [key for key in layers[place].values if key not in later]
    try:
        return _differing(scene, layers[place].over(scene), keys)
    except SceneError:  # it is about an instance that the scene has no more, or has of another kind
        return tuple(keys)


def _differing(scene: Scene, said: Scene, keys: Iterable[str]) -> tuple[str, ...]:
    return tuple(key for key in keys if _value(scene, key) != _value(said, key))


def _value(scene: Scene, key: str) -> Value | object:
    try:
        return scene.get(key)
    except SceneError:
        return _MISSING
