"""The flight of studies/flight.py: refined frames against exact ones, and what happens from frame to frame."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from blackhole_gl.rendering.frame import Renderer
from blackhole_gl.scene import Scene, presets
from studies import flight, pictures
from studies.flight import FlightFrame
from studies.flip import flip

COUNT = round(flight.SECONDS * flight.FPS)
SMALL, WHOLE = (320, 180), (640, 360)

# Of the whole flight: 10, 60 and 160 lie in the disk's plane, 110 and 260 over the pole.
FRAMES = (0, 10, 13, 30, 60, 80, 110, 135, 160, 185, 235, 260)
# Where the whole flight's displacement, one pixel's ꟻLIP and the mean ꟻLIP are largest (docs/data/flight.csv).
WORST = (58, 200, 212)

# Less than a fifth of the mean ꟻLIP of a frame against itself one grey level lighter, the least step of a screen; a test below sees to it.
LARGEST_MEAN_FLIP = 0.005

# Grey levels of 255, mean over a block of 8×8 pixels: half of what a screen shows at the least.
BLOCK = 8
LARGEST_FLICKER = 0.5


@pytest.fixture(scope="module")
def scene() -> Scene:
    """What the window opens with: a marched Kerr hole."""
    return presets.load()


def assert_kept(frame: FlightFrame, tolerance: float) -> None:
    assert frame.largest_px <= tolerance, frame
    assert frame.fates_off_edge == 0, frame
    assert frame.flip_mean <= LARGEST_MEAN_FLIP, frame


@pytest.mark.parametrize("index, size", [(index, SMALL) for index in FRAMES] + [(index, WHOLE) for index in WORST])
def test_a_refined_frame_is_the_exact_one_within_the_tolerance(renderer: Renderer, scene: Scene, index: int, size: tuple[int, int]) -> None:
    frame = flight.measure(renderer, flight.camera_at(scene, index / COUNT), flight.SECONDS * index / COUNT, size)
    assert frame.own_rays < 0.7, "nearly nothing was interpolated"
    assert_kept(frame, scene.rays.tolerance)


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_no_frame_of_the_whole_flight_is_beyond_the_tolerance(renderer: Renderer, scene: Scene) -> None:
    for frame in flight.fly(renderer, scene, WHOLE, COUNT):
        assert_kept(frame, scene.rays.tolerance)


def test_the_flight_goes_where_it_is_said_to_go(scene: Scene) -> None:
    """Through the equator, over the pole, in to 1.6 r_s and out, turning all the while, without a jerk."""
    cameras = [flight.camera_at(scene, index / COUNT).camera for index in range(COUNT + 1)]
    tilt = np.array([camera.inclination_deg for camera in cameras])
    assert tilt[0] < 90.0 and tilt.min() == pytest.approx(0.0, abs=1e-9) and tilt.max() == pytest.approx(120.0, abs=0.1)
    assert np.sum(np.diff(np.sign(np.round(tilt - 90.0, 9))) != 0) >= 4
    distance = np.array([camera.distance for camera in cameras])
    assert distance[0] == distance[-1] == scene.camera.distance and distance.min() == distance[COUNT // 2] == pytest.approx(flight.NEAREST)
    assert np.all(np.diff([camera.azimuth_deg for camera in cameras]) > 0.0)
    for path in (tilt, np.log(distance), np.log([camera.fov_deg for camera in cameras])):
        assert np.abs(np.diff(path, 2)).max() < 0.1 * np.abs(np.diff(path)).max()


@pytest.mark.parametrize("index", [0, 120])
def test_the_bound_on_flip_is_less_than_a_fifth_of_a_grey_level(renderer: Renderer, scene: Scene, index: int) -> None:
    exact = flight.drawn(renderer, flight.camera_at(scene, index / COUNT), 0.0, SMALL).exact
    lighter = np.where(exact < 255, exact + 1, 254).astype(np.uint8)
    assert flip(exact, lighter).mean() > 5.0 * LARGEST_MEAN_FLIP


def test_exact_pictures_have_nothing_to_compare(renderer: Renderer, scene: Scene) -> None:
    with pytest.raises(ValueError, match="no refinement"):
        flight.drawn(renderer, scene.with_values({"rays.refine": False}), 0.0, SMALL)


def test_the_plot_shows_every_part(tmp_path: Path) -> None:
    frames = [FlightFrame(t, 20.0 - t, 80.0 - t, t, 42.0, 0.3, 0.1, 0, 2, 0.004, 0.1, 0.2) for t in (0.0, 1.0, 2.0)]
    pictures.draw_flight(tmp_path / "flight.png", frames, 0.5)
    shown = np.asarray(Image.open(tmp_path / "flight.png").convert("L")) < 200
    assert all(rows.mean() > 0.005 for rows in np.array_split(shown, 4)), "four panels, one above the other"


@pytest.mark.parametrize("index, step_px", [(0, 0.1), (40, 0.25), (110, 0.1), (165, 0.1), (200, 0.1)])
def test_refinement_adds_no_shimmer(renderer: Renderer, scene: Scene, index: int, step_px: float) -> None:
    """The camera tilts by a part of a pixel a frame, so that pixels pass from cell to cell; the disk stands still.

    The whole picture changes by no more than the exact one, to half a per cent: what is left when the noise of 8 bits is counted in both. That is of the
    mean of four patterns of the disk, as single ones scatter by one per cent to both sides. No block flickers more than the exact one's by what would
    show. Both are
    seen in the change from frame to frame and in the change of that, where what comes and goes is not hidden by what moves.
    """
    start = flight.camera_at(scene, index / COUNT)
    turn = step_px * start.camera.fov_deg / SMALL[1]
    tilted = [replace(start, camera=replace(start.camera, inclination_deg=start.camera.inclination_deg + turn * step)) for step in range(6)]
    whole = {order: np.zeros(2) for order in (1, 2)}
    for time in (0.0, 133.0, 277.0, 411.0):  # more than a pattern's life apart
        pairs = [flight.drawn(renderer, view, time, SMALL) for view in tilted]
        for order in whole:
            frames = np.array([[pair.refined for pair in pairs], [pair.exact for pair in pairs]], float)
            change, true_change = np.abs(np.diff(frames, order, axis=1)).mean(axis=-1)
            whole[order] += change.mean(), true_change.mean()
            assert np.max(_blocks(change) - _blocks(true_change)) <= LARGEST_FLICKER
    for refined, exact in whole.values():
        assert refined <= 1.005 * exact


def _blocks(frames: np.ndarray) -> np.ndarray:
    """(frames, height, width) → means over whole blocks."""
    count, height, width = frames.shape
    rows, columns = height // BLOCK, width // BLOCK
    return frames[:, : rows * BLOCK, : columns * BLOCK].reshape(count, rows, BLOCK, columns, BLOCK).mean(axis=(2, 4))
