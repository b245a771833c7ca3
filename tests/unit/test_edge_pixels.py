"""Where marks of pixels change, against the rule pixel by pixel."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.glsl.declared import EdgeMark, Fate
from blackhole_gl.rendering.edge_pixels import at_edges, beside_things

SKY, SHADOW = int(Fate.ESCAPED), int(Fate.CAPTURED)
NO_RAY = 0xFFFF
MARKS = (
    *(SKY, SKY, SKY, SHADOW, SKY | EdgeMark.RING_1, SKY | EdgeMark.VEILED, SKY | EdgeMark.VEILED | EdgeMark.RING_1),
    *(SKY | 3 << 8, SKY | EdgeMark.IN_FIELD, NO_RAY),
)


def by_pixel(marks: np.ndarray) -> list[tuple[int, int]]:
    """The rule as it is told: a pixel with a ray that differs, in what counts for it, from one beside it that has a ray too."""
    height, width = marks.shape
    found = []
    for y in range(height):
        for x in range(width):
            here = int(marks[y, x])
            ignored = EdgeMark.VEILED | (3 * EdgeMark.RING_1 if here & EdgeMark.VEILED else 0)
            beside = [int(mark) for mark in marks[max(y - 1, 0) : y + 2, max(x - 1, 0) : x + 2].ravel()]
            if here != NO_RAY and any(mark != NO_RAY and (mark ^ here) & ~ignored for mark in beside):
                found.append((x, y))
    return found


@pytest.mark.parametrize("seed", range(20))
def test_edges_are_found_wherever_they_are(seed: int) -> None:
    random = np.random.default_rng(seed)
    height, width = random.integers(1, 12, 2)
    patches = random.choice(MARKS, (height, width))
    few = np.where(random.random((height, width)) < 0.15, patches, random.choice((SKY, NO_RAY, SKY | EdgeMark.VEILED))).astype(np.uint16)
    for marks in (patches.astype(np.uint16), few):
        assert [tuple(pixel) for pixel in at_edges(marks).tolist()] == by_pixel(marks)


@pytest.mark.parametrize("seed", range(5))
def test_pixels_beside_things_are_told(seed: int) -> None:
    """What is met lies in the upper seven bits less one; of a pixel without a ray all bits are set, and it shows nothing."""
    random = np.random.default_rng(seed)
    marks = random.choice((*MARKS, SKY | 1 << 15), (9, 14), p=(0.9, *[0.1 / 10] * 10)).astype(np.uint16)
    pixels = np.stack(np.divmod(np.arange(marks.size), 14)[::-1], axis=-1)
    shows = (marks != NO_RAY) & (marks >> 8 & 127 != 0)
    expected = [bool(shows[max(y - 1, 0) : y + 2, max(x - 1, 0) : x + 2].any()) for x, y in pixels]
    assert beside_things(marks, pixels).tolist() == expected and 0 < sum(expected) < marks.size


def test_a_picture_of_one_kind_has_no_edges() -> None:
    assert at_edges(np.full((9, 16), SKY, np.uint16)).shape == (0, 2)
