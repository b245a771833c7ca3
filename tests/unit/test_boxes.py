"""Parts of a picture that draws are kept to."""

from __future__ import annotations

import numpy as np
import pytest

from blackhole_gl.rendering.boxes import WORTH_A_DRAW, bands_of, box_of, few_of, joined

SIDE = 4


@pytest.mark.parametrize("height", [1, 3, 16])
def test_bands_hold_what_is_picked_and_none_is_larger_than_it_has_to_be(height: int) -> None:
    picked = np.random.default_rng(height).random((19, 27)) < 0.02
    size = 27 * SIDE - 3, 19 * SIDE - 1  # the last cells are cut
    bands = list(bands_of(picked, size, SIDE, height))
    held = np.zeros((size[1], size[0]), bool)
    for x, y, width, rows in bands:
        held[y : y + rows, x : x + width] = True
    pixels = np.kron(picked, np.ones((SIDE, SIDE), bool))[: size[1], : size[0]]
    assert bands and not (pixels & ~held).any()
    for first in range(0, len(picked), height):
        alone = np.zeros_like(picked)
        alone[first : first + height] = picked[first : first + height]
        box = box_of(alone, size, SIDE)
        assert (box in bands) == alone.any()


def test_nothing_picked_has_no_band() -> None:
    assert list(bands_of(np.zeros((5, 5), bool), (20, 20), SIDE, 2)) == []


def test_bands_that_spare_little_by_themselves_are_drawn_as_one() -> None:
    near, beside, far = (40, 0, 120, 80), (48, 80, 120, 80), (280, 160, 120, 80)
    both = joined(near, beside)
    assert few_of([near, beside, far]) == [both, far] and few_of([]) == []
    _, _, width, height = joined(both, far)
    assert width * height - both[2] * both[3] - far[2] * far[3] > WORTH_A_DRAW
