"""How coarse the moving picture is, and that a still one is not drawn twice. Without GL: what decides is plain arithmetic."""

import pytest

from blackhole_gl.app.picture import Area, Picture


def chooser() -> Picture:
    picture = Picture.__new__(Picture)
    picture._cost_ms, picture._divisors = {}, {}
    return picture


@pytest.mark.parametrize("milliseconds, moving, still", [(5, 1, 1), (50, 1, 1), (200, 2, 1), (500, 3, 2), (5000, 4, 2)])
def test_slow_pictures_are_coarser_while_they_move(milliseconds, moving, still):
    picture = chooser()
    picture._cost_ms = {True: milliseconds, False: milliseconds}
    assert picture._divisor_for(True) == moving
    assert picture._divisor_for(False) == still


def test_divisor_does_not_hop():
    picture = chooser()
    picture._cost_ms[True] = 250.0
    first = picture._divisor_for(True)
    for milliseconds in (220.0, 260.0, 230.0, 280.0):
        picture._cost_ms[True] = milliseconds
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
