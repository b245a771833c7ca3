"""Bounding volume hierarchies: that every box is found where it is, by the walk that shaders take."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from blackhole_gl.render import hierarchy


def _boxes(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    low = np.round(rng.normal(size=(count, 3)), 1) * (0.0 if seed % 5 == 0 else 10.0)  # at times all in one place
    return low, low + rng.uniform(0.0, 1.0, (count, 3))


def _walked(texels: np.ndarray, point: np.ndarray) -> tuple[list[int], int]:
    """What the leaves hold whose boxes hold the point, and how many nodes were looked at: shaders/common/hierarchy.glsl."""
    nodes, found, node, looks = texels.reshape(-1, 2, 4), [], 0, 0
    while node >= 0:
        low, high = nodes[node]
        met, leaf = bool(np.all(low[:3] <= point) and np.all(point <= high[:3])), high[3] >= 0
        found += [int(high[3])] if met and leaf else []
        node = node + 1 if met and not leaf else int(low[3])
        looks += 1
    return found, looks


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 70), st.integers(0, 1000), st.integers(1, hierarchy.MOST_IN_LEAF))
def test_a_walk_finds_every_box_that_holds_a_point(count: int, seed: int, in_leaf: int) -> None:
    low, high = _boxes(count, seed)
    made = hierarchy.build(low, high, in_leaf)
    texels = made.texels(made.first)
    assert sorted(made.order) == list(range(count)) and made.count.sum() == count
    for point in np.vstack([low, high, 0.5 * (low + high), np.zeros((1, 3))]):
        leaves, _ = _walked(texels, point)
        counts = dict(zip(made.first, made.count))
        seen = {int(item) for first in leaves for item in made.order[first : first + counts[first]]}
        inside = {int(item) for item in np.flatnonzero(np.all((low <= point) & (point <= high), axis=1))}
        assert inside <= seen


def test_few_nodes_are_looked_at_for_a_point_among_many_boxes() -> None:
    low, high = _boxes(10_000, 1)
    texels = hierarchy.build(low, high).texels(np.arange(19_999))
    looks = [_walked(texels, point)[1] for point in low[:50].astype(np.float32)]
    assert np.mean(looks) < 250, "of 19,999"


@pytest.mark.parametrize("value", [0.1, -0.1, 1e5 / 3.0])
def test_boxes_are_rounded_outwards(value: float) -> None:
    texels = hierarchy.build(np.full((1, 3), value), np.full((1, 3), value)).texels(np.array([0]))
    assert np.all(texels[0, 0, :3] < value) and np.all(texels[0, 1, :3] > value)
