"""What keys, the mouse and buttons do to the state. No imgui here."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace

from ..scene import fields
from . import free_flight, timeline
from .camera_control import Motion, limited, pose_of, within_reach
from .state import WindowState

DRAG_DEG = 180.0  # a drag over the picture's height
DRAG_REACH = 3.0  # a drag over the picture's height, in logarithms of the distance from the horizon
WHEEL_REACH = 0.15  # a notch, in logarithms of the distance from the horizon
LOOK_RATE = 1.5  # of a picture's height a second, by a gamepad
HOLD_DEG = 60.0  # a held key, a second
HOLD_REACH = 1.2
DEFAULT_KERR_SPIN = 0.9
_STOPPED = {
    False: "No nearer by hand: from here on the hole is all that is seen. The panel's values go further.",
    True: "No farther by hand: from here on the hole is a dot. The panel's values go further.",
}

_HELD: Mapping[str, tuple[float, float, float]] = {
    # action: degrees of azimuth and inclination and logarithms of reach, a second
    "orbit_left": (-HOLD_DEG, 0.0, 0.0),
    "orbit_right": (HOLD_DEG, 0.0, 0.0),
    "orbit_up": (0.0, -HOLD_DEG, 0.0),
    "orbit_down": (0.0, HOLD_DEG, 0.0),
    "zoom_in": (0.0, 0.0, -HOLD_REACH),
    "zoom_out": (0.0, 0.0, HOLD_REACH),
}


@dataclass(frozen=True)
class Hand:
    """What the user's hands did in one frame.

    Attributes:
        drag, look, pull: ways right and down, over the picture's height, of the drags that orbit, look around and zoom.
        wheel: notches, positive away from the user.
        held: names of the held actions.
        stick: how fast a gamepad flies right, up and forward, in shares of the full speed.
    """

    drag: tuple[float, float] = (0.0, 0.0)
    look: tuple[float, float] = (0.0, 0.0)
    pull: tuple[float, float] = (0.0, 0.0)
    wheel: float = 0.0
    held: Collection[str] = ()
    stick: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def turned(self, look: tuple[float, float], dt: float) -> Hand:
        """With what a stick that looks right and down, −1 … 1, turns in `dt` seconds: the view goes where it points, which is against a drag's way."""
        return replace(self, look=(self.look[0] - LOOK_RATE * look[0] * dt, self.look[1] - LOOK_RATE * look[1] * dt)) if any(look) else self


def advance(state: WindowState, hand: Hand, dt: float, slept: float = 0.0) -> None:
    """Lets `dt` seconds pass: the camera follows the hand, scene time runs unless paused, notices leave.

    Args:
        slept: seconds before these in which the window slept: for notices alone, which a user reads meanwhile.
    """
    right, down = hand.drag
    # The near side of what is looked at follows the hand, so the camera goes the other way.
    azimuth, inclination, reach = -DRAG_DEG * right, -DRAG_DEG * down, DRAG_REACH * hand.pull[1] - WHEEL_REACH * hand.wheel
    for name in hand.held:
        if name not in _HELD:
            continue
        turn, tilt, go = _HELD[name]
        azimuth, inclination, reach = azimuth + turn * dt, inclination + tilt * dt, reach + go * dt
    target = state.motion.target
    if azimuth or inclination or reach or any(hand.look):
        state.timeline = replace(state.timeline, plays=False)  # the hand takes over
    if azimuth or inclination or reach:
        wanted = target.moved(azimuth, inclination, reach)
        target = within_reach(wanted, state.scene, target)
        if target.reach != wanted.reach:
            state.say(_STOPPED[wanted.reach > target.reach])
    state.move_camera(state.motion.advanced(target, dt))
    state.looks = any(hand.look)
    if state.looks:
        look(state, *hand.look)
    fly(state, hand, dt)
    if state.timeline.plays:
        timeline.advance(state, dt)
    elif state.is_playing:
        state.time += dt * state.scene.playback.rate
    state.clock += slept + dt
    if state.notice and state.notice.until is not None and state.clock > state.notice.until:
        state.notice = None


def look(state: WindowState, right: float, down: float) -> None:
    """Turns the view so that what is in its middle follows the hand, `right` and `down` over the picture's height."""
    camera = state.scene.camera
    if math.isinf(camera.distance):
        state.say("A camera infinitely far away has parallel rays and cannot look aside.")
        return
    roll = math.radians(camera.roll_deg)
    across, along = right * math.cos(roll) - down * math.sin(roll), right * math.sin(roll) + down * math.cos(roll)
    pitch = fields()["camera.pitch_deg"]
    state.change({
        "camera.yaw_deg": math.remainder(camera.yaw_deg - camera.fov_deg * across, 360.0),
        "camera.pitch_deg": min(max(camera.pitch_deg + camera.fov_deg * along, pitch.low), pitch.high),
    })  # fmt: skip


