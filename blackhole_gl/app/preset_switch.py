"""Picking one preset of a group without losing what the others, or the user's hand, have set."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from ..scene import Scene, instances, presets
from ..scene.catalogue import KIND
from . import files_outside
from .state import WindowState

PICKERS: Mapping[str, tuple[str, ...]] = {"Physics": ("physics",), "Look": ("look",), "Quality": ("quality", "steps")}
"""The panel's pickers of presets that lie over each other, and the groups in each: a preset of either group takes the place of the other's."""

LAYERED = tuple(group for groups in PICKERS.values() for group in groups)
WHOLE = ("scene", presets.USER_GROUP)
_BASE = "scene"
"""A look or a quality picked over one of these lies over it; physics picked starts anew, without what it said."""

DEFAULT_QUALITY = {"quality": "automatic"}
"""What a scene has that says nothing of quality."""


def chosen_among(names: Iterable[str]) -> dict[str, str]:
    """Group → name for those of `names`, and of the presets they lie over, that are presets with a name; with the default quality where they are all
    known to say nothing of it."""
    groups = {info.name: info.group for info in presets.available()}
    names = [presets.renamed([name]).get(str(name), str(name)) for name in presets.with_default(list(names))]
    found = {groups[name]: name for name in names if name in groups}
    told = any(name not in groups or groups[name] in (*PICKERS["Quality"], presets.USER_GROUP) for name in names)
    return found if told else {**found, **DEFAULT_QUALITY}


def start(scene: Scene, names: Sequence[str], *, any_file: bool = False) -> WindowState:
    """The state of a window that opens on `scene`, made from the presets called `names` and what was set besides; from none where there are none."""
    if not names:
        return WindowState.start(scene)
    state = WindowState.start(scene, chosen_among(names), presets.load(names, any_file=any_file))
    if timed := presets.last_timed(names):
        state.play_from(timed)
    if skipped := presets.skipped(names, any_file=any_file):
        state.tell("Opened, but for some of it.", skipped)
    return state


def pick(state: WindowState, group: str, name: str) -> None:
    """Puts the preset `name` of `group` into the scene.

    What the new preset sets is set, but for what layers above it set too; what only its forerunner in the picker had set goes back to what the
    other layers say; all else stays. A preset of a whole scene replaces everything. A look or a quality lies over it; physics takes its place.
    """
    any_file = files_outside.allowed(state, name)
    try:
        preset = presets.read(name, any_file=any_file)
        if group in WHOLE:
            scene = home = presets.load([name], any_file=any_file)
            chosen = chosen_among([name])
        else:
            rivals = next(groups for groups in PICKERS.values() if group in groups) + ((_BASE,) if group == "physics" else ())
            old = [state.chosen[rival] for rival in rivals if rival in state.chosen]
            chosen = {key: value for key, value in state.chosen.items() if key in (_BASE, *LAYERED) and key not in rivals} | {group: name}
            scene, home = (_laid(preset, old, chosen, before) for before in (state.scene, state.home))
        refused = preset.refused(scene)
    except presets.SceneError as error:
        state.complain(str(error))
        return
    state.put_in_force(home, chosen, scene)
    state.play_from(preset)
    if preset.skipped or refused or any_file:
        files_outside.tell(state, f"Took the preset {name}.", name, preset, refused, "Pick it again")


def left(scene: Scene, in_force: Mapping[str, presets.Preset]) -> dict[str, tuple[str, ...]]:
    """Group → the keys in which `scene` is not what the preset in force there says; a preset of a whole scene says everything that none over it says."""
    laid = [group for group in LAYERED if group in in_force]
    found = {group: presets.departures(scene, [in_force[name] for name in laid], place) for place, group in enumerate(laid)}
    over = {key for group in laid for key in in_force[group].values}
    whole = {group: presets.differing(scene, in_force[group].over(Scene())) for group in WHOLE if group in in_force}
    if _BASE in whole:  # one of the user's was saved with all that lies over it
        whole[_BASE] = tuple(key for key in whole[_BASE] if key not in over)
    return found | whole


def remark(keys: Sequence[str]) -> str:
    """What stands behind a preset's name where the scene differs from it in `keys`."""
    if not keys:
        return ""
    return " · moved" if all(key.startswith("camera.") for key in keys) else " · modified"


def layers(chosen: Mapping[str, str]) -> list[str]:
    """The names among `chosen` of presets that lie over each other, lowest first."""
    return [chosen[group] for group in (_BASE, *LAYERED) if group in chosen]


def _laid(preset: presets.Preset, old: Sequence[str], chosen: Mapping[str, str], scene: Scene) -> Scene:
    """`scene` with `preset`, one of the layers `chosen`, in the place of its forerunners `old`."""
    above = layers(chosen)
    above = above[above.index(chosen[preset.group]) + 1 :]
    overruled = {key for name in above for key in presets.read(name).values}
    seen = replace(preset, values={key: value for key, value in preset.values.items() if key not in overruled})
    return seen.over(_taken_back(scene, old, preset, chosen))


def _taken_back(scene: Scene, old: Iterable[str], new: presets.Preset, chosen: Mapping[str, str]) -> Scene:
    """`scene` with what only `new`'s forerunners `old` had set as the layers `chosen` have it."""
    left = {key for name in old for key in presets.read(name).values} - set(new.values)
    if not left:
        return scene
    below = presets.load(layers(chosen))
    known = below.keys()
    for place in {place for key in left if (place := instances.place_of(key)) is not None}:
        if place.path + "." + KIND in known:
            left.add(place.path + "." + KIND)
        elif place.name in getattr(scene, place.section):
            scene = scene.without(place.path)
    return scene.with_values({key: below.get(key) for key in known if key in left})
