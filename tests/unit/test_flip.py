"""ꟻLIP against its authors' own programme, and what must hold for any such measure."""

from __future__ import annotations

import numpy as np
import pytest

from studies.flip import flip


def _pattern() -> np.ndarray:
    """A picture with edges, stripes and colours, the same everywhere: whole numbers only."""
    y, x = np.mgrid[:90, :160]
    return np.stack([(7 * x + 3 * y) % 256, (x * y) // 60, 255 * ((x // 20 + y // 20) % 2)], axis=-1).astype(np.uint8)


def _with_spot(picture: np.ndarray) -> np.ndarray:
    changed = picture.copy()
    changed[40:44, 60:64] = 255
    changed[10, 10] = 0
    return changed


PAIRS = {
    "moved by a pixel": lambda a: (a, np.roll(a, 1, axis=1)),
    "a spot": lambda a: (a, _with_spot(a)),
    "lighter": lambda a: (a // 2, a // 2 + 8),
    "black and white": lambda a: (0 * a, 0 * a + 255),
    "upside down": lambda a: (a, a[::-1]),
}
# (mean, largest) at 67 and at 40 pixels per degree, by flip-evaluator 1.7: evaluate(a/255, b/255, "LDR", applyMagma=False, parameters={"ppd": …}).
PUBLISHED: dict[str, tuple[tuple[float, float], tuple[float, float]]] = {
    "moved by a pixel": ((0.21117, 0.98824), (0.21657, 0.99025)),
    "a spot": ((0.00510, 0.98742), (0.00366, 0.99329)),
    "lighter": ((0.17176, 0.21185), (0.17233, 0.21389)),
    "black and white": ((0.96750, 0.96739), (0.96750, 0.96739)),
    "upside down": ((0.77081, 0.98462), (0.78145, 0.98610)),
}


@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("index, pixels_per_degree", [(0, 67.0), (1, 40.0)])
def test_it_is_the_authors_measure(name: str, index: int, pixels_per_degree: float) -> None:
    """Within 5e-4: both compute in 32 bits, theirs with constants rounded to six digits."""
    found = flip(*PAIRS[name](_pattern()), pixels_per_degree)
    assert (found.mean(), found.max()) == pytest.approx(PUBLISHED[name][index], abs=5e-4)


def test_a_picture_does_not_differ_from_itself() -> None:
    assert not flip(_pattern(), _pattern()).any()


def test_the_order_does_not_matter() -> None:
    a = _pattern()
    np.testing.assert_array_equal(flip(a, _with_spot(a)), flip(_with_spot(a), a))


def test_a_difference_is_seen_where_it_is() -> None:
    """Beyond the reach of the widest filter, ten pixels at 67 pixels per degree, nothing changes."""
    a = _pattern()
    found = flip(a, _with_spot(a))
    assert found[42, 62] > 0.5 and found[10, 10] > 0.1
    assert not found[:, 80:].any() and not found[60:].any()


@pytest.mark.parametrize("other", [_pattern()[:-1], _pattern().astype(float), _pattern()[..., 0]])
def test_only_pictures_of_one_kind_are_compared(other: np.ndarray) -> None:
    with pytest.raises(ValueError, match="uint8"):
        flip(_pattern(), other)
