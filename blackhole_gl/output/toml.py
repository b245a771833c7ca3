"""Values as TOML text (TOML 1.0): Python reads TOML and does not write it."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def line(name: str, value: Any, comment: str = "") -> str:
    """``name = value`` and a line's end.

    Args:
        value: text, a bool, a number, or a list or mapping of such.
    """
    return f"{key(name)} = {literal(value)}{f' # {comment}' if comment else ''}\n"


def key(name: str) -> str:
    """One part of a key, in quotes where it has to be."""
    return name if _BARE.fullmatch(name) else literal(name)


def literal(value: Any) -> str:
    """`value` as it stands behind an equals sign."""
    match value:
        case bool():
            return "true" if value else "false"
        case str():
            return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case int() | float():
            return repr(value)
        case Mapping():
            return "{" + ", ".join(f"{key(name)} = {literal(part)}" for name, part in value.items()) + "}"
        case _:
            return "[" + ", ".join(literal(part) for part in value) + "]"
