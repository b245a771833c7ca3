"""How coarse the moving picture is: the choice against a made-up machine whose frames cost what a test says."""

import math
import random

import pytest

from blackhole_gl.app.resolution import COARSEST, PIXELS_SHARE, REST_SHARE, STEPS_PER_OCTAVE, Resolution

STEP = 2.0 ** (1.0 / STEPS_PER_OCTAVE)


class Machine:
    """Frames whose pixels cost `full_ms` at full size, with `constant_ms` for a picture of any size and `other_ms` beside the picture."""

    def __init__(self, full_ms: float, other_ms: float = 0.0, noise: float = 0.0, *, constant_ms: float = 0.0, seed: int = 1):
        self.full_ms, self.other_ms, self.constant_ms, self._noise = full_ms, other_ms, constant_ms, noise
        self.resolution = Resolution()
        self.elapsed, self._random = 0.0, random.Random(seed)

    def run(
        self, frames: int = 0, target: float = 30.0, *, seconds: float = 0.0, camera_moving: bool = True, keeps_rays: bool = False, spike: float = 1.0
    ) -> list[float]:
        """The scales of the frames of so many seconds, `frames` of them at least; `spike` multiplies the cost of the first."""
        scales, time = [], 0.0
        while len(scales) < frames or time < seconds:
            index = len(scales)
            scale = self.resolution.scale(target, camera_moving=camera_moving, elapsed=self.elapsed)
            cost = self._cost(scale) * (spike if index == 0 else 1.0)
            self.resolution.record(scale, cost, traced=camera_moving and not keeps_rays)
            self.resolution.record_rest(self.other_ms)
            self.elapsed = (cost + self.other_ms) / 1e3
            time += self.elapsed
            scales.append(scale)
        return scales

    def move_and_rest(self, times: int = 2) -> "Machine":
        """Movements of two seconds or so, before and after each the whole picture of a camera at rest."""
        for _ in range(times):
            self.rest_whole()
            self.run(60)
        self.rest_whole()
        return self

    def rest_whole(self) -> None:
        """The camera comes to rest and the whole picture is drawn."""
        self.resolution.rest()
        self.resolution.record(1.0, self._cost(1.0), traced=True)

    def frame_ms(self, scale: float) -> float:
        return self.constant_ms + self.full_ms * scale**2 + self.other_ms

    def _cost(self, scale: float) -> float:
        return (self.constant_ms + self.full_ms * scale**2) * self._random.uniform(1.0 - self._noise, 1.0 + self._noise)


def hops(scales: list[float]) -> int:
    """How often the scale changed."""
    return sum(a != b for a, b in zip(scales, scales[1:]))


@pytest.mark.parametrize("full_ms", [40.0, 70.0, 130.0, 400.0])
@pytest.mark.parametrize("other_ms", [0.0, 8.0])
@pytest.mark.parametrize("target", [30.0, 20.0])
def test_the_frame_rate_is_held(full_ms, other_ms, target):
    """The step is less than one from what fits, and one is a factor 2^(1/4) in cost."""
    machine = Machine(full_ms, other_ms)
    scale = machine.run(target=target, seconds=3.0)[-1]
    if scale == 1.0:
        assert machine.frame_ms(1.0) <= 1e3 / target * STEP**2
    elif scale == COARSEST:
        assert machine.frame_ms(scale) >= 1e3 / target / STEP**2
    else:
        assert STEP**-2 <= (machine.frame_ms(scale) - other_ms) / (1e3 / target - other_ms) <= STEP**2


def test_what_fits_is_drawn_whole():
    assert set(Machine(20.0).run(seconds=3.0)[-20:]) == {1.0}


def test_without_a_target_all_is_drawn():
    assert set(Machine(500.0).run(5, target=0.0)) == {1.0}


