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
from blackhole_gl.plan import choice, plan
from tests.images.test_golden_pictures import GOLDEN, MEAN, MOST, SHARE, SHOTS
from tests.portability.on_driver import METHODS, scene_and_rays

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Driver:
    """How a driver is asked for, how GL_RENDERER begins where it is it, and the package that brings it."""

    environment: tuple[tuple[str, str], ...]
    renderer: str
    package: str


DRIVERS = {
    "softpipe": Driver((("GALLIUM_DRIVER", "softpipe"),), "softpipe", "libgl1-mesa-dri"),
    "zink": Driver((("MESA_LOADER_DRIVER_OVERRIDE", "zink"),), "zink (llvmpipe", "mesa-vulkan-drivers"),
}

pytestmark = [pytest.mark.slow, pytest.mark.timeout(1800)]  # softpipe interprets shaders: three to five minutes for all pictures


@pytest.fixture(scope="module", params=DRIVERS)
def drawn(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of what tests/portability/on_driver.py found with the driver."""
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
    return folder


@pytest.mark.parametrize("name", SHOTS)
def test_golden_picture(drawn: Path, name: str) -> None:
    """The tolerances are those of llvmpipe's own pictures: what differs is rounding."""
    found, golden = (np.asarray(Image.open(folder / f"{name}.png").convert("RGB")).astype(int) for folder in (drawn, GOLDEN))
    difference = np.abs(found - golden)
    share = np.mean(difference.max(axis=-1) > MOST)
    by_any = np.mean(difference.max(axis=-1) > 0)
    print(f"{name}: mean {difference.mean():.3f}; off by more than {MOST} {share:.3%} of the pixels, by any {by_any:.1%}; at most {difference.max()}")
    assert difference.mean() <= MEAN and share <= SHARE


@pytest.mark.parametrize("name", METHODS)
def test_a_preset_s_own_method_against_the_twin(drawn: Path, name: str) -> None:
    """Fates are the twin's, and directions and crossings within the tolerance that the plan chose the method by."""
    scene, rays = scene_and_rays(name)
    twin = listed_rays.trace_by_reference(plan(scene).scene, rays)
    with np.load(drawn / f"{name}.npz") as stored:
        found = listed_rays.TracedRays(**stored)
    errors = compare(found, twin, np.ones(len(rays), bool))
    pixels = choice.error_px(scene, errors.direction_99, errors.crossing_r_99)
    directions = f"escape direction median {errors.direction_median:.1e}, 99 % {errors.direction_99:.1e} rad"
    print(f"{name}: {directions}; 99 % of crossing r {errors.crossing_r_99:.1e}: {pixels:.2g} px")
    assert errors.wrong_fates == 0.0 and errors.lost_crossings == 0.0
    assert pixels <= scene.rays.tolerance
