"""Key chords as imgui sees them. A field that is typed in keeps its keys."""

from __future__ import annotations

from imgui_bundle import imgui

from .keys import ACTIONS, Bindings, Chord

_RENAMED = {"LEFT": "left_arrow", "RIGHT": "right_arrow", "UP": "up_arrow", "DOWN": "down_arrow", "PLUS": "equal"}
_MODIFIERS = {"CTRL": imgui.Key.mod_ctrl, "SHIFT": imgui.Key.mod_shift, "ALT": imgui.Key.mod_alt, "SUPER": imgui.Key.mod_super}
_HELD = frozenset(action.name for action in ACTIONS if action.held)


def imgui_key(chord: Chord) -> imgui.Key:
    """The key of `chord` without its modifiers."""
    if chord.key.isdigit():
        name = f"_{chord.key}"
    elif chord.key.startswith("KEYPAD_") and chord.key[-1].isdigit():
        name = chord.key.lower().replace("_", "")
    else:
        name = _RENAMED.get(chord.key, chord.key.lower())
    return getattr(imgui.Key, name)


def imgui_chord(chord: Chord) -> int:
    """`chord` as the number that `imgui.shortcut` takes."""
    code = int(imgui_key(chord))
    # PLUS is the sign, which most layouts put on the shifted key.
    modifiers = (*chord.modifiers, "SHIFT") if chord.key == "PLUS" else chord.modifiers
    for word in modifiers:
        code |= int(_MODIFIERS[word])
    return code


class Shortcuts:
    """Turns key presses into names of actions.

    Args:
        bindings: action → chords.
    """

    def __init__(self, bindings: Bindings):
        self._chords = [(name, chord, imgui_chord(chord)) for name, chords in bindings.items() for chord in chords]
        self._down: dict[str, Chord] = {}

    def poll(self) -> tuple[list[str], list[str]]:
        """The actions pressed in this frame, and those held. Call once in each frame."""
        if imgui.get_io().want_text_input:
            self._down.clear()
            return [], []
        pressed = []
        for name, chord, code in self._chords:
            if imgui.shortcut(code, imgui.InputFlags_.route_global.value):
                if name in _HELD:
                    self._down[name] = chord
                else:
                    pressed.append(name)
        self._down = {name: chord for name, chord in self._down.items() if imgui.is_key_down(imgui_key(chord))}
        return pressed, list(self._down)
