"""What one way of drawing a frame takes of another's processor time: the two in turn, and the median of the pairs' ratios.

    LP_NUM_THREADS=1 python tools/time_pairs.py [--size 1280x720] [--rounds 40] [--preset kerr] [--set rays.lensing=false] [--only edges]

glow: a picture at rest while time runs, its glow made for every third frame, against one made for each.
edges: a picture under a moving camera with several rays in the pixels at edges, against one ray in each.
catalogue: a picture under a moving camera before the sky of measured stars, against the invented one.
things: ten spheres and the disk under a moving camera, against the disk alone.
orbit: ten spheres before a camera at rest, one of them on an orbit, against all of them at rest.
turning, zooming: a camera that only turns by half a degree a frame, or zooms in by 1 %, against one at rest; with the rays that are marched for each picture.
turning_up, zooming_out: the same, up and out.
stars: a picture of half the size under a moving camera, enlarged with its stars drawn over it, against one that is only enlarged.
"""

from __future__ import annotations

import argparse
import math
import time as clock
from collections.abc import Callable
from statistics import mean, median, quantiles
from typing import Any

from blackhole_gl.app.area import Area
from blackhole_gl.app.targets import Drawing, Targets
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.rendering.frame_report import FrameReport
from blackhole_gl.rendering.post import GLOW_SERVES
from blackhole_gl.rendering.target import Target
from blackhole_gl.scene import Scene, presets

FRAME_S = 1.0 / 30.0  # between frames, of the window's time

Frames = Callable[[int], FrameReport | None]  # draws the frames of a round; may tell of the last


