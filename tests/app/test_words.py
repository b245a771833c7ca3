"""What the window's figures say is explained in its help."""

import pytest

from blackhole_gl import planning
from blackhole_gl.app.words import WORDS
from blackhole_gl.measure.gauge import Gauged
from blackhole_gl.scene import presets


@pytest.mark.parametrize("name, symbol", [("kerr", "κ"), ("gargantua_s1", "Δt₀")])
def test_symbols_of_methods_are_explained(name: str, symbol: str) -> None:
    assert symbol in planning.plan(presets.load([name])).method
    assert any(symbol in word.split(", ") for word in WORDS)


def test_the_unit_of_cost_is_explained() -> None:
    assert "flat frame" in str(Gauged(0.1, 0.0, 2.0)) and "flat frame" in WORDS
