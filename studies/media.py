"""Measures the error and the cost of steps in every kind of medium, against short ones: a table for the plan, and a page. A few minutes.

    python -m studies.media [--out docs] [--plan-table assets/measurements_media.csv]
"""

from __future__ import annotations

import argparse
import dataclasses
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from blackhole_gl.measure import timing
from blackhole_gl.output.files import write_whole
from blackhole_gl.output.progress import Progress
from blackhole_gl.planning.media_steps import MeasuredMedium
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, met, presets
from studies.table import Origin, origin, short, write_records

_STEPS = (1.0, 0.85, 0.7, 0.6, 0.5, 0.42, 0.35, 0.25)
_SHORT = 0.08  # what they are compared with: by the order of the march its error is a hundredth of the shortest's
_SIZE = (160, 90)
_ROUNDS = 5
_TIME = 1.0  # r_s/c
_BARE: Mapping[str, object] = {"sky.enabled": False, "disk.enabled": False, "post.bloom": False, "rays.edges": 1}
_FOG = {"media.fog.kind": "ball", "media.fog.radius": 4.0, "media.fog.depth": 0.4}
_SCENES: Mapping[str, tuple[str, Mapping[str, object]]] = {
    **{f"gold_{number}": (f"gold_{number}", {}) for number in range(1, 6)},
    "polish_doughnut": ("polish_doughnut", {}),
    "cloudy_slab": ("cloudy_slab", {}),
    "cloudy_slab with lanes and grain": ("cloudy_slab", {"media.slab.lanes": 1.0, "media.slab.grain": 1.0}),
    "jet": ("jet", {}),
    "kerr with a ball of fog": ("kerr", _FOG),
}
"""Name → preset, and what is other in it."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, default=Path("accuracy"), help="folder for media.md")
    parser.add_argument("--plan-table", type=Path, help="also write the table that the plan chooses by")
    asked = parser.parse_args()
    renderer = Renderer(create_headless())
    rows: list[MeasuredMedium] = []
    with Progress("measuring") as progress:
        for done, (name, (preset, other)) in enumerate(_SCENES.items()):
            rows += _rows(renderer, name, presets.load([preset], {**_BARE, **other}))
            progress((done + 1) / len(_SCENES))
    where = origin(renderer.ctx.info["GL_RENDERER"])
    asked.out.mkdir(parents=True, exist_ok=True)
    write_whole(asked.out / "media.md", page(rows, where).encode())
    if asked.plan_table:
        columns = tuple(item.name for item in dataclasses.fields(MeasuredMedium))
        write_records(asked.plan_table, columns, ([getattr(row, name) for name in columns] for row in rows), where)


def _rows(renderer: Renderer, name: str, scene: Scene) -> Iterator[MeasuredMedium]:
    (kind,) = met.kinds(scene, "medium")
    right = _light(renderer, scene, _SHORT)
    brightest, lit = float(np.quantile(right.max(axis=-1), 0.999)), right.max(axis=-1) > 0.0
    costs = _costs(renderer, scene)
    for step in _STEPS:
        off = np.abs(_light(renderer, scene, step) - right).max(axis=-1)[lit]
        yield MeasuredMedium(name, kind.key, step, float(np.quantile(off, 0.99)) / brightest, costs[step])


def _light(renderer: Renderer, scene: Scene, step: float) -> np.ndarray:
    """Of each pixel, (height, width, 3), in single floats before the picture makes them half ones; 0 where a ray meets no medium."""
    renderer.render(scene.with_values({"rays.medium_step": step}), _TIME, _SIZE)
    (gathered,), _ = renderer.transfer.read()
    return np.where(renderer.radiance()[::-1] > 0.0, gathered, 0.0)


def _costs(renderer: Renderer, scene: Scene) -> dict[float, float]:
    """Step → least processor time of a frame in which media are marched anew, over that of the flat one without them; all in turn."""
    flat = Renderer(renderer.ctx)
    plain = met.without_any(timing.flat_scene(scene)).with_values({"disk.enabled": True})
    taken: dict[float, list[float]] = {step: [] for step in _STEPS}
    yard = []
    for number in range(_ROUNDS + 1):
        yard.append(_seconds(flat, plain, number))
        for step in _STEPS:
            taken[step].append(_seconds(renderer, scene.with_values({"rays.medium_step": step}), number))
    flat.release()
    return {step: min(times[1:]) / min(yard[1:]) for step, times in taken.items()}


def _seconds(renderer: Renderer, scene: Scene, number: int) -> float:
    renderer.ctx.finish()
    start = time.process_time()
    renderer.render(scene, _TIME + 0.1 * number, _SIZE)
    renderer.ctx.finish()
    return time.process_time() - start


def page(rows: Sequence[MeasuredMedium], where: Origin) -> str:
    """The page as Markdown."""
    width, height = _SIZE
    lines = [
        "# Accuracy and cost in media",
        "",
        f"Made by `make media`; do not edit. Measured on: {where.text}. The plan takes the longest step whose light meets `rays.light_tolerance` by the same",
        "table, `assets/measurements_media.csv`; `blackhole-gl plan` says which, and what to expect.",
        "",
        f"Steps are shares of the length on which a medium changes, `rays.medium_step`. Error: of the light of a picture {width}×{height} large, media",
        f"alone, against steps of {_SHORT:g}, at 99 % of the pixels that show any, of the brightest 0.1 %. Cost: processor time of a still frame whose",
        "media are marched anew on rays that are kept, over that of a frame of the disk in flat space, the least of five in turn.",
        "",
    ]
    steps = [f"{step:g}" for step in _STEPS]
    for title, digits in (("Error", "light_99"), ("Cost / flat", "cost_flat_ratio")):
        lines += [f"## {title}", "", f"| scene | medium | {' | '.join(steps)} |", f"| --- | --- |{' ---: |' * len(steps)}"]
        for name in _SCENES:
            own = [row for row in rows if row.scene == name]
            lines.append(f"| {name} | {own[0].kind} | {' | '.join(short(getattr(row, digits)) for row in own)} |")
        lines.append("")
    return "\n".join(lines[:-1]) + "\n"


if __name__ == "__main__":
    main()
