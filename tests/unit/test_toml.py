"""What is written as TOML is read back by Python."""

import tomllib

from hypothesis import given
from hypothesis import strategies as st

from blackhole_gl.output import toml

# Half characters have no UTF-8, and no TOML.
TEXT = st.text(st.characters(exclude_categories=("Cs",)))
PLAIN = TEXT | st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False)
VALUES = st.recursive(PLAIN, lambda values: st.lists(values) | st.dictionaries(TEXT.filter(bool), values), max_leaves=5)


@given(st.dictionaries(TEXT, VALUES), st.sampled_from(["", "r_s", "×"]))
def test_values_come_back(values: dict, comment: str) -> None:
    assert tomllib.loads("".join(toml.line(name, value, comment) for name, value in values.items())) == values


def test_what_a_record_holds_as_a_tuple_is_a_list() -> None:
    assert toml.line("at", (1.0, -2.5e-300, float("inf"))) == "at = [1.0, -2.5e-300, inf]\n"
