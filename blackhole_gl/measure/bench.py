"""How long frames take on this machine: methods and looks, still and moving, over picture sizes; interleaved, as ratios to the flat frame.

A *still* frame keeps the hit map and lets the disk turn: shade and post. A *moving* one follows a camera that has gone half a degree round and
half a degree down since the last: trace, shade and post, as the window draws it: refined where the plan refines. Times are by the wall clock with the
pipeline drained after each frame, the median of a few frames in each round, as other programs come in bursts; beside their median stands the least
processor time of the process, which other programs disturb less and which a GPU makes meaningless.
"""

from __future__ import annotations

import platform
import statistics
import time as clock
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass

from .. import planning
from ..physics.observer import is_possible
from ..rendering.frame import Renderer
from ..scene import Scene
from . import timing

SIZES = ((640, 360), (1280, 720), (1920, 1080), (3840, 2160))
TURN_DEG = 0.5
YARDSTICK = "flat"
FRAMES = 3
"""Frames of each row in a round; their median is the round's."""
EULER_SIZE = (1280, 720)
"""The size at which E is timed too, in every round of the moving frames."""


@dataclass(frozen=True)
class Frames:
    """One scene at one size, still or moving.

    Attributes:
        scene: its name; method: how its rays are traced; motion: ``still`` or ``moving``.
        width, height: pixels.
        milliseconds: median of whole frames by the wall clock; trace_ms, shade_ms, post_ms: medians of their parts.
        ratio: median over the rounds of the whole frame relative to the flat one of the same round, size and motion.
        processor_ms: least processor time of a whole frame.
        trace_in_e: median over the rounds of the trace relative to E, the trace of 300 fixed Euler steps of `schwarzschild` at the same size in
            the same round; None where E was not timed.
        own_rays: share of the pixels that had a ray of their own in the last frame; 1 where nothing was interpolated.
    """

    scene: str
    method: str
    motion: str
    width: int
    height: int
    milliseconds: float
    trace_ms: float
    shade_ms: float
    post_ms: float
    ratio: float
    processor_ms: float
    trace_in_e: float | None
    own_rays: float


@dataclass(frozen=True)
class Bench:
    """A whole run: the machine, the rounds and the rows; `euler_ms` is the median of E at `EULER_SIZE`, None where it was not timed."""

    machine: str
    renderer: str
    rounds: int
    euler_ms: float | None
    rows: tuple[Frames, ...]

    def as_dict(self) -> dict[str, object]:
        """What JSON takes."""
        return asdict(self)


def scenes(scene: Scene) -> dict[str, Scene]:
    """What is compared: `scene` by its own plan, straight rays, other ray models where there is such a camera, and `scene` with one part left out."""
    without_spin = scene.with_values({"hole.spin": 0.0})
    compared = {
        YARDSTICK: timing.flat_scene(scene),
        "as given": scene,
        "as given, not refined": scene.with_values({"rays.refine": False}),
        "kerr, κ = 0.2, not refined": scene.with_values({"rays.model": "kerr", "rays.integrator": "rk4", "rays.step_angle": 0.2, "rays.refine": False}),
        "kerr, nystrom4": scene.with_values({"rays.model": "kerr", "rays.integrator": "nystrom4", "rays.step_angle": 0.2, "rays.refine": False}),
        "schwarzschild": without_spin.with_values({"rays.model": "schwarzschild"}),
        "table": without_spin.with_values({"rays.model": "schwarzschild_table"}),
        "table, no disk": without_spin.with_values({"rays.model": "schwarzschild_table", "disk.enabled": False}),
        "table, no sky": without_spin.with_values({"rays.model": "schwarzschild_table", "sky.enabled": False}),
        "table, no bloom": without_spin.with_values({"rays.model": "schwarzschild_table", "post.bloom": False}),
    }
    return {name: item for name, item in compared.items() if is_possible(item)}


