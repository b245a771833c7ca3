"""Small pictures of the shipped presets and skies, made by tools/make_thumbnails.py, as textures that imgui draws."""

from __future__ import annotations

import moderngl
from imgui_bundle import ImVec2, hello_imgui, imgui
from PIL import Image

from ..resources import assets_dir

_ASPECT = 16.0 / 9.0
ROW_EM = 2.4  # height in a list
_TOOLTIP_EM = 9.0


class Thumbnails:
    """Loads each when it is first to be seen."""

    def __init__(self, gl: moderngl.Context):
        self._gl = gl
        self._textures: dict[str, moderngl.Texture | None] = {}

    def draw(self, name: str, height_em: float = _TOOLTIP_EM) -> bool:
        """Draws that of the preset called `name`, or of the sky ``skies/NAME``. False where there is none, as of a user's own."""
        if name not in self._textures:
            self._textures[name] = self._load(name)
        texture = self._textures[name]
        if texture is None:
            return False
        height = height_em * hello_imgui.em_size()
        imgui.image(imgui.ImTextureRef(texture.glo), ImVec2(_ASPECT * height, height))
        return True

    def _load(self, name: str) -> moderngl.Texture | None:
        path = assets_dir() / "thumbnails" / f"{name}.jpg"
        if not path.is_file():
            return None
        with Image.open(path) as picture:
            return self._gl.texture(picture.size, 3, picture.convert("RGB").tobytes(), alignment=1)
