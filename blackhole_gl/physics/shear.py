"""Phases of a sheared pattern that never winds up.

A pattern carried by Keplerian orbits is wound ever tighter. So two patterns live at a time, half a period apart: each is
born with a new seed, sheared while it fades in and out, and replaced when it has faded. What is seen is as much wound after
ten hours as in the first second.
"""

from __future__ import annotations

import math

RENEWAL_PERIOD = 96.0
"""Life of one pattern in r_s/c: 2.1 orbits at r = 3 r_s, 0.3 at 10 r_s."""

_SEEDS, _SEED_STEP = 1024, 389  # odd: a seed returns after 512 lives

DEFINES = {"SHEAR_PERIOD": int(RENEWAL_PERIOD), "SHEAR_SEEDS": _SEEDS, "SHEAR_SEEDS_A_LIFE": 2 * _SEED_STEP}
"""What shaders know of it, to look back in time: the seed of a pattern's next life is so much more, as a remainder of so many."""


def shear_phases(time: float, period: float = RENEWAL_PERIOD) -> tuple[tuple[float, float], tuple[float, float], tuple[float, float]]:
    """Ages, weights and seeds of the two patterns at `time`.

    Args:
        time: scene time in r_s/c, of either sign; float64, so that a step of 1e-6 still counts after days.
        period: life of a pattern in r_s/c, above 0.

    Returns:
        ages, each in 0 ≤ age < period; weights sin²(π age/period), which add up to 1; seeds, whole numbers in
        0…1023 as floats, new in each life and never alike in the two patterns at a time.

    Raises:
        ValueError: time is not finite, or period is not above 0.
    """
    if not math.isfinite(time):
        raise ValueError(f"time must be finite, got {time}")
    if not period > 0.0:
        raise ValueError(f"period must be above 0, got {period}")
    ages, seeds = [], []
    for pattern in (0, 1):
        lives = time / period + 0.5 * pattern
        life = math.floor(lives)
        ages.append(min((lives - life) * period, math.nextafter(period, 0.0)))
        seeds.append(float((2 * life + pattern) * _SEED_STEP % _SEEDS))
    first = math.sin(math.pi * ages[0] / period) ** 2
    return (ages[0], ages[1]), (first, 1.0 - first), (seeds[0], seeds[1])
