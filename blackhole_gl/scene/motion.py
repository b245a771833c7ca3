"""Where an instance is and how it moves: the parameters that every kind has whose header says ``moves = true``. What follows from them: physics/motion.py."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .schema import Field

PATHS = ("fixed", "geodesic", "circle")


def _place(name: str, default: float, where: str) -> Field:
    return Field(name, "float", default, -1000.0, 1000.0, "r_s", f"Place of its centre{where}, where its path is fixed.")


def _angle(name: str, low: float, high: float, help: str) -> Field:
    return Field(name, "float", 0.0, low, high, "°", help)


_FIELDS = (
    Field(
        "path",
        "choice",
        "fixed",
        options=PATHS,
        help="Whether it rests, goes round the hole in a circle at the rate of free fall, or in one at a rate of its own.",
    ),
    _place("x", 8.0, ""),
    _place("y", 0.0, ""),
    _place("z", 3.0, " along the spin axis"),
    Field("orbit_radius", "float", 8.0, 1.0, 1000.0, "r_s", "Of its circle."),
    Field("orbit_sense", "choice", "prograde", options=("prograde", "retrograde"), help="With the hole's spin or against it."),
    Field("orbit_rate", "float", 0.1, 0.0, 10.0, "rad c/r_s", "Of its circle, where its path is a circle at a rate of its own."),
    _angle("orbit_phase_deg", -360.0, 360.0, "Where it is on its circle at time 0, from where the circle rises through the equatorial plane."),
    _angle("orbit_tilt_deg", 0.0, 180.0, "Angle between the circle's axis and the spin axis. Round a hole that spins, no tilted circle is one of free fall."),
    _angle("orbit_node_deg", -180.0, 180.0, "Azimuth at which the circle rises through the equatorial plane."),
    _angle("axis_tilt_deg", 0.0, 180.0, "Angle between its own axis and the spin axis of the hole."),
    _angle("axis_azimuth_deg", -180.0, 180.0, "Azimuth that its own axis leans towards."),
    _angle("turn_deg", -360.0, 360.0, "How far it is turned about its own axis at time 0."),
    Field("turn_rate", "float", 0.0, -10.0, 10.0, "rad c/r_s", "How fast it turns about its own axis."),
)

FIELDS: Mapping[str, Field] = MappingProxyType({item.key: item for item in _FIELDS})
"""The parameters by name."""
