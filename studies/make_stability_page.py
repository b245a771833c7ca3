"""Runs every stability case through every method and writes docs/data/stability.csv, and docs/stability.md from it; `make stability`.

--only WORD runs the methods whose names hold the word and keeps the rest as stored. Words of their own: `default`, each model's default method; `viewer`,
the viewer's own cases; `missing`, what is not stored yet, with which an interrupted run goes on. --check writes nothing and says what differs.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable
from pathlib import Path

from blackhole_gl.rendering.context import create_headless, describe
from blackhole_gl.rendering.frame import Renderer
from studies import stability, stability_page
from studies.stability_cases import CASES
from studies.stability_viewer import VIEWER_CASES

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "stability.md"
TABLE = ROOT / "docs" / "data" / "stability.csv"

DEFAULT_RAYS = 1_000_000
"""Rays of a sweep through a model's default method."""


Table = dict[tuple[str, str], stability.Judgement]


def measure(renderer: Renderer, rays: int, full: bool, only: str, old: Table, keep: Callable[[Table], None]) -> Table:
    """The judgement of every cell, in the page's order; those of methods that `only` leaves out are taken from `old`.

    Args:
        keep: called with what there is after each method that ran.
    """
    found: Table = {}
    every = stability.methods()
    for number, method in enumerate(every):
        wanted = stability.is_default(method) if only == "default" else only in method.name
        count = rays if stability.is_default(method) else min(rays, stability.OTHER_SWEEP_RAYS)
        due = [case for case in CASES if wanted or (case.key, method.name) not in old]
        found |= {(case.key, method.name): stability.run(renderer, case, method, count) if case in due else old[case.key, method.name] for case in CASES}
        if due:
            keep({**old, **found})
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

    def keep(table: Table) -> None:
        if not given.check:
            TABLE.write_text(stability_page.dumps(table), encoding="utf-8")

    new = measure(renderer, given.rays, not given.small, given.only, old, keep)
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
