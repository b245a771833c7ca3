"""The wheel carries its data, and the copy installed from it works from any folder."""

from __future__ import annotations

import csv
import struct
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DATA_FOLDERS = ("shaders", "presets", "assets")


def committed_data(folder: str) -> set[str]:
    return {path.relative_to(ROOT).as_posix() for path in (ROOT / folder).rglob("*") if path.is_file() and "__pycache__" not in path.parts}


@pytest.mark.parametrize("folder", DATA_FOLDERS)
def test_wheel_carries_every_data_file(wheel: Path, folder: str) -> None:
    with zipfile.ZipFile(wheel) as archive:
        inside = {name.removeprefix("blackhole_gl/data/") for name in archive.namelist()}
    wanted = committed_data(folder)
    assert wanted, f"{folder}/ is empty"
    assert wanted <= inside


def test_wheel_carries_nothing_else(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        tops = {name.partition("/")[0] for name in archive.namelist()}
    assert {top for top in tops if not top.endswith(".dist-info")} == {"blackhole_gl"}


def test_data_comes_from_the_installed_package(installed_copy) -> None:
    script = "import blackhole_gl.resources as r; print(r.__file__, r.shaders_dir(), r.presets_dir(), r.assets_dir(), sep='\\n')"
    run = installed_copy.run("python", "-c", script)
    assert run.returncode == 0, run.stderr
    module, *folders = map(Path, run.stdout.splitlines())
    assert not module.is_relative_to(ROOT)
    for name, folder in zip(DATA_FOLDERS, folders, strict=True):
        assert folder == module.parent / "data" / name


def test_presets_are_listed(installed_copy) -> None:
    run = installed_copy.run("blackhole-gl", "presets")
    assert run.returncode == 0, run.stderr
    for name in ("schwarzschild", "kerr", "automatic", "draft", "light", "fine", "finest", "reference"):
        assert name in run.stdout.split()


def test_module_runs_like_the_script(installed_copy) -> None:
    script, module = installed_copy.run("blackhole-gl", "--help"), installed_copy.run("python", "-m", "blackhole_gl", "--help")
    assert (script.returncode, module.returncode) == (0, 0), script.stderr + module.stderr
    for command in ("view", "render", "trace", "check", "presets"):
        assert command in script.stdout and command in module.stdout


def test_render_writes_a_picture(installed_copy) -> None:
    run = installed_copy.run("blackhole-gl", "render", "--preset", "schwarzschild", "--preset", "draft", "--size", "160x90", "--time", "0", "--out", "x.png")
    assert run.returncode == 0, run.stderr
    png = (installed_copy.elsewhere / "x.png").read_bytes()
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    assert struct.unpack(">II", png[16:24]) == (160, 90)


def test_picture_opens_as_a_preset(installed_copy) -> None:
    options = ("--size", "96x54", "--time", "0")
    first = installed_copy.run("blackhole-gl", "render", "--preset", "kerr", "--set", "disk.outer_radius=9", *options, "--out", "first.png")
    again = installed_copy.run("blackhole-gl", "render", "--preset", "first.png", *options, "--out", "again.png")
    assert (first.returncode, again.returncode) == (0, 0), first.stderr + again.stderr
    assert (installed_copy.elsewhere / "first.png").read_bytes() == (installed_copy.elsewhere / "again.png").read_bytes()


def test_trace_answers_for_a_list_of_rays(installed_copy) -> None:
    (installed_copy.elsewhere / "rays.csv").write_text("psi,chi\n0.0,0.0\n0.5,0.3\n", encoding="utf-8")
    command = ("blackhole-gl", "trace", "--preset", "schwarzschild", "--set", "camera.distance=15", "--rays", "rays.csv", "--out", "hits.csv")
    run = installed_copy.run(*command)
    assert run.returncode == 0, run.stderr
    with (installed_copy.elsewhere / "hits.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    # sin psi_c = b_c sqrt(1 - 1/R)/R: 0.168 rad at R = 15 r_s.
    assert [row["fate"] for row in rows] == ["captured", "escaped"]


def test_check_passes(installed_copy) -> None:
    run = installed_copy.run("blackhole-gl", "check")
    assert run.returncode == 0, run.stdout + run.stderr


def test_view_without_a_display_writes_a_picture(installed_copy) -> None:
    run = installed_copy.run("blackhole-gl", "view")
    assert run.returncode == 0, run.stdout + run.stderr
    assert (installed_copy.elsewhere / "blackhole.png").read_bytes().startswith(b"\x89PNG")
    assert "blackhole.png" in (run.stdout + run.stderr).replace("\n", "")


def test_mistaken_key_is_explained(installed_copy) -> None:
    run = installed_copy.run("blackhole-gl", "render", "--preset", "kerr", "--set", "hole.spim=0.5", "--out", "never.png")
    assert run.returncode != 0
    assert "hole.spin" in run.stdout + run.stderr
    assert "Traceback" not in run.stderr
    assert not (installed_copy.elsewhere / "never.png").exists()
