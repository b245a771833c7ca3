"""Which cases of a parametrized test the quick suite runs; the slow one runs all."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import pytest


def sampled(cases: Iterable, quick: Sequence) -> list:
    """`cases` in their order, those that are not in `quick` marked slow.

    Raises:
        ValueError: a quick case is none of the cases, so that nothing would run in its stead.
    """
    cases = list(cases)
    if missing := [case for case in quick if case not in cases]:
        raise ValueError(f"{missing}: no cases of this test, which has {cases}")
    return [case if case in quick else pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.slow) for case in cases]
