"""Fair timing: methods interleaved in one run, as ratios to the flat frame of the same scene.

Machines drift and are shared; a ratio taken round by round does not. Timer queries are not used: docs/llvmpipe.md.
"""

from __future__ import annotations

import statistics
from collections.abc import Container, Mapping
from dataclasses import dataclass, replace

from .. import planning
from ..physics.observer import RESTING
from ..physics.space_time import is_inside
from ..planning import Plan
from ..rendering.frame import Renderer
from ..scene import Scene

_JUST_OUTSIDE = 1.1  # r_s: of every hole


@dataclass(frozen=True)
class Timing:
    """Trace time of one scene.

    Attributes:
        milliseconds: median over the rounds.
        ratio: median over the rounds of the time relative to the yardstick in the same round.
        spread: (lowest, highest) of that ratio.
    """

    milliseconds: float
    ratio: float
    spread: tuple[float, float]


def flat_scene(scene: Scene) -> Scene:
    """The same scene with straight rays: the yardstick.

    In flat space nothing falls or circles, and its black ball has no inside: there the camera rests, just outside where it was inside.
    """
    camera = scene.camera
    observer = camera.observer if camera.observer in RESTING else "static"
    distance = _JUST_OUTSIDE if is_inside(scene) else camera.distance
    return scene.with_values({"rays.lensing": False, "camera.observer": observer, "camera.distance": distance})


def euler_plan(scene: Scene) -> Plan:
    """300 fixed Euler steps of `schwarzschild` in the same picture: the common way of today's viewers.

    Every ray that is not captured takes all 300: the step is so short that none gets out of the march's bound before.
    """
    resting = flat_scene(scene)
    values = {"rays.model": "schwarzschild", "rays.integrator": "euler", "rays.step_control": "fixed", "rays.max_steps": 300, "rays.lensing": True}
    outside = {"hole.spin": 0.0, "camera.distance": max(resting.camera.distance, _JUST_OUTSIDE)}
    slow = planning.plan(resting.with_values({**values, **outside}))
    return replace(slow, step_length=slow.march_bound / 300.0)


def interleaved(
    renderer: Renderer,
    work: Mapping[str, Plan],
    size: tuple[int, int],
    yardstick: str,
    rounds: int = 7,
    refined: Container[str] = (),
) -> dict[str, Timing]:
    """Trace times of `work` at `size`, taken in turn `rounds` times after one uncounted round.

    Args:
        yardstick: the key in `work` that ratios are taken to.
        refined: the keys in `work` whose plans say how far hits may be interpolated, and which are traced so.
    """
    times: dict[str, list[float]] = {name: [] for name in work}
    for counted in range(-1, rounds):
        for name, made in work.items():
            seconds = renderer.time_trace(made, size, progressive=name in refined)
            if counted >= 0:
                times[name].append(seconds)
    found = {}
    for name, taken in times.items():
        ratios = [a / b for a, b in zip(taken, times[yardstick])]
        found[name] = Timing(1e3 * statistics.median(taken), statistics.median(ratios), (min(ratios), max(ratios)))
    return found
