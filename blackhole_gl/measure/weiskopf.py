"""The measurements of Weiskopf, Schafhitzel & Ertl 2004, "GPU-Based Nonlinear Ray Tracing", made again: their Table 1 and their Figure 5.

Their scene is of ten spheres, 800 × 600 pixels, and 300 Euler steps for every ray, in four models; how the spheres lie is not told. *Plain* is that, every step
being tested against every sphere. Their accelerations are switches here, each alone and all together.
"""

from __future__ import annotations

import math
import platform
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace

import numpy as np

from ..planning import Plan, plan
from ..rendering.frame import Renderer
from ..scene import Scene

SIZE = (800, 600)
STEPS, LENGTH = 300, 0.1  # of Euler; r_s
SPHERES = 10
COUNTS = (1, 3, 10, 30, 100, 300, 1000)
MOST_PLAIN = 100
"""Spheres up to which Figure 5 is also timed with every step tested against every one of them."""

PUBLISHED: Mapping[str, tuple[float, float]] = {
    "lorenz": (3.87, 3.13), "potential": (4.22, 1.16), "refraction": (3.35, 2.42), "schwarzschild": (4.91, 3.79),
}  # fmt: skip
"""Seconds a frame without and with their accelerations, on a Radeon 9700."""

_OFF = {"rays.early_end": False, "rays.bounds": False, "rays.step_control": "fixed"}
_ON = {"rays.early_end": True, "rays.bounds": True, "rays.step_control": "doubling"}
ACCELERATIONS: Mapping[str, Mapping[str, object]] = {
    "plain": _OFF,
    "early end": {**_OFF, "rays.early_end": True},
    "doubling": {**_OFF, "rays.step_control": "doubling"},
    "both of theirs": {**_ON, "rays.bounds": False},
    "bounds": {**_OFF, "rays.bounds": True},
    "all": _ON,
}
"""What is timed, the scene's values by key. Theirs are early termination and step doubling."""

_TOLERANCE = 1e-3  # rad a step of doubling: Euler's fixed steps err by about as much
_WAY = STEPS * LENGTH
_RANGE = (4.0, 8.0)  # r_s from the middle, of the spheres' centres
_DISTANCE = 18.0  # r_s, of the camera


@dataclass(frozen=True)
class Frame:
    """One picture's trace.

    Attributes:
        model: the ray model; name: what of `ACCELERATIONS` is on; spheres: how many.
        seconds: the least of the rounds.
        steps: mean over the rays.
    """

    model: str
    name: str
    spheres: int
    seconds: float
    steps: float


@dataclass(frozen=True)
class Suite:
    """A whole run: Table 1, Figure 5, and what of."""

    machine: str
    renderer: str
    width: int
    height: int
    rounds: int
    table: tuple[Frame, ...]
    figure: tuple[Frame, ...]

    def as_dict(self) -> dict[str, object]:
        """What JSON takes."""
        return asdict(self)


def scene_of(model: str, spheres: int, values: Mapping[str, object], seed: int = 0) -> Scene:
    """The scene of `model` with so many spheres, of the same volume together whatever their number, and `values` put in."""
    rng = np.random.default_rng(seed)
    direction = rng.normal(size=(spheres, 3))
    place = direction / np.linalg.norm(direction, axis=1, keepdims=True) * rng.uniform(*_RANGE, (spheres, 1))
    found: dict[str, object] = {"rays.model": model, "camera.distance": _DISTANCE, "disk.enabled": False, "hole.spin": 0.0, "rays.field_way": _WAY}
    found |= {"rays.integrator": "euler", "rays.step_length": LENGTH, "rays.max_steps": STEPS, "rays.doubling.tolerance": _TOLERANCE}
    radius = (SPHERES / spheres) ** (1.0 / 3.0)
    for number, centre in enumerate(place):
        name = f"things.sphere{number}"
        found |= {f"{name}.kind": "sphere", f"{name}.radius": radius, f"{name}.surface": "checker"}
        found |= {f"{name}.{axis}": float(value) for axis, value in zip("xyz", centre)}
    return Scene().with_values({**found, **values})


def plan_of(scene: Scene) -> Plan:
    """The plan of `scene` with steps as long as stated: 300 of them are all that there are."""
    return replace(plan(scene), step_length=LENGTH, max_steps=STEPS)


def measure(renderer: Renderer, size: tuple[int, int] = SIZE, rounds: int = 1, progress: Callable[[float], None] | None = None) -> Suite:
    """Runs the suite on `renderer`; `progress` is called with the share done, 0…1."""
    asked = [*_table(), *_figure()]
    found = []
    for number, (model, name, spheres) in enumerate(asked):
        made = plan_of(scene_of(model, spheres, ACCELERATIONS[name]))
        renderer.time_trace(made, (16, 12))  # drivers compile at the first draw
        seconds = min(renderer.time_trace(made, size) for _ in range(rounds))
        found.append(Frame(model, name, spheres, seconds, float(np.mean(renderer.hits().steps))))
        if progress is not None:
            progress((number + 1) / len(asked))
    cut = len(list(_table()))
    machine = platform.processor() or platform.machine()
    return Suite(machine, renderer.ctx.info["GL_RENDERER"], *size, rounds, tuple(found[:cut]), tuple(found[cut:]))


def _table() -> Iterator[tuple[str, str, int]]:
    for model in PUBLISHED:
        for name in ACCELERATIONS:
            yield model, name, SPHERES


def _figure() -> Iterator[tuple[str, str, int]]:
    for spheres in COUNTS:
        if spheres <= MOST_PLAIN:
            yield "lorenz", "early end", spheres
        yield "lorenz", "all", spheres


def text(suite: Suite) -> str:
    """The suite as Markdown tables."""
    names = [name for name in ACCELERATIONS if name != "plain"]
    lines = [f"{suite.renderer}; {suite.width}×{suite.height}, {suite.rounds} rounds", ""]
    lines += _head(["model", "plain, s", *(f"{name}, ×" for name in names), "steps, plain", "all", "2004: plain, s", "accelerated, s", "×"])
    for model, (plain, accelerated) in PUBLISHED.items():
        of = {frame.name: frame for frame in suite.table if frame.model == model}
        faster = [f"{of['plain'].seconds / of[name].seconds:.2f}" for name in names]
        steps = [f"{of[name].steps:.0f}" for name in ("plain", "all")]
        lines.append(_row([model, f"{of['plain'].seconds:.2f}", *faster, *steps, f"{plain:.2f}", f"{accelerated:.2f}", f"{plain / accelerated:.2f}"]))
    lines += ["", *_head(["spheres", "every step against every sphere, s", "all accelerations, s"])]
    times = {(frame.spheres, frame.name): frame.seconds for frame in suite.figure}
    for spheres in COUNTS:
        cells = (times.get((spheres, name), math.nan) for name in ("early end", "all"))
        lines.append(_row([str(spheres), *("–" if math.isnan(seconds) else f"{seconds:.2f}" for seconds in cells)]))
    return "\n".join(lines) + "\n"


def _head(names: Iterable[str]) -> list[str]:
    names = list(names)
    return [_row(names), _row(["---", *["---:"] * (len(names) - 1)])]


def _row(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"