def test_before_anything_is_known():
    assert Machine(100.0).run(1)[0] == COARSEST, "coarse under a moving camera"
    assert Machine(100.0).run(1, camera_moving=False)[0] == 1.0, "whole before a resting one"


@pytest.mark.parametrize("full_ms", [100.0, 120.0, 140.0])
def test_the_scale_does_not_hop(full_ms):
    """Fifteen per cent of noise in the cost is 0.6 steps. A step that fits barely may be left once; the next one is then well within."""
    machine = Machine(full_ms, noise=0.15)
    scales = machine.run(seconds=20.0)[-500:]
    assert hops(scales) <= 1


@pytest.mark.parametrize("full_ms", [90.0, 110.0, 130.0])
def test_a_resting_picture_keeps_its_size_on_a_busy_machine(full_ms):
    """Every step would trace the whole picture anew. Forty per cent of noise is two steps; once it must find its size."""
    assert hops(Machine(full_ms, noise=0.4).run(seconds=30.0, camera_moving=False)) <= 1


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
    assert Machine(5000.0).run(20, seconds=3.0, camera_moving=False)[-1] == 2.0 * COARSEST


def test_a_movement_begins_with_what_the_last_one_found():
    machine = Machine(130.0)
    found = machine.run(seconds=3.0)[-1]
    machine.full_ms = 40.0
    assert set(machine.run(20, camera_moving=False)) == {1.0}, "the camera rests: sharp at once"
    machine.resolution.rest()
    machine.full_ms = 130.0
    assert set(machine.run(20)) == {found}


@pytest.mark.parametrize("noise", [0.0, 0.15])
@pytest.mark.parametrize("constant_ms", [5.0, 10.0, 20.0])
@pytest.mark.parametrize("full_ms", [10.0, 40.0, 100.0, 400.0])
@pytest.mark.parametrize("movements", [0, 2])
def test_the_frame_rate_is_held_where_pixels_are_not_all_that_costs(full_ms, constant_ms, noise, movements):
    """A step is left when the frame is off by 0.9 steps, a factor 2^(0.9/4) = 1.17; it is no longer and no shorter than that, unless an end is reached."""
    aim, machine = 1e3 / 30.0, Machine(full_ms, noise=noise, constant_ms=constant_ms)
    if movements:
        machine.move_and_rest(movements)
    scales = machine.run(seconds=25.0)
    assert hops(scales[-500:]) <= 1
    frame = machine.frame_ms(scales[-1])
    assert frame <= 1.17 * aim or scales[-1] == COARSEST
    assert frame >= aim / 1.17 or scales[-1] == 1.0


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("constant_ms", [0.0, 5.0, 10.0, 20.0])
def test_the_constant_is_found(constant_ms, seed):
    """Fifteen per cent of noise in 33 ms is 5 ms, for frames in motion as for the pixels' share of one at rest; movements average over it."""
    machine = Machine(200.0, noise=0.15, constant_ms=constant_ms, seed=seed).move_and_rest(4)
    assert machine.resolution.constant_ms == pytest.approx(constant_ms, abs=5.0)


@pytest.mark.parametrize("noise", [0.0, 0.15])
@pytest.mark.parametrize("full_ms", [10.0, 40.0])
@pytest.mark.parametrize("constant_ms", [40.0, 80.0])
def test_sharpness_is_not_given_up_for_nothing(constant_ms, full_ms, noise):
    """Where the constant alone exceeds the frame, a quarter of the size would gain a few milliseconds. Pixels take a sixth of the constant instead,
    or half or twice of that before a step is left. With noise a tenth of the constant goes unseen, which is most of a sixth: then they take less."""
    machine = Machine(full_ms, noise=noise, constant_ms=constant_ms).move_and_rest()
    scales = machine.run(seconds=25.0)
    pixels_ms = machine.frame_ms(scales[-1]) - constant_ms
    allowed = PIXELS_SHARE * constant_ms
    assert min((0.15 if noise else 0.5) * allowed, 0.5 * full_ms) <= pixels_ms <= 2.0 * allowed
    assert scales[-1] > COARSEST and hops(scales[60:]) <= 1


