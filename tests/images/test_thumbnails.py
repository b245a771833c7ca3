"""The panel's small pictures: there for every preset that has one, small, and of what the preset shows now. `make thumbnails` makes them anew."""

import numpy as np
import pytest
from PIL import Image

from blackhole_gl.render.frame import Renderer
from blackhole_gl.resources import assets_dir
from tools import make_thumbnails

FOLDER = assets_dir() / "thumbnails"
NAMES = [info.name for info in make_thumbnails.pictured()]
# Grey levels of 255, mean: JPEG takes 1 to 2 of them; two looks that differ least are 4 apart.
MEAN = 3.0


def test_they_are_complete_and_small() -> None:
    assert sorted(path.stem for path in FOLDER.iterdir()) == sorted(NAMES)
    assert sum(path.stat().st_size for path in FOLDER.iterdir()) < 300_000


@pytest.mark.parametrize("name", NAMES)
def test_a_thumbnail_shows_its_preset(renderer: Renderer, name: str) -> None:
    kept = np.asarray(Image.open(FOLDER / f"{name}.jpg"), dtype=float)
    difference = np.abs(kept - make_thumbnails.draw(renderer, name)).mean()
    assert difference < MEAN, f"{difference:.1f} grey levels: run `make thumbnails`"
