"""The shear's phases: bounded, stationary, continuous and the same for the same time."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from blackhole_gl.physics.shear import RENEWAL_PERIOD, shear_phases

TEN_HOURS = 36_000.0 * 4.0  # of playback at the default 4 r_s/c a second


@given(st.floats(-1e9, 1e9), st.floats(1e-2, 1e4))
def test_ages_weights_and_seeds_stay_in_range(time: float, period: float) -> None:
    ages, weights, seeds = shear_phases(time, period)
    assert all(0.0 <= age < period for age in ages)
    assert all(0.0 <= weight <= 1.0 for weight in weights)
    assert sum(weights) == pytest.approx(1.0, abs=1e-12)
    assert all(seed == int(seed) and 0 <= seed < 1024 for seed in seeds)
    assert seeds[0] != seeds[1]


@pytest.mark.parametrize("start", [0.0, TEN_HOURS, -TEN_HOURS, 1e9])
def test_winding_is_the_same_at_any_time(start: float) -> None:
    """Mean and spread of the visible age over one period, which set how wound the picture looks."""
    times = start + RENEWAL_PERIOD * (np.arange(2000) + 0.5) / 2000
    phases = [shear_phases(t) for t in times]
    visible = np.array([np.dot(ages, weights) for ages, weights, _ in phases])
    assert visible.mean() == pytest.approx(RENEWAL_PERIOD / 2, rel=1e-6)  # symmetric in time: half a period
    assert visible.max() < RENEWAL_PERIOD * 0.7


def test_a_pattern_changes_its_seed_only_while_it_is_invisible() -> None:
    times = TEN_HOURS + np.linspace(0.0, 3 * RENEWAL_PERIOD, 30_001)
    phases = [shear_phases(t) for t in times]
    for pattern in (0, 1):
        seeds = np.array([phase[2][pattern] for phase in phases])
        weights = np.array([phase[1][pattern] for phase in phases])
        changes = np.flatnonzero(np.diff(seeds))
        assert len(changes) == 3
        assert weights[changes].max() < 1e-6  # within one step of 1e-4 periods of zero: sin²(π 1e-4) = 1e-7


def test_a_short_step_counts_after_a_day() -> None:
    """Float64 time: 1e-6 r_s/c is still seen at 1e6."""
    (before, _), _, _ = shear_phases(1e6)
    (after, _), _, _ = shear_phases(1e6 + 1e-6)
    assert after - before == pytest.approx(1e-6, rel=1e-3)


@pytest.mark.parametrize("time, period", [(math.nan, 1.0), (math.inf, 1.0), (0.0, 0.0), (0.0, -1.0), (0.0, math.nan)])
def test_nonsense_is_refused(time: float, period: float) -> None:
    with pytest.raises(ValueError, match="must be"):
        shear_phases(time, period)
