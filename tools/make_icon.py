"""Makes assets/icon.png, the program's icon in menus and of its scene files: a hole and its disk in a round field, drawn by the program itself."""

from __future__ import annotations

import numpy as np
from PIL import Image

import blackhole_gl as bh
from blackhole_gl.resources import assets_dir

SIDE = 256  # of the icon; menus take smaller ones from it
DRAWN = 4 * SIDE
SCENE = {
    "camera.fov_deg": 47.0, "camera.inclination_deg": 79.0, "camera.roll_deg": -14.0, "disk.outer_radius": 6.5, "post.exposure": 0.7, "sky.enabled": False,
    "rays.in_stills": 2,
}  # fmt: skip


def main() -> None:
    pixels = bh.render(bh.load(["kerr", "smooth"], SCENE), (DRAWN, DRAWN))
    Image.fromarray(np.dstack([pixels, round_field()])).resize((SIDE, SIDE), Image.Resampling.LANCZOS).save(assets_dir() / "icon.png", optimize=True)


def round_field() -> np.ndarray:
    """Opacity, uint8 (DRAWN, DRAWN): 255 within the circle that touches the edges."""
    x = np.arange(DRAWN) + 0.5 - 0.5 * DRAWN
    return np.where(np.hypot(x, x[:, None]) <= 0.5 * DRAWN, 255, 0).astype(np.uint8)


if __name__ == "__main__":
    main()
