"""Picture files as textures: one for each picture that a sky, a layer or a ray model shows, and one array for those of all things and media."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

import moderngl
import numpy as np

from ..scene import Scene, met
from ..scene.files import PANORAMAS, PICTURES
from ..scene.instances import Instances
from ..scene.plug_in import PlugIn
from ..scene.schema import Field
from . import mip_levels, panorama_files, picture_files
from .picture_files import PictureFiles, Stamp

ARRAY = "instance_pictures"
"""Sampler of the pictures of things and media: a parameter of an instance is its picture's layer in it, −1 for none."""

MOST_ASIDE = 4096
"""Pixels along a side of a texture; larger pictures are reduced to that."""

MOST_ARRAY_BYTES = 256 << 20
"""Of all layers of the array; where there are so many pictures that they would take more, they share it as smaller ones."""

_TEXEL_BYTES = 8

_FILES = PictureFiles()  # of all contexts


def is_picture(item: Field) -> bool:
    """Whether `item` names picture files."""
    return item.kind == "file" and set(item.suffixes) <= set(PICTURES)


def is_panorama(item: Field) -> bool:
    """Whether `item` names panoramas."""
    return item.kind == "file" and not is_picture(item) and set(item.suffixes) <= set(PANORAMAS)


@lru_cache(maxsize=64)
def _named_by(plug_ins: tuple[PlugIn, ...]) -> tuple[Field, ...]:
    """Those of the parameters of `plug_ins` that name pictures or panoramas."""
    return tuple(item for plug_in in plug_ins for item in plug_in.parameters.values() if is_picture(item) or is_panorama(item))


def layers(scene: Scene) -> dict[str, int]:
    """The pictures that things and media of `scene` name → their layers in the array."""
    return {value: layer for layer, (_, value) in enumerate(_named(scene))}


def _named(scene: Scene) -> tuple[tuple[str, str], ...]:
    """(key, value) of each picture that things and media name, each picture once, in their order."""
    if met.is_empty(scene):
        return ()
    found: dict[str, str] = {}
    for slot, section in (("thing", "things"), ("medium", "media")):
        for key, value in _named_in(section, met.named(scene, slot), met.kinds(scene, slot)):
            found.setdefault(value, key)
    return tuple((key, value) for value, key in found.items())


@lru_cache(maxsize=met.SCENES_KEPT)
def _named_in(section: str, named: Instances, kinds: tuple[PlugIn, ...]) -> tuple[tuple[str, str], ...]:
    """(key, value) of each picture that the instances of one section name, each picture once."""
    found: dict[str, str] = {}
    fields = {kind.key: [item.key for item in kind.parameters.values() if is_picture(item)] for kind in kinds}
    for name, instance in named.items():
        for key in fields[instance.kind]:
            value = instance.values[key]
            if isinstance(value, str) and value:
                found.setdefault(value, f"{section}.{name}.{key}")
    return tuple((key, value) for value, key in found.items())


