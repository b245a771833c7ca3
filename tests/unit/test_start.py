"""What importing the program leaves to others."""

import os
import subprocess
import sys

import pytest


@pytest.mark.parametrize("given, used", [(None, "1"), ("2", "2")])
def test_numpy_starts_no_threads_unless_asked_to(given: str | None, used: str) -> None:
    others = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    environment = others if given is None else {**others, "OPENBLAS_NUM_THREADS": given}
    look = "import os; from blackhole_gl import cli; print(os.environ['OPENBLAS_NUM_THREADS'])"
    assert subprocess.run([sys.executable, "-c", look], env=environment, capture_output=True, text=True, check=True).stdout.strip() == used


def test_numpy_is_not_there_before_the_program_says_so() -> None:
    """Its threads are started when it is first imported."""
    look = "import sys; import blackhole_gl; print('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", look], capture_output=True, text=True, check=True).stdout.strip() == "False"


def test_what_imports_made_is_not_looked_through_for_what_may_go() -> None:
    """A tenth of the start, and again in every later round: it is there to stay."""
    look = (
        "import gc, sys; from blackhole_gl import __main__ as entry; before = gc.get_stats()[2]['collections']; sys.argv = ['blackhole-gl', '--version']\n"
        "try: entry.main()\nexcept SystemExit: print(gc.get_freeze_count() > 30000, gc.isenabled(), gc.get_stats()[2]['collections'] - before)"
    )
    said = subprocess.run([sys.executable, "-c", look], capture_output=True, text=True, check=True).stdout.split()
    assert said[-3:] == ["True", "True", "0"]
