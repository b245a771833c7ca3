"""Flights: what stands between keys, what gravity decides, and what is told of mistakes."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

from blackhole_gl.physics import flight_files
from blackhole_gl.scene import Scene, presets

STILL = Scene().with_values({"rays.model": "kerr", "hole.spin": 0.9, "camera.distance": 20.0})


def keys(*entries: str) -> str:
    return "".join(f"[[keys]]\n{entry}\n" for entry in entries)


def test_numbers_are_smooth_between_keys_and_never_beyond_them() -> None:
    given = {0.0: 30.0, 1.0: 10.0, 1.5: 9.0, 4.0: 9.0, 5.0: 14.0}
    flown = flight_files.parse(keys(*(f"at = {at}\ncamera.distance = {value}" for at, value in given.items())), STILL)
    seconds = np.linspace(0.0, 5.0, 501)
    found = np.array([flown.at(float(at)).scene.camera.distance for at in seconds])
    for at, value in given.items():
        assert flown.at(at).scene.camera.distance == pytest.approx(value, abs=1e-12)
    assert np.all(np.diff(found[:151]) <= 1e-12) and np.all(np.diff(found[400:]) >= -1e-12) and np.all(found[151:400] == 9.0)
    assert np.abs(np.diff(found, 2)).max() < 0.02, "no kink: a step of a hundredth of a second changes its slope by little"
    assert flown.at(-1.0).scene.camera.distance == 30.0 and flown.at(9.0).scene.camera.distance == 14.0
    assert flown.seconds == 5.0


def test_switches_and_choices_change_at_their_keys() -> None:
    flown = flight_files.parse(keys("at = 0\ndisk.enabled = false", "at = 2\ndisk.enabled = true\nrays.orders = 1", "at = 3\nrays.orders = 3"), STILL)
    assert [flown.at(at).scene.disk.enabled for at in (0.0, 1.99, 2.0, 5.0)] == [False, False, True, True]
    assert [flown.at(at).scene.rays.orders for at in (2.0, 2.99, 3.0)] == [1, 1, 3]


@pytest.mark.parametrize("way", ["", '[way]\nkind = "rain"\nrate = {rate}\ndistance = {far}\n'], ids=["keys", "a fall"])
def test_a_flight_in_M_is_the_same_one(way: str) -> None:
    """r_s = 2 M: lengths, rates and ranges; angles and seconds stay."""
    key = "camera.fov_deg = 50" if way else "camera.distance = {near}"
    text = "rate = {rate}\n" + keys("at = 0\ndisk.outer_radius = {far}", f"at = 4\ndisk.outer_radius = {{near}}\n{key}") + way
    told = {"rate": 2.0, "far": 18.0, "near": 9.0}
    flown = flight_files.parse(text.format(**told), STILL, start=1.0)
    in_m = flight_files.parse('lengths = "M"\n' + text.format(**{name: 2.0 * value for name, value in told.items()}), STILL, start=1.0)
    for at in (0.0, 1.3, 4.0):
        assert repr(in_m.at(at)) == repr(flown.at(at)), "halves of doubles are the same numbers, and NaN is NaN"


def test_scene_time_runs_by_the_rate() -> None:
    flown = flight_files.parse("rate = 2.5\n" + keys("at = 0\npost.exposure = 0.0", "at = 4\npost.exposure = 1.0"), STILL, start=10.0)
    assert [flown.at(at).time for at in (0.0, 2.0)] == [10.0, 15.0]


@pytest.mark.parametrize("spin, inclination", [(0.0, 80.0), (0.9, 90.0), (0.9, 30.0)])
def test_a_fall_takes_the_time_that_its_geodesic_does(spin: float, inclination: float) -> None:
    """dr/dτ and dt/dτ of the fall from rest at infinity with L = 0, Q = 0, by quadrature (M = 1)."""
    model = "kerr" if spin else "schwarzschild"
    scene = STILL.with_values({"rays.model": model, "hole.spin": spin, "camera.inclination_deg": inclination, "camera.distance": 15.0})
    flown = flight_files.parse('[way]\nkind = "rain"\n', scene)
    for proper in (5.0, 20.0, 30.0):
        moment = flown.at(proper)
        r, cosine2 = 2.0 * moment.scene.camera.distance, math.cos(math.radians(inclination)) ** 2

        def rate(x: float) -> float:
            return (x * x + spin**2 * cosine2) / math.sqrt(2.0 * x * (x * x + spin**2))  # noqa: B023

        def far(x: float) -> float:
            delta = x * x - 2.0 * x + spin**2
            area = (x * x + spin**2) ** 2 - delta * spin**2 * (1.0 - cosine2)  # noqa: B023
            return rate(x) * area / (delta * (x * x + spin**2 * cosine2))  # noqa: B023

        # Between 4096 samples of the way it is interpolated: 1e-6 of it.
        assert 0.5 * quad(rate, r, 30.0)[0] == pytest.approx(proper, rel=1e-5)
        assert 0.5 * quad(far, r, 30.0)[0] == pytest.approx(moment.far_time, rel=1e-5)
        assert (moment.proper_time, moment.time, moment.scene.camera.observer) == (proper, proper, "rain")


def test_rain_in_schwarzschilds_space_has_the_speed_of_escape() -> None:
    scene = STILL.with_values({"rays.model": "schwarzschild", "hole.spin": 0.0})
    moment = flight_files.parse('[way]\nkind = "rain"\ndistance = 4.0', scene).at(1.0)
    assert moment.speed == pytest.approx(moment.scene.camera.distance**-0.5, rel=1e-6)


def test_a_fall_that_slows_goes_by_roots_of_the_radius() -> None:
    """Without spin dτ = −√r dr: at a rate of r/r₀ the film's seconds are 2 r₀ (√r₀ − √r)."""
    scene = STILL.with_values({"rays.model": "schwarzschild", "hole.spin": 0.0})
    flown = flight_files.parse('[way]\nkind = "rain"\ndistance = 16.0\nrate = 8.0\nslows = true', scene)
    for r in (9.0, 1.0, 0.25):
        moment = flown.at(2.0 * 16.0 * (4.0 - math.sqrt(r)) / 8.0)
        assert moment.scene.camera.distance == pytest.approx(r, rel=1e-4)
        assert moment.proper_time == pytest.approx((64.0 - r**1.5) * 2.0 / 3.0, rel=1e-5)
    assert flown.seconds == pytest.approx(4.0 * (4.0 - math.sqrt(0.1)), rel=1e-4)


