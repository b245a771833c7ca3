"""Which monitor full screen fills."""

from blackhole_gl.app.full_screen import Rectangle, most_covered

LEFT, RIGHT = Rectangle(0, 0, 1920, 1080), Rectangle(1920, 0, 2560, 1440)


def test_the_monitor_under_most_of_the_window():
    assert most_covered(Rectangle(100, 100, 800, 600), [LEFT, RIGHT]) == 0
    assert most_covered(Rectangle(1800, 100, 800, 600), [LEFT, RIGHT]) == 1


def test_a_window_off_every_monitor_takes_the_first():
    assert most_covered(Rectangle(-5000, 0, 800, 600), [LEFT, RIGHT]) == 0
