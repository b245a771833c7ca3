"""The extrapolation integrator on problems with known solutions."""

from __future__ import annotations

import numpy as np

from blackhole_gl.reference import integrator


class Oscillators:
    """y'' = -k^2 y with a k of each ray's own: rows (y, y', k)."""

    def rhs(self, state):
        return np.stack([state[1], -state[2] ** 2 * state[0], np.zeros_like(state[0])])

    def scale(self, state):
        return np.stack([np.ones_like(state[0]), state[2], np.ones_like(state[0])])

    def longest_step(self, state):
        return 2.0 / state[2]

    def rechart(self, before, after):
        return after


def started(k):
    return np.stack([np.zeros_like(k), k, k])


def test_order_of_one_step():
    k = np.ones(1)
    errors = [abs(integrator.extrapolated_step(Oscillators().rhs, started(k), np.array([h]))[0][0, 0] - np.sin(h)) for h in (4.0, 2.0)]
    # Halving the step divides the error of one step by 2^15.
    assert 2**13 < errors[0] / errors[1] < 2**17


def test_each_ray_has_its_own_step_and_end():
    k = np.array([0.5, 3.0, 40.0, 7.0])
    system, state = Oscillators(), started(k)
    turns = np.zeros(4)
    end = np.zeros(4)

    def watch(rays, before, after, step):
        zero = before[0] * after[0] < 0
        if zero.any():
            at, found = integrator.locate_zero(system.rhs, lambda state: state[0], before[:, zero], after[:, zero], step[zero])
            assert np.all(np.abs(found[0]) < 1e-14)
            assert np.all((at >= 0) & (at <= step[zero]))
        end[rays] += step
        turns[rays] += zero
        return turns[rays] >= rays + 1

    last, steps = integrator.march(system, state, np.full(4, 1e-3), watch, tolerance=1e-12, max_steps=500)
    assert np.all(turns == [1, 2, 3, 4])
    np.testing.assert_allclose(last[0], np.sin(k * end), atol=1e-11)  # a dozen steps of 1e-12
    assert np.all(steps < 40)


def test_a_bad_right_hand_side_ends_in_no_nan():
    class Pole(Oscillators):
        def rhs(self, state):
            with np.errstate(all="ignore"):
                return np.stack([1 / np.sqrt(1 - state[0]), 0 * state[0], 0 * state[0]])

    state = np.array([[0.0], [0.0], [1.0]])
    last, steps = integrator.march(Pole(), state, np.array([1.0]), lambda *_: np.zeros(_[0].size, bool), tolerance=1e-12, max_steps=60)
    assert np.all(np.isfinite(last)) and last[0, 0] < 1 and steps[0] == 60
