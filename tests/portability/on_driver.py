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
from blackhole_gl.render.context import create_headless
from blackhole_gl.render.frame import Renderer
from blackhole_gl.resources import presets_dir
from blackhole_gl.scene import Scene, presets
from tests.images.test_golden_pictures import SHOTS, SIZE
from tests.shaders.sampling import random_rays

RAYS = 500

METHODS = [info.name for info in presets.available() if info.group in ("physics", "scene") and info.path.is_relative_to(presets_dir())]
"""Presets of which each leaves its method to the plan."""


def scene_and_rays(name: str) -> tuple[Scene, np.ndarray]:
    """The preset `name` as it is shipped, and rays at least 1 % off the critical curve."""
    scene = presets.load([name])
    if np.isinf(scene.camera.distance):
        rng = np.random.default_rng(5)
        radius, turn = rng.uniform(6.5, 25.0, RAYS), rng.uniform(0.0, 2.0 * np.pi, RAYS)  # M; outside every critical curve
        return scene, np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=-1)
    return scene, random_rays(scene, RAYS, seed=20)


def main(folder: Path) -> None:
    ctx = create_headless("egl")
    renderer = Renderer(ctx)
    for name in METHODS:
        found = listed_rays.trace_by_shader(renderer, *scene_and_rays(name))
        np.savez(folder / f"{name}.npz", **asdict(found))
    for name, shot in SHOTS.items():
        renderer.render_still(presets.load([*shot.presets], dict(shot.changes)), shot.time, SIZE, 2)
        Image.fromarray(renderer.read_rgb8()).save(folder / f"{name}.png")
    print(ctx.info["GL_RENDERER"])


if __name__ == "__main__":
    main(Path(sys.argv[1]))