def measure(
    renderer: Renderer,
    scene: Scene,
    sizes: Iterable[tuple[int, int]] = SIZES,
    rounds: int = 5,
    euler: bool = True,
    progress: Callable[[float], None] | None = None,
) -> Bench:
    """Runs the bench on `renderer`.

    Args:
        euler: also time E where `sizes` hold `EULER_SIZE`; it takes as long as dozens of frames.
        progress: called with the share done, 0…1.
    """
    compared, sizes = scenes(scene), tuple(sizes)
    rows: list[Frames] = []
    euler_ms: list[float] = []
    for done, size in enumerate(sizes):
        for half, motion in enumerate(("still", "moving")):
            yardstick = timing.euler_plan(scene) if euler and motion == "moving" and size == EULER_SIZE else None
            rows += _rows(renderer, compared, motion, size, rounds, yardstick, euler_ms)
            if progress is not None:
                progress((done + 0.5 * (half + 1)) / len(sizes))
    machine = platform.processor() or platform.machine()
    return Bench(machine, renderer.ctx.info["GL_RENDERER"], rounds, statistics.median(euler_ms) if euler_ms else None, tuple(rows))


def text(bench: Bench) -> str:
    """The bench as a Markdown table."""
    lines = [
        f"{bench.renderer}; {bench.rounds} rounds" + (f"; E = {bench.euler_ms:.0f} ms" if bench.euler_ms else ""),
        "",
        "| size | motion | scene | method | ms | trace | shade | post | × flat | trace, E | own rays | processor ms |",
        "| --- | --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for row in bench.rows:
        times = " | ".join(f"{value:.1f}" for value in (row.milliseconds, row.trace_ms, row.shade_ms, row.post_ms))
        in_e = "" if row.trace_in_e is None else f"{row.trace_in_e:.3f}"
        lines.append(
            f"| {row.width}×{row.height} | {row.motion} | {row.scene} | {row.method} | {times} | {row.ratio:.2f} | {in_e} | {row.own_rays:.2f} | "
            f"{row.processor_ms:.1f} |"
        )
    return "\n".join(lines) + "\n"


def _rows(
    renderer: Renderer,
    compared: Mapping[str, Scene],
    motion: str,
    size: tuple[int, int],
    rounds: int,
    yardstick: planning.Plan | None,
    euler_ms: list[float],
) -> list[Frames]:
    """The rows of one size and motion; E of every round, where there is a `yardstick`, is put into `euler_ms`."""
    wall: dict[str, list[tuple[float, ...]]] = {name: [] for name in compared}
    processor: dict[str, list[float]] = {name: [] for name in compared}
    own_rays: dict[str, float] = {}
    for counted in range(-1, rounds):
        if yardstick is not None:
            seconds = renderer.time_trace(yardstick, size)
            if counted >= 0:
                euler_ms.append(1e3 * seconds)
        for name, scene in compared.items():
            frame = _moved(scene, counted + 2) if motion == "moving" else scene
            for warm in range(1 if motion == "moving" else 3):  # the hit map, and the sky that is kept from the second frame on
                renderer.render(frame, 0.01 * warm, size, progressive=motion == "moving")
            taken = []
            for number in range(FRAMES):
                seen = _moved(frame, number + 1) if motion == "moving" else frame
                renderer.ctx.finish()
                start = clock.process_time()
                report = renderer.render(seen, 0.1 * (FRAMES * counted + number + 10), size, measure=True, progressive=motion == "moving")
                if counted >= 0:
                    processor[name].append(1e3 * (clock.process_time() - start))
                taken.append((report.trace_ms + report.shade_ms + report.post_ms, report.trace_ms, report.shade_ms, report.post_ms))
            if counted >= 0:
                own_rays[name] = float(renderer.hit_map.own_rays().mean())
                wall[name].append(tuple(map(statistics.median, zip(*taken))))
    found = []
    for name, scene in compared.items():
        whole, trace, shade, post = (statistics.median(column) for column in zip(*wall[name]))
        ratio = statistics.median(a[0] / b[0] for a, b in zip(wall[name], wall[YARDSTICK]))
        in_e = statistics.median(times[1] / e for times, e in zip(wall[name], euler_ms)) if yardstick else None
        cost = min(processor[name])
        found.append(Frames(name, _method(scene, motion), motion, size[0], size[1], whole, trace, shade, post, ratio, cost, in_e, own_rays[name]))
    return found


def _method(scene: Scene, motion: str) -> str:
    made = planning.plan(scene)
    return f"{made.method}, refined" if motion == "moving" and made.refine_px else made.method


def _moved(scene: Scene, frames: int) -> Scene:
    angle = scene.camera.inclination_deg
    turned = {"camera.azimuth_deg": scene.camera.azimuth_deg + TURN_DEG * frames, "camera.inclination_deg": min(angle + TURN_DEG * frames, 180.0)}
    return scene.with_values(turned)
