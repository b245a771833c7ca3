"""Picking one preset of a group without losing what the others, or the user's hand, have set."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from ..scene import presets
from .state import WindowState

LAYERED = ("physics", "look", "quality")
WHOLE = ("scene", presets.USER_GROUP)


def chosen_among(names: Iterable[str]) -> dict[str, str]:
    """Group → name for those of `names` that are presets with a name."""
    groups = {info.name: info.group for info in presets.available()}
    return {groups[name]: name for name in names if name in groups}


def pick(state: WindowState, group: str, name: str) -> None:
    """Puts the preset `name` of `group` into the scene.

    What the new preset sets is set; what only its forerunner in the group had set goes back to what the other layers say; all else, the
    camera under the hand among it, stays. A preset of a whole scene replaces everything.
    """
    try:
        if group in WHOLE:
            scene, chosen = presets.load([name]), {group: name}
        else:
            chosen = {key: value for key, value in state.chosen.items() if key in LAYERED} | {group: name}
            scene = state.scene.with_values(_changes(state.chosen.get(group), name, chosen))
        moves_camera = group in WHOLE or any(key.startswith("camera.") for key in presets.read(name).values)
    except presets.SceneError as error:
        state.complain(str(error))
        return
    state.chosen = chosen
    state.show(scene, as_home=moves_camera)


def _changes(old: str | None, new: str, chosen: Mapping[str, str]) -> Mapping[str, object]:
    changes = dict(presets.read(new).values)
    left = set(presets.read(old).values) - set(changes) if old else set()
    if left:
        without = presets.load([chosen[group] for group in LAYERED if group in chosen])
        changes |= {key: without.get(key) for key in left}
    return changes


