"""Measures the error and the cost of every method on this machine: tables, charts and a page. Under 20 minutes.

    python -m studies.chart [--out docs] [--plan-table assets/measurements.csv] [--quick]
"""

from __future__ import annotations

import argparse
from pathlib import Path

from blackhole_gl import resources
from blackhole_gl.output.progress import Progress
from blackhole_gl.rendering.context import create_headless
from blackhole_gl.rendering.frame import Renderer

from . import run
from .pictures import library


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path, default=Path("accuracy"), help="folder for accuracy.md, pictures/ and data/")
    parser.add_argument("--plan-table", type=Path, help="also write the table that the plan chooses by")
    parser.add_argument("--work", type=Path, help="folder for finished measurements, so that a broken-off run goes on; the user's cache by default")
    parser.add_argument("--quick", action="store_true", help="few scenes, methods and rays: under 2 minutes")
    parser.add_argument("--backend", default="auto", help="how to get a GL context without a window: auto, egl or osmesa")
    asked = parser.parse_args()

    library()  # says what is missing before the long part
    renderer = Renderer(create_headless(asked.backend))
    command = "make chart" if asked.plan_table else "python -m studies.chart" + (" --quick" if asked.quick else "")
    work = asked.work or resources.user_cache_dir() / "chart"
    with Progress("measuring") as progress:
        written = run.make(renderer, asked.out, work, quick=asked.quick, command=command, progress=progress, plan_table=asked.plan_table)
    print("Written: " + ", ".join(str(path) for path in written))


if __name__ == "__main__":
    main()
