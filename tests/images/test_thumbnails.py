"""The panel's small pictures: small, and of what their presets and skies show now. `make thumbnails` makes them anew, and those that are missing."""

import numpy as np
import pytest
from PIL import Image

from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.resources import assets_dir
from tests.sampled import sampled
from tools import make_thumbnails

FOLDER = assets_dir() / "thumbnails"
SCENES = make_thumbnails.scenes()
NAMES = sorted(path.relative_to(FOLDER).with_suffix("").as_posix() for path in FOLDER.rglob("*.jpg"))
# Grey levels of 255, mean: JPEG takes 1 to 2 of them; two looks that differ least are 4 apart.
MEAN = 3.0
# Seconds of marching through matter or a medium, or of its programs: what is alike in the others, or in the golden pictures, stands for them.
DEAR = ("cloudy_slab", "crystal_ball", "gold_1", "gold_2", "gold_4", "gold_5", "jet", "knot_behind_a_hole", "mirage", "objects_black_hole",
        "objects_potential", "objects_refraction", "objects_roessler", "polish_doughnut", "real_sky", "tilted_disk")


def test_they_are_of_presets_and_skies_that_there_are_and_small() -> None:
    assert len(NAMES) > 25 and set(NAMES) <= set(SCENES)
    assert sum(path.stat().st_size for path in FOLDER.rglob("*.jpg")) < 300_000


@pytest.mark.parametrize("name", sampled(NAMES, [name for name in NAMES if name not in DEAR]))
def test_a_thumbnail_shows_its_preset(renderer: Renderer, name: str) -> None:
    kept = np.asarray(Image.open(FOLDER / f"{name}.jpg"), dtype=float)
    difference = np.abs(kept - make_thumbnails.draw(renderer, SCENES[name])).mean()
    assert difference < MEAN, f"{difference:.1f} grey levels: run `make thumbnails`"
