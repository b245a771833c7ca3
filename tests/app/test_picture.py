"""Where the picture lies in the window."""

from blackhole_gl.app.picture import Area


def test_coarse_pictures_have_a_pixel_at_least():
    assert Area(0, 0, 1, 3).scaled(0.25) == (1, 1)
    assert Area(0, 0, 0, 3).is_empty


def test_area_is_in_framebuffer_pixels_from_the_bottom():
    assert Area.of_screen(0, 20, 300, 100, 200, (1.0, 1.0)) == Area(0, 80, 300, 100)
    assert Area.of_screen(0, 20, 300, 100, 200, (2.0, 2.0)) == Area(0, 160, 600, 200)


def test_neighbouring_areas_leave_no_gap_at_odd_scales():
    left = Area.of_screen(0, 0, 333, 100, 100, (1.25, 1.25))
    right = Area.of_screen(333, 0, 100, 100, 100, (1.25, 1.25))
    assert left.x + left.width == right.x