@pytest.mark.parametrize("full_ms", [50.0, 90.0, 200.0])
@pytest.mark.parametrize("seed", range(4))
def test_work_that_begins_with_a_movement_is_not_taken_for_the_constant(full_ms, seed):
    """Another process slows every other movement to 2.5 times, some from the start: frames are as long as that makes them at the coarsest, or as aimed at,
    but for the tenth that finding the step takes."""
    machine, chance = Machine(full_ms, 10.0, noise=0.15, seed=seed), random.Random(seed)
    took = fitting = 0.0
    for _ in range(12):
        machine.rest_whole()
        for factor in (chance.choice((1.0, 2.5)), 1.0):
            machine.full_ms = factor * full_ms
            frames = [machine.frame_ms(scale) for scale in machine.run(35)]
            took += sum(frames)
            fitting += len(frames) * max(machine.frame_ms(COARSEST), min(1e3 / 30.0, machine.frame_ms(1.0)))
        machine.full_ms = full_ms
    assert took <= 1.1 * fitting


def test_pixels_that_cost_much_are_not_drawn_where_the_constant_exceeds_the_frame():
    assert Machine(1000.0, constant_ms=40.0).move_and_rest().run(seconds=5.0)[-1] == COARSEST


@pytest.mark.parametrize("constant_ms", [0.0, 10.0, 20.0])
def test_a_view_that_changes_is_followed(constant_ms):
    """Pixels twice as dear and half as dear again and again, in six seconds: the mean frame is the one aimed at, and the constant believed in stays."""
    machine = Machine(100.0, noise=0.15, constant_ms=constant_ms).move_and_rest()
    frames = [machine.frame_ms(machine.run(1)[0]) for _ in range(60)]
    taken = machine.resolution.constant_ms
    for number in range(900):
        machine.full_ms = 100.0 * 2.0 ** math.sin(2.0 * math.pi * number / 180.0)
        frames.append(machine.frame_ms(machine.run(1)[0]))
    assert sum(frames[60:]) / 900 == pytest.approx(1e3 / 30.0, rel=0.1)
    assert machine.resolution.constant_ms == taken


def test_a_camera_that_turns_about_the_axis_is_drawn_as_sharp_as_its_kept_rays_allow():
    machine = Machine(400.0).move_and_rest()
    traced = machine.run(seconds=3.0)[-1]
    machine.full_ms = 100.0
    turning = machine.run(seconds=3.0, keeps_rays=True)[-1]
    assert turning == pytest.approx(2.0 * traced, rel=STEP - 1.0)


@pytest.mark.parametrize("full_ms", [10.0, 20.0])
def test_waiting_for_the_screen_does_not_keep_a_picture_coarse(full_ms):
    """A screen of 60 Hz, aimed at: each frame waits for the next 60th of a second, which looks like work that pixels have to leave room for.
    Half of the frame is theirs all the same, but for one step."""
    frame, machine = 1e3 / 60.0, Machine(400.0)
    machine.run(target=60.0, seconds=3.0)
    machine.full_ms = full_ms
    for _ in range(300):
        cost = machine.run(1, target=60.0)[-1] ** 2 * full_ms
        machine.other_ms = frame * math.ceil(cost / frame) - cost
    assert cost >= min(0.5 * frame, full_ms) / STEP**2


def test_a_small_picture_that_is_cheaper_by_the_pixel_has_no_negative_constant():
    """As where it fits a cache."""
    resolution = Resolution()
    for _ in range(20):
        resolution.scale(30.0, camera_moving=True, elapsed=0.03)
        resolution.record(0.25, 1.0, traced=True)
        resolution.rest()
        resolution.record(1.0, 100.0, traced=True)
    assert resolution.constant_ms == 0.0
