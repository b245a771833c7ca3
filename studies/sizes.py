"""The third chart: cost against the number of pixels."""

from __future__ import annotations

from dataclasses import dataclass

from blackhole_gl import planning
from blackhole_gl.measure import timing
from blackhole_gl.measure.methods import Combination
from blackhole_gl.measure.refined import refined_plan
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene

SIZES = ((160, 90), (320, 180), (480, 270), (640, 360), (960, 540), (1280, 720))

_METHODS = {
    "kerr, κ = 0.4": (Combination("kerr", "rk4", "mino"), 0.4),
    "kerr, κ = 0.2": (Combination("kerr", "rk4", "mino"), 0.2),
    "kerr, κ = 0.05": (Combination("kerr", "rk4", "mino"), 0.05),
    "kerr, κ = 0.2, refined": (Combination("kerr", "rk4", "mino", refined=True), 0.2),
    "schwarzschild, rk4, Δt₀ = 0.15": (Combination("schwarzschild", "rk4", "radius"), 0.15),
}


@dataclass(frozen=True)
class Cost:
    """What a frame of one size costs: milliseconds, and the ratio to the flat frame of that size."""

    method: str
    width: int
    height: int
    milliseconds: float
    flat_ratio: float


COLUMNS = tuple(Cost.__dataclass_fields__)


def costs(renderer: Renderer, scene: Scene, quick: bool) -> list[Cost]:
    """Costs of some methods in `scene` at several sizes, each interleaved with the flat frame."""
    scenes = {name: method.applied(scene, setting) for name, (method, setting) in _METHODS.items()}
    found = []
    for size in SIZES[:3] if quick else SIZES:
        work = {name: planning.plan(asked) for name, asked in {"flat": timing.flat_scene(scene), **scenes}.items()}
        work["300 Euler steps"] = timing.euler_plan(scene)
        moving = {name: refined_plan(scenes[name]) for name, (method, _) in _METHODS.items() if method.refined}
        for name, taken in timing.interleaved(renderer, work | moving, size, "flat", rounds=3, refined=moving).items():
            found.append(Cost(name, *size, taken.milliseconds, taken.ratio))
    return found
