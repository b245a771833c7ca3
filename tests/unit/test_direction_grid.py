"""Directions about an observer: the host's places are those at which shaders trace, and grids that move keep their pixels."""

from __future__ import annotations

import math

import numpy as np
import pytest

from blackhole_gl.physics import projection
from blackhole_gl.physics.observer import look_rotation
from blackhole_gl.rendering.boxes import boxes_of
from blackhole_gl.rendering.direction_grid import CELL, DirectionGrid, View
from blackhole_gl.scene import Camera

SIZE = 640, 360
LOOKS = [(0.0, 0.0, 0.0), (170.0, 5.0, 0.0), (-60.0, 40.0, 25.0)]


def grid_about(look: tuple[float, float, float]) -> tuple[DirectionGrid, View]:
    camera = Camera(yaw_deg=look[0], pitch_deg=look[1], roll_deg=look[2], fov_deg=42.0)
    view = View.of(camera, SIZE)
    grid = DirectionGrid.about(camera, view, 1.0, 0.3)
    assert grid is not None
    return grid, view


@pytest.mark.parametrize("look", LOOKS)
def test_places_are_those_of_the_picture_all_round(look: tuple[float, float, float]) -> None:
    """To 1e-9 pixels: both are float64."""
    grid, _ = grid_about(look)
    at = np.array([[0.5, 0.5], [100.0, 40.25], [grid.size[0] - 1.0, grid.size[1] - 1.0]])
    around = Camera(projection="equirectangular", yaw_deg=grid.yaw_deg, pitch_deg=grid.pitch_deg, roll_deg=grid.roll_deg)
    seen = projection.directions(around, grid.picture, at + grid.corner) @ look_rotation(around).T
    assert np.allclose(grid.places(seen), at, atol=1e-9)


@pytest.mark.parametrize("look", LOOKS)
def test_what_a_view_shows_lies_in_its_box_and_cells(look: tuple[float, float, float]) -> None:
    grid, view = grid_about(look)
    x, y, width, height = grid.box(view)
    inside = np.random.default_rng(3).uniform(-1.0, 1.0, (1000, 2)) * view.half
    at = grid.places(np.column_stack([-np.ones(1000), -inside[:, 1], inside[:, 0]]) @ view.look.T)
    assert ((at >= (x, y)) & (at <= (x + width, y + height))).all() and grid.holds(view)
    columns, rows = (at // CELL).astype(int).T
    assert grid.seen(view)[rows, columns].all()


def test_a_grid_that_moves_keeps_its_pixels() -> None:
    """Across half a turn too, each where it lies in the textures; to 2e-7 pixels, of a few thousand."""
    grid, _ = grid_about((170.0, 5.0, 0.0))
    seen = View.of(Camera(yaw_deg=-165.0, pitch_deg=3.0, fov_deg=42.0), SIZE)
    found = grid.moved_to(seen, 2 * CELL)
    assert found is not None
    moved, held = found
    assert moved.holds(seen, 2 * CELL) and moved.size == grid.size and moved.start[0] > 0
    ahead = -seen.look[:, 0]
    before, now = (at.places(ahead) + at.start for at in (grid, moved))
    assert (now - before) % grid.size == pytest.approx(0.0, abs=2e-7) or (before - now) % grid.size == pytest.approx(0.0, abs=2e-7)
    here = grid.ahead(seen)
    assert np.allclose(here[held], moved.ahead(seen)[held], atol=1e-12) and not np.isclose(here[~held], moved.ahead(seen)[~held], atol=1e-6).any()
    assert 0.5 < held.mean() < 0.95


def test_a_view_goes_on_as_it_came() -> None:
    """Turned about whatever axis and zoomed: where so many further steps would bring it, to 1e-9; one that rests, or takes all of it in a step, stays."""
    views = [View.of(Camera(yaw_deg=0.4 * n, pitch_deg=30.0, fov_deg=42.0 * 1.004**n), SIZE) for n in range(8)]
    grown = np.tan(np.radians(21.0 * 1.004)) / np.tan(np.radians(21.0))
    coming = views[1].going_on(views[0], 60)
    steps = round(math.log(coming.half[0] / views[1].half[0]) / math.log(grown))
    assert 10 <= steps <= 15 and coming.half[1] == pytest.approx(views[1].half[1] * grown**steps)
    turn = views[1].look @ views[0].look.T
    assert np.allclose(coming.look, np.linalg.matrix_power(turn, steps + 1) @ views[0].look, atol=1e-9)
    assert views[1].going_on(views[1], 60).half == views[1].half and np.array_equal(views[7].going_on(views[0], 5).look, views[7].look)


def test_a_view_that_is_too_wide_has_no_grid() -> None:
    camera = Camera(fov_deg=140.0)
    assert DirectionGrid.about(camera, View.of(camera, SIZE), 1.0, 0.3) is None


def test_boxes_hold_all_cells_and_little_else() -> None:
    picked = np.zeros((40, 60), bool)
    picked[5:30, 10:12] = picked[30:32, 10:50] = picked[3, 55] = True
    held = np.zeros_like(picked)
    for x, y, width, height in boxes_of(picked, 2):
        held[y // 2 : (y + height) // 2, x // 2 : (x + width) // 2] = True
    assert held[picked].all() and held.sum() <= 1.5 * picked.sum()
