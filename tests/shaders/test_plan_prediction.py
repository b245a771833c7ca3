"""The plan keeps its word: what is measured of its choice is within the tolerance.

The rays are those of the chart: a change of a shader or of the table shows, the scatter of a new sample does not.
Its cost is checked by ``blackhole-gl plan --measure``: benchmarks are no timed tests.
"""

from __future__ import annotations

import pytest

from blackhole_gl import listed_rays, planning
from blackhole_gl.measure import refined
from blackhole_gl.measure.errors import compare
from blackhole_gl.measure.scenes import NEAR_CRITICAL, ChartScene, is_charted
from blackhole_gl.physics.space_time import is_inside
from blackhole_gl.planning import choice
from blackhole_gl.scene import presets
from tests.sampled import sampled

PHYSICAL = [info.name for info in presets.available() if info.group in ("physics", "scene") and is_charted(presets.load([info.name]))]

# The twin takes seconds for a scene with spin: of those the fastest hole, and one that is seen from infinitely far away.
QUICK = [name for name in PHYSICAL if name not in ("gargantua_as_filmed", "hot_spot", "kerr", "kerr_06", "m87_like", "sgr_a_eht")]


@pytest.fixture(scope="module", params=sampled(PHYSICAL, QUICK))
def place(request) -> ChartScene:
    """A scene whose rays are traced by the twin once."""
    return ChartScene(request.param, presets.load([request.param]))


def test_the_measured_error_is_within_the_tolerance(renderer, place):
    scene = place.scene
    errors = compare(listed_rays.trace_by_shader(renderer, planning.plan(scene).scene, place.rays), place.truth, place.epsilon >= NEAR_CRITICAL)
    assert choice.error_px(scene, errors.direction_99, errors.crossing_r_99) <= scene.rays.tolerance
    assert errors.wrong_fates <= 0.01


def test_while_the_camera_moves_the_tolerance_is_kept_too(renderer, place):
    """In pixels of the picture that is interpolated."""
    scene = place.scene
    made = planning.plan(scene)
    # a look-up is nearly as cheap as interpolation: which of the two is taken is the table's to say
    assert made.refine_px > 0.0 or made.integrator is None, "else a moving picture costs several times what it need"
    errors = refined.errors(renderer, place, planning.plan(scene).scene)
    assert choice.error_px(scene, errors.direction_99, errors.crossing_r_99, choice.REFINED_SIZE[1]) <= scene.rays.tolerance
    assert errors.wrong_fates <= 0.01
    assert is_inside(scene) or errors.lost_crossings <= 0.01, "inside the horizon there is no disk, whose plane the twin meets all the same"
