"""Commands declared as functions: a parameter's annotation says how it is typed, its default what holds when it is not.

    def render(size: Annotated[str, Option(help="Width × height.")] = "1280x720") -> None:
        '''Render a picture.'''

    program = Program("blackhole-gl", "Black holes.", "1.0", (render,))
    command, values = program.parsed(["render", "--size", "64x36"])

Only the command that is asked for has its annotations read. Over `argparse`, which is there: packages that do this took a tenth of the time of a first picture.
"""

from __future__ import annotations

import argparse
import inspect
import math
import os
import types
import typing
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from .text_files import decimal_comma

Command = Callable[..., None]


@dataclass(frozen=True)
class Argument:
    """A word, or words, without a name."""

    help: str
    metavar: str | None = None


class Option:
    """A named value; a switch where its type is bool.

    Args:
        names: as typed; ``--`` and the parameter's name when there are none.
        help: a sentence.
        metavar: what stands for its value in the help.
        default: how the default is told where that is not the value itself.
        least, most: bounds of a number.
        variable: the environment variable that holds the default.
    """

    def __init__(
        self,
        *names: str,
        help: str,
        metavar: str | None = None,
        default: str | None = None,
        least: float | None = None,
        most: float | None = None,
        variable: str | None = None,
    ):
        self.names, self.help, self.metavar, self.default, self.least, self.most, self.variable = names, help, metavar, default, least, most, variable


@dataclass(frozen=True)
class Program:
    """Commands under one name.

    Raises:
        SystemExit: a mistake, told in one sentence (status 2), or help or version was asked for (0).
    """

    name: str
    summary: str
    version: str
    commands: tuple[Command, ...]

    def parsed(self, words: Sequence[str]) -> tuple[Command, dict[str, object]]:
        """The command that `words` begin with, and its parameters by the rest."""
        named = {command.__name__: command for command in self.commands}
        if words and words[0] in named:
            command = named[words[0]]
            return command, _values(_parser(f"{self.name} {words[0]}", command), words[1:])
        parser = _Parser(self.name, f"{self.summary}\n\ncommands:\n{self._listing()}")
        parser.add_argument("--version", action="version", version=f"{self.name} {self.version}", help="Say which version this is.")
        parser.parse_args(words)
        parser.error(f"no command; allowed is one of {', '.join(named)}")

    def _listing(self) -> str:
        return "\n".join(f"  {command.__name__:14}{_sentences(command)[0]}" for command in self.commands)


class _Parser(argparse.ArgumentParser):
    """Mistakes are one sentence, with the line that says what there is."""

    def __init__(self, name: str, text: str):
        super().__init__(name, description=text.replace("%", "%%"), formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)

    def error(self, message: str) -> typing.NoReturn:
        self.exit(2, f"{self.prog}: {message.removeprefix('argument ')}; `{self.prog} -h` lists what there is\n")


def _parser(name: str, command: Command) -> _Parser:
    parser = _Parser(name, "\n".join(_sentences(command)))
    hints = typing.get_type_hints(command, include_extras=True)
    for parameter in inspect.signature(command).parameters.values():
        kind, declared = typing.get_args(hints[parameter.name])[:2]
        if isinstance(declared, Argument):
            _add_argument(parser, parameter.name, _plain(kind), declared)
        else:
            _add_option(parser, parameter, _plain(kind), declared)
    return parser


def _add_argument(parser: _Parser, name: str, kind: object, declared: Argument) -> None:
    many = typing.get_origin(kind) is list
    parser.add_argument(name, nargs="*" if many else "?", metavar=declared.metavar or name.upper(), help=declared.help.replace("%", "%%"))


def _add_option(parser: _Parser, parameter: inspect.Parameter, kind: object, declared: Option) -> None:
    names = declared.names or (f"--{parameter.name.strip('_')}",)
    given = parameter.default if declared.variable is None else os.environ.get(declared.variable, parameter.default)
    required = parameter.default is parameter.empty
    told = "required" if required else declared.default or ("" if given is None or isinstance(given, bool) else f"{given}")
    text = f"{declared.help} [{told if required else f'default: {told}'}]" if told else declared.help
    shared: dict[str, typing.Any] = {"dest": parameter.name, "default": None if required else given, "help": text.replace("%", "%%")}
    if kind is bool:
        parser.add_argument(*names, action=argparse.BooleanOptionalAction if given else "store_true", **shared)
    elif typing.get_origin(kind) is list:
        parser.add_argument(*names, action="append", metavar=declared.metavar or "TEXT", **shared)
    else:
        read = _Reader(typing.cast("type", kind), declared.least, declared.most)
        parser.add_argument(*names, type=read, metavar=declared.metavar or read.name, required=required, **shared)


def _values(parser: _Parser, words: Sequence[str]) -> dict[str, object]:
    """Options may stand before, between and behind words without a name."""
    found, unknown = parser.parse_known_intermixed_args(words)
    if unknown:
        import difflib  # only in a mistake

        known = [name for action in parser._actions for name in action.option_strings]
        close = difflib.get_close_matches(unknown[0].split("=")[0], known, 1)
        parser.error(f"no such option: {unknown[0]}" + (f"; did you mean {close[0]}?" if close else ""))
    return vars(found)


@dataclass(frozen=True)
class _Reader:
    """Reads a value of one type within bounds."""

    kind: type
    least: float | None
    most: float | None

    @property
    def name(self) -> str:
        return {str: "TEXT", Path: "PATH", int: "INTEGER", float: "NUMBER"}[self.kind]

    def __call__(self, text: str) -> object:
        try:
            value = self.kind(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"got {text!r}; allowed is {self._allowed}{decimal_comma(text)}") from None
        outside = (self.least is not None and value < self.least) or (self.most is not None and value > self.most)
        if outside or self.kind is float and not math.isfinite(value):
            raise argparse.ArgumentTypeError(f"got {text!r}; allowed is {self._allowed}")
        return value

    @property
    def _allowed(self) -> str:
        kind = {int: "a whole number", float: "a number"}[self.kind]
        if self.least is None and self.most is None:
            return kind
        if self.least is not None and self.most is not None:
            return f"{kind}, {self.least:g} to {self.most:g}"
        return f"{kind}, {self.least:g} or more" if self.most is None else f"{kind}, {self.most:g} or less"


def _plain(kind: object) -> object:
    """The type, or the one beside None."""
    if isinstance(kind, types.UnionType):
        return next(part for part in typing.get_args(kind) if part is not type(None))
    return kind


def _sentences(command: Command) -> list[str]:
    return inspect.cleandoc(command.__doc__ or "").splitlines()
