"""Shader text from files: includes, slots and switches, with a map from every output line back to its file and line.

Directives, each alone on its line and never acted on inside a comment:

``#include "common/noise.glsl"``      the file (path below a shader folder), the first time it is asked for
``#slot ray_model``                   the file of the plug-in chosen for a slot
``#slots disk_layer``                 the files of all plug-ins chosen for a slot
``#each disk_layer : f_$key(x);``     the line once for every plug-in chosen for a slot, ``$key`` and ``$KEY`` replaced
``#blocks``                           the numbers that the host gives, those that the compiled text mentions;
                                      a loose uniform among them is defined where it was declared
``#defines``                          the switches that the text mentions
``#instances``                        what reads the tables of the scene's things and media

moderngl's own ``ctx.includes`` is not recursive, has no once-guard and loses the line numbers.
"""

from __future__ import annotations

import os
import re
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TypeAlias

from ..text_files import TextError, read_text
from .live import Words, live_words, loose_uniform, names, numbered_live_lines

_DIRECTIVE = re.compile(r"^\s*#(include|slots|slot|each|blocks|defines|instances)\b\s*(.*)$")
_CALLED = re.compile(r"\w*\$key\w*(?=\()")  # functions of a plug-in, in a line for each
_OF_SLOT = {  # functions of a slot of one plug-in, by their names, where they are called
    "ray_model": re.compile(r"\b(?:trace_ray|(?:ray|state)_[a-z]\w*)(?=\()"),
    "integrator": re.compile(r"\bintegrator_[a-z]\w*(?=\()"),
    "step_control": re.compile(r"\b(?:step_[a-z]\w*|adapted_step)(?=\()"),
    "sky": re.compile(r"\bsky_[a-z]\w*(?=\()"),
}
_GIVEN = re.compile(r"^\s*(?:#\s*define\s+|(?!return\b|else\b)(?:\w+\s+)+)(\w+)\s*\(", re.MULTILINE)  # functions, at their heads
_LOG_LINE = (
    re.compile(r"^\d+:(?P<line>\d+)\(\d+\): (?P<text>.*)$"),  # Mesa
    re.compile(r"^\d+\((?P<line>\d+)\) : (?P<text>.*)$"),  # NVIDIA
    re.compile(r"^(?P<kind>ERROR|WARNING): \d+:(?P<line>\d+): (?P<text>.*)$"),  # AMD, Intel, Apple
)

_GIVEN_BY_HOST = re.compile(r"#(defines|blocks|instances)")
_MOST_KEPT = 64

Line: TypeAlias = tuple[str, tuple[str, int]]
"""A line's text, and the (file, 1-based line) that it comes from."""

_Chosen: TypeAlias = tuple[tuple[str, tuple[str, ...]], ...]
_Switches: TypeAlias = tuple[tuple[str, int], ...]
_Changed: TypeAlias = tuple[int, int] | None


class ShaderError(Exception):
    """A mistake in shader text.

    Attributes:
        message: what is wrong.
        file: path below ``shaders/``, or the whole path of a file of the user's; empty when no place is known.
        line: 1-based line in that file; 0 when no place is known.
    """

    def __init__(self, message: str, file: str = "", line: int = 0):
        place = f"{file}:{line}: " if file else ""
        super().__init__(place + message)
        self.message, self.file, self.line = message, file, line


@dataclass(frozen=True)
class Composed:
    """Composed shader text.

    Attributes:
        text: GLSL for the driver.
        places: for each line of `text`, its (file, 1-based line).
        defines: the switches that the text mentions, with their values.
        words: the identifiers of what is compiled and run.
    """

    text: str
    places: tuple[tuple[str, int], ...]
    defines: Mapping[str, int]
    words: Words

    def explain(self, log: str) -> ShaderError:
        """The driver's compile `log` as an error that names the author's file and line (the first with a place)."""
        rewritten, first = [], None
        for line in log.splitlines():
            match = next((m for m in (pattern.match(line.strip()) for pattern in _LOG_LINE) if m), None)
            if match is None:
                continue
            file, number = self.place(int(match["line"]))
            rewritten.append(f"{file}:{number}: {match['text']}")
            if first is None and "warning" not in line.lower():
                first = (match["text"], file, number)
        if first is None:
            return ShaderError(log.strip())
        rest = [line for line in rewritten if line != f"{first[1]}:{first[2]}: {first[0]}"]
        return ShaderError("\n".join([first[0], *rest]), first[1], first[2])

    def place(self, line: int) -> tuple[str, int]:
        """(file, line) of the 1-based output `line`."""
        return self.places[line - 1] if 0 < line <= len(self.places) else ("", 0)


