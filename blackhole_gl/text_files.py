"""Text files as editors of all systems write them."""

from __future__ import annotations

import codecs
import re
from pathlib import Path

_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


class TextError(ValueError):
    """A file that is no text; the message says what is allowed, and leaves the file's name to those who know what it is for."""


def read_text(path: Path) -> str:
    """The text of the file at `path`, lines ended by a line feed: UTF-8, with a byte order mark or without, or UTF-16 with one.

    Raises:
        TextError: it is neither.
        OSError: it cannot be read.
    """
    data = path.read_bytes()
    try:
        text = data.decode("utf-16") if data.startswith(_UTF_16) else data.removeprefix(codecs.BOM_UTF8).decode("utf-8")
    except UnicodeDecodeError as error:
        raise TextError(f"not UTF-8 text (byte {error.start}); save it as UTF-8") from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def decimal_comma(text: str) -> str:
    """A hint, to be put behind a message, where `text` is a number with a decimal comma; empty where it is not."""
    number = text.strip()
    if not re.fullmatch(r"[+-]?\d+,\d+([eE][+-]?\d+)?", number):
        return ""
    return f"; write {number.replace(',', '.')}, not {number}"
