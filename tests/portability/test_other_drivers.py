"""Golden pictures and the presets' own methods on Mesa's other two ways to draw in software: softpipe, and zink over lavapipe. `-rP` shows the figures.

docs/portability.md has what was found. Where a driver cannot be had its tests fail with the line that installs it: a skip would hide it.
"""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from blackhole_gl import listed_rays
from blackhole_gl.measure.errors import compare
from blackhole_gl.measure.scenes import NEAR_CRITICAL, ChartScene
from blackhole_gl.planning import choice
from tests.images.test_golden_pictures import GOLDEN, MEAN, MOST, SHARE, SHOTS
from tests.portability.on_driver import places

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Driver:
    """How a driver is asked for.

    Attributes:
        environment: variables that ask for it.
        renderer: how GL_RENDERER begins where it is it.
        package: Debian's package that brings it.
        mean: grey levels by which its pictures may differ from llvmpipe's on average.
    """

    environment: tuple[tuple[str, str], ...]
    renderer: str
    package: str
    mean: float


@dataclass(frozen=True)
class Drawn:
    """What tests/portability/on_driver.py found with a driver, in a folder."""

    driver: Driver
    folder: Path


# llvmpipe filters textures of 8 bits in whole numbers, and makes the galaxy's band up to 1.5 grey levels too bright (docs/portability.md); softpipe filters in
# floats. In the one golden picture of a bright sky alone that is 0.7 grey levels.
DRIVERS = {
    "softpipe": Driver((("GALLIUM_DRIVER", "softpipe"),), "softpipe", "libgl1-mesa-dri", mean=1.0),
    "zink": Driver((("MESA_LOADER_DRIVER_OVERRIDE", "zink"),), "zink (llvmpipe", "mesa-vulkan-drivers", MEAN),
}

pytestmark = [pytest.mark.slow, pytest.mark.timeout(1800)]  # softpipe interprets shaders: three to five minutes for all pictures


@pytest.fixture(scope="module", params=DRIVERS)
def drawn(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    driver, folder = DRIVERS[request.param], tmp_path_factory.mktemp(request.param)
    asked = dict(driver.environment)
    environment = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1", **asked}
    command = [sys.executable, "-m", "tests.portability.on_driver", str(folder)]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=1500)
    found = done.stdout.strip().rpartition("\n")[2]
    if done.returncode or not found.startswith(driver.renderer):
        asked_for = " ".join(f"{name}={value}" for name, value in asked.items())
        mend = f"sudo apt-get install -y --no-install-recommends {driver.package}"
        what = f"{asked_for}: asked for a renderer {driver.renderer}…, found {found or 'none'}. If it is not installed: {mend}"
        pytest.fail(f"{what}\n{done.stderr[-2000:]}", pytrace=False)
    return Drawn(driver, folder)


@pytest.mark.parametrize("name", SHOTS)
def test_golden_picture(drawn: Drawn, name: str) -> None:
    """Of single pixels no more may be off than on llvmpipe itself: what differs there is rounding."""
    found, golden = (np.asarray(Image.open(folder / f"{name}.png").convert("RGB")).astype(int) for folder in (drawn.folder, GOLDEN))
    difference = np.abs(found - golden)
    share = np.mean(difference.max(axis=-1) > MOST)
    by_any = np.mean(difference.max(axis=-1) > 0)
    print(f"{name}: mean {difference.mean():.3f}; off by more than {MOST} {share:.3%} of the pixels, by any {by_any:.1%}; at most {difference.max()}")
    assert difference.mean() <= drawn.driver.mean and share <= SHARE


@pytest.mark.parametrize("place", places(), ids=lambda place: place.name)
def test_a_preset_s_own_method_against_the_twin(drawn: Drawn, place: ChartScene) -> None:
    """Off the critical curve fates are the twin's, and directions and crossings within the tolerance that the plan chose the method by."""
    with np.load(drawn.folder / f"{place.name}.npz") as stored:
        found = listed_rays.TracedRays(**stored)
    errors = compare(found, place.truth, place.epsilon >= NEAR_CRITICAL)
    pixels = choice.error_px(place.scene, errors.direction_99, errors.crossing_r_99)
    directions = f"escape direction median {errors.direction_median:.1e}, 99 % {errors.direction_99:.1e} rad"
    print(f"{place.name}: {directions}; 99 % of crossing r {errors.crossing_r_99:.1e}: {pixels:.2g} px")
    assert errors.wrong_fates == 0.0 and errors.lost_crossings == 0.0
    assert pixels <= place.scene.rays.tolerance
