"""A gamepad's sticks, where GLFW knows one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from imgui_bundle import imgui  # noqa: F401  # before glfw: on Linux the first GLFW that is loaded is the one used

# isort: split
import glfw

_DEAD = 0.15  # of a stick's way: worn ones do not come back to their middle


@dataclass(frozen=True)
class Sticks:
    """What is asked for: to fly right, up and forward, and to look right and down; −1 … 1 each."""

    fly: tuple[float, float, float] = (0.0, 0.0, 0.0)
    look: tuple[float, float] = (0.0, 0.0)


def poll() -> Sticks:
    """The first gamepad that there is: the left stick and the triggers fly, the right stick looks. Without one nothing is asked for."""
    for joystick in range(glfw.JOYSTICK_1, glfw.JOYSTICK_LAST + 1):
        if glfw.joystick_is_gamepad(joystick) and (state := glfw.get_gamepad_state(joystick)) is not None:
            return of_axes(state.axes)
    return Sticks()


def of_axes(axes: Sequence[float]) -> Sticks:
    """What GLFW's six `axes` ask for; triggers are −1 where they are let go."""
    aside, back, look_right, look_down, sinks, climbs = (float(axis) for axis in axes)
    return Sticks((_beyond(aside), _beyond(0.5 * (climbs - sinks)), -_beyond(back)), (_beyond(look_right), _beyond(look_down)))


def _beyond(value: float) -> float:
    """`value` without the dead middle of its way."""
    size = max(abs(value) - _DEAD, 0.0) / (1.0 - _DEAD)
    return size if value > 0.0 else -size
