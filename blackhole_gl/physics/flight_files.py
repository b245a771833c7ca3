"""Files of flights: a scene at every second of a film.

A flight is a TOML file::

    title = "Round the hole and up"
    rate = 4.0                      # scene time, r_s/c, that passes in one second; the scene's playback.rate when not given
    [[keys]]
    at = 0.0                        # seconds of the film
    camera.inclination_deg = 80     # any number, switch or choice of the scene
    [[keys]]
    at = 5.0
    camera.inclination_deg = 20

Numbers run through their keys on monotone cubics (Fritsch & Carlson 1980): smooth, and never beyond the keys on either side. All else changes at its key.

``lengths = "M"`` at the top says that all of its lengths and times of the scene are in M = GM/c², half of r_s; seconds stay seconds.

With a way the camera's place is no matter of keys::

    [way]
    kind = "rain"                   # falls from rest at infinity; "orbit": a circular geodesic
    rate = 2.0                      # r_s/c of the traveller's own clock in one second
    slows = true                    # a fall's rate is that at its beginning, and falls with the radius

A flight may say of which presets its scene is made, for who opens it by name (``presets = ["schwarzschild"]``), and what is to be seen when, for a run that
explains::

    [[notes]]
    at = 17.4
    text = "The horizon, 1 r_s: nothing is seen to happen."
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..resources import flights_dir
from ..scene import Scene, SceneError, lengths
from ..text_files import TextError, read_text
from .flight import WAYS, Flight, Keyframe, Note, Way
from .space_time import space_time

_ENTRIES = ("title", "lengths", "rate", "keys", "way", "presets", "notes")
_WAY_ENTRIES = ("kind", "rate", "distance", "slows")
_DECIDED = {"rain": ("camera.distance", "camera.observer"), "orbit": ("camera.distance", "camera.observer", "camera.azimuth_deg")}


class FlightError(SceneError):
    """A flight that cannot be flown; the text names the file, the entry, what was given and what is allowed."""

    def __init__(self, source: str, message: str):
        ValueError.__init__(self, f"{source}: {message}")
        self.key, self.message, self.entry, self.source = "", message, 0, source


def read(path: Path, scene: Scene, start: float = 0.0) -> Flight:
    """The flight in the TOML file at `path` through `scene`, from scene time `start` (r_s/c) on.

    Raises:
        FlightError: it cannot be read, or has an entry or a value that is not allowed.
    """
    return parse(_text(path), scene, str(path), start)


def shipped() -> dict[str, Path]:
    """The shipped flights, by name."""
    return {path.stem: path for path in sorted(flights_dir().glob("*.toml"))}


def presets_of(path: Path) -> tuple[str, ...]:
    """The presets that the flight at `path` says its scene is made of, lowest first; none where it says none.

    Raises:
        FlightError: as `read`.
    """
    given = _tables(_text(path), str(path)).get("presets", [])
    if not isinstance(given, list) or not all(isinstance(name, str) for name in given):
        raise FlightError(str(path), f"presets: got {given!r}; allowed is a list of names of presets")
    return tuple(given)


def parse(text: str, scene: Scene, source: str = "flight", start: float = 0.0) -> Flight:
    """The flight in the TOML `text`; as `read`."""
    tables = _tables(text, source)
    _refuse_unknown(tables, _ENTRIES, source, "")
    unit = tables.get("lengths", "r_s")
    if unit not in lengths.UNITS:
        raise FlightError(source, f"lengths: got {unit!r}; allowed is one of {', '.join(lengths.UNITS)}")
    way = _way(tables["way"], scene, source, unit) if "way" in tables else None
    keys = _keys(tables.get("keys", []), scene, source, _DECIDED[way.kind] if way else (), unit)
    if not keys and way is None:
        raise FlightError(source, "has neither [[keys]] nor a [way]: nothing would move")
    rate = _length(tables["rate"], 0.0, 100.0, "rate", source, unit) if "rate" in tables else scene.playback.rate
    return Flight(scene, keys, rate, way, str(tables.get("title", "")), start, _notes(tables.get("notes", []), source))


def _text(path: Path) -> str:
    try:
        return read_text(path)
    except OSError as error:
        raise FlightError(str(path), f"cannot be read: {error.strerror or error}") from None
    except TextError as error:
        raise FlightError(str(path), str(error)) from None


def _tables(text: str, source: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise FlightError(source, f"not TOML: {error}") from None


def _notes(given: Any, source: str) -> tuple[Note, ...]:
    found: list[Note] = []
    for number, entry in enumerate(given if isinstance(given, list) else [None], 1):
        place = f"[[notes]] {number}"
        if not isinstance(entry, dict) or set(entry) != {"at", "text"} or not isinstance(entry["text"], str):
            raise FlightError(source, f"{place}: allowed are at, the second of the film that it begins at, and text, and both are needed")
        found.append(Note(_number(entry["at"], 0.0, 1e6, f"{place}: at", source), entry["text"]))
    return tuple(sorted(found, key=lambda note: note.at))


def _keys(given: Any, scene: Scene, source: str, decided: tuple[str, ...], unit: str) -> tuple[Keyframe, ...]:
    if not isinstance(given, list) or not all(isinstance(entry, dict) for entry in given):
        raise FlightError(source, "keys: allowed is a [[keys]] for each keyframe")
    found: list[Keyframe] = []
    for number, entry in enumerate(given, 1):
        place = f"[[keys]] {number}"
        if "at" not in entry:
            raise FlightError(source, f"{place}: at is missing; allowed is the second of the film that it stands for")
        at = _number(entry["at"], 0.0, 1e6, f"{place}: at", source)
        if found and at <= found[-1].at:
            raise FlightError(source, f"{place}: at: got {at:g}; allowed is more than {found[-1].at:g}, that of the one before")
        values = {}
        for key, value in _flat({name: value for name, value in entry.items() if name != "at"}).items():
            if key in decided:
                raise FlightError(source, f"{place}: {key} is decided by the [way]; allowed is any other key")
            try:
                item = scene.field(key)
                values[key] = lengths.in_rs(item, lengths.field_in(item, unit).check(value), unit)
            except SceneError as error:
                raise FlightError(source, f"{place}: {error}") from None
        found.append(Keyframe(at, values))
    return tuple(found)


def _way(given: Any, scene: Scene, source: str, unit: str) -> Way:
    if not isinstance(given, dict):
        raise FlightError(source, "way: allowed is a table [way]")
    _refuse_unknown(given, _WAY_ENTRIES, source, "[way] ")
    kind = given.get("kind")
    if kind not in WAYS:
        raise FlightError(source, f"[way] kind: got {kind!r}; allowed is one of {', '.join(WAYS)}")
    rate = _length(given["rate"], 1e-6, 1e4, "[way] rate", source, unit) if "rate" in given else 1.0
    horizon = space_time(scene).horizon_radius
    distance = _length(given["distance"], 0.0, 1e4, "[way] distance", source, unit) if "distance" in given else None
    begins = scene.camera.distance if distance is None else distance
    if space_time(scene).kind == "flat" or not (horizon < begins < math.inf):
        scale = lengths.factor(unit)
        there, edge = f"{scale * begins:g} {unit}", f"{scale * horizon:.4g} {unit}"
        raise FlightError(source, f"[way] begins at {there}; allowed is outside the horizon ({edge}) of a hole, and not infinite")
    slows = given.get("slows", False)
    if not isinstance(slows, bool) or (slows and kind != "rain"):
        raise FlightError(source, f"[way] slows: got {slows!r}; allowed is true or false, and true for a fall, whose radius changes")
    return Way(kind, rate, distance, slows)


def _refuse_unknown(given: Mapping[str, Any], known: tuple[str, ...], source: str, place: str) -> None:
    for name in given:
        if name not in known:
            raise FlightError(source, f"{place}{name}: no such entry; allowed are {', '.join(known)}")


def _number(value: Any, low: float, high: float, name: str, source: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
        raise FlightError(source, f"{name}: got {value!r}; allowed is {low:g} to {high:g}")
    return float(value)


def _length(value: Any, low: float, high: float, name: str, source: str, unit: str) -> float:
    """In r_s what the file has in `unit`; `low` and `high` are in r_s, too."""
    scale = lengths.factor(unit)
    return _number(value, low * scale, high * scale, name, source) / scale


def _flat(table: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    """Nested tables as dotted keys."""
    found: dict[str, Any] = {}
    for name, value in table.items():
        if isinstance(value, dict):
            found |= _flat(value, f"{before}{name}.")
        else:
            found[f"{before}{name}"] = value
    return found
