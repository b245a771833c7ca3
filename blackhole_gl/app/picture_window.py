"""The dialog that saves a picture of any size with any number of rays a pixel.

Items: ``//Picture/##width``, ``##height``, ``##rays``, ``##path``, ``Save``, ``Stop``.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from imgui_bundle import hello_imgui, imgui

from . import file_dialog, scene_files, theme, tool_window
from .divided import RightSide
from .file_dialog import FileDialog
from .state import WindowState
from .still import Order, Still

TITLE = "Picture"
MOST_SIDE, MOST_SAMPLES = 32768, 16
_SIZES = ((1280, 720), (1920, 1080), (2560, 1440), (3840, 2160), (7680, 4320), (2048, 2048))


class PictureWindow:
    """What is typed in the dialog, and the picture under way.

    Args:
        folder: where pictures go.
        make_renderer: makes a renderer from the window's context.
    """

    def __init__(self, folder: Path, make_renderer: Callable[[Any], Any], dialog: FileDialog):
        self._folder, self._make_renderer, self._dialog = folder, make_renderer, dialog
        self._size, self._samples, self._path = _SIZES[1], 2, ""
        self._replace = ""
        self._order: Order | None = None
        self._still: Still | None = None
        self._said = ""

    @property
    def busy(self) -> bool:
        """Whether a picture is being made."""
        return self._order is not None or self._still is not None

    def advance(self, gl: Any, state: WindowState) -> None:
        """Goes on with the picture under way, in a bounded part of a frame. The context is current."""
        if self._order is not None:
            order, self._order = self._order, None
            self._still = Still(self._make_renderer(gl), order)
        if self._still is None:
            return
        self._still.advance()
        if not self._still.is_over:
            return
        try:
            self._said = self._still.result()
            state.say(self._said)
        except OSError as error:
            self._said = f"{self._still.order.path}: {error.strerror or error}"
            state.complain(self._said)
        self.close()

    def close(self) -> None:
        """Leaves the picture under way."""
        if self._still is not None:
            self._still.close()
        self._still = self._order = None

    def draw(self, state: WindowState, right_side: Callable[[WindowState], RightSide | None]) -> None:
        """Draws the dialog when it is wanted; its close button puts it away, and a picture under way goes on.

        Args:
            right_side: what stands right of a divider, if there is one.
        """
        if not state.show_picture_window:
            self._path = ""
            return
        if not self._path:
            self._path, self._said = str(scene_files.new_picture(self._folder)), ""
        tool_window.appears_in_the_middle()
        imgui.set_next_window_size((30.0 * hello_imgui.em_size(), 0.0))
        state.show_picture_window = tool_window.draw(TITLE, lambda: self._contents(state, right_side), imgui.WindowFlags_.no_resize)

    def _contents(self, state: WindowState, right_side: Callable[[WindowState], RightSide | None]) -> None:
        em = hello_imgui.em_size()
        imgui.begin_disabled(self.busy)
        self._size_row(em)
        self._rays_row(em)
        self._path_row(em)
        imgui.end_disabled()
        self._last_row(state, right_side, em)

    def _size_row(self, em: float) -> None:
        _label("Size", em)
        width, height = self._size
        imgui.set_next_item_width(5.0 * em)
        _, width = imgui.input_int("##width", width, 0)
        imgui.same_line()
        imgui.text_unformatted("×")
        imgui.same_line()
        imgui.set_next_item_width(5.0 * em)
        _, height = imgui.input_int("##height", height, 0)
        self._size = min(max(width, 1), MOST_SIDE), min(max(height, 1), MOST_SIDE)
        imgui.same_line()
        imgui.set_next_item_width(-1.0)
        if imgui.begin_combo("##sizes", "Usual sizes"):
            for size in _SIZES:
                clicked, _ = imgui.selectable(f"{size[0]} × {size[1]}", size == self._size)
                if clicked:
                    self._size = size
            imgui.end_combo()

    def _rays_row(self, em: float) -> None:
        _label("Rays a pixel", em)
        imgui.set_next_item_width(-1.0)
        _, self._samples = imgui.slider_int("##rays", self._samples, 1, MOST_SAMPLES, f"%d × {self._samples} = {self._samples**2}")
        self._samples = min(max(self._samples, 1), MOST_SAMPLES)

    def _path_row(self, em: float) -> None:
        _label("File", em)
        with_dialog = file_dialog.is_there()
        imgui.set_next_item_width(-6.0 * em if with_dialog else -1.0)
        _, self._path = imgui.input_text("##path", self._path)
        if with_dialog:
            imgui.same_line()
            if imgui.button("Choose …", (-1.0, 0.0)):
                self._dialog.ask_save("Save the picture", Path(self._path).expanduser(), file_dialog.PICTURES, self._take_path)

    def _take_path(self, path: Path) -> None:
        self._path = self._replace = str(path if path.suffix.lower() == ".png" else path.with_name(path.name + ".png"))

    def _last_row(self, state: WindowState, right_side: Callable[[WindowState], RightSide | None], em: float) -> None:
        if self.busy:
            share = self._still.share if self._still is not None else 0.0
            imgui.progress_bar(share, (-6.0 * em, 0.0), "writing …" if share >= 1.0 else f"{share:.0%}")
            imgui.same_line()
            if imgui.button("Stop", (-1.0, 0.0)):
                self.close()
                self._said = "Stopped."
            return
        if imgui.button("Save", (6.0 * em, 0.0)):
            self._begin(state, right_side(state))
        imgui.same_line()
        imgui.push_style_color(imgui.Col_.text, theme.DIM)
        imgui.text_wrapped(self._said or "The scene as it is now, without what is written over it.")
        imgui.pop_style_color()

    def _begin(self, state: WindowState, right: RightSide | None) -> None:
        path = Path(self._path.strip()).expanduser()
        if path.suffix.lower() != ".png":
            self._said = f"{path.name or 'The file'}: only PNG is written here; end the name in .png."
        elif path.exists() and self._replace != str(path):
            self._replace, self._said = str(path), f"{path.name} exists. Save again to replace it."
        else:
            self._replace = self._said = ""
            self._order = Order(state.scene, state.time, self._size, self._samples, path, right)


def _label(text: str, em: float) -> None:
    imgui.align_text_to_frame_padding()
    imgui.text_unformatted(text)
    imgui.same_line(7.0 * em)
