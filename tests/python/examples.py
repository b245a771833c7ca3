"""Runs the scripts and notebooks of examples/ and the code of docs/python.md in one process, which keeps programs compiled; prints what failed, as JSON."""

from __future__ import annotations

import json
import os
import re
import runpy
import sys
import traceback
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = sorted((ROOT / "examples").glob("*.py"))
NOTEBOOKS = sorted((ROOT / "examples").glob("*.ipynb"))
PAGE = ROOT / "docs" / "python.md"


def code_of(notebook: Path) -> str:
    """All its code, a cell after the other."""
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    return "\n\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")


def code_on(page: Path) -> str:
    """All its Python, a block after the other."""
    return "\n\n".join(re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.DOTALL))


def _outcome(path: Path) -> str | None:
    try:
        if path.suffix == ".py":
            runpy.run_path(str(path), run_name="__main__")
        else:
            exec(compile((code_of if path.suffix == ".ipynb" else code_on)(path), str(path), "exec"), {"__name__": "__main__"})
    except BaseException:
        return traceback.format_exc()
    return None


if __name__ == "__main__":
    said = os.dup(1)
    os.dup2(2, 1)
    results = {path.name: _outcome(path) for path in (*SCRIPTS, *NOTEBOOKS, PAGE)}
    sys.stdout.flush()
    os.write(said, json.dumps(results).encode())
