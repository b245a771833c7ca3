"""Times ways to trace against each other in one scene of the chart, and says how far off each is.

    python tools/time_ray_models.py [--scene kerr] [--rounds 12] flat kerr:rk4:0.28 schwarzschild_table …

A way is a ray model, or model:integrator:step angle κ for one that marches in Mino time. For trying out a ray model before it has
its cells in the chart: it need only lie in shaders/ray_models. Costs are processor time of a trace of 1280×720 pixels, the least of
the rounds, in which the ways take turns; errors are of the chart's rays, those within 1e-3 of the critical curve apart.
"""

from __future__ import annotations

import argparse
import time

from blackhole_gl import listed_rays, planning
from blackhole_gl.measure import errors, scenes, timing
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene

SIZE = (1280, 720)


def scene_of(way: str, scene: Scene) -> Scene:
    """`scene` traced in the `way` of the command line."""
    if way == "flat":
        return timing.flat_scene(scene)
    model, *march = way.split(":")
    values: dict[str, object] = {"rays.model": model}
    if march:
        values |= {"rays.integrator": march[0], "rays.step_control": "mino", "rays.step_angle": float(march[1])}
    return scene.with_values(values)


def least_costs(renderer: Renderer, ways: dict[str, Scene], rounds: int) -> dict[str, float]:
    """Processor time in ms of each way's trace; the first round, which compiles, does not count."""
    plans = {way: planning.plan(scene) for way, scene in ways.items()}
    found = {way: float("inf") for way in ways}
    for counted in range(-1, rounds):
        for way in ways:
            begin = time.process_time()
            renderer.time_trace(plans[way], SIZE)
            if counted >= 0:
                found[way] = min(found[way], 1e3 * (time.process_time() - begin))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ways", nargs="+")
    parser.add_argument("--scene", default="kerr", help="a scene of the chart")
    parser.add_argument("--rounds", type=int, default=12)
    args = parser.parse_args()
    chart_scene = next(item for item in scenes.chart_scenes() if item.name == args.scene)
    renderer = Renderer(create_headless())
    ways = {way: scene_of(way, chart_scene.scene) for way in args.ways}
    costs = least_costs(renderer, ways, args.rounds)
    away = chart_scene.epsilon >= scenes.NEAR_CRITICAL
    print("way                         ms   direction 99 %: rad, px   crossing r 99 %   near the curve: direction median   wrong fates")
    for way, scene in ways.items():
        found = listed_rays.trace_by_shader(renderer, scene, chart_scene.rays)
        far, near = (errors.compare(found, chart_scene.truth, part) for part in (away, ~away))
        print(
            f"{way:24s}{costs[way]:6.0f}{far.direction_99:16.1e}{far.direction_99 / chart_scene.pixel:10.3f}{far.crossing_r_99:18.1e}"
            f"{near.direction_median:36.1e}{near.wrong_fates:14.3f}"
        )
    renderer.release()


if __name__ == "__main__":
    main()
