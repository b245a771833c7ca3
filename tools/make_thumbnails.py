"""Makes the thumbnails in assets/thumbnails/, which the panel's pickers show: `make thumbnails`.

One for each shipped preset that changes what is seen, under its name; looks lie over the default preset, as `presets.load` has them. And one for each
shipped sky, in the folder skies/, as it is round a hole without a disk.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.resources import assets_dir
from blackhole_gl.scene import Scene, catalogue, presets

SIZE = (160, 90)
SAMPLES = 4
TIME = 30.0  # r_s/c, as in the gallery
GROUPS = ("physics", "look", "scene")


SKY = {"disk.enabled": False, "rays.model": "schwarzschild", "camera.distance": 25.0, "camera.fov_deg": 60.0, "post.exposure": 1.0}
"""The scene of a sky's thumbnail, beside what each sky needs to show anything."""
OF_SKIES = {
    "catalogue": {"sky.catalogue.yaw_deg": -74.0, "camera.inclination_deg": 73.0},
    "picture": {"sky.picture.file": "asset:pictures/deep_field.jpg"},
    "image": {"sky.image.file": "asset:pictures/desert.jpg", "post.exposure": 0.0},
    "drifting_field": {"sky.drifting_field.scale": 20.0, "sky.drifting_field.threshold": 0.75},
}


def skies() -> list[str]:
    """The skies that have a thumbnail: those that come with the program."""
    return [key for key, sky in catalogue.plug_ins("sky").items() if sky.shipped]


def sky(key: str) -> Scene:
    """The scene of a sky's thumbnail."""
    return presets.load(["schwarzschild"], {**SKY, "sky.model": key, **OF_SKIES.get(key, {})})


def pictured() -> list[presets.PresetInfo]:
    """The presets that have a thumbnail: those that come with the program, but for qualities, which differ too little."""
    return [info for info in presets.available() if info.group in GROUPS and info.path.parent != presets.user_presets_dir()]


def scenes() -> dict[str, Scene]:
    """What each thumbnail shows, by its path below the folder without its ending."""
    return {**{info.name: presets.load([info.name]) for info in pictured()}, **{f"skies/{key}": sky(key) for key in skies()}}


def draw(renderer: Renderer, scene: Scene) -> np.ndarray:
    """The thumbnail of `scene`, uint8 (height, width, 3)."""
    renderer.render_still(scene, TIME, SIZE, SAMPLES)
    return renderer.read_rgb8()


def main() -> None:
    folder = Path(assets_dir()) / "thumbnails"
    (folder / "skies").mkdir(parents=True, exist_ok=True)
    for left in folder.rglob("*.jpg"):
        if left.relative_to(folder).with_suffix("").as_posix() not in scenes():
            left.unlink()
    renderer = Renderer(create_headless())
    for name, scene in scenes().items():
        path = folder / f"{name}.jpg"
        Image.fromarray(draw(renderer, scene)).save(path, quality=94, optimize=True)
        print(f"{path.name}  {path.stat().st_size} bytes", flush=True)


if __name__ == "__main__":
    main()
