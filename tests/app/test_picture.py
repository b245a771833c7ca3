"""How coarse the moving picture is, and that a still one is not drawn twice. Without GL: what decides is plain arithmetic."""

import math

import pytest

from blackhole_gl.app.picture import Area, Picture


def chooser(trace_ms: float = 0.0, shade_ms: float = 0.0) -> Picture:
    picture = Picture.__new__(Picture)
    picture._trace_ms, picture._shade_ms, picture._divisors = trace_ms, shade_ms, {}
    return picture


@pytest.mark.parametrize("trace_ms, shade_ms, moving, still", [(3, 2, 1, 1), (30, 20, 1, 1), (150, 50, 2, 1), (100, 400, 3, 2), (5000, 100, 4, 1)])
def test_slow_pictures_are_coarser_while_they_move(trace_ms, shade_ms, moving, still):
    picture = chooser(trace_ms, shade_ms)
    assert picture._divisor_for(True) == moving
    assert picture._divisor_for(False) == still


def test_the_first_picture_is_coarse():
    assert chooser(math.inf, math.inf)._divisor_for(True) == 4


def test_divisor_does_not_hop():
    picture = chooser(250.0)
    first = picture._divisor_for(True)
    for picture._trace_ms in (220.0, 260.0, 230.0, 280.0):
        assert picture._divisor_for(True) == first


def test_coarse_pictures_have_a_pixel_at_least():
    assert Area(0, 0, 1, 3).coarsened(4) == (1, 1)
    assert Area(0, 0, 0, 3).is_empty


def test_area_is_in_framebuffer_pixels_from_the_bottom():
    assert Area.of_screen(0, 20, 300, 100, 200, (1.0, 1.0)) == Area(0, 80, 300, 100)
    assert Area.of_screen(0, 20, 300, 100, 200, (2.0, 2.0)) == Area(0, 160, 600, 200)


def test_neighbouring_areas_leave_no_gap_at_odd_scales():
    left = Area.of_screen(0, 0, 333, 100, 100, (1.25, 1.25))
    right = Area.of_screen(333, 0, 100, 100, 100, (1.25, 1.25))
    assert left.x + left.width == right.x
