"""Boxes of triangles, two by two: that every triangle is found in them, by the walk that shaders take."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from blackhole_gl.rendering import box_pairs
from blackhole_gl.rendering.box_pairs import IN_LEAF, BoxPairs


def _triangles(count: int, seed: int) -> np.ndarray:
    """Corners within the unit ball, at times all in one place."""
    rng = np.random.default_rng(seed)
    return rng.uniform(-0.5, 0.5, (count, 1, 3)) * (0.0 if seed % 5 == 0 else 1.0) + rng.uniform(0.0, 0.07, (count, 3, 3))


def _pairs(made: BoxPairs) -> tuple[np.ndarray, np.ndarray]:
    """The boxes below each node (node, first or second, low or high, axis), and what stands beyond their bits."""
    words = made.texels.view(np.uint32).reshape(-1, 2, 2).swapaxes(1, 2)
    return (np.stack([words & 1023, words >> 10 & 1023, words >> 20 & 1023], axis=-1) - 511.0) / 510.0, words >> 30


def _walked(made: BoxPairs, point: np.ndarray, backwards: int) -> tuple[list[int], int]:
    """The places of triangles in boxes that hold the point, as walk_on of shaders/common/box_pairs.glsl comes to them, and how many nodes were looked at."""
    boxes, beyond = _pairs(made)
    holds = np.all((boxes[:, :, 0] <= point) & (point <= boxes[:, :, 1]), axis=-1).tolist()
    lowest, node, trail, looks, found = 1 << made.levels >> 1, 1, 0, 0, []
    while node > 0:
        looks += 1
        one, other = holds[node]
        if (one or other) and node < lowest:
            both = one and other
            side = backwards >> int(beyond[node, 0, 1]) & 1 if both else int(not one)
            node, trail = 2 * node + side, 2 * trail + both
            continue
        if one or other:
            count = int(beyond[node, 0, 0])
            begin, end = 0 if one else count, count + int(beyond[node, 1, 0]) if other else count
            found += [2 * IN_LEAF * (node - lowest) + place for place in range(begin, end)]
        up = (trail & -trail).bit_length() - 1
        node, trail = (node >> up ^ 1, trail >> up ^ 1) if trail else (0, 0)
    return found, looks


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 70), st.integers(0, 1000))
def test_a_walk_finds_every_triangle_whose_box_holds_a_point(count: int, seed: int) -> None:
    corners = _triangles(count, seed)
    low, high, made = corners.min(axis=1), corners.max(axis=1), box_pairs.build(corners)
    assert len(made.texels) == 1 << made.levels and len(set(made.places)) == count and made.places.max() < IN_LEAF << made.levels
    for point in np.vstack([low, high, 0.5 * (low + high), np.zeros((1, 3))]):
        found, _ = _walked(made, point, seed % 8)
        inside = np.flatnonzero(np.all((low <= point) & (point <= high), axis=1))
        assert len(set(found)) == len(found) and set(made.places[inside]) <= set(found) <= set(made.places)


def test_of_two_boxes_the_second_lies_behind_the_first_along_the_axis_that_is_told() -> None:
    made = box_pairs.build(_triangles(1000, 1))
    boxes, beyond = _pairs(made)
    middles = boxes[1:].sum(axis=2)
    both = np.all(beyond[1:, :, 0] > 0, axis=1) | (np.arange(1, len(boxes)) < len(boxes) // 4)
    ahead = np.take_along_axis(middles[:, 1] - middles[:, 0], beyond[1:, 0, 1, None].astype(int), axis=1)[:, 0]
    assert np.mean(ahead[both] > -0.01) > 0.99


def test_few_nodes_are_looked_at_for_a_point_among_many_triangles() -> None:
    corners = _triangles(10_000, 1)
    made = box_pairs.build(corners)
    assert np.mean([_walked(made, point, 0)[1] for point in corners.min(axis=1)[:50]]) < 150, "of 8,191"


@pytest.mark.parametrize("value", [0.1, -0.1, 1.0, -1.0])
def test_boxes_are_rounded_outwards_by_no_more_than_a_cell(value: float) -> None:
    boxes, _ = _pairs(box_pairs.build(np.full((1, 3, 3), value)))
    sides = min(boxes[1], key=lambda box: float(np.abs(box - value).max()))
    assert np.all(sides[0] < value) and np.all(sides[1] > value) and np.all(sides[1] - sides[0] < 2.5 / 510.0)


def test_the_longest_side_of_all_triangles_stands_before_the_nodes() -> None:
    corners = _triangles(100, 2).astype(np.float32)
    corners[40, 1] = corners[40, 0] + (0.3, 0.0, 0.0)
    sides = [np.linalg.norm(corners[:, k] - corners[:, k - 1], axis=1).max() for k in range(3)]
    assert box_pairs.build(corners).texels[0, :1].view(np.float32) == pytest.approx(max(sides))
