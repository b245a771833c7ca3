"""The program in the menus of a Linux desktop, and its scene files opened by it: entry, icon and kind of file by the rules of freedesktop.org.

Scenes called ``*.blackhole.toml`` are a kind of their own, which a double click opens here; any other ``.toml``, and a picture that carries its scene, is
opened here by choice ("Open with").
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

from .output.files import write_whole
from .resources import assets_dir, desktop_data_dir

MIME_TYPE = "application/x-blackhole-gl-scene"
SCENE_SUFFIX = ".blackhole.toml"
WINDOW_CLASS = "Blackhole GL"  # by which a desktop knows whose window it is: its title, as GLFW has it

_ICON, _ENTRY, _KIND = "icons/hicolor/256x256/apps/blackhole-gl.png", "applications/blackhole-gl.desktop", "mime/packages/blackhole-gl.xml"

_ENTRY_TEXT = """[Desktop Entry]
Type=Application
Version=1.5
Name=Blackhole GL
GenericName=Viewer of black holes
Comment=Black holes in real time, with an error bar
Exec={command} -m blackhole_gl view %f
TryExec={tried}
Icon=blackhole-gl
Terminal=false
Categories=Education;Science;Astronomy;
Keywords=black hole;relativity;Kerr;astronomy;
MimeType={mime_type};application/toml;image/png;
StartupWMClass={window_class}
"""

_KIND_TEXT = """<?xml version="1.0" encoding="UTF-8"?>
<mime-info xmlns="http://www.freedesktop.org/standards/shared-mime-info">
  <mime-type type="{mime_type}">
    <comment>Blackhole GL scene</comment>
    <sub-class-of type="application/toml"/>
    <icon name="blackhole-gl"/>
    <glob pattern="*{suffix}"/>
  </mime-type>
</mime-info>
"""


def install() -> list[Path]:
    """Puts entry, icon and kind of file where the user's desktop finds them, and returns their paths. Those of another installation are replaced.

    Raises:
        ValueError: this system has no such desktops.
        OSError: a file cannot be written.
    """
    _refuse_elsewhere()
    made = {
        _ICON: (assets_dir() / "icon.png").read_bytes(),
        _ENTRY: _ENTRY_TEXT.format(
            command=quoted(sys.executable), tried=_escaped(sys.executable), mime_type=MIME_TYPE, window_class=WINDOW_CLASS,
        ).encode(),
        _KIND: _KIND_TEXT.format(mime_type=MIME_TYPE, suffix=SCENE_SUFFIX).encode(),
    }
    for name, content in made.items():
        write_whole(desktop_data_dir() / name, content)
    _tell_desktop()
    return _paths()


def remove() -> list[Path]:
    """Takes away what `install` put there, and returns the paths of what there was.

    Raises:
        ValueError: this system has no such desktops.
        OSError: a file cannot be removed.
    """
    _refuse_elsewhere()
    there = [path for path in _paths() if path.exists()]
    for path in there:
        path.unlink()
    _tell_desktop()
    return there


def quoted(word: str) -> str:
    """`word` as one argument of an entry's command (Desktop Entry Specification 1.5, "The Exec key")."""
    inside = re.sub(r'(["`$\\])', r"\\\1", word.replace("%", "%%"))
    return _escaped(f'"{inside}"')


def _escaped(text: str) -> str:
    """`text` as a value of an entry's key."""
    return text.replace("\\", "\\\\")


def _paths() -> list[Path]:
    return [desktop_data_dir() / name for name in (_ENTRY, _ICON, _KIND)]


def _refuse_elsewhere() -> None:
    if sys.platform in ("win32", "darwin"):
        raise ValueError("menu entries are made for desktops by the rules of freedesktop.org, as on Linux, and not for this system")


def _tell_desktop() -> None:
    """Has what desktops keep of such files made anew; where a program for it is missing, the desktop looks by itself or at the next login."""
    for program, folder in (("update-desktop-database", "applications"), ("update-mime-database", "mime")):
        found = shutil.which(program)
        if found and (desktop_data_dir() / folder).is_dir():
            subprocess.run([found, desktop_data_dir() / folder], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
