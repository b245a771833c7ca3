"""How long the line at start stays."""

import pytest

from blackhole_gl.app.start_line import StartLine
from blackhole_gl.scene import Scene

STILL = Scene()
MOVED = STILL.with_values({"camera.azimuth_deg": 5.0})


def test_it_leaves_after_ten_seconds():
    line = StartLine(STILL, "F1")
    assert line.advance(STILL, 100.0) == 1.0 and line.advance(STILL, 109.9) == 1.0 and not line.fades
    assert 0.0 < line.advance(STILL, 110.4) < 1.0 and line.fades
    assert line.advance(STILL, 112.0) == 0.0 and line.is_over and not line.fades


@pytest.mark.parametrize("later", [STILL, MOVED])
def test_it_leaves_once_the_camera_was_moved(later):
    line = StartLine(STILL, "F1")
    line.advance(STILL, 0.0)
    assert line.advance(MOVED, 2.0) == 1.0
    assert 0.0 < line.advance(later, 2.5) < 1.0
    assert line.advance(later, 3.0) == 0.0 and line.is_over
