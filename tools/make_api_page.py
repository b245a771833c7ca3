"""Writes docs/python_reference.md, or the path given, from the docstrings of `blackhole_gl.api`: `make api-page`."""

from __future__ import annotations

import inspect
import re
import sys
from pathlib import Path

from blackhole_gl import api

ROOT = Path(__file__).resolve().parents[1]
SECTION = re.compile(r"^(Args|Attributes|Returns|Raises):$")


def main() -> None:
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "python_reference.md"
    target.write_text(page(), encoding="utf-8")


def page() -> str:
    """The whole page."""
    offered = [(name, getattr(api, name)) for name in api.__all__]
    head = f"# What `import blackhole_gl as bh` offers\n\n{inspect.getdoc(api)}\n\nMade by `make api-page` from the docstrings; [with examples](python.md).\n"
    functions = [entry(f"bh.{name}", made) for name, made in offered if inspect.isfunction(made)]
    classes = [class_entry(name, made) for name, made in offered if inspect.isclass(made)]
    return "\n".join([head, "## Functions\n", *functions, "## Classes\n", *classes]).rstrip() + "\n"


def entry(name: str, made: object) -> str:
    """A function's or method's heading, signature and text."""
    return f"### `{name}`\n\n```python\n{name}{signature(made)}\n```\n\n{body(made)}\n"


def class_entry(name: str, made: type) -> str:
    """A class with those of its methods that are its own."""
    own = [(key, value) for key, value in vars(made).items() if inspect.isfunction(value) and not key.startswith("_") and value.__doc__]
    methods = [f"- `{key}{signature(value)}`: {first_line(value)}" for key, value in own]
    return "\n".join([f"### `bh.{name}`\n", body(made), *([""] if methods else []), *methods, ""])


def signature(made: object) -> str:
    """Without what every method has, and with types as people write them."""
    found = inspect.signature(made)
    shown = found.replace(parameters=[item for item in found.parameters.values() if item.name != "self"])
    return str(shown).replace("'", "")


def first_line(made: object) -> str:
    return (inspect.getdoc(made) or "").split("\n\n")[0].replace("\n", " ")


def body(made: object) -> str:
    """A docstring as Markdown: its sections as lists."""
    lines = []
    for line in (inspect.getdoc(made) or "").splitlines():
        if SECTION.match(line):
            lines.append(f"**{line[:-1]}**\n")
        elif line.startswith("    ") and not line.startswith("     "):
            lines.append(f"- {line.strip()}")
        elif line.startswith("     "):
            lines[-1] += " " + line.strip()
        else:
            lines.append(line)
    return "\n".join(lines).strip().replace("``", "`")


if __name__ == "__main__":
    main()
