"""Where the plan takes the screen-space lens, what is drawn is within the tolerance of the float64 reference."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl import planning
from blackhole_gl.listed_rays import trace_by_shader
from blackhole_gl.measure.errors import angles_between
from blackhole_gl.measure.scenes import ChartScene
from blackhole_gl.planning import choice
from blackhole_gl.rendering.frame import Renderer
from studies import lens_by_distance


@pytest.mark.parametrize("distance, view, spin, tolerance", [(10000.0, 40.0, 0.0, 0.5), (3000.0, 90.0, 0.9, 0.5), (1000.0, 40.0, 0.0, 2.5)])
def test_the_picture_keeps_the_tolerance_where_the_plan_takes_the_lens(renderer: Renderer, distance: float, view: float, spin: float, tolerance: float):
    scene = lens_by_distance.sky_alone(distance, view).with_values({"hole.spin": spin, "rays.tolerance": tolerance})
    made = planning.plan(scene)
    assert made.model.key == "screen_lens"
    item = ChartScene("lens", scene, 1000)
    shown = trace_by_shader(renderer, made.scene, item.rays)
    off = angles_between(shown, item.truth)[: item.count] / item.pixel
    assert np.nanquantile(off, 0.99) <= tolerance
    assert np.mean(shown.fate[: item.count] != item.truth.fate[: item.count]) <= 0.01
    assert choice.choose(scene).chosen.error_px <= tolerance
