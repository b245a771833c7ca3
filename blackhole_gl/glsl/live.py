"""What of a composed text is run: what a program only mentions, where its ``#if`` leave it out or in functions that it never calls, should not cost it a
carried number."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

_CONDITIONAL = re.compile(r"^\s*#\s*(if|ifdef|ifndef|elif|else|endif)\b\s*(.*)$")
_DEFINE = re.compile(r"^\s*#\s*define\s+(\w+)[ \t]*(\S*)")
_DEFINED = re.compile(r"\bdefined\s*\(?\s*(\w+)\s*\)?")
_NAME = re.compile(r"\b[A-Za-z_]\w*\b")
_FUNCTION = re.compile(r"^[A-Za-z]\w*(?:\[\w*\])?\s+(\w+)\s*\([^;{]*\)\s*\{")
_LOOSE = re.compile(r"^uniform\s+(float|int|vec2|vec4)\s+(\w+)\s*;")
_ARITHMETIC = (ast.Expression, ast.BoolOp, ast.UnaryOp, ast.BinOp, ast.Compare, ast.Constant, ast.boolop, ast.unaryop, ast.operator, ast.cmpop)


@dataclass(frozen=True)
class Words:
    """Identifiers of a text, less those in line comments.

    Attributes:
        compiled: of all that is compiled: what these name has to be declared.
        run: of these, less what stands in functions that are never called.
        loose: (name, type) of the uniforms of one number or vector each that the text declares outside of any block.
    """

    compiled: frozenset[str]
    run: frozenset[str]
    loose: tuple[tuple[str, str], ...] = ()


def live_words(lines: Iterable[str], switches: Mapping[str, int]) -> Words:
    """The words of a composed text; `switches` are the defines that the host writes.

    Functions are told by their heads at the left margin and their closing braces there; all else counts as run, so that at worst too many words come.
    """
    functions: dict[str, set[str]] = {}
    outside: set[str] = set()
    within: set[str] | None = None
    loose: list[tuple[str, str]] = []
    for _, line in _compiled(lines, switches):
        loose += [line.loose] if line.loose else []
        if line.function and within is None:
            within = functions.setdefault(line.function, set())
        (outside if within is None else within).update(line.names)
        if within is not None and line.ends:
            within = None
    compiled = outside.union(functions, *functions.values())
    run = outside | functions.pop("main", set())
    while called := run & functions.keys():
        run = run.union(*(functions.pop(name) for name in called))
    return Words(frozenset(compiled), frozenset(run), tuple(loose))


def loose_uniform(line: str) -> tuple[str, str] | None:
    """(name, type) where a line declares a uniform of one number or vector outside of any block."""
    return _read(line).loose


def names(line: str) -> frozenset[str]:
    """The identifiers of a line, less those in its line comment."""
    return _read(line).names


class _Line(NamedTuple):  # thousands are made at a start, in a third of the time that a frozen dataclass takes
    """A line as it is read.

    Attributes:
        code: its text without a line comment.
        conditional: (word, condition) of an ``#if`` and its like.
        define: (name, value) of a ``#define``.
        names: its identifiers.
        function: that whose head it is, or empty.
        ends: a function that is open ends here.
        loose: what `loose_uniform` answers.
    """

    code: str
    conditional: tuple[str, str] | None
    define: tuple[str, str] | None
    names: frozenset[str]
    function: str
    ends: bool
    loose: tuple[str, str] | None


@lru_cache(maxsize=1 << 14)
def _read(line: str) -> _Line:
    """`line`, read once: programs share most of their lines."""
    code = line.partition("//")[0]
    directive = code.lstrip().startswith("#")
    conditional, define = (_CONDITIONAL.match(code), _DEFINE.match(code)) if directive else (None, None)
    head = _FUNCTION.match(code) if code[:1].isalpha() else None
    uniform = _LOOSE.match(code) if code.startswith("uniform") else None
    return _Line(
        code,
        (conditional[1], conditional[2]) if conditional else None,
        (define[1], define[2]) if define else None,
        frozenset(_NAME.findall(code)),
        head[1] if head else "",
        code.startswith("}") or head is not None and code.count("{") == code.count("}"),
        (uniform[2], uniform[1]) if uniform else None,
    )


@dataclass
class _Branch:
    runs: bool  # this branch
    ran: bool  # one before it, so that no later one does


def live_lines(lines: Iterable[str], switches: Mapping[str, int]) -> Iterator[str]:
    """The lines that are compiled, as `numbered_live_lines` has them."""
    return (line.code for _, line in _compiled(lines, switches))


def numbered_live_lines(lines: Iterable[str], switches: Mapping[str, int]) -> Iterator[tuple[int, str]]:
    """The lines that are compiled, without line comments, each with its place in `lines`, from 0; `switches` are the defines that the host writes.

    A condition that cannot be worked out here (a macro with arguments) counts as true and so does its opposite: more lines stand then than run.
    """
    return ((number, line.code) for number, line in _compiled(lines, switches))


def _compiled(lines: Iterable[str], switches: Mapping[str, int]) -> Iterator[tuple[int, _Line]]:
    known: dict[str, str] = {name: str(value) for name, value in switches.items()}
    branches: list[_Branch] = []
    runs = True
    for number, line in enumerate(map(_read, lines)):
        if line.conditional:
            _follow(branches, *line.conditional, known)
            runs = all(branch.runs for branch in branches)
        elif runs:
            if line.define:
                known[line.define[0]] = line.define[1]
            yield number, line


def _follow(branches: list[_Branch], word: str, condition: str, known: Mapping[str, str]) -> None:
    if word in ("if", "ifdef", "ifndef"):
        asked = condition if word == "if" else f"{'' if word == 'ifdef' else '!'}defined({condition})"
        truth = _truth(asked, known)
        branches.append(_Branch(truth is not False, truth is True))
    elif word == "endif" and branches:
        branches.pop()
    elif branches:
        last = branches[-1]
        truth = True if word == "else" else _truth(condition, known)
        last.runs = not last.ran and truth is not False
        last.ran = last.ran or truth is True


def _truth(condition: str, known: Mapping[str, str]) -> bool | None:
    """Whether a condition holds; None where that cannot be said."""
    text = _DEFINED.sub(lambda match: str(int(match[1] in known)), condition)
    return _value(_NAME.sub(lambda match: known.get(match[0], "0"), text))


@lru_cache(maxsize=256)
def _value(text: str) -> bool | None:
    """Whether an expression of numbers is other than 0; None where it is no such expression."""
    try:
        parsed = ast.parse(re.sub(r"!(?!=)", " not ", text.replace("&&", " and ").replace("||", " or ")).strip(), mode="eval")
        arithmetic = all(isinstance(node, _ARITHMETIC) for node in ast.walk(parsed))
        return bool(eval(compile(parsed, "", "eval"))) if arithmetic else None
    except (SyntaxError, ArithmeticError):
        return None