def compose(
    roots: Sequence[Path],
    path: str,
    *,
    chosen: Mapping[str, Sequence[str]] | None = None,
    switches: Mapping[str, int] | None = None,
    blocks: Callable[[Words], str] = lambda words: "",
    instances: str = "",
) -> Composed:
    """The text of the file at `path` with all directives carried out.

    Args:
        roots: the shader folders: the shipped one, then the user's. A file is taken from the first that has it.
        path: path below one of them.
        chosen: slot → paths of the chosen plug-ins, below one of them.
        switches: name → value of every possible ``#define``; only those mentioned are written.
        blocks: gives the GLSL that replaces ``#blocks`` from the identifiers of the text.
        instances: the GLSL that replaces ``#instances``.

    Raises:
        ShaderError: a file or a slot is missing, a directive is malformed, or a plug-in lacks a function of its slot that is called.
    """
    gathered = _gathered(tuple(roots), path, tuple((slot, tuple(paths)) for slot, paths in (chosen or {}).items()))
    used = {name: value for name, value in (switches or {}).items() if name in gathered.mentioned}
    words = gathered.words(tuple(used.items()))
    texts: list[str] = []
    places: list[tuple[str, int]] = []
    moved: dict[str, str] = {}  # loose uniforms and what stands where they were declared
    for stretch in gathered.stretches:
        texts += _with_moved(stretch.texts, moved) if moved else stretch.texts
        places += stretch.places
        match stretch.ends:
            case "defines":
                given = [f"#define {name} {value}" for name, value in used.items()]
            case "blocks":
                given = blocks(words).splitlines()
                moved = {name: line for name, _ in words.loose for line in given if line.startswith(f"#define {name} ")}
                given = [line for line in given if line not in moved.values()]
            case "instances":
                given = instances.splitlines()
            case _:
                continue
        texts += given
        places += [stretch.end] * len(given)
    if gathered.asked_of_users:
        gathered.refuse_missing(texts, places, used)
    return Composed("\n".join(texts) + "\n", tuple(places), used, words)


def _with_moved(texts: Iterable[str], moved: Mapping[str, str]) -> Iterator[str]:
    """`texts` with the declarations of `moved` uniforms replaced."""
    for text in texts:
        loose = loose_uniform(text) if text.startswith("uniform") else None
        yield moved.get(loose[0], text) if loose else text


@dataclass(frozen=True)
class _Stretch:
    """Lines and their places, up to a directive for what the host gives, at `end`; the last has none, and its `ends` is empty."""

    texts: tuple[str, ...]
    places: tuple[tuple[str, int], ...]
    ends: str = ""
    end: tuple[str, int] = ("", 0)


