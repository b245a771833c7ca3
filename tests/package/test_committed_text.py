"""What is committed works anywhere, for anybody: no path of somebody's machine, no address of a package index, no source that a reader cannot find."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = (".ci", "assets", "blackhole_gl", "docs", "examples", "presets", "shaders", "studies", "tests", "tools")
BINARY = {".png", ".npy", ".npz", ".exr", ".jpg", ".pyc", ".mp4", ".ply"}

# Each is written in two pieces, so that this file does not find itself.
MACHINE_PATH = re.compile("|".join(["/" + r"(?:work|home|root|Users|opt)/[A-Za-z.]", r"[A-Z]:\\" + r"Users\\"]))
PACKAGE_INDEX = re.compile(
    "|".join(["pypi" + r"\.org", "python" + r"hosted\.org", "deb" + r"\.debian", "registry" + r"\.npmjs", "index" + "-url", "find" + "-links", "--hash" + "="])
)
# What a reader cannot look up. S0 to S4 are short names of works that docs/sources.md names in full.
NOT_A_SOURCE = re.compile("|".join([r"\bSPEC" + r"\b", r"\b[Ii]ssue" + r" [0-9]", r"the specif" + r"ication\b"]))
SHORT_NAME = re.compile(r"\bS[0-4]" + r"\b")
PIN = re.compile(r"[a-z0-9]+(?:-[a-z0-9]+)*==[0-9][0-9a-z.]*")


def committed_files() -> Iterator[Path]:
    """The text files that travel with the project. Not asked of git: an unpacked archive has none."""
    candidates = [path for path in ROOT.iterdir() if path.is_file() and path.suffix in {"", ".md", ".toml", ".txt", ".cfg", ".lock"}]
    for folder in FOLDERS:
        candidates += [path for path in (ROOT / folder).rglob("*") if path.is_file()]
    for path in sorted(candidates):
        relative = path.relative_to(ROOT)
        if path.suffix not in BINARY and "__pycache__" not in relative.parts and relative.parts[:2] != ("tests", "output"):
            if path.name != ".git":  # a work tree's pointer file
                yield path


def lines_with(pattern: re.Pattern[str]) -> list[str]:
    return [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
        for path in committed_files()
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if pattern.search(line)
    ]


def test_no_machine_paths() -> None:
    assert not lines_with(MACHINE_PATH)


def test_no_package_index() -> None:
    assert not lines_with(PACKAGE_INDEX)


def test_sources_are_such_as_a_reader_can_find() -> None:
    assert not lines_with(NOT_A_SOURCE)


def test_works_are_named_in_full_outside_the_list_of_sources() -> None:
    named = [line for line in lines_with(SHORT_NAME) if not line.startswith(("docs/sources.md:", "tests/package/test_committed_text.py:"))]
    assert not named


def test_pins_are_exact_bare_and_sorted() -> None:
    pins = [line for line in (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    assert [pin for pin in pins if not PIN.fullmatch(pin)] == []
    names = [pin.partition("==")[0] for pin in pins]
    assert names == sorted(set(names))