class Pictures:
    """The textures of one context. Each is made anew when its file or the choice of files changes, and only then.

    Attributes:
        made: how many textures have been made.
    """

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self.made = 0
        self._most_aside = min(MOST_ASIDE, ctx.info["GL_MAX_TEXTURE_SIZE"])
        self._single: dict[str, tuple[Stamp | None, moderngl.Texture]] = {}
        self._array: tuple[tuple[Stamp, ...], moderngl.TextureArray] | None = None

    def of(self, plug_ins: Iterable[PlugIn], scene: Scene) -> dict[str, moderngl.Texture]:
        """Sampler's name → texture of the pictures that parameters of `plug_ins` name, such as ``sky_picture_file``: light premultiplied by alpha, mipmapped;
        where no file is named one texel of nothing. A panorama's are the tiles of a cube.

        Raises:
            SceneError: a file cannot be used.
        """
        return {item.glsl_name: self._texture(item, scene) for item in _named_by(tuple(plug_ins))}

    def of_instances(self, scene: Scene) -> dict[str, moderngl.TextureArray]:
        """The array by its sampler's name; nothing where no thing and no medium names a picture.

        Raises:
            SceneError: a file cannot be used.
        """
        named = _named(scene)
        if not named:
            return {}
        stamps = tuple(picture_files.stamp(key, value) for key, value in named)
        if self._array is None or self._array[0] != stamps:
            filled = self._filled_array([_FILES.read(key, stamp, self._most_aside) for (key, _), stamp in zip(named, stamps)])
            if self._array is not None:
                self._array[1].release()
            self._array = stamps, filled
        return {ARRAY: self._array[1]}

    @staticmethod
    def stamps(plug_ins: Iterable[PlugIn], scene: Scene) -> tuple[Stamp, ...]:
        """What tells the files of all these pictures, as they are now, from what they were and will be.

        Raises:
            SceneError: one is not there.
        """
        single = [(item, scene.get(item.key)) for item in _named_by(tuple(plug_ins))]
        own = [(panorama_files if is_panorama(item) else picture_files).stamp(item.key, value) for item, value in single if isinstance(value, str) and value]
        return (*own, *(picture_files.stamp(key, value) for key, value in _named(scene)))

    def release(self) -> None:
        """Gives the GL objects back."""
        for _, texture in self._single.values():
            texture.release()
        if self._array is not None:
            self._array[1].release()
        self._single, self._array = {}, None

    def _texture(self, item: Field, scene: Scene) -> moderngl.Texture:
        key, value = item.key, scene.get(item.key)
        own = panorama_files if is_panorama(item) else picture_files
        stamp = own.stamp(key, value) if isinstance(value, str) and value else None
        kept = self._single.get(key)
        if kept is not None and kept[0] == stamp:
            return kept[1]
        levels: tuple[np.ndarray, ...]
        if stamp is None:
            levels = (np.zeros((1, 1, 4), np.float16),)
        else:
            levels = panorama_files.read(key, stamp) if is_panorama(item) else (_FILES.read(key, stamp, self._most_aside),)
        if kept is not None:
            kept[1].release()
        rows, columns, components = levels[0].shape
        texture = self._ctx.texture((columns, rows), components, np.ascontiguousarray(levels[0]), dtype="f2", alignment=1)
        texture.repeat_x = texture.repeat_y = False
        if len(levels) > 1:
            mip_levels.build(self._ctx, texture, levels[0], list(levels[1:]))
        else:
            texture.build_mipmaps()
        texture.filter = moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR
        self.made += 1
        self._single[key] = stamp, texture
        return texture

    def _filled_array(self, pictures: list[np.ndarray]) -> moderngl.TextureArray:
        width, height = _layer_size(pictures)
        data = b"".join(_resized(picture, (width, height)).tobytes() for picture in pictures)
        texture = self._ctx.texture_array((width, height, len(pictures)), 4, data, dtype="f2")
        texture.repeat_x, texture.repeat_y = True, False  # round a globe the last column meets the first
        texture.build_mipmaps()
        texture.filter = moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR
        self.made += 1
        return texture


def _layer_size(pictures: list[np.ndarray]) -> tuple[int, int]:
    """(width, height) of the layers: the largest of each, halved until all fit."""
    width, height = max(picture.shape[1] for picture in pictures), max(picture.shape[0] for picture in pictures)
    while width * height * len(pictures) * _TEXEL_BYTES > MOST_ARRAY_BYTES:
        width, height = max(width // 2, 1), max(height // 2, 1)
    return width, height


def _resized(picture: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """`picture` at `size` (width, height), float16; resampled in linear light, channel by channel, as Pillow has no float pictures of several."""
    if (picture.shape[1], picture.shape[0]) == size:
        return picture
    from PIL import Image

    channels = [Image.fromarray(np.ascontiguousarray(picture[..., k], np.float32)).resize(size, Image.Resampling.BILINEAR) for k in range(4)]
    return np.stack([np.asarray(channel) for channel in channels], axis=-1).astype(np.float16)
