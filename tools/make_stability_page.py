"""Runs every stability case through every method and writes docs/stability.md and tests/stability/verdicts.csv; `make stability`.

--only WORD runs the methods whose names hold the word (`default`: each model's default method; `viewer`: no method, the viewer's own cases) and keeps
the rest as stored. --check writes nothing and says which cells differ from the stored ones.
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

from blackhole_gl.chart import stability, stability_page
from blackhole_gl.chart.stability_cases import CASES
from blackhole_gl.chart.stability_viewer import VIEWER_CASES
from blackhole_gl.render.context import create_headless, describe
from blackhole_gl.render.frame import Renderer

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "stability.md"
TABLE = ROOT / "tests" / "stability" / "verdicts.csv"

DEFAULT_RAYS, OTHER_RAYS = 1_000_000, 5_000
"""Rays of a sweep through a model's default method, and through any other."""


Table = dict[tuple[str, str], stability.Outcome]


def measure(renderer: Renderer, rays: int, full: bool, only: str, old: Table) -> Table:
    """The outcome of every cell, in the page's order; those of methods that `only` leaves out are taken from `old`."""
    found = {}
    every = stability.methods()
    for number, method in enumerate(every):
        wanted = stability.is_default(method) if only == "default" else only in method.name
        for case in CASES:
            cell = case.key, method.name
            count = rays if stability.is_default(method) else min(rays, OTHER_RAYS)
            found[cell] = stability.run(renderer, case, method, count) if wanted or cell not in old else old[cell]
        print(f"{number + 1}/{len(every)} {method.name}", file=sys.stderr, flush=True)
    for case in VIEWER_CASES:
        cell = case.key, stability_page.VIEWER
        found[cell] = case.run(renderer, full) if only in ("", stability_page.VIEWER) or cell not in old else old[cell]
    return found


def differences(old: Table, new: Table) -> list[str]:
    """The cells whose verdict changed, or that one of the two lacks."""
    lines = []
    for cell in sorted({*old, *new}):
        before, after = (table[cell].verdict if cell in table else "absent" for table in (old, new))
        if before != after:
            error = new[cell].error if cell in new else math.nan
            lines.append(f"{cell[0]}, {cell[1]}: {before} → {after} ({error:.1e} {new[cell].note if cell in new else ''})")
    return lines


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare with what is stored and write nothing")
    parser.add_argument("--only", default="", metavar="WORD", help="methods to run; all when left out")
    parser.add_argument("--rays", type=int, default=DEFAULT_RAYS, help="rays in a sweep of a default method")
    parser.add_argument("--small", action="store_true", help="leave out the 4096×4096 and 8K pictures")
    given = parser.parse_args()
    context = create_headless()
    print(describe(context), file=sys.stderr)
    renderer = Renderer(context)
    old = stability_page.loads(TABLE.read_text(encoding="utf-8")) if TABLE.exists() else {}
    new = measure(renderer, given.rays, not given.small, given.only, old)
    changed = differences(old, new)
    print("\n".join(changed))
    if given.check:
        return 1 if changed else 0
    TABLE.write_text(stability_page.dumps(new), encoding="utf-8")
    # From the stored text, so that page and table round alike.
    PAGE.write_text(stability_page.page(stability_page.loads(TABLE.read_text(encoding="utf-8"))), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
