"""Bounding volume hierarchies: that every box is found where it is, by the walk that shaders take."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from blackhole_gl.rendering import hierarchy


def _boxes(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    low = np.round(rng.normal(size=(count, 3)), 1) * (0.0 if seed % 5 == 0 else 10.0)  # at times all in one place
    return low, low + rng.uniform(0.0, 1.0, (count, 3))


def _walked(texels: np.ndarray, point: np.ndarray) -> tuple[list[int], int]:
    """What the leaves hold whose boxes hold the point, and how many nodes were looked at: shaders/common/hierarchy.glsl."""
    nodes, found, node, looks = texels.reshape(-1, 4), [], hierarchy.FIRST, 0
    low, high = _boxes_of(nodes)
    holds = np.all((low <= point) & (point <= high), axis=1)
    while node > 0:
        met, link = bool(holds[node]), int(nodes[node, 3])
        leaf = link < 0
        found += [(-1 - link) >> 1] if met and leaf else []
        follows = link & 1 == 1 if leaf else met
        node = node + 1 if follows else max(link, 0)
        looks += 1
    return found, looks


def _boxes_of(nodes: np.ndarray) -> np.ndarray:
    """The low and the high corners of their boxes."""
    *corner, cell = nodes[0].view(np.float32).astype(float)
    sides = np.ascontiguousarray(nodes[:, :3]).view(np.uint32).astype(np.int64)
    return np.array(corner) + cell * np.stack([sides & 65535, sides >> 16])


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 70), st.integers(0, 1000))
def test_a_walk_finds_every_box_that_holds_a_point(count: int, seed: int) -> None:
    low, high = _boxes(count, seed)
    made = hierarchy.build(low, high)
    texels = made.texels(made.first)
    assert sorted(made.order) == list(range(count)) and made.count.sum() == count
    for point in np.vstack([low, high, 0.5 * (low + high), np.zeros((1, 3))]):
        leaves, _ = _walked(texels, point)
        counts = dict(zip(made.first, made.count))
        seen = {int(item) for first in leaves for item in made.order[first : first + counts[first]]}
        inside = {int(item) for item in np.flatnonzero(np.all((low <= point) & (point <= high), axis=1))}
        assert inside <= seen


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 30), st.integers(1, 30), st.integers(0, 1000))
def test_a_walk_through_two_joined_finds_what_either_holds(first: int, second: int, seed: int) -> None:
    low, high = _boxes(first + second, seed)
    made = hierarchy.both(hierarchy.build(low[:first], high[:first]), hierarchy.build(low[first:], high[first:]))
    texels = made.texels(made.order[made.first])
    assert sorted(made.order) == list(range(first + second))
    for point in 0.5 * (low + high):
        inside = {int(item) for item in np.flatnonzero(np.all((low <= point) & (point <= high), axis=1))}
        assert inside <= set(_walked(texels, point)[0])


def test_few_nodes_are_looked_at_for_a_point_among_many_boxes() -> None:
    low, high = _boxes(10_000, 1)
    texels = hierarchy.build(low, high).texels(np.arange(19_999))
    looks = [_walked(texels, point)[1] for point in low[:50].astype(np.float32)]
    assert np.mean(looks) < 250, "of 19,999"


@pytest.mark.parametrize("value", [0.1, -0.1, 1e5 / 3.0])
def test_boxes_are_rounded_outwards(value: float) -> None:
    texels = hierarchy.build(np.full((1, 3), value), np.full((1, 3), value)).texels(np.array([0]))
    low, high = _boxes_of(texels[0])[:, hierarchy.FIRST]
    assert np.all(low < value) and np.all(high > value) and np.all(high - low < 1e-6 * abs(value))


def test_boxes_far_from_where_places_are_counted_are_as_narrow_as_single_precision_has_them() -> None:
    low = np.array([[1000.0, -3.0, 7.0], [1000.1, -3.0, 7.05]])
    texels = hierarchy.build(low, low + 0.02).texels(np.arange(3))
    for node in (2, 3):
        found = _boxes_of(texels[0])[:, node]
        box = int(np.argmin(np.abs(low[:, 0] - found[0, 0])))
        assert np.all(found[0] < low[box]) and np.all(found[1] > low[box] + 0.02) and np.all(np.abs(found - [low[box], low[box] + 0.02]) < 5e-4)
