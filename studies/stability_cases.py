"""Where methods fail: named cases with concrete initial conditions. Data alone; `stability` runs it.

Lengths in r_s = 1, angles in radians.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from blackhole_gl.physics import relativity
from studies.stability_case import FLOOR, Case, beside_shadow, impact, listed, whole_sky


def _camera(distance: float, inclination: float = 80.0, spin: float = 0.0, **more: Any) -> dict[str, Any]:
    values = {"camera.distance": distance, "camera.inclination_deg": inclination, "hole.spin": spin}
    return {**values, **{key.replace("__", "."): value for key, value in more.items()}}


def _coarse(step: float) -> dict[str, Any]:
    """Steps of `step` r_s from a camera at 20; models that step by an angle take their coarsest."""
    return _camera(20.0, rays__step_length=step, rays__step_angle=0.8)


def _critical(power: int) -> Case:
    epsilon = 10.0**-power
    return Case(
        f"critical-1e-{power}",
        "critical curve",
        f"ε = ±1e-{power} from the critical curve, from 20 r_s",
        f"Errors grow as 1/ε: up to {min(FLOOR / epsilon, math.pi):.0e} rad is float32's own share.",
        values=_camera(20.0),
        rays=beside_shadow(epsilon, -epsilon),
        floor=min(FLOOR / epsilon, math.pi),
        fates=epsilon >= 1e-6,
    )


_TUNNEL = "A step that leaps the horizon comes out on the far side: a ray that is lost is seen to escape."
_PLANE = "The ray never leaves z = 0: heights of ±0 turn into crossings, and angles above the plane into 0/0."
_POLE = "In (θ, φ) coordinates φ jumps by π at the pole and 1/sin θ has no bound."
_HORIZON = "Redshift and shadow diverge: 1 − 1/r loses all its digits."

_INSIDE = "Nothing rests there, and Boyer–Lindquist's t and φ are of no use: models that do not lead through the horizon refuse the camera."
_ALL_ROUND = listed([0.15, 0.35, 1.2, 1.5, 2.0, 2.6])  # none near the shadow's edge, 0.7 to 1.0

CASES: tuple[Case, ...] = (
    Case(
        "shadow-15",
        "observer's frame",
        "Shadow's size for a static observer at 15 r_s",
        "Without √(1 − 1/R) in the observer's frame: 3.4 % too large.",
        "shadow",
        _camera(15.0),
    ),
    Case("shadow-3", "observer's frame", "The same at 3 r_s", "Without the observer's frame: 13 % too large.", "shadow", _camera(3.0)),
    Case(
        "shadow-far",
        "force law",
        "Shadow's size from 1000 r_s",
        "No observer's frame to speak of: what is wrong here is the force law. Published viewers are 30 % off either way.",
        "shadow",
        _camera(1000.0),
    ),
    Case(
        "weak-far",
        "force law",
        "Deflection at b = 100 and 300 r_s, from 1000 r_s",
        "4GM/c²b is right; the post-Newtonian force bends half as much again.",
        values=_camera(1000.0),
        rays=impact(100.0, 300.0),
    ),
    Case(
        "bend-10",
        "force law",
        "Deflection at b = 5, 10 and 20 r_s, from 100 r_s",
        "First orders in r_s/b end here, and a wrong force shows in degrees.",
        values=_camera(100.0),
        rays=impact(5.0, 10.0, 20.0),
    ),
    Case(
        "radial-in",
        "special directions",
        "Exactly towards the hole",
        "L = 0: Binet's equation has no angle to march in.",
        values=_camera(20.0),
        rays=listed(0.0),
    ),
    Case(
        "radial-out",
        "special directions",
        "Exactly away from the hole",
        "As above, and the ray's plane is undefined.",
        values=_camera(20.0),
        rays=listed(np.pi),
    ),
    Case(
        "near-radial",
        "special directions",
        "0.006° and 6e-6° from both",
        "The ray's plane is the difference of two nearly equal directions.",
        values=_camera(20.0),
        rays=listed([1e-4, 1e-7, np.pi - 1e-4, np.pi - 1e-7]),
    ),
    Case(
        "tangential",
        "special directions",
        "Across, and 0.006° inwards and outwards of it",
        "u' = −u cot ψ passes zero: first-order forms choose the wrong root.",
        values=_camera(20.0),
        rays=listed([0.5 * np.pi, 0.5 * np.pi - 1e-4, 0.5 * np.pi + 1e-4, 0.6 * np.pi]),
    ),
    Case("tunnel-1", "long steps", "Steps of 1 r_s, b = 0.5", _TUNNEL, values=_coarse(1.0), rays=impact(0.5), needs="steps", floor=math.pi),
    Case("tunnel-1.5", "long steps", "Steps of 1.5 r_s, b = 1.5", _TUNNEL, values=_coarse(1.5), rays=impact(1.5), needs="steps", floor=math.pi),
    Case("tunnel-2", "long steps", "Steps of 2 r_s, b = 2.4", _TUNNEL, values=_coarse(2.0), rays=impact(2.4), needs="steps", floor=math.pi),
    Case(
        "false-capture",
        "long steps",
        "Steps of 1 r_s, b = b_c (1 + 1e-4)",
        "Truncation errors near the photon sphere push a ray in that should turn.",
        values=_coarse(1.0),
        rays=impact(relativity.CRITICAL_IMPACT * (1.0 + 1e-4)),
        needs="steps",
        floor=math.pi,
    ),
    Case(
        "disk-jump",
        "long steps",
        "Steps of 1 r_s over a thin disk seen from 85°",
        "A step that crosses the plane twice, or a position read off one end of the step, loses the disk.",
        values={**_coarse(1.0), "camera.inclination_deg": 85.0},
        rays=whole_sky(64, 0.6, 0.05),
        needs="steps",
        floor=0.1,
    ),
    Case(
        "stop-radius",
        "end of the march",
        "Escape directions at b = 5…18 r_s from 20 r_s",
        "Where a march stops the ray is still bending: up to 2/R rad is missing.",
        values=_camera(20.0),
        rays=impact(5.0, 10.0, 14.0, 18.0),
    ),
    Case(
        "stop-radius-outward",
        "end of the march",
        "Rays that are outward bound from 10 r_s",
        "The same for rays that are outward bound from the start.",
        values=_camera(10.0),
        rays=impact(1.0, 4.0, 8.0, 10.0, inward=False),
    ),
    *(_critical(power) for power in range(2, 8)),
    Case(
        "critical-kerr",
        "critical curve",
        "ε = ±1e-3 from the critical curve at a* = 0.9",
        "As above, where both turning points are near each other.",
        values=_camera(20.0, spin=0.9),
        rays=beside_shadow(1e-3, -1e-3),
        floor=FLOOR / 1e-3,
        needs="spin",
    ),
    Case(
        "too-many-steps",
        "critical curve",
        "ε = ±1e-4 with steps a fifth as long as the reference's",
        "Each step rounds: near the critical curve more steps make float32 worse, not better.",
        values=_camera(20.0, rays__step_angle=0.01, rays__step_length=0.028, rays__max_steps=30000),
        rays=beside_shadow(1e-4, -1e-4),
        floor=5.0 * FLOOR / 1e-4,
        needs="steps",
    ),
    Case(
        "inside-shadow",
        "inside the photon sphere",
        "Shadow's size from 1.2 r_s, inside the photon sphere",
        "“b < b_c is captured” is false here; the shadow is larger than half the sky.",
        "shadow",
        _camera(1.2),
    ),
    Case("inside-sky", "inside the photon sphere", "The whole sky from 1.2 r_s", "As above.", values=_camera(1.2, 60.0), rays=whole_sky(64)),
    Case(
        "pole",
        "coordinates",
        "Rays over the poles, a* = 0",
        _POLE,
        values=_camera(20.0, 30.0),
        rays=listed([0.05, 0.2, 0.28, 0.4, 1.0, 2.0], [0.5 * np.pi, 1.5 * np.pi]),
    ),
    Case(
        "pole-kerr",
        "coordinates",
        "Rays of no angular momentum over the poles, a* = 0.9",
        _POLE,
        values=_camera(20.0, 30.0, 0.9, camera__observer="zamo"),
        rays=listed([0.05, 0.2, 0.28, 0.4, 1.0, 2.0], [0.5 * np.pi, 1.5 * np.pi]),
        needs="spin",
    ),
    Case(
        "horizon-kerr",
        "coordinates",
        "The whole sky from 5 r_s at a* = 0.9: turning points and the horizon",
        "Boyer–Lindquist φ winds up at the horizon; forms with ±√ stick at turning points.",
        values=_camera(5.0, 60.0, 0.9),
        rays=whole_sky(96),
        needs="spin",
    ),
    Case(
        "flat-side",
        "coordinates",
        "The shadow's outline at a* = 0.95 from the plane",
        "Ingoing coordinates for backward rays put its flat side where the disk recedes.",
        "shadow",
        _camera(20.0, 90.0, 0.95),
        needs="spin",
    ),
    Case(
        "in-plane",
        "camera's place",
        "Looking along the equatorial plane, a* = 0",
        _PLANE,
        values=_camera(20.0, 90.0),
        rays=listed([0.0, 0.05, 0.2, 0.5, 2.0], [0.0, np.pi]),
    ),
    Case(
        "in-plane-kerr",
        "camera's place",
        "The same at a* = 0.9",
        _PLANE,
        values=_camera(20.0, 90.0, 0.9),
        rays=listed([0.0, 0.05, 0.25, 0.5, 2.0], [0.0, np.pi]),
        needs="spin",
    ),
    Case(
        "near-plane",
        "camera's place",
        "Camera at 89.99°",
        "Rays graze the disk: a crossing's place is known to no more than rounding over the angle.",
        values=_camera(20.0, 89.99),
        rays=whole_sky(64, 0.6, 0.02),
        floor=2e-3,
    ),
    Case("axis", "camera's place", "Camera on the axis", _POLE, values=_camera(20.0, 0.0), rays=whole_sky(64)),
    Case("axis-kerr", "camera's place", "Camera on the axis, below, at a* = 0.9", _POLE, values=_camera(20.0, 180.0, 0.9), rays=whole_sky(64), needs="spin"),
    Case(
        "ergosphere",
        "camera's place",
        "Camera in the ergosphere: 0.85 r_s at a* = 0.9",
        "No observer can rest here: a static tetrad has no real γ, and light of negative energy arrives.",
        values=_camera(0.85, 85.0, 0.9),
        rays=whole_sky(64),
        needs="spin",
    ),
    Case("horizon", "camera's place", "Camera at 1.0001 r_s", _HORIZON, values=_camera(1.0001, 60.0), rays=whole_sky(64, away=3e-2)),
    Case(
        "horizon-spinning",
        "camera's place",
        "Camera a thousandth above the horizon of a* = 0.998",
        _HORIZON,
        values=_camera(0.5321, 60.0, 0.998),
        rays=whole_sky(64, away=3e-2),
        needs="spin",
    ),
    Case(
        "far-camera",
        "camera's place",
        "Camera at 10⁴ r_s, b = 2…50 r_s",
        "Places far away leave float32 no digits near the hole.",
        values=_camera(1e4),
        rays=impact(2.0, 2.7, 5.0, 20.0, 50.0),
    ),
    Case(
        "fall-1.2",
        "camera's place",
        "Falling like rain at 1.2 r_s",
        "Frames by √(1 − 1/r), or the aberration of one that rests: the fall is at 0.91 c.",
        values=_camera(1.2, camera__observer="rain"),
        rays=_ALL_ROUND,
    ),
    Case(
        "fall-0.5",
        "camera's place",
        "Falling like rain at 0.5 r_s, inside the horizon",
        _INSIDE,
        values=_camera(0.5, camera__observer="rain"),
        rays=_ALL_ROUND,
    ),
    Case(
        "fall-kerr",
        "camera's place",
        "Falling like rain at 0.75 r_s, just above the horizon of a* = 0.9",
        "A twist that is divided by Δ has a pole just below.",
        values=_camera(0.75, spin=0.9, camera__observer="rain"),
        rays=_ALL_ROUND,
        needs="spin",
    ),
    Case(
        "fall-0.5-kerr",
        "camera's place",
        "Falling like rain at 0.5 r_s, inside the horizon of a* = 0.9",
        _INSIDE,
        values=_camera(0.5, 30.0, 0.9, camera__observer="rain"),  # from 80° the twin counts crossings inside, without disk
        rays=_ALL_ROUND,
        needs="spin",
    ),
    Case("spin-tiny", "extreme spins", "a* = 1e-8", "Closed forms that divide by a.", values=_camera(10.0, 60.0, 1e-8), rays=whole_sky(64), needs="spin"),
    Case(
        "spin-limit",
        "extreme spins",
        "a* = 0.9999, from 5 r_s",
        "√(1 − a²) and the throat it leaves.",
        values=_camera(5.0, 75.0, 0.9999),
        rays=whole_sky(96),
        needs="spin",
        floor=2e-3,
    ),
    Case(
        "spin-limit-reversed",
        "extreme spins",
        "a* = −0.9999, from 5 r_s",
        "The same, turning the other way.",
        values=_camera(5.0, 75.0, -0.9999),
        rays=whole_sky(96),
        needs="spin",
        floor=2e-3,
    ),
    Case(
        "sweep",
        "whole range",
        "Random rays over the whole sky and the whole range of physical scenes",
        "Whatever nobody thought of: rays without a fate, or not finite.",
        "sweep",
    ),
    Case(
        "sweep-art",
        "whole range",
        "The same with artistic gravity (0.1–10) and horizon (0.01–1 r_s)",
        "Strong gravity with a small horizon leaves rays that wind without end.",
        "sweep",
        {"hole.gravity_strength": 10.0},
        needs="steps",
    ),
)