def glow(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """As many frames of a clock that runs as fast as forty of them show it as a glow may serve, one of which it is made for."""

    def frames(number: int, *, lasts: bool) -> None:
        for k in range(GLOW_SERVES):
            renderer.render(scene, 0.025 * scene.playback.rate * (GLOW_SERVES * number + k), size, glow_may_last=lasts)

    return lambda number: frames(number, lasts=True), lambda number: frames(number, lasts=False)


def edges(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """The camera tilts by half a degree a frame."""

    def frame(number: int, rays: int) -> None:
        turned = scene.with_values({"camera.inclination_deg": 60.0 + 0.5 * (number % 20) + 0.01 * rays, "rays.edges": rays})
        renderer.render(turned, FRAME_S * number, size, progressive=True)

    return lambda number: frame(number, scene.rays.edges), lambda number: frame(number, 1)


def stars(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """The window's own way of showing such a picture, and the same without the layer."""
    area = Area(0, 0, *size)
    window = Target.of(renderer.ctx, [renderer.ctx.texture(size, 4)])
    with_stars, without = Targets(renderer.ctx, renderer), Targets(renderer.ctx, _NoStars(renderer))

    def frame(number: int, targets: Targets, shift_deg: float) -> None:
        turned = scene.with_values({"camera.inclination_deg": 70.0 + 0.5 * (number % 20) + shift_deg})
        targets.render_into(window.frame, area, Drawing(turned, FRAME_S * number, area.scaled(0.5), area.size, progressive=True, passes=False))

    return lambda number: frame(number, with_stars, 0.0), lambda number: frame(number, without, 0.01)  # another view, or it would keep the rays


def catalogue(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """The camera tilts by half a degree a frame."""
    other, measured, invented = Renderer(renderer.ctx), *(scene.with_values({"sky.model": sky}) for sky in ("catalogue", "procedural"))

    def frame(number: int, drawn_by: Renderer, seen: Scene) -> None:
        drawn_by.render(seen.with_values({"camera.inclination_deg": 60.0 + 0.5 * (number % 20)}), FRAME_S * number, size, progressive=True)

    return lambda number: frame(number, renderer, measured), lambda number: frame(number, other, invented)


def ten_spheres(scene: Scene, *, orbiting: bool) -> Scene:
    """`scene` with ten spheres about the hole, the first of them on an orbit or at rest."""
    values: dict[str, object] = {}
    for k in range(10):
        r, around = 4.0 + 0.9 * k, 0.2 * math.pi * k
        place = {"x": r * math.cos(around), "y": r * math.sin(around), "z": 1.5 * math.sin(3.0 * around) + 1.0}
        values |= {f"things.s{k}.{key}": value for key, value in {"kind": "sphere", "radius": 0.24 + 0.04 * k, **place}.items()}
    if orbiting:
        values |= {"things.s0.path": "geodesic", "things.s0.orbit_radius": 6.0, "things.s0.orbit_tilt_deg": 20.0}
    return scene.with_values(values)


def things(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """A camera that turns in both angles."""
    other, with_things = Renderer(renderer.ctx), ten_spheres(scene, orbiting=False)

    def frame(number: int, drawn_by: Renderer, seen: Scene) -> None:
        turn = 0.5 * (number + 3)
        turned = seen.with_values({"camera.azimuth_deg": turn, "camera.inclination_deg": 75.0 + turn % 10.0})
        drawn_by.render(turned, FRAME_S * number, size, progressive=True)

    return lambda number: frame(number, renderer, with_things), lambda number: frame(number, other, scene)


def orbit(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """Frames of a running clock, as the window draws them."""
    other, moves, rests = Renderer(renderer.ctx), ten_spheres(scene, orbiting=True), ten_spheres(scene, orbiting=False)

    def frame(number: int, drawn_by: Renderer, seen: Scene) -> None:
        drawn_by.render(seen, 4.0 * FRAME_S * (number + 3), size, glow_may_last=True)

    return lambda number: frame(number, renderer, moves), lambda number: frame(number, other, rests)


class _NoStars:
    """A renderer that draws its stars with the rest."""

    def __init__(self, renderer: Renderer):
        self._renderer = renderer

    def render(self, *given: Any, shown: object, **named: Any) -> FrameReport:
        return self._renderer.render(*given, **named)

    def draw_stars(self, *given: object) -> None:
        pass


def looking(renderer: Renderer, scene: Scene, size: tuple[int, int], look: Callable[[int], dict[str, object]]) -> tuple[Frames, Frames]:
    """Frames of a running clock under a camera that has the `look` of each frame's number, and under one that rests with the look of the thirtieth."""
    other, middle = Renderer(renderer.ctx), scene.with_values(look(30))

    def looks(number: int) -> FrameReport:
        return renderer.render(scene.with_values(look(number)), FRAME_S * number, size, progressive=True, may_turn=True)

    def rests(number: int) -> None:
        other.render(middle, FRAME_S * number, size)

    return looks, rests


def turning(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """To the right."""
    return looking(renderer, scene, size, lambda number: {"camera.yaw_deg": 0.5 * (number - 30)})


def turning_up(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """From below, past the hole."""
    return looking(renderer, scene, size, lambda number: {"camera.pitch_deg": 0.5 * (number - 30)})


def zooming(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """In."""
    return looking(renderer, scene, size, lambda number: {"camera.fov_deg": scene.camera.fov_deg * 0.99 ** (number + 3)})


def zooming_out(renderer: Renderer, scene: Scene, size: tuple[int, int]) -> tuple[Frames, Frames]:
    """Out."""
    return looking(renderer, scene, size, lambda number: {"camera.fov_deg": 0.6 * scene.camera.fov_deg * 1.01 ** (number + 3)})


COMPARED = {
    **{"glow": glow, "edges": edges, "things": things, "orbit": orbit, "stars": stars, "catalogue": catalogue},
    **{"turning": turning, "turning_up": turning_up, "zooming": zooming, "zooming_out": zooming_out},
}


def spent(renderer: Renderer, frames: Frames, number: int, told: list[FrameReport]) -> float:
    """Milliseconds of processor time; what is told of a frame is put to `told`."""
    renderer.ctx.finish()
    begun = clock.process_time()
    report = frames(number)
    renderer.ctx.finish()
    told += [] if report is None else [report]
    return 1e3 * (clock.process_time() - begun)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--rounds", type=int, default=40)
    parser.add_argument("--preset", action="append")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--only", choices=COMPARED)
    given = parser.parse_args()
    width, height = (int(side) for side in given.size.split("x"))
    renderer, scene = Renderer(create_headless()), presets.load(given.preset or ["kerr"], dict(pair.split("=", 1) for pair in given.set))
    for compare in [COMPARED[given.only]] if given.only else COMPARED.values():
        new, old = compare(renderer, scene, (width, height))
        told: list[FrameReport] = []
        taken = [(spent(renderer, new, number, told), spent(renderer, old, number, told)) for number in range(-3, given.rounds)][3:]
        low, _, high = quantiles((a / b for a, b in taken), n=4)
        whole = sum(a for a, _ in taken) / sum(b for _, b in taken)
        print(f"{compare.__name__}: {median(a / b for a, b in taken):.3f} of the time, half of the pairs within {low:.3f} to {high:.3f}, {whole:.3f} in all")
        if told:
            marched = [report.marched / (width * height) for report in told[3:]]
            many = sum(share > 0.05 for share in marched)
            print(f"  rays marched: {mean(marched):.3f} of the pixels in the mean, {max(marched):.3f} at most, in {many} of {len(marched)} more than 0.05")


if __name__ == "__main__":
    main()
