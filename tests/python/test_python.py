"""``import blackhole_gl``: what it offers, its examples and its page. All of it runs in two other processes, as the tests' own has one GL context."""

from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import blackhole_gl
from blackhole_gl import api
from blackhole_gl.physics.screen_curves import critical_curve
from blackhole_gl.scene import Scene
from tests.python import examples

ROOT = Path(__file__).resolve().parents[2]
CHECKS = [node.name for node in ast.parse((Path(__file__).parent / "checks.py").read_text(encoding="utf-8")).body if isinstance(node, ast.FunctionDef)]


def outcomes(script: str, folder: Path) -> dict[str, str | None]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
    run = subprocess.run(
        [sys.executable, "-m", f"tests.python.{script}"], cwd=folder, env=environment, capture_output=True, text=True, timeout=280,
    )
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


@pytest.fixture(scope="module")
def checked(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str | None]:
    return outcomes("checks", tmp_path_factory.mktemp("checks"))


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str | None]:
    return outcomes("examples", tmp_path_factory.mktemp("examples"))


@pytest.mark.parametrize("name", [name for name in CHECKS if not name.startswith("_")])
def test_of_a_script(name: str, checked: dict[str, str | None]) -> None:
    assert checked[name] is None, checked[name]


@pytest.mark.parametrize("path", [*examples.SCRIPTS, *examples.NOTEBOOKS, examples.PAGE], ids=lambda path: path.name)
def test_examples_run(path: Path, shown: dict[str, str | None]) -> None:
    assert shown[path.name] is None, shown[path.name]


def test_every_public_name_has_an_example() -> None:
    text = "\n".join([examples.code_on(examples.PAGE), *(path.read_text(encoding="utf-8") for path in examples.SCRIPTS)])
    assert [name for name in blackhole_gl.__all__ if not re.search(rf"\bbh\.{name}\b", text)] == []


def test_the_package_offers_what_its_api_does() -> None:
    assert blackhole_gl.__all__ == api.__all__ == sorted(api.__all__, key=lambda name: (name.islower(), name))
    assert all(getattr(blackhole_gl, name) is getattr(api, name) for name in api.__all__)
    assert set(api.__all__) <= set(dir(blackhole_gl))
    with pytest.raises(AttributeError, match="no attribute 'rendr'"):
        blackhole_gl.rendr  # noqa: B018


def test_the_reference_is_made_from_the_docstrings(tmp_path: Path) -> None:
    made = subprocess.run([sys.executable, ROOT / "tools" / "make_api_page.py", tmp_path / "page.md"], capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    assert (tmp_path / "page.md").read_text(encoding="utf-8") == (ROOT / "docs" / "python_reference.md").read_text(encoding="utf-8"), "make api-page"


LONG = """
import multiprocessing, os
from pathlib import Path
import numpy as np
import blackhole_gl as bh

def memory():
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") / 2**20

def draw(spin):
    return bh.render(bh.load("kerr", {"hole.spin": spin}), (64, 36))

if __name__ == "__main__":
    spins = np.linspace(0.0, 0.99, 40)
    truth = [draw(spin) for spin in spins]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert all(map(np.array_equal, pool.map(draw, spins, chunksize=20), truth)), "two processes draw what one does"
    begun = memory()
    for count in range(1000):
        assert np.array_equal(draw(spins[count % 40]), truth[count % 40])
    print(memory() - begun)
"""


@pytest.mark.slow
def test_a_thousand_pictures_keep_no_memory_and_two_processes_draw_the_same(tmp_path: Path) -> None:
    (tmp_path / "long.py").write_text(LONG, encoding="utf-8")
    run = subprocess.run([sys.executable, "long.py"], cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True, timeout=290)
    assert run.returncode == 0, run.stderr
    print(f"a thousand pictures: {float(run.stdout):+.2f} MB")
    # A picture and its parts have 0.1 MB: a twentieth of them kept would be 5 MB.
    assert float(run.stdout) < 4.0


@pytest.mark.parametrize("inclination", [1.0, 30.0, 60.0, 90.0])
@pytest.mark.parametrize("spin", [0.0, 0.3, 0.6, 0.9, 0.998])
def test_the_critical_curve_is_bardeens(spin: float, inclination: float) -> None:
    """By radius r of the spherical orbit (Bardeen 1973), as this project's code does not do it: λ(r) = α's gives r, η(r) then β."""
    scene = Scene().with_values({"rays.model": "kerr", "hole.spin": spin, "camera.distance": np.inf, "camera.inclination_deg": inclination})
    curve = critical_curve(scene, 40)
    sine, cosine = np.sin(np.radians(inclination)), np.cos(np.radians(inclination))
    if spin == 0.0:
        assert np.abs(np.hypot(curve.alpha, curve.beta) - np.sqrt(27.0)).max() < 1e-6
        return
    ends = [2.0 * (1.0 + np.cos(2.0 / 3.0 * np.arccos(sign * spin))) for sign in (-1.0, 1.0)]

    def lam(r: float) -> float:
        return (r * r * (3.0 - r) - spin**2 * (r + 1.0)) / (spin * (r - 1.0))

    for alpha, beta in zip(curve.alpha, curve.beta):
        r = brentq(lambda r: lam(r) + alpha * sine, ends[0] - 1e-9, ends[1] + 1e-9, xtol=1e-14)  # noqa: B023
        eta = r**3 * (4.0 * spin**2 - r * (r - 3.0) ** 2) / (spin * (r - 1.0)) ** 2
        square = eta + cosine**2 * (spin**2 - (lam(r) / sine) ** 2)
        assert abs(np.sqrt(max(square, 0.0)) - abs(beta)) < 1e-6 or abs(square - beta**2) < 1e-11, "where β tends to 0 only its square is known so well"
