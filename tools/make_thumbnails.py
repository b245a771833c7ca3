"""Makes the thumbnails in assets/thumbnails/, which the panel's pickers show: `make thumbnails`.

One for each shipped preset that changes what is seen, under its name; looks lie over the default preset, as `presets.load` has them.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from blackhole_gl.render.context import create_headless
from blackhole_gl.render.frame import Renderer
from blackhole_gl.resources import assets_dir
from blackhole_gl.scene import presets

SIZE = (160, 90)
SAMPLES = 4
TIME = 30.0  # r_s/c, as in the gallery
GROUPS = ("physics", "look", "scene")


def pictured() -> list[presets.PresetInfo]:
    """The presets that have a thumbnail: those that come with the program, but for qualities, which differ too little."""
    return [info for info in presets.available() if info.group in GROUPS and info.path.parent != presets.user_presets_dir()]


def draw(renderer: Renderer, name: str) -> np.ndarray:
    """The thumbnail of the preset called `name`, uint8 (height, width, 3)."""
    renderer.render_still(presets.load([name]), TIME, SIZE, SAMPLES)
    return renderer.read_rgb8()


def main() -> None:
    folder = Path(assets_dir()) / "thumbnails"
    folder.mkdir(exist_ok=True)
    for left in folder.glob("*.jpg"):
        if left.stem not in {info.name for info in pictured()}:
            left.unlink()
    renderer = Renderer(create_headless())
    for info in pictured():
        path = folder / f"{info.name}.jpg"
        Image.fromarray(draw(renderer, info.name)).save(path, quality=94, optimize=True)
        print(f"{path.name}  {path.stat().st_size} bytes", flush=True)


if __name__ == "__main__":
    main()
