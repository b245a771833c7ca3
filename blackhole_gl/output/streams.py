"""Text on standard output and standard error, whatever characters these can show."""

from __future__ import annotations

import codecs
import io
import os
import sys
import unicodedata

_HANDLER = "blackhole_gl.spelled_out"
# What neither its name nor its decomposition spells out in ASCII.
_SPELLED = {
    "×": "x", "·": "*", "°": " deg", "≤": "<=", "≥": ">=", "≈": "~", "→": "->", "√": "sqrt", "±": "+-",
    "–": "-", "—": "-", "−": "-", "“": '"', "”": '"', "’": "'", "µ": "u", "☉": "_sun",
}


def prepare() -> None:
    """Has no text fail for a character that an encoding does not have.

    Files and pipes get UTF-8, which all that reads them back expects. A terminal keeps its encoding, as does whatever PYTHONIOENCODING is set for,
    and what that lacks is spelled out: kappa for κ, x for ×.
    """
    codecs.register_error(_HANDLER, _spelled_out)
    for stream in (sys.stdout, sys.stderr):
        if not isinstance(stream, io.TextIOWrapper):
            continue  # there is none, or somebody has put another thing in its place
        if stream.isatty() or os.environ.get("PYTHONIOENCODING"):
            stream.reconfigure(errors=_HANDLER)
        else:
            stream.reconfigure(encoding="utf-8", errors=_HANDLER)  # half a character of a file's name can be written in no encoding


def give_up_output() -> None:
    """Nobody reads standard output any more: what is left in it goes nowhere, without a word at the end of the program."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def spelled(text: str) -> str:
    """`text` in ASCII."""
    return "".join(letter if letter.isascii() else _spelled(letter) for letter in text)


def _spelled(letter: str) -> str:
    if letter in _SPELLED:
        return _SPELLED[letter]
    name = unicodedata.name(letter, "").split()
    if name[:1] == ["GREEK"] and "LETTER" in name:
        word = name[name.index("LETTER") + 1].lower()
        return word.capitalize() if "CAPITAL" in name else word
    plain = unicodedata.normalize("NFKD", letter).encode("ascii", "ignore").decode()
    return plain or "?"


def _spelled_out(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return spelled(error.object[error.start : error.end]), error.end
