"""Values that have an order: none of them may be larger than the one after it."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
from itertools import pairwise

from .schema import SceneError, Value, number_of


def disorder(increasing: Sequence[str], value: Callable[[str], Value]) -> list[tuple[str, str]]:
    """The neighbours among the names `increasing` that stand the wrong way round; `value` gives that of a name."""
    return [(smaller, larger) for smaller, larger in pairwise(increasing) if number_of(value(smaller)) > number_of(value(larger))]


def refuse_disorder(path: str, increasing: Sequence[str], value: Callable[[str], Value], given: Container[str]) -> None:
    """Refuses values below `path` that stand the wrong way round, in the name of one that is among those just `given`.

    Raises:
        SceneError: it says what is allowed beside the other.
    """
    for smaller, larger in disorder(increasing, value):
        last, bound, other = (larger, "at least", smaller) if larger in given else (smaller, "at most", larger)
        raise SceneError(f"{path}.{last}", f"got {value(last):g}; allowed is {bound} {value(other):g}, which is {path}.{other}")
