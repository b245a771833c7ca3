"""Commands declared as functions."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import pytest

from blackhole_gl.arguments import Argument, Option, Program


def draw(
    out: Annotated[Path, Option("--out", "-o", help="Where to, 100 % of it.")],
    names: Annotated[list[str] | None, Argument(help="What.")] = None,
    size_: Annotated[int, Option(least=1, most=16, help="How large.")] = 4,
    when: Annotated[float | None, Option(help="When.", default="now")] = None,
    lasts: Annotated[float, Option(least=0.0, help="How long.")] = 0.0,
    depth: Annotated[int, Option(most=3, help="How deep.")] = 0,
    set_: Annotated[list[str] | None, Option("--set", "-s", help="With what.")] = None,
    quick: Annotated[bool, Option(help="Or not.")] = False,
    checked: Annotated[bool, Option(help="Or not.")] = True,
    way: Annotated[str, Option(help="How.", variable="PROGRAM_WAY")] = "auto",
) -> None:
    """Draw it."""


PROGRAM = Program("program", "A program.", "1.2", (draw,))


def values(words: str) -> dict[str, object]:
    return PROGRAM.parsed(["draw", *words.split()])[1]


def test_a_parameter_not_given_is_its_default(monkeypatch: pytest.MonkeyPatch) -> None:
    found = values("-o x")
    assert found.pop("out") == Path("x") and found.pop("names") == []
    assert found == {"size_": 4, "when": None, "lasts": 0.0, "depth": 0, "set_": None, "quick": False, "checked": True, "way": "auto"}
    monkeypatch.setenv("PROGRAM_WAY", "egl")
    assert values("-o x")["way"] == "egl" and values("-o x --way osmesa")["way"] == "osmesa"


def test_options_stand_before_between_and_behind_words() -> None:
    found = values("one --quick -s a=-1 two -o - --set=b=2 --no-checked --size 16 three --when -2.5")
    assert found["names"] == ["one", "two", "three"] and found["set_"] == ["a=-1", "b=2"] and found["out"] == Path("-")
    assert (found["quick"], found["checked"], found["size_"], found["when"]) == (True, False, 16, -2.5)


@pytest.mark.parametrize(
    "words, told",
    [
        ("draw", "program draw: the following arguments are required: --out/-o"),
        ("draw -o", "program draw: --out/-o: expected one argument"),
        ("draw -o x --sise 3", "program draw: no such option: --sise; did you mean --size?"),
        ("draw -o x --siz 3", "program draw: no such option: --siz; did you mean --size?"),
        ("draw -o x --size 17", "program draw: --size: got '17'; allowed is a whole number, 1 to 16"),
        ("draw -o x --size 1.5", "program draw: --size: got '1.5'; allowed is a whole number, 1 to 16"),
        ("draw -o x --when 1,5", "program draw: --when: got '1,5'; allowed is a number; write 1.5, not 1,5"),
        ("draw -o x --when nan", "program draw: --when: got 'nan'; allowed is a number"),
        ("draw -o x --lasts inf", "program draw: --lasts: got 'inf'; allowed is a number, 0 or more"),
        ("draw -o x --lasts -5", "program draw: --lasts: got '-5'; allowed is a number, 0 or more"),
        ("draw -o x --depth 4", "program draw: --depth: got '4'; allowed is a whole number, 3 or less"),
        ("", "program: no command; allowed is one of draw"),
    ],
)
def test_a_mistake_is_one_sentence_with_status_2(words: str, told: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        PROGRAM.parsed(words.split())
    said = capsys.readouterr().err
    assert ended.value.code == 2 and said.startswith(told + "; `program") and said.count("\n") == 1


def test_help_has_every_option_and_the_version_its_number(capsys: pytest.CaptureFixture[str]) -> None:
    for words in (["--help"], ["draw", "-h"], ["--version"]):
        with pytest.raises(SystemExit) as ended:
            PROGRAM.parsed(words)
        assert ended.value.code == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "draw Draw it." in said and said.endswith("program 1.2")
    for text in ("100 % of it. [required]", "How large. [default: 4]", "When. [default: now]", "--no-checked", "How. [default: auto]"):
        assert text in said, text
