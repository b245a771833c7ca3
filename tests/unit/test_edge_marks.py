"""Where marks of pixels change, against the rule pixel by pixel."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.glsl.declared import EdgeMark, Fate
from blackhole_gl.rendering.edge_marks import MarkedSquares, shown_in_cells

SKY, SHADOW = int(Fate.ESCAPED), int(Fate.CAPTURED)
NO_RAY = 0xFFFF
MARKS = (
    *(SKY, SKY, SKY, SHADOW, SKY | EdgeMark.RING_1, SKY | EdgeMark.VEILED, SKY | EdgeMark.VEILED | EdgeMark.RING_1),
    *(SKY | 3 << 8, SKY | EdgeMark.IN_FIELD, NO_RAY),
)


def by_pixel(marks: np.ndarray, corners: bool = False) -> list[tuple[int, int]]:
    """The rule as it is told: a pixel with a ray that differs, in what counts for it, from one beside it that has a ray too."""
    height, width = marks.shape

    def differs(here: int, x: int, y: int, corner: bool) -> bool:
        veiled = corner and not corners and EdgeMark.MET << 8 | EdgeMark.IN_FIELD or ~(EdgeMark.VEILED | 3 * EdgeMark.RING_1)
        beside = int(marks[y, x]) if 0 <= x < width and 0 <= y < height else NO_RAY
        return beside != NO_RAY and (beside ^ here) & (veiled if here & EdgeMark.VEILED else ~EdgeMark.VEILED) != 0

    def at_edge(x: int, y: int) -> bool:
        here = int(marks[y, x])
        return here != NO_RAY and any(differs(here, x + i, y + j, bool(i and j)) for i in (-1, 0, 1) for j in (-1, 0, 1))

    return [(x, y) for y in range(height) for x in range(width) if at_edge(x, y)]


@pytest.mark.parametrize("seed", range(20))
def test_edges_are_found_wherever_they_are(seed: int) -> None:
    random = np.random.default_rng(seed)
    height, width = random.integers(1, 28, 2)
    patches = random.choice(MARKS, (height, width))
    few = np.where(random.random((height, width)) < 0.15, patches, random.choice((SKY, NO_RAY, SKY | EdgeMark.VEILED))).astype(np.uint16)
    for marks in (patches.astype(np.uint16), few):
        for corners in (False, True):
            found = MarkedSquares.of(marks).edges(corners=corners)
            assert sorted(map(tuple, found.pixels[:, ::-1].tolist())) == [pixel[::-1] for pixel in by_pixel(marks, corners)]


@pytest.mark.parametrize("slope", np.linspace(-1.0, 1.0, 9))
def test_a_straight_edge_behind_the_direct_picture_is_found_wherever_it_cuts_a_pixel(slope: float) -> None:
    """Though pixels that it touches at a corner alone are left out."""
    y, x = np.mgrid[0:40, 0:40]
    level = slope * (x - 19.5) + 0.3 - (y - 19.5)
    marks = (np.where(level > 0.0, SKY, SHADOW) | EdgeMark.VEILED).astype(np.uint16)
    found = {tuple(pixel) for pixel in MarkedSquares.of(marks).edges().pixels.tolist()}
    cut = np.abs(level) < 0.5 * (1.0 + abs(slope)) - 1e-9  # of a pixel's corners some lie on either side
    assert cut.sum() > 30 and {tuple(pixel) for pixel in np.argwhere(cut)[:, ::-1].tolist()} <= found


@pytest.mark.parametrize("seed", range(5))
def test_pixels_beside_things_are_told(seed: int) -> None:
    """What is met lies in the upper seven bits less one; of a pixel without a ray all bits are set, and it shows nothing."""
    random = np.random.default_rng(seed)
    marks = random.choice((*MARKS, SKY | 1 << 15), (9, 44), p=(0.9, *[0.1 / 10] * 10)).astype(np.uint16)
    edges = MarkedSquares.of(marks).edges()
    shows = (marks != NO_RAY) & (marks >> 8 & 127 != 0)
    expected = [bool(shows[max(y - 1, 0) : y + 2, max(x - 1, 0) : x + 2].any()) for x, y in edges.pixels]
    assert edges.beside_things().tolist() == expected and 0 < sum(expected) < len(expected)


def plain_by_pixel(marks: np.ndarray, x: int, y: int) -> bool:
    """The rule as it is told: this pixel and those beside it lie in squares of 2×2 that are alike, and differ in what is met alone."""

    def at(column: int, row: int) -> int:
        return int(marks[min(max(row, 0), marks.shape[0] - 1), min(max(column, 0), marks.shape[1] - 1)])

    def is_wide(column: int, row: int) -> bool:
        squares = [[at(column + i + a, row + j + b) for a in (0, 1) for b in (0, 1)] for i in (-1, 0) for j in (-1, 0)]
        return any(len({mark for mark in square if mark != NO_RAY}) <= 1 for square in squares)

    def but_for_things(mark: int) -> int:
        return (mark - Fate.MET + Fate.ESCAPED if mark & 3 == Fate.MET else mark) & ~(127 << 8)

    near = [(x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    seen = {but_for_things(at(*place)) for place in near if at(*place) != NO_RAY}
    return seen <= {but_for_things(at(x, y))} and all(is_wide(*place) for place in near)


@pytest.mark.parametrize("seed", range(10))
def test_plain_outlines_are_told(seed: int) -> None:
    random = np.random.default_rng(seed)
    met = SKY - Fate.ESCAPED + Fate.MET | 3 << 8
    marks = np.kron(random.choice((SKY, met, met + (1 << 8), NO_RAY, SHADOW), (5, 7), p=(0.4, 0.3, 0.1, 0.1, 0.1)), np.ones((3, 4), int)).astype(np.uint16)
    marks = np.where(random.random(marks.shape) < 0.02, met, marks).astype(np.uint16)
    edges = MarkedSquares.of(marks).edges()
    found = edges.at_plain_outlines()
    assert found.tolist() == [plain_by_pixel(marks, *pixel) for pixel in edges.pixels.tolist()]
    assert 0 < np.count_nonzero(found) < len(found)


@pytest.mark.parametrize("shape", [(0, 0), (0, 5), (5, 0)])
def test_where_nothing_has_rays_there_are_no_edges(shape: tuple[int, int]) -> None:
    """A camera that looks away from all that bends light."""
    marks = np.zeros(shape, np.uint16)
    found = MarkedSquares.of(marks).edges()
    assert found.pixels.shape == (0, 2) and found.beside_things().shape == found.at_plain_outlines().shape == (0,)


@pytest.mark.parametrize("kinds", [(SKY,), (SKY, NO_RAY), (NO_RAY,)])
def test_a_picture_of_one_kind_has_no_edges(kinds: tuple[int, ...]) -> None:
    marks = np.random.default_rng(1).choice(np.array(kinds, np.uint16), (19, 16))
    assert MarkedSquares.of(marks).edges().pixels.shape == (0, 2)


@pytest.mark.parametrize("size", [(8, 12), (7, 10), (1, 1), (0, 0)])
def test_cells_are_told_by_what_any_of_their_pixels_shows(size: tuple[int, int]) -> None:
    kinds = SKY, SHADOW, SKY | EdgeMark.RING_1 | 3 << 8, SHADOW | 1 << 15, int(Fate.MET) | 5 << 8, NO_RAY
    marks = np.random.default_rng(3).choice(np.array(kinds, np.uint16), size, p=[0.1, 0.7, 0.05, 0.1, 0.03, 0.02])
    met, escaped = shown_in_cells(marks)
    for (row, column), shows in np.ndenumerate(met):
        cell = marks[4 * row : 4 * row + 4, 4 * column : 4 * column + 4]
        assert shows == (cell >> 8 & EdgeMark.MET != 0).any()
        assert escaped[row, column] == (cell & 3 == Fate.ESCAPED).any()
    assert met.shape == escaped.shape == (-(-size[0] // 4), -(-size[1] // 4))
