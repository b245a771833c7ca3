"""What of a composed text is run: what a program only mentions, where its ``#if`` leave it out or in functions that it never calls, should not cost it a
carried number."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

_CONDITIONAL = re.compile(r"^\s*#\s*(if|ifdef|ifndef|elif|else|endif)\b\s*(.*)$")
_DEFINE = re.compile(r"^\s*#\s*define\s+(\w+)[ \t]*(\S*)")
_DEFINED = re.compile(r"\bdefined\s*\(?\s*(\w+)\s*\)?")
_NAME = re.compile(r"\b[A-Za-z_]\w*\b")
_FUNCTION = re.compile(r"^[A-Za-z]\w*(?:\[\w*\])?\s+(\w+)\s*\([^;{]*\)\s*\{")
_ARITHMETIC = (ast.Expression, ast.BoolOp, ast.UnaryOp, ast.BinOp, ast.Compare, ast.Constant, ast.boolop, ast.unaryop, ast.operator, ast.cmpop)


@dataclass(frozen=True)
class Words:
    """Identifiers of a text, less those in line comments.

    Attributes:
        compiled: of all that is compiled: what these name has to be declared.
        run: of these, less what stands in functions that are never called.
    """

    compiled: frozenset[str]
    run: frozenset[str]


def live_words(lines: Iterable[str], switches: Mapping[str, int]) -> Words:
    """The words of a composed text; `switches` are the defines that the host writes.

    Functions are told by their heads at the left margin and their closing braces there; all else counts as run, so that at worst too many words come.
    """
    functions: dict[str, set[str]] = {}
    outside: set[str] = set()
    within: set[str] | None = None
    for line in live_lines(lines, switches):
        head = _FUNCTION.match(line)
        if head and within is None:
            within = functions.setdefault(head[1], set())
        (outside if within is None else within).update(_NAME.findall(line))
        if within is not None and (line.startswith("}") or head and line.count("{") == line.count("}")):
            within = None
    compiled = outside.union(functions, *functions.values())
    run = outside | functions.pop("main", set())
    while called := run & functions.keys():
        run = run.union(*(functions.pop(name) for name in called))
    return Words(frozenset(compiled), frozenset(run))


@dataclass
class _Branch:
    runs: bool  # this branch
    ran: bool  # one before it, so that no later one does


def live_lines(lines: Iterable[str], switches: Mapping[str, int]) -> Iterator[str]:
    """The lines that are compiled, as `numbered_live_lines` has them."""
    return (text for _, text in numbered_live_lines(lines, switches))


def numbered_live_lines(lines: Iterable[str], switches: Mapping[str, int]) -> Iterator[tuple[int, str]]:
    """The lines that are compiled, without line comments, each with its place in `lines`, from 0; `switches` are the defines that the host writes.

    A condition that cannot be worked out here (a macro with arguments) counts as true and so does its opposite: more lines stand then than run.
    """
    known: dict[str, str] = {name: str(value) for name, value in switches.items()}
    branches: list[_Branch] = []
    for number, line in enumerate(lines):
        text = line.partition("//")[0]
        conditional = _CONDITIONAL.match(text)
        if conditional:
            _follow(branches, conditional[1], conditional[2], known)
        elif all(branch.runs for branch in branches):
            define = _DEFINE.match(text)
            if define:
                known[define[1]] = define[2]
            yield number, text


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