def fly(state: WindowState, hand: Hand, dt: float) -> None:
    """Flies the camera for `dt` seconds as the hand wants it."""
    asked = free_flight.wanted(hand.held, hand.stick)
    if state.flight.at_rest and not any(asked):
        return
    if math.isinf(state.scene.camera.distance):
        state.say("A camera infinitely far away cannot be flown: give it a distance.")
        return
    state.flight, way = state.flight.advanced(asked, dt)
    right, up, forward = (free_flight.RATE * part for part in way)
    state.change(free_flight.flown(state.scene, (right, up, forward)))


def toggle_disk(state: WindowState) -> None:
    """Disk on or off."""
    state.change({"disk.enabled": not state.scene.disk.enabled})


def toggle_spin(state: WindowState) -> None:
    """From a spinning hole to one without spin or back, each with the spin and ray model it last had."""
    scene = state.scene
    spinning = scene.hole.spin != 0.0
    state.holes[spinning] = {"hole.spin": scene.hole.spin, "rays.model": scene.rays.model}
    first = {"hole.spin": 0.0} if spinning else {"hole.spin": DEFAULT_KERR_SPIN, "rays.model": "auto"}
    values = state.holes.get(not spinning, first)
    state.say(f"Kerr: a* = {values['hole.spin']:g}" if values["hole.spin"] else "Schwarzschild: no spin")
    state.change(values)


def next_view(state: WindowState) -> None:
    """From the picture to the first diagnostic view, on to the next, and from the last back to the picture."""
    views = fields()["post.view"].options
    state.change({"post.view": views[(views.index(state.scene.post.view) + 1) % len(views)]})


def toggle_labels(state: WindowState) -> None:
    """Names and outlines in the picture or none."""
    state.change({"post.labels": not state.scene.post.labels})


def toggle_pause(state: WindowState) -> None:
    """Stops scene time or lets it run."""
    state.paused = not state.paused


def remove_picked(state: WindowState) -> None:
    """Takes what is picked out of the scene."""
    path = state.picked
    if not path:
        state.say("Nothing is picked. A click on a thing in the picture picks it.")
    elif state.edit(lambda scene: scene.without(path)):
        state.say(f"Removed {path.partition('.')[2]}.")


_POSE = ("camera.distance", "camera.inclination_deg", "camera.azimuth_deg")


def reset_camera(state: WindowState) -> None:
    """Sends the camera back to where the presets in force have it, the short way round."""
    home = {key: state.home.get(key) for key in fields() if key.startswith("camera.")}
    pose_keys = {key: home.pop(key) for key in _POSE}
    if math.isinf(state.home.camera.distance) or math.isinf(state.scene.camera.distance):
        # There is no way between a near and an infinitely far camera.
        state.change({**pose_keys, **home})
        return
    state.change(home)
    pose = pose_of(state.scene.with_values(pose_keys))
    here = state.motion.current
    turns = round((here.azimuth - pose.azimuth) / 360.0)
    state.motion = Motion(here, limited(pose.moved(azimuth=360.0 * turns), state.scene))


def reset_all(state: WindowState) -> None:
    """Sets everything back to what the presets in force, or the opened file, say."""
    state.put_in_force(state.home, state.chosen)


def work_panel_by_keys(state: WindowState) -> None:
    """Gives the arrows, TAB, SPACE and ENTER to the panel, or takes them back."""
    state.panel_keys = not state.panel_keys
    if state.panel_keys:
        state.show_panel = True
        state.say("Keys work the panel: arrows and TAB go, SPACE and ENTER take, ESC leaves.")


def flip(name: str) -> Callable[[WindowState], None]:
    """A command that turns the state's switch `name` over."""

    def command(state: WindowState) -> None:
        setattr(state, name, not getattr(state, name))

    return command


COMMANDS: Mapping[str, Callable[[WindowState], None]] = {
    # every action of `keys.ACTIONS` that needs nothing but the state and is not held
    "disk": toggle_disk,
    "spin": toggle_spin,
    "pause": toggle_pause,
    "reset": reset_camera,
    "reset_all": reset_all,
    "undo": WindowState.undo,
    "redo": WindowState.redo,
    "remove": remove_picked,
    "help": flip("show_help"),
    "search": flip("show_search"),
    "picture_window": flip("show_picture_window"),
    "panel_keys": work_panel_by_keys,
    "picture": flip("picture_wanted"),
    "full_screen": flip("full_screen"),
    "view": next_view,
    "labels": toggle_labels,
    "panel": flip("show_panel"),
    "overlay": flip("show_overlay"),
    "values": flip("show_values"),
    "chart": flip("show_chart"),
    "line": flip("show_line"),
    "light": flip("show_light"),
    "paths": flip("show_paths"),
    "sides": flip("show_sides"),
    "timeline": flip("show_timeline"),
}