class _Gathered:
    """A file with all that it brings in.

    Attributes:
        files: what was read, and when it had been changed.
        mentioned: the identifiers of all lines.
        stretches: the lines.
        asked_of_users: slot → (path, name in errors) of the plug-ins that are the user's: ours are tested, and looking takes milliseconds.
    """

    def __init__(self, roots: tuple[Path, ...], path: str, chosen: _Chosen):
        reader = _Reader(roots, dict(chosen))
        lines = reader.lines(path)
        self.files, self.mentioned = reader.files, reader.mentioned
        self.stretches = tuple(_stretches(lines))
        self.asked_of_users = reader.asked_of_users()
        self._called = reader.called
        self._lines = [text for text, _ in lines]
        self._words: dict[_Switches, Words] = {}

    @property
    def is_current(self) -> bool:
        """Whether its files are as they were."""
        return all(_changed(file) == changed for file, changed in self.files.items())

    def words(self, switches: _Switches) -> Words:
        """The identifiers of what is compiled and run. Kept, as programs differ in switches of which few change any."""
        if switches not in self._words:
            self._words[switches] = live_words(self._lines, dict(switches))
        return self._words[switches]

    def refuse_missing(self, texts: Sequence[str], places: Sequence[tuple[str, int]], switches: Mapping[str, int]) -> None:
        """Refuses the composed lines where a plug-in of the user's lacks functions that others call in it."""
        users = {path: shown for plug_ins in self.asked_of_users.values() for path, shown in plug_ins}
        compiled = [(text, places[number][0]) for number, text in numbered_live_lines(texts, switches)]
        whole = "\n".join(text for text, _ in compiled)
        given = set(_GIVEN.findall(whole))
        asked = {function: plug_in for function, plug_in in self._called.items() if plug_in in users and function in whole}  # else its line is left out
        for slot, functions in _OF_SLOT.items():
            for path, own in self.asked_of_users.get(slot, ()):
                asked |= {name: path for text, file in compiled if file != own for name in functions.findall(text)}
        for path in dict.fromkeys(asked.values()):
            missing = [name for name, of in asked.items() if of == path and name not in given]
            if missing:
                what = f"is no function {missing[0]}" if len(missing) == 1 else f"are no functions {', '.join(missing)}"
                raise ShaderError(f"there {what}, which this plug-in has to have", users[path], 1)


_KEPT: OrderedDict[tuple[tuple[Path, ...], str, _Chosen], _Gathered] = OrderedDict()


def _gathered(roots: tuple[Path, ...], path: str, chosen: _Chosen) -> _Gathered:
    """The file at `path` with all that it brings in: kept while its files are as they were, as many programs differ in switches alone."""
    key = roots, path, chosen
    found = _KEPT.get(key)
    if found is None or not found.is_current:
        found = _KEPT[key] = _Gathered(roots, path, chosen)
        if len(_KEPT) > _MOST_KEPT:
            _KEPT.popitem(last=False)
    return found


def _stretches(lines: Sequence[Line]) -> Iterator[_Stretch]:
    first = 0
    for number, (text, place) in enumerate(lines):
        if "#" in text and (directive := _GIVEN_BY_HOST.fullmatch(text.strip())):
            yield _Stretch(*_texts_and_places(lines[first:number]), directive[1], place)
            first = number + 1
    yield _Stretch(*_texts_and_places(lines[first:]))


def _texts_and_places(lines: Sequence[Line]) -> tuple[tuple[str, ...], tuple[tuple[str, int], ...]]:
    return tuple(text for text, _ in lines), tuple(place for _, place in lines)


