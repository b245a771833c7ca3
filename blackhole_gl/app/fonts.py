"""The fonts of the window: one that comes with it, and for the letters it lacks those that the system, or the user, has."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from pathlib import Path

from imgui_bundle import hello_imgui

from ..resources import user_config_dir
from . import theme

_MARKS = (b"\x00\x01\x00\x00", b"OTTO", b"ttcf", b"true")  # what a file of outlines begins with
_ENDINGS = (".ttf", ".ttc", ".otf")
# Of each line the first that is there: for Chinese, Japanese and Korean, which one file may hold, then for what else is written.
_LINUX = (
    (
        "opentype/noto/NotoSansCJK-Regular.ttc", "noto-cjk/NotoSansCJK-Regular.ttc", "google-noto-sans-cjk-vf-fonts/NotoSansCJK-VF.ttc",
        "google-noto-cjk/NotoSansCJK-Regular.ttc", "truetype/droid/DroidSansFallbackFull.ttf", "truetype/wqy/wqy-microhei.ttc",
    ),
    ("truetype/dejavu/DejaVuSans.ttf", "TTF/DejaVuSans.ttf", "dejavu-sans-fonts/DejaVuSans.ttf", "dejavu/DejaVuSans.ttf"),
    ("truetype/noto/NotoSansDevanagari-Regular.ttf", "noto/NotoSansDevanagari-Regular.ttf"),
    ("truetype/noto/NotoSansThai-Regular.ttf", "noto/NotoSansThai-Regular.ttf"),
)  # fmt: skip
_MACOS = (("PingFang.ttc", "Hiragino Sans GB.ttc"), ("AppleSDGothicNeo.ttc",), ("Supplemental/Arial Unicode.ttf",))
_WINDOWS = (("msyh.ttc", "simsun.ttc"), ("YuGothM.ttc", "msgothic.ttc"), ("malgun.ttf",), ("segoeui.ttf",), ("Nirmala.ttc", "Nirmala.ttf"), ("LeelawUI.ttf",))


def load() -> None:
    """Loads the text font, a second one for the signs it lacks (₀, ⁵, →), which both come with imgui-bundle, and behind them `others`."""
    hello_imgui.load_font("fonts/DroidSans.ttf", theme.FONT_SIZE)
    _merge("fonts/Inconsolata-Medium.ttf", inside_assets=True)
    for path in others():
        _merge(str(path), inside_assets=False)


def others() -> list[Path]:
    """Font files for letters that ours lack: those in the configuration folder's ``fonts/``, then the system's. Letters are made as they are shown."""
    own = user_config_dir() / "fonts"
    mine = sorted(path for path in own.iterdir() if path.suffix.lower() in _ENDINGS) if own.is_dir() else []
    return [path for path in (*mine, *_of_system()) if _is_font(path)]


def _of_system() -> Iterable[Path]:
    if sys.platform == "win32":
        folder, lines = Path(os.environ.get("WINDIR", r"C:\Windows"), "Fonts"), _WINDOWS
    elif sys.platform == "darwin":
        folder, lines = Path("/System/Library/Fonts"), _MACOS
    else:
        folder, lines = Path("/usr/share/fonts"), _LINUX
    for line in lines:
        there = next((folder / name for name in line if (folder / name).is_file()), None)
        if there is not None:
            yield there


def _is_font(path: Path) -> bool:
    """Whether the file begins as one: imgui ends the program over one that does not."""
    try:
        with path.open("rb") as stream:
            return stream.read(4) in _MARKS
    except OSError:
        return False


def _merge(name: str, *, inside_assets: bool) -> None:
    params = hello_imgui.FontLoadingParams()
    params.merge_to_last_font, params.inside_assets = True, inside_assets
    hello_imgui.load_font(name, theme.FONT_SIZE, params)
