"""The documents' links lead somewhere, and the site made of them is whole without a network."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CONFIGURATION = ROOT / "docs" / "site" / "conf.py"
ELSEWHERE = [ROOT / "assets/SOURCES.md", *(ROOT / name / "README.md" for name in ("examples", "shaders"))]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *ELSEWHERE])
LINK = re.compile(r"\]\(([^()\s]+)\)")


def text_of(page: Path) -> str:
    """The page without its blocks and pieces of code, in which brackets are no links."""
    return re.sub(r"```.*?```|``[^`]*``|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)


@cache
def anchors(page: Path) -> frozenset[str]:
    """What links to headings of `page` are called: lower case, without signs, words joined by hyphens."""
    headings = re.findall(r"^#{1,6} +(.+?) *#*$", re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL), flags=re.MULTILINE)
    return frozenset(re.sub(r"[^\w\- ]", "", re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)).lower().replace(" ", "-") for heading in headings)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_link_of_the_documents_leads_somewhere(page: Path) -> None:
    broken = []
    for link in LINK.findall(text_of(page)):
        if re.match(r"[a-z]+:", link):
            continue
        name, _, anchor = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        if not target.is_file() or (anchor and anchor not in anchors(target)):
            broken.append(link)
    assert broken == [], "folders have no page of their own: a file is needed"


def test_the_site_has_every_page() -> None:
    (pages,) = (node.value for node in ast.parse(CONFIGURATION.read_text()).body if isinstance(node, ast.Assign) and node.targets[0].id == "_PAGES")
    listed = {name for names in ast.literal_eval(pages).values() for name in names} | {"README"}
    assert listed == {page.relative_to(ROOT).with_suffix("").as_posix() for page in PAGES}, f"the list is in {CONFIGURATION.relative_to(ROOT)}"


@pytest.mark.slow
def test_the_site_is_built_without_a_warning_and_needs_no_network(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-n", "-d", tmp_path / "kept", "-c", CONFIGURATION.parent, ROOT, tmp_path / "site"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=280)
    assert done.returncode == 0, done.stderr
    pages = {path.relative_to(tmp_path / "site").as_posix(): path.read_text(encoding="utf-8") for path in (tmp_path / "site").rglob("*.html")}
    assert {"index.html", "README.html", "docs/physics.html", "examples/README.html"} <= set(pages)
    fetched = r"""<(?:script|img|iframe|source)\b[^>]*\bsrc="([^"]+)"|<link\b[^>]*\bhref="([^"]+)"|<a\b[^>]*\bhref="([^"]+)\""""
    for name, text in pages.items():
        for source, sheet, page in re.findall(fetched, text):
            assert not re.match(r"(?:https?:)?//", source or sheet), f"{name} fetches {source or sheet}"
            target = (source or sheet or page).split("#")[0].split("?")[0]
            if target and not re.match(r"[a-z]+:", target):
                assert (tmp_path / "site" / name).parent.joinpath(target).is_file(), f"{name}: {target}"
    assert pages["index.html"].count("<img") > 50, "the gallery"
