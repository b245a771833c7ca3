"""The menu entry, icon and kind of file of a Linux desktop: what is written is what desktops read, and all of it goes again."""

from __future__ import annotations

import configparser
import os
import re
import shlex
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from PIL import Image

from blackhole_gl import cli, desktop

MIME = "{http://www.freedesktop.org/standards/shared-mime-info}"


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's data folder, and a program on the path that writes down what it is called with."""
    programs = tmp_path / "bin"
    programs.mkdir()
    for name in ("update-desktop-database", "update-mime-database"):
        (programs / name).write_text(f'#!/bin/sh\necho "$0 $*" >> "{tmp_path}/calls"\n')
        (programs / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    return tmp_path


def entry(home: Path) -> configparser.SectionProxy:
    parser = configparser.ConfigParser(interpolation=None, delimiters="=")
    parser.optionxform = str  # keys have capitals
    parser.read(home / "data/applications/blackhole-gl.desktop", encoding="utf-8")
    return parser["Desktop Entry"]


def test_the_entry_runs_this_installation_on_the_file(home: Path) -> None:
    cli.run(["desktop", "install"])
    made = entry(home)
    assert shlex.split(made["Exec"]) == [sys.executable, "-m", "blackhole_gl", "view", "%f"]
    assert (home / f"data/icons/hicolor/256x256/apps/{made['Icon']}.png").is_file()
    assert set(made["MimeType"].strip(";").split(";")) == {desktop.MIME_TYPE, "application/toml", "image/png"}
    called = (home / "calls").read_text().split("\n")
    assert [re.sub(r".*/bin/", "", line) for line in called if line] == [
        f"update-desktop-database {home}/data/applications", f"update-mime-database {home}/data/mime",
    ]


def test_scene_files_are_a_kind_of_their_own(home: Path) -> None:
    desktop.install()
    (kind,) = ElementTree.parse(home / "data/mime/packages/blackhole-gl.xml").getroot()
    assert kind.get("type") == desktop.MIME_TYPE and kind.find(f"{MIME}glob").get("pattern") == "*.blackhole.toml"
    assert kind.find(f"{MIME}sub-class-of").get("type") == "application/toml"


def test_all_of_it_goes_again(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = desktop.install()
    other = home / "data/applications/another.desktop"
    other.touch()
    assert desktop.remove() == made
    assert [path for path in (home / "data").rglob("*") if path.is_file()] == [other]
    cli.run(["desktop", "remove"])
    assert capsys.readouterr().out == "There was nothing to remove.\n"


def test_paths_with_signs_that_entries_read_otherwise_are_quoted() -> None:
    path = '/srv/my $tools/100 % "new"\\bin/`python`'
    written = desktop.quoted(path).replace("\\\\", "\\")  # as a key's value is read; then as its quoted argument is
    assert written[0] == written[-1] == '"'
    assert re.sub(r'\\(["`$\\])', r"\1", written[1:-1]).replace("%%", "%") == path


def test_what_is_no_action_is_told(home: Path) -> None:
    for words, got in ((["desktop"], "nothing"), (["desktop", "uninstall"], "uninstall")):
        with pytest.raises(ValueError, match=f"got {got}; allowed is install or remove"):
            cli.run(words)


def test_the_icon_is_round_with_a_dark_hole() -> None:
    icon = Image.open(Path(__file__).resolve().parents[2] / "assets/icon.png")
    assert icon.mode == "RGBA" and icon.size == (256, 256)
    assert icon.getpixel((2, 2))[3] == 0 and icon.getpixel((128, 128))[3] == 255
    assert sum(icon.getpixel((158, 128))[:3]) < 30 < sum(icon.getpixel((60, 128))[:3])
