"""What of a shader's text is compiled, and what is run."""

from __future__ import annotations

import pytest

from blackhole_gl.glsl.live import live_lines, live_words

CONDITIONS = [
    ("#if A", True),
    ("#if B", False),
    ("#if !B", True),
    ("#if A > 1", True),
    ("#if A != 2", False),
    ("#if A >= 2 && !B || C", True),
    ("#if UNKNOWN", False),
    ("#if defined(A) && defined B", True),
    ("#if defined(UNKNOWN)", False),
    ("#ifdef B", True),
    ("#ifndef B", False),
    ("#  if A // said why", True),
]


@pytest.mark.parametrize(("condition", "holds"), CONDITIONS)
def test_conditions(condition: str, holds: bool) -> None:
    lines = [condition, "yes", "#else", "no", "#endif", "after"]
    assert [line.strip() for line in live_lines(lines, {"A": 2, "B": 0})] == (["yes"] if holds else ["no"]) + ["after"]


def test_one_branch_of_a_chain_stands() -> None:
    lines = ["#if A == 0", "zero", "#elif A == 1", "one", "#if B", "deeper", "#endif", "#elif A < 9", "few", "#else", "many", "#endif"]
    assert [list(live_lines(lines, {"A": a, "B": b})) for a, b in ((0, 1), (1, 0), (1, 1), (5, 1), (9, 1))] == [
        ["zero"],
        ["one"],
        ["one", "deeper"],
        ["few"],
        ["many"],
    ]


def test_defines_of_the_text_count_where_they_are_compiled() -> None:
    lines = ["#if A", "#define HAS 3", "#else", "#define NOT 1", "#endif", "#if HAS == 3", "has", "#endif", "#ifdef NOT", "not", "#endif"]
    assert [line for line in live_lines(lines, {"A": 1}) if not line.startswith("#")] == ["has"]


def test_what_cannot_be_worked_out_stands_with_its_opposite() -> None:
    assert list(live_lines(["#if F(2) == 4", "yes", "#else", "no", "#endif"], {})) == ["yes", "no"]


TEXT = """
uniform float outside; // in_a_comment
#define MACRO by_macro
float leaf(float x) { return x * by_leaf; }
vec2 branch(
    float x) {
    return vec2(by_long_head);
}
vec3[2] called(vec3 v) {
    if (v.x > 0.0) {
        v *= leaf(by_called);
    }
    return vec3[2](v, v);
}
float never(float x) {
    return never_alone(by_never);
}
float never_alone(float x) { return by_never_alone; }
#if 0
float gone() { return by_gone; }
#endif
void main() {
    called(vec3(by_main));
}
""".splitlines()


def test_words_of_functions_that_are_never_called_are_not_run() -> None:
    words = live_words(TEXT, {})
    by = {"by_macro", "by_leaf", "by_called", "by_main", "outside"}
    assert by <= words.run and "by_never" not in words.run and "by_never_alone" not in words.run
    assert by | {"by_never", "by_never_alone", "by_long_head"} <= words.compiled
    assert not {"by_gone", "in_a_comment"} & words.compiled


def test_a_head_that_is_not_told_counts_as_run() -> None:
    assert "by_long_head" in live_words(TEXT, {}).run
