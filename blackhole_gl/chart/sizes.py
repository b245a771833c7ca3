"""The third chart: cost against the number of pixels."""

from __future__ import annotations

from dataclasses import dataclass

from .. import timing
from ..render.frame import Renderer
from ..scene import Scene
from .methods import Method

SIZES = ((160, 90), (320, 180), (480, 270), (640, 360), (960, 540), (1280, 720))

_METHODS = {
    "kerr, κ = 0.4": (Method("kerr", "rk4", "mino"), 0.4),
    "kerr, κ = 0.2": (Method("kerr", "rk4", "mino"), 0.2),
    "kerr, κ = 0.05": (Method("kerr", "rk4", "mino"), 0.05),
    "schwarzschild, rk4, Δt₀ = 0.15": (Method("schwarzschild", "rk4", "radius"), 0.15),
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
    tasks = {name: method.applied(scene, setting) for name, (method, setting) in _METHODS.items()}
    found = []
    for size in SIZES[:3] if quick else SIZES:
        work = timing.tasks({"flat": timing.flat_scene(scene), **tasks}) | {"300 Euler steps": timing.euler_task(scene)}
        for name, taken in timing.interleaved(renderer, work, size, "flat", rounds=3).items():
            found.append(Cost(name, *size, taken.milliseconds, taken.ratio))
    return found