class _Reader:
    """Carries out the directives that bring in other files.

    Attributes:
        mentioned: the identifiers of all lines so far.
        files: what was read so far → when it had been changed.
        called: in lines for each: function → the plug-in that has to have it, by its file.
    """

    def __init__(self, roots: Sequence[Path], chosen: Mapping[str, Sequence[str]]):
        self._roots, self._chosen = roots, chosen
        self.mentioned: set[str] = set()
        self.files: dict[str, _Changed] = {}
        self.called: dict[str, str] = {}
        self._seen: set[str] = set()

    def lines(self, path: str, asked_at: tuple[str, int] = ("", 0)) -> list[Line]:
        """Each line of the file at `path`, and of what it brings in, with its place."""
        if path in self._seen:
            return []
        self._seen.add(path)
        root, shown = self._found(path)
        lines: list[Line] = []
        for part in self._parts(os.path.join(root, path), path, shown, asked_at):
            lines += part.lines
            self.mentioned |= part.names
            if part.directive == "include":
                name = re.fullmatch(r'"([^"]+)"\s*(//.*)?', part.rest)
                if name is None:
                    raise ShaderError('write #include "path below shaders/"', *part.place)
                lines += self.lines(name[1], part.place)
            elif part.directive:
                lines += self._slot(part.directive, part.rest, part.place)
        return lines

    def asked_of_users(self) -> dict[str, list[tuple[str, str]]]:
        """Slot → (path, name in errors) of the plug-ins chosen for it that are not in the first root."""
        found = {slot: [(path, self._found(path)) for path in paths] for slot, paths in self._chosen.items()}
        users = {slot: [(path, shown) for path, (root, shown) in of if root != self._roots[0]] for slot, of in found.items()}
        return {slot: of for slot, of in users.items() if of}

    def _parts(self, file: str, path: str, shown: str, asked_at: tuple[str, int]) -> tuple[_Part, ...]:
        try:
            self.files[file] = changed = _changed(file)
            return _parts(_read(file, changed), shown)
        except OSError:
            raise ShaderError(f"there is no shader file {path}", *asked_at) from None
        except TextError as error:
            raise ShaderError(f"{shown} is {error}", *asked_at) from None

    def _slot(self, directive: str, rest: str, place: tuple[str, int]) -> list[Line]:
        slot, _, template = rest.partition(":")
        if slot.strip() not in self._chosen:
            raise ShaderError(f"there is no slot {slot.strip()!r} here", *place)
        lines: list[Line] = []
        for plug_in in self._chosen[slot.strip()]:
            if directive != "each":
                lines += self.lines(plug_in, place)
                continue
            key = Path(plug_in).stem
            self.called |= {name.replace("$key", key): plug_in for name in _CALLED.findall(template)}
            text = template.strip().replace("$key", key).replace("$KEY", key.upper())
            self.mentioned |= names(text)
            lines.append((text, place))
        return lines

    def _found(self, path: str) -> tuple[Path, str]:
        """The root of the file at `path`, and what errors call the file."""
        root = next((root for root in self._roots if os.path.isfile(os.path.join(root, path))), self._roots[0])
        return root, path if root == self._roots[0] else str(root / path)


@dataclass(frozen=True)
class _Part:
    """Lines of a file up to a directive that brings in others; the last part of a file has none, and its `directive` is empty."""

    lines: tuple[Line, ...]
    directive: str = ""
    rest: str = ""
    place: tuple[str, int] = ("", 0)

    @cached_property
    def names(self) -> frozenset[str]:
        """The identifiers of its lines."""
        return frozenset[str]().union(*(names(text) for text, _ in self.lines))


@lru_cache(maxsize=256)
def _parts(source: str, shown: str) -> tuple[_Part, ...]:
    """The text `source` of the file that errors call `shown`. Kept, as programs share most of their files."""
    parts: list[_Part] = []
    lines: list[Line] = []
    in_comment = False
    for number, text in enumerate(source.splitlines(), start=1):
        match = None if in_comment or "#" not in text else _DIRECTIVE.match(text)
        in_comment = _comment_open(text, in_comment)
        if match is None or match[1] in ("defines", "blocks", "instances"):
            lines.append((text, (shown, number)))
        else:
            parts.append(_Part(tuple(lines), match[1], match[2].strip(), (shown, number)))
            lines = []
    return *parts, _Part(tuple(lines))


def _changed(file: str) -> _Changed:
    """When `file` was last changed, and its size; None where it is not there."""
    try:
        seen = os.stat(file)
        return seen.st_mtime_ns, seen.st_size
    except OSError:
        return None


@lru_cache(maxsize=256)
def _read(file: str, changed: _Changed) -> str:
    """The text of `file`, as it is since it was `changed`: programs share most of their files."""
    return read_text(Path(file))


def _comment_open(text: str, is_open: bool) -> bool:
    """Whether a block comment is open after `text`."""
    while True:
        if is_open:
            end = text.find("*/")
            if end < 0:
                return True
            text, is_open = text[end + 2 :], False
        elif "/*" not in text:
            return False
        else:
            start, line_comment = text.find("/*"), text.find("//")
            if 0 <= line_comment < start:
                return False
            text, is_open = text[start + 2 :], True
