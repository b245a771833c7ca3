"""A flight in the window: played, scrubbed, and made of keys that are taken from the view. No imgui here."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import tomlkit

from ..output.files import write_whole
from ..physics import flight_files
from ..physics.flight import Flight, Keyframe, Moment
from ..scene import SceneError, fields
from .camera_control import Motion

if TYPE_CHECKING:
    from .state import WindowState

_ENDLESS_S = 60.0
"""Seconds that the slider has for a flight which nothing ends."""

_LEAST_APART_S = 0.05
"""A key that is taken nearer than this to another takes its place."""

EXPLAINED = {
    "post.labels": True,
    **{f"post.show_{name}": True for name in ("horizon", "ergosphere", "photon_shell", "isco", "sky_grid")},
}
"""What a run that explains shows besides: names, and lines where light paths put them."""

_TAKEN = tuple(f"camera.{name}" for name in ("distance", "inclination_deg", "azimuth_deg", "yaw_deg", "pitch_deg", "roll_deg", "fov_deg"))


@dataclass(frozen=True)
class Timeline:
    """Where a flight is.

    Attributes:
        flight: what is flown; None before one is opened, or a key taken.
        seconds: of its film.
        plays: whether they run.
        loops: whether it begins again at its end.
        explains: whether what is seen is named and told of.
        moment: what the flight was like there; None before it has played.
        file: where it lies, or is to be saved.
    """

    flight: Flight | None = None
    seconds: float = 0.0
    plays: bool = False
    loops: bool = False
    explains: bool = False
    moment: Moment | None = None
    file: str = "flight.toml"

    @property
    def length(self) -> float:
        """How far the slider goes, in seconds."""
        if self.flight is None:
            return 0.0
        return self.flight.seconds if math.isfinite(self.flight.seconds) else _ENDLESS_S

    @property
    def note(self) -> str:
        """What is told of what is seen; empty but in a run that explains."""
        return self.flight.note_at(self.seconds) if self.flight is not None and self.explains else ""


def open_file(state: WindowState, path: str) -> None:
    """Takes the flight in the file at `path` through the scene of now; what is wrong with it becomes a notice."""
    try:
        found = flight_files.read(Path(path), state.scene, state.time)
    except SceneError as error:
        state.complain(str(error))
        return
    state.timeline = Timeline(found, file=path, loops=state.timeline.loops, explains=state.timeline.explains)
    state.say(f"Flight: {found.title or Path(path).name}")
    seek(state, 0.0)


def explain(state: WindowState, explains: bool) -> None:
    """Has what is seen named and told of, or not."""
    state.timeline = replace(state.timeline, explains=explains)
    if state.timeline.moment is not None:
        seek(state, state.timeline.seconds)


def play(state: WindowState) -> None:
    """Lets it run or stops it; from its end it begins again."""
    now = state.timeline
    if now.flight is None:
        return
    seconds = 0.0 if not now.plays and now.seconds >= now.flight.seconds else now.seconds
    state.timeline = replace(now, plays=not now.plays, seconds=seconds)


def advance(state: WindowState, dt: float) -> None:
    """Lets `dt` seconds pass."""
    now = state.timeline
    if now.flight is None or not now.plays:
        return
    seconds, end = now.seconds + dt, now.flight.seconds
    if seconds >= end:
        seconds = seconds % end if now.loops else end
        state.timeline = replace(now, plays=now.loops)
    seek(state, seconds)


def seek(state: WindowState, seconds: float) -> None:
    """Shows the flight at `seconds`; where the scene refuses it, it stops there with a notice."""
    now = state.timeline
    if now.flight is None:
        return
    try:
        moment = now.flight.at(seconds)
    except SceneError as error:
        state.timeline = replace(now, plays=False)
        state.complain(str(error))
        return
    # Not `state.show`, which keeps cameras out of holes: a fall goes in.
    scene = moment.scene.with_values(EXPLAINED) if now.explains else moment.scene
    state.scene, state.motion, state.time = scene, Motion.at(scene), moment.time
    state.timeline = replace(now, seconds=seconds, moment=moment)


def take_key(state: WindowState) -> None:
    """Makes the view of now a key of the flight, where the slider stands; the first starts a flight of its own."""
    now = state.timeline
    known = fields()
    values = {key: state.scene.get(key) for key in _TAKEN if state.scene.get(key) != math.inf and key in known}
    flown = now.flight if now.flight is not None and now.flight.way is None else Flight(state.scene, rate=state.scene.playback.rate, start=state.time)
    others = [key for key in flown.keys if abs(key.at - now.seconds) >= _LEAST_APART_S]
    keys = tuple(sorted([*others, Keyframe(now.seconds, values)], key=lambda key: key.at))
    made = Flight(flown.scene, keys, flown.rate, None, flown.title, flown.start)
    state.timeline = replace(now, flight=made, plays=False)
    state.say(f"Key {keys.index(next(key for key in keys if key.at == now.seconds)) + 1} of {len(keys)} at {now.seconds:.2f} s")


def save(state: WindowState, path: str) -> None:
    """Writes the flight's keys as TOML to `path`; whether that went well becomes a notice."""
    flown = state.timeline.flight
    if flown is None or flown.way is not None:
        state.say("There are no keys to save.")
        return
    try:
        write_whole(path, _text(flown).encode("utf-8"))
    except OSError as error:
        state.complain(f"{path}: cannot be written: {error.strerror or error}")
        return
    state.timeline = replace(state.timeline, file=path)
    state.say(f"Saved: {path}")


def _text(flown: Flight) -> str:
    document = tomlkit.document()
    if flown.title:
        document.add("title", flown.title)
    document.add("rate", flown.rate)
    keys = tomlkit.aot()
    for keyframe in flown.keys:
        table = tomlkit.table()
        table.add("at", keyframe.at)
        for name, value in keyframe.values.items():
            table.add(tomlkit.key(name.split(".")), value)
        keys.append(table)
    document.add("keys", keys)
    return tomlkit.dumps(document)


def reading(moment: Moment | None) -> str:
    """What the traveller on a way reads, a line; empty for one whom only keys move."""
    if moment is None or math.isnan(moment.proper_time):
        return ""
    far = f"{moment.far_time:.2f}" if math.isfinite(moment.far_time) else "no more"
    goes = "falls" if moment.scene.camera.observer == "rain" else "moves"
    speed = f"{goes} at {moment.speed:.3f} c" if moment.speed < 1.0 else "nothing stands still here"
    return f"own clock {moment.proper_time:.2f}, far away {far} r_s/c; r = {moment.scene.camera.distance:.4g} r_s, {speed}"
