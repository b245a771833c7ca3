"""The documentation as a site that reads offline, too: Sphinx over the Markdown pages where they lie, `make site`."""

from __future__ import annotations

import shutil
from pathlib import Path

from sphinx.application import Sphinx

from blackhole_gl import VERSION

_FRONT = "README"
_PAGES = {
    "Using it": ("docs/troubleshooting", "docs/film", "docs/python", "docs/python_reference", "examples/README"),
    "What it computes": ("docs/physics", "docs/accuracy", "docs/fields", "docs/media", "docs/stability", "docs/performance", "docs/sources"),
    "How it is made": (
        "docs/architecture", "docs/extending", "shaders/README", "docs/llvmpipe", "docs/portability", "CONTRIBUTING", "assets/SOURCES", "CHANGELOG",
    ),
}  # fmt: skip

project = "Blackhole GL"
author = "the authors of Blackhole GL"
version = release = VERSION
root_doc = _FRONT
include_patterns = [f"{name}.md" for name in (_FRONT, *(page for pages in _PAGES.values() for page in pages))]
extensions = ["myst_parser"]
myst_heading_anchors = 4  # by the rule of the forges that show these pages, too
html_theme = "furo"
html_title = f"Blackhole GL {VERSION}"
html_logo = html_favicon = "../../assets/icon.png"
html_copy_source = html_show_sourcelink = False
html_theme_options = {"sidebar_hide_name": True, "top_of_page_buttons": []}


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.connect("source-read", _with_contents)
    app.connect("build-finished", _with_index)


def _with_contents(app: Sphinx, page: str, source: list[str]) -> None:
    """Puts the list of pages, which makes the bar at the side, behind the front page, and the scripts behind the page on examples."""
    if page == "examples/README":
        for script in sorted((Path(app.srcdir) / "examples").glob("*.py")):
            source[0] += f"\n\n## {script.stem.replace('_', ' ')}\n\n```{{literalinclude}} {script.name}\n:language: python\n```\n"
    if page == _FRONT:
        source[0] += "".join(f"\n\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n" + "\n".join(pages) + "\n```\n" for caption, pages in _PAGES.items())


def _with_index(app: Sphinx, failed: Exception | None) -> None:
    """The front page under the name that browsers and servers look for."""
    if failed is None and app.builder.name == "html":
        folder = Path(app.outdir)
        shutil.copyfile(folder / f"{_FRONT}.html", folder / "index.html")
