"""A few pictures, whole: what no figure of hits or light would notice.

`--renew-goldens` writes them anew. On a failure the picture, the golden one and their difference are left in tests/output/.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import presets

GOLDEN = Path(__file__).resolve().parent / "golden"
OUTPUT = Path(__file__).resolve().parents[1] / "output"
SIZE = (192, 108)

# Grey levels of 255. Drivers round differently, and processors of one driver too: single pixels on the photon ring, stars and the
# filaments of the look layers move by more than a level. A wrong side, a missing layer or a shift by a pixel is far outside.
MEAN = 0.6
MOST, SHARE = 12, 0.01  # this many levels may be exceeded by this share of the pixels


@dataclass(frozen=True)
class Shot:
    """The presets, what differs from them, and the scene time in r_s/c."""

    presets: tuple[str, ...]
    changes: Mapping[str, object] = field(default_factory=dict)
    time: float = 30.0


SHOTS = {
    "kerr": Shot(("kerr", "fine")),
    "kerr_ten_hours_later": Shot(("kerr", "fine"), time=144000.0),
    "schwarzschild_smooth": Shot(("schwarzschild", "smooth", "fine")),
    "kerr_0998_85": Shot(("kerr_0998_85", "fine")),
    "particle_storm": Shot(("kerr_06", "particle_storm", "fine"), {"camera.inclination_deg": 60.0}),
    "m87_like": Shot(("m87_like", "minimal_bloom", "fine")),
    "swirling_lanes": Shot(("kerr_06", "swirling_lanes", "fine"), {"camera.inclination_deg": 55.0}),
    "points_and_rings": Shot(("kerr_06", "points_and_rings", "fine"), {"camera.inclination_deg": 62.0}),
    "clouds": Shot(("kerr", "clouds", "fine")),
    "amber_dust": Shot(("kerr_06", "amber_dust", "fine"), {"camera.inclination_deg": 66.0}),
    "thin_disk": Shot(("thin_disk",)),
    "gargantua_as_filmed": Shot(("gargantua_as_filmed", "fine")),
    "luminet_1979": Shot(("luminet_1979", "fine")),
    "sky_about_a_shadow": Shot(
        ("kerr_0998_85", "fine"),
        {"disk.enabled": False, "camera.distance": 6.0, "camera.fov_deg": 70.0, "sky.brightness": 2.0, "post.exposure": 1.5},
    ),
    "flat": Shot(("kerr",), {"rays.lensing": False}),
}


@pytest.mark.parametrize("name", SHOTS)
def test_golden_picture(renderer: Renderer, request: pytest.FixtureRequest, name: str) -> None:
    shot = SHOTS[name]
    renderer.render_still(presets.load([*shot.presets], dict(shot.changes)), shot.time, SIZE, 2)
    found = renderer.read_rgb8()
    path = GOLDEN / f"{name}.png"
    if request.config.getoption("--renew-goldens"):
        path.parent.mkdir(exist_ok=True)
        Image.fromarray(found).save(path, optimize=True)
        return
    assert path.is_file(), f"{path.name} is missing: run with --renew-goldens and look at what it writes"
    golden = np.asarray(Image.open(path).convert("RGB"))
    difference = np.abs(found.astype(int) - golden)
    mean, share = difference.mean(), np.mean(difference.max(axis=-1) > MOST)
    if mean > MEAN or share > SHARE:
        places = leave(name, found, golden, difference)
        pytest.fail(
            f"{name}: mean difference {mean:.2f} (allowed {MEAN}), {share:.2%} of the pixels off by more than {MOST} (allowed {SHARE:.0%}); see {places}",
            pytrace=False,
        )


def leave(name: str, found: np.ndarray, golden: np.ndarray, difference: np.ndarray) -> str:
    """Writes the three pictures, the difference eight times enlarged, and returns where."""
    OUTPUT.mkdir(parents=True, exist_ok=True)
    for kind, pixels in (("found", found), ("golden", golden), ("difference", np.clip(8 * difference, 0, 255))):
        Image.fromarray(pixels.astype(np.uint8)).save(OUTPUT / f"{name}.{kind}.png")
    return str(OUTPUT / f"{name}.*.png")


def test_no_golden_picture_is_left_over() -> None:
    assert {path.stem for path in GOLDEN.glob("*.png")} == set(SHOTS)