def test_an_orbit_turns_by_keplers_law_and_its_clock_is_slow() -> None:
    flown = flight_files.parse('[way]\nkind = "orbit"\nrate = 2.0\ndistance = 6.0', STILL.with_values({"hole.spin": 0.0, "rays.model": "schwarzschild"}))
    moment = flown.at(3.0)
    assert moment.proper_time == 6.0 and moment.far_time == pytest.approx(6.0 / math.sqrt(1.0 - 1.5 / 6.0))
    assert moment.scene.camera.azimuth_deg == pytest.approx(math.degrees(math.sqrt(0.5 / 6.0**3) * moment.far_time))
    assert moment.speed == pytest.approx(math.sqrt(0.5 / (6.0 - 1.0)))
    assert moment.scene.camera.observer == "circular"
    assert flown.seconds == math.inf


MISTAKES = {
    "nothing = 1": "nothing: no such entry; allowed are title, lengths, rate, keys, way, presets, notes",
    "rate = 1.0": "neither [[keys]] nor a [way]",
    "rate = true\n[way]\nkind = 'orbit'": "rate: got True; allowed is 0 to 100",
    "x = ": "not TOML",
    keys("camera.distance = 3"): "[[keys]] 1: at is missing",
    keys("at = 1", "at = 1"): "[[keys]] 2: at: got 1; allowed is more than 1",
    keys("at = 0\ncamera.distanc = 3"): "did you mean camera.distance?",
    keys("at = 0\ncamera.distance = -3"): "[[keys]] 1: camera.distance: got -3; allowed is a number from",
    "[way]\nkind = 'up'": "[way] kind: got 'up'; allowed is one of rain, orbit",
    "[way]\nkind = 'rain'\nspeed = 3": "[way] speed: no such entry; allowed are kind, rate, distance, slows",
    "[way]\nkind = 'orbit'\nslows = true": "[way] slows: got True; allowed is true or false, and true for a fall",
    "[way]\nkind = 'rain'\ndistance = 0.2": "[way] begins at 0.2 r_s; allowed is outside the horizon",
    "[way]\nkind = 'rain'\n" + keys("at = 0\ncamera.distance = 3"): "camera.distance is decided by the [way]",
    "notes = 3\n" + keys("at = 0"): "[[notes]] 1: allowed are at",
    "[[notes]]\nat = 1\n" + keys("at = 0"): "[[notes]] 1: allowed are at, the second of the film that it begins at, and text",
    "lengths = 'm'\n" + keys("at = 0"): "lengths: got 'm'; allowed is one of r_s, M",
    "lengths = 'M'\n[way]\nkind = 'rain'\ndistance = 0.4": "[way] begins at 0.4 M; allowed is outside the horizon (1.436 M)",
    "lengths = 'M'\n" + keys("at = 0\ndisk.outer_radius = 1e9"): "disk.outer_radius: got 1000000000.0; allowed is a number from 2 to 200 M",
    "keys = 3": "keys: allowed is a [[keys]] for each keyframe",
}


@pytest.mark.parametrize("text", MISTAKES)
def test_mistakes_are_told(text: str) -> None:
    with pytest.raises(flight_files.FlightError) as told:
        flight_files.parse(text, STILL, "dive.toml")
    assert str(told.value).startswith("dive.toml: ") and MISTAKES[text] in str(told.value)


def test_a_flight_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(flight_files.FlightError, match="cannot be read: No such file"):
        flight_files.read(tmp_path / "none.toml", STILL)


@pytest.mark.parametrize("name", flight_files.shipped())
def test_the_shipped_flights_fly(name: str) -> None:
    path = flight_files.shipped()[name]
    flown = flight_files.read(path, presets.load(list(flight_files.presets_of(path))))
    assert flown.title and flown.notes
    assert flown.note_at(0.0) == flown.notes[0].text and flown.note_at(1e6) == flown.notes[-1].text
    for share in np.linspace(0.0, 1.0, 7):
        flown.at(share * min(flown.seconds, 20.0))
