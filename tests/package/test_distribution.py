"""What is handed on: an archive of sources with all that it takes, and a wheel that comes out the same from it and says what it needs."""

from __future__ import annotations

import email
import re
import subprocess
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

from blackhole_gl import VERSION
from tests.package.conftest import wheel_of

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = {".ci", "assets", "blackhole_gl", "docs", "examples", "presets", "shaders", "studies", "tests", "tools"}
FILES = {".gitignore", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "Makefile", "PKG-INFO", "README.md", "constraints.txt", "pyproject.toml"}
TOOLS = {"chart", "site", "test", "tools"}  # extras for work on the project itself


def metadata(wheel: Path) -> email.message.Message:
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        return email.message_from_bytes(archive.read(name))


def test_the_archive_of_sources_is_whole_and_gives_the_same_wheel(sdist: Path, wheel: Path, tmp_path: Path) -> None:
    with tarfile.open(sdist) as archive:
        inside = {name.partition("/")[2] for name in archive.getnames()}
    assert {name.partition("/")[0] for name in inside} == FOLDERS | FILES, "and nothing that programs or tests left lying about"
    tests = {path.relative_to(ROOT).as_posix() for path in (ROOT / "tests").rglob("*.py")}
    assert tests <= inside
    with zipfile.ZipFile(wheel) as made, zipfile.ZipFile(wheel_of(sdist, tmp_path)) as again:
        assert sorted(made.namelist()) == sorted(again.namelist())
        assert [name for name in made.namelist() if made.read(name) != again.read(name)] == []


def test_the_version_stands_in_one_place(wheel: Path, sdist: Path) -> None:
    assert metadata(wheel)["Version"] == VERSION
    assert sdist.name == f"blackhole_gl-{VERSION}.tar.gz"
    stated = [path.name for path in (ROOT / "blackhole_gl").rglob("*.py") if f'"{VERSION}"' in path.read_text(encoding="utf-8")]
    assert stated == ["__init__.py"] and VERSION not in re.sub(r">=[\d.]+", "", (ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_extras_that_messages_and_documents_name_are_there(wheel: Path) -> None:
    offered = set(metadata(wheel).get_all("Provides-Extra"))
    texts = [*(ROOT / "blackhole_gl").rglob("*.py"), ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    lists = [found for path in texts for found in re.findall(r"(?:blackhole-gl|\.|\.whl)\[([a-z, ]+)\]", path.read_text(encoding="utf-8"))]
    named = {extra.strip() for found in lists for extra in found.split(",")}
    assert {"exr", "fits", "film", "cluster"} <= named <= offered
    assert offered - TOOLS <= named, "each has a place where users read of it"


@pytest.mark.slow
def test_an_empty_environment_takes_the_wheel_with_its_extras(wheel: Path, tmp_path: Path) -> None:
    """All comes from a package index, by the releases of constraints.txt; then each extra does what it is for."""
    builder = venv.EnvBuilder(with_pip=True)
    scripts = Path(builder.ensure_directories(tmp_path / "venv").bin_path)
    builder.create(tmp_path / "venv")
    extras = ",".join(sorted(set(metadata(wheel).get_all("Provides-Extra")) - {"site", "test", "tools"}))
    command = [scripts / "python", "-m", "pip", "install", "--quiet", "--constraint", ROOT / "constraints.txt", f"{wheel}[{extras}]"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=280)
    assert done.returncode == 0, done.stderr
    for name in ("x.png", "x.exr", "x.fits", "x.npz"):
        run(scripts / "blackhole-gl", "render", "kerr", "draft", "--size", "64x36", "-o", name, folder=tmp_path)
    run(scripts / "blackhole-gl", "video", "kerr", "draft", "--size", "64x36", "--fps", "4", "--seconds", "0.5", "-o", "x.mp4", folder=tmp_path)
    run(scripts / "python", "-c", "import distributed, matplotlib, blackhole_gl as bh; assert bh.load('x.png').hole.spin", folder=tmp_path)
    assert all((tmp_path / name).stat().st_size > 1000 for name in ("x.png", "x.exr", "x.fits", "x.npz", "x.mp4"))


def run(*command: str | Path, folder: Path) -> None:
    done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
