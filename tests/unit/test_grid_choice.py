"""Which grid of directions is begun for a view that turns: in time, and where it goes."""

from __future__ import annotations

import math

import pytest

from blackhole_gl.rendering.direction_grid import DirectionGrid, View
from blackhole_gl.rendering.grid_choice import COARSE, frames_for, frames_left, is_late, rise_deg, wanted
from blackhole_gl.scene import Camera

SIZE = 640, 360


def seen_by(camera: Camera) -> View:
    return View.of(camera, SIZE)


def looking_up(pitch_deg: float, yaw_deg: float = 0.0) -> Camera:
    return Camera(yaw_deg=yaw_deg, pitch_deg=pitch_deg, fov_deg=42.0)


def grid_of(camera: Camera, wider: float = 1.0, rise: float = 0.0) -> DirectionGrid:
    grid = DirectionGrid.about(camera, seen_by(camera), 1.0 / wider, 0.3, 100, rise)
    assert grid is not None
    return grid


def wanted_after(grid: DirectionGrid, last: Camera, now: Camera) -> float | None:
    return wanted(grid, seen_by(now), seen_by(last), 1.0)


def test_a_grid_is_begun_where_the_view_goes() -> None:
    """20° above it at most, and about it where it turns to a side, across half a turn too."""
    assert rise_deg(looking_up(30.5), looking_up(30.0)) == 20.0 and rise_deg(looking_up(29.9), looking_up(30.0)) == pytest.approx(-6.0)
    assert rise_deg(looking_up(30.5, -179.0), looking_up(30.0, 180.0)) == pytest.approx(10.0)
    ahead = grid_of(looking_up(30.0), rise=20.0)
    assert math.degrees(ahead.latitude(seen_by(looking_up(30.0)))) == pytest.approx(-20.0)
    assert frames_left(ahead, seen_by(looking_up(30.5)), seen_by(looking_up(30.0))) == pytest.approx(99.0)
    assert frames_left(ahead, seen_by(looking_up(29.5)), seen_by(looking_up(30.0))) == pytest.approx(19.0)


@pytest.mark.parametrize(("up", "wider"), [(0.1, None), (0.5, math.sqrt(2.0)), (1.0, COARSE)])
def test_the_next_grid_is_as_fine_as_there_are_frames_to_make_it(up: float, wider: float | None) -> None:
    """Past the equator of a fine one, by half a degree."""
    assert wanted_after(grid_of(looking_up(30.0)), looking_up(30.5), looking_up(30.5 + up)) == wider


def test_a_view_that_comes_to_the_equator_keeps_its_grid() -> None:
    grid = grid_of(looking_up(30.0), rise=20.0)
    assert wanted_after(grid, looking_up(30.0), looking_up(30.5)) is None
    assert wanted_after(grid, looking_up(30.0), looking_up(29.5)) == COARSE, "it turned round, and has 21 frames"


def test_one_that_will_not_be_there_in_time_is_late_if_a_coarse_one_is_not() -> None:
    last, now = looking_up(44.5), looking_up(45.0)
    seen, fine, coarse = grid_of(looking_up(30.0), COARSE), grid_of(now, 1.0, 20.0), grid_of(now, COARSE, 20.0)
    assert is_late(fine, 1.0, seen, seen_by(now), seen_by(last)) and not is_late(fine, 0.2, seen, seen_by(now), seen_by(last))
    assert not is_late(coarse, 0.25, seen, seen_by(now), seen_by(last))


def test_what_is_new_takes_rays_from_what_is_made() -> None:
    assert frames_for(1.0, 1.0, 1.0, 0.0) == pytest.approx(1.15 / 0.042)
    assert frames_for(1.0, 1.0, 1.0, 0.005) > 1.3 * frames_for(1.0, 1.0, 1.0, 0.0) and math.isinf(frames_for(1.0, 1.0, 1.0, 0.02))
