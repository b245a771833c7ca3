"""Picking one preset of a group without losing what the others, or the user's hand, have set."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from ..scene import Scene, instances, presets
from ..scene.catalogue import KIND
from .state import WindowState

PICKERS: Mapping[str, tuple[str, ...]] = {"Physics": ("physics",), "Look": ("look",), "Quality": ("quality", "steps")}
"""The panel's pickers of presets that lie over each other, and the groups in each: a preset of either group takes the place of the other's."""

LAYERED = tuple(group for groups in PICKERS.values() for group in groups)
WHOLE = ("scene", presets.USER_GROUP)

DEFAULT_QUALITY = {"quality": "automatic"}
"""What a scene has that says nothing of quality."""


def chosen_among(names: Iterable[str]) -> dict[str, str]:
    """Group → name for those of `names` that are presets with a name; with the default quality where they are all known to say nothing of it."""
    groups = {info.name: info.group for info in presets.available()}
    names = [presets.renamed([name]).get(str(name), str(name)) for name in names]
    found = {groups[name]: name for name in names if name in groups}
    told = any(name not in groups or groups[name] in (*PICKERS["Quality"], presets.USER_GROUP) for name in names)
    return found if told else {**found, **DEFAULT_QUALITY}


def start(scene: Scene, names: Sequence[str]) -> WindowState:
    """The state of a window that opens on `scene`, made from the presets called `names`."""
    state = WindowState.start(scene, chosen_among(names))
    if skipped := presets.skipped(names):
        state.tell("Opened, but for what this version does not know.", skipped)
    return state


def pick(state: WindowState, group: str, name: str) -> None:
    """Puts the preset `name` of `group` into the scene.

    What the new preset sets is set; what only its forerunner in the picker had set goes back to what the other layers say; all else, the
    camera under the hand among it, stays. A preset of a whole scene replaces everything.
    """
    try:
        if group in WHOLE:
            scene, chosen = presets.load([name]), chosen_among([name])
        else:
            rivals = next(groups for groups in PICKERS.values() if group in groups)
            old = [state.chosen[rival] for rival in rivals if rival in state.chosen]
            chosen = {key: value for key, value in state.chosen.items() if key in LAYERED and key not in rivals} | {group: name}
            scene = presets.read(name).over(_taken_back(state, old, name, chosen))
        moves_camera = group in WHOLE or any(key.startswith("camera.") for key in presets.read(name).values)
        skipped = presets.skipped([name])
    except presets.SceneError as error:
        state.complain(str(error))
        return
    state.chosen = chosen
    state.show(scene, as_home=moves_camera)
    if skipped:
        state.tell(f"Took the preset {name}.", skipped)


def _taken_back(state: WindowState, old: Iterable[str], new: str, chosen: Mapping[str, str]) -> Scene:
    """The scene with what only `new`'s forerunners `old` had set as the layers `chosen` have it."""
    left = {key for name in old for key in presets.read(name).values} - set(presets.read(new).values)
    if not left:
        return state.scene
    layers = presets.load([chosen[group] for group in LAYERED if group in chosen])
    known, scene = layers.keys(), state.scene
    for place in {place for key in left if (place := instances.place_of(key)) is not None}:
        if place.path + "." + KIND in known:
            left.add(place.path + "." + KIND)
        elif place.name in getattr(scene, place.section):
            scene = scene.without(place.path)
    return scene.with_values({key: layers.get(key) for key in known if key in left})
