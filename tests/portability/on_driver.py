"""Draws every golden picture and traces every shipped preset's own method, on the driver that this process's environment asks for.

    python -m tests.portability.on_driver FOLDER

writes FOLDER/NAME.png for every picture and FOLDER/NAME.npz (a `TracedRays`) for every preset, and prints the driver's name.
"""

from __future__ import annotations

import sys
from dataclasses import asdict
from pathlib import Path

import numpy as np
from PIL import Image

from blackhole_gl import listed_rays
from blackhole_gl.measure.scenes import ChartScene, is_charted
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.resources import presets_dir
from blackhole_gl.scene import presets
from tests.images.test_golden_pictures import SHOTS, SIZE

RAYS = 500


def places() -> list[ChartScene]:
    """Every shipped preset that shows a hole as it is and leaves its method to the plan, each with a sample of its picture's rays."""
    shipped = [info.name for info in presets.available() if info.group in ("physics", "scene") and info.path.is_relative_to(presets_dir())]
    return [ChartScene(name, scene, RAYS) for name, scene in ((name, presets.load([name])) for name in shipped) if is_charted(scene)]


def main(folder: Path) -> None:
    ctx = create_headless("egl")
    renderer = Renderer(ctx)
    for place in places():
        np.savez(folder / f"{place.name}.npz", **asdict(listed_rays.trace_by_shader(renderer, place.scene, place.rays)))
    for name, shot in SHOTS.items():
        renderer.render_still(presets.load([*shot.presets], dict(shot.changes)), shot.time, SIZE, 2)
        Image.fromarray(renderer.read_rgb8()).save(folder / f"{name}.png")
    print(ctx.info["GL_RENDERER"])


if __name__ == "__main__":
    main(Path(sys.argv[1]))
