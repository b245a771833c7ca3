"""How long the first picture without a window takes: `blackhole-gl render --size 640x360`, processes begun and ended, of one checkout or of several in turn.

    python tools/time_start.py [--rounds 15] [CHECKOUT ...]

The first round fills the caches of bytecode, texts and the driver, and is left out. As root on Linux, `chrt -f 10 python tools/time_start.py` has the system
leave other work aside meanwhile, which is as good as an idle machine where there is none.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent.parent


def timed(checkout: Path, folder: Path) -> tuple[float, float]:
    """Seconds by the wall clock and of processor time."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment |= {"PYTHONPATH": str(checkout), "PYTHONPYCACHEPREFIX": str(folder / "bytecode")}
    before, start = os.times(), time.perf_counter()
    subprocess.run([sys.executable, "-m", "blackhole_gl", "render", "--size", "640x360", "--out", "x.png"], cwd=folder, env=environment, check=True)
    after = os.times()
    return time.perf_counter() - start, after.children_user + after.children_system - before.children_user - before.children_system


def main() -> None:
    """Times, and prints least and median of each."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkouts", nargs="*", type=Path, default=[HERE])
    parser.add_argument("--rounds", type=int, default=15)
    asked = parser.parse_args()
    checkouts = [checkout.resolve() for checkout in asked.checkouts]
    with tempfile.TemporaryDirectory() as folder:
        rounds = [[timed(checkout, Path(folder)) for checkout in checkouts] for _ in range(asked.rounds + 1)][1:]
    for number, checkout in enumerate(checkouts):
        wall, processor = zip(*(found[number] for found in rounds))
        least_and_median = (f"{name} {min(times):.3f}, {statistics.median(times):.3f} s" for name, times in (("wall clock", wall), ("processor", processor)))
        print(f"{checkout}: least and median: {'; '.join(least_and_median)}")


if __name__ == "__main__":
    main()
