"""How coarse the moving picture is: the choice against a made-up machine whose frames cost what a test says."""

import random

import pytest

from blackhole_gl.app.resolution import COARSEST, REST_SHARE, STEPS_PER_OCTAVE, Resolution

STEP = 2.0 ** (1.0 / STEPS_PER_OCTAVE)


class Machine:
    """Frames that cost `full_ms` at full size, and `other_ms` beside the picture."""

    def __init__(self, full_ms: float, other_ms: float = 0.0, noise: float = 0.0):
        self.full_ms, self.other_ms, self._noise = full_ms, other_ms, noise
        self.resolution = Resolution()
        self.elapsed, self._random = 0.0, random.Random(1)

    def run(self, frames: int = 0, target: float = 30.0, *, seconds: float = 0.0, camera_moving: bool = True, spike: float = 1.0) -> list[float]:
        """The scales of the frames of so many seconds, `frames` of them at least; `spike` multiplies the cost of the first."""
        scales, time = [], 0.0
        while len(scales) < frames or time < seconds:
            index = len(scales)
            scale = self.resolution.scale(target, camera_moving=camera_moving, elapsed=self.elapsed)
            cost = self.full_ms * scale**2 * self._random.uniform(1.0 - self._noise, 1.0 + self._noise) * (spike if index == 0 else 1.0)
            self.resolution.record(scale, cost, traced=camera_moving)
            self.resolution.record_rest(self.other_ms)
            self.elapsed = (cost + self.other_ms) / 1e3
            time += self.elapsed
            scales.append(scale)
        return scales

    def frame_ms(self, scale: float) -> float:
        return self.full_ms * scale**2 + self.other_ms


@pytest.mark.parametrize("full_ms", [40.0, 70.0, 130.0, 400.0])
@pytest.mark.parametrize("other_ms", [0.0, 8.0])
@pytest.mark.parametrize("target", [30.0, 20.0])
def test_the_frame_rate_is_held(full_ms, other_ms, target):
    """The step is less than one from what fits, and one is a factor 2^(1/4) in cost."""
    machine = Machine(full_ms, other_ms)
    scale = machine.run(target=target, seconds=3.0)[-1]
    if scale == 1.0:
        assert machine.frame_ms(1.0) <= 1e3 / target * STEP**2
    elif scale == COARSEST[True]:
        assert machine.frame_ms(scale) >= 1e3 / target / STEP**2
    else:
        assert STEP**-2 <= (machine.frame_ms(scale) - other_ms) / (1e3 / target - other_ms) <= STEP**2


def test_what_fits_is_drawn_whole():
    assert set(Machine(20.0).run(seconds=3.0)[-20:]) == {1.0}


def test_without_a_target_all_is_drawn():
    assert set(Machine(500.0).run(5, target=0.0)) == {1.0}


def test_before_anything_is_known():
    assert Machine(100.0).run(1)[0] == COARSEST[True], "coarse under a moving camera"
    assert Machine(100.0).run(1, camera_moving=False)[0] == 1.0, "whole before a resting one"


@pytest.mark.parametrize("full_ms", [100.0, 120.0, 140.0])
def test_the_scale_does_not_hop(full_ms):
    """Fifteen per cent of noise in the cost is 0.6 steps. A step that fits barely may be left once; the next one is then well within."""
    machine = Machine(full_ms, noise=0.15)
    scales = machine.run(seconds=20.0)[-500:]
    assert sum(a != b for a, b in zip(scales, scales[1:])) <= 1


def test_one_slow_frame_changes_nothing():
    machine = Machine(120.0)
    before = machine.run(seconds=3.0)[-1]
    assert set(machine.run(20, spike=20.0)) == {before}


def test_the_scale_glides():
    """When frames become four times as dear the picture gets coarser step by step, within two seconds, and finer again likewise."""
    machine = Machine(60.0)
    fine = machine.run(seconds=3.0)[-1]
    machine.full_ms = 240.0
    falling = machine.run(seconds=2.0)
    machine.full_ms = 60.0
    rising = machine.run(seconds=2.0)
    assert all(a >= b for a, b in zip(falling, falling[1:])) and all(a <= b for a, b in zip(rising, rising[1:]))
    assert max(b / a for a, b in zip(rising, rising[1:])) <= 1.001 * STEP**2
    assert fine / falling[-1] == pytest.approx(2.0, rel=STEP - 1.0)
    assert rising[-1] / fine == pytest.approx(1.0, rel=STEP - 1.0)


def test_a_resting_camera_keeps_sharpness_before_frame_rate():
    """A disk that turns before a resting camera is drawn whole down to half the frame rate, and never coarser than half the size."""
    assert Machine(0.9 * 1e3 / (30.0 * REST_SHARE)).run(seconds=3.0, camera_moving=False)[-1] == 1.0
    assert Machine(5000.0).run(20, seconds=3.0, camera_moving=False)[-1] == COARSEST[False]


def test_a_movement_begins_with_what_the_last_one_found():
    machine = Machine(130.0)
    found = machine.run(seconds=3.0)[-1]
    machine.full_ms = 40.0
    assert set(machine.run(20, camera_moving=False)) == {1.0}, "the camera rests: sharp at once"
    machine.resolution.rest()
    machine.full_ms = 130.0
    assert set(machine.run(20)) == {found}
