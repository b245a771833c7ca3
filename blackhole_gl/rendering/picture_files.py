"""Picture files → linear light, or an error that says what is wrong with them. They come from strangers: nothing in one can do more than fail."""

from __future__ import annotations

import io
import warnings
from collections import OrderedDict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..scene import files
from ..scene.schema import SceneError
from . import stamps
from .stamps import Stamp, Unusable

if TYPE_CHECKING:
    from PIL import Image  # imported when there is a picture: most scenes have none, and it takes a fiftieth of the time of a first frame

MOST_BYTES = 64 << 20
MOST_PIXELS = 1 << 26
MOST_ASIDE = 16384
ALLOWED = "a PNG, JPEG, WebP or BMP file of at most 64 MiB, 16384 pixels a side and 67 million in all"

FORMATS = ("PNG", "JPEG", "WEBP", "BMP")
_KEPT_BYTES = 256 << 20  # of decoded pictures


class PictureFiles:
    """Pictures that have been read, so that none is read twice while its file stays as it is, and none that cannot be used either."""

    def __init__(self) -> None:
        self._kept: OrderedDict[tuple[Stamp, int], np.ndarray | str] = OrderedDict()

    def read(self, key: str, stamp: Stamp, most_aside: int) -> np.ndarray:
        """Linear light of the picture that the field `key` names, premultiplied by its alpha: float16 (rows, columns, 4), the bottom row first, 0…1.

        Args:
            most_aside: a picture with more pixels along a side is reduced to that.

        Raises:
            SceneError: it cannot be used; the text names key and file, and says why and what is allowed.
        """
        place = stamp, most_aside
        if place not in self._kept:
            try:
                self._kept[place] = _linear(_decoded(stamp.path, most_aside))
            except Unusable as error:
                self._kept[place] = str(error)
            while len(self._kept) > 1 and sum(len(kept) if isinstance(kept, str) else kept.nbytes for kept in self._kept.values()) > _KEPT_BYTES:
                self._kept.popitem(last=False)
        self._kept.move_to_end(place)
        kept = self._kept[place]
        if isinstance(kept, str):
            raise _error(key, stamp.path, kept)
        return kept


def stamp(key: str, value: str) -> Stamp:
    """The file that the picture field `key` of `value` names, as it stands now.

    Raises:
        SceneError: it is not there, or is no file, or has too many bytes.
    """
    path = files.located(key, value)
    try:
        return stamps.stamp(path, MOST_BYTES)
    except Unusable as error:
        raise _error(key, path, str(error)) from None


def _error(key: str, path: Path, reason: str) -> SceneError:
    return SceneError(key, f"the picture {path} cannot be used: {reason}; allowed is {ALLOWED}")


def _decoded(path: Path, most_aside: int) -> Image.Image:
    """The picture upright, RGBA with 8 bits, reduced where a side is longer than `most_aside`."""
    from PIL import Image, ImageOps

    data = stamps.content(path, MOST_BYTES)
    try:
        with warnings.catch_warnings(action="ignore"):  # of what it refuses itself, and of what it makes do with
            with Image.open(io.BytesIO(data), formats=FORMATS) as image:
                width, height = image.size
                if max(image.size) > MOST_ASIDE or width * height > MOST_PIXELS:
                    raise Unusable(f"it has {width}×{height} pixels")
                image.draft("RGB", (most_aside, most_aside))  # of a JPEG no more is decoded than needed
                upright = _rgba(ImageOps.exif_transpose(image))
                upright.thumbnail((most_aside, most_aside), Image.Resampling.BOX)
                return upright
    except Unusable:
        raise
    except Image.UnidentifiedImageError:
        raise Unusable("it is none of these kinds, whatever its name says") from None
    except Exception as error:  # decoders raise whatever they stumble over in a damaged file
        raise Unusable(f"it is damaged: {error or type(error).__name__}") from None


def _rgba(image: Image.Image) -> Image.Image:
    from PIL import Image

    if image.mode.startswith("I;16"):
        return Image.fromarray((np.asarray(image) >> 8).astype(np.uint8)).convert("RGBA")
    return image.convert("RGBA") if image.mode in ("L", "LA", "La", "P", "PA", "1", "RGB", "RGBA", "RGBa") else image.convert("RGB").convert("RGBA")


def _linear(image: Image.Image) -> np.ndarray:
    pixels = np.asarray(image)[::-1]
    light = _LINEAR[pixels]
    light[..., 3] = pixels[..., 3] / np.float16(255.0)
    if pixels[..., 3].min() < 255:
        light[..., :3] *= light[..., 3:]
    return light


def _srgb_to_linear() -> np.ndarray:
    """Light of each of the 256 codes of sRGB, float16."""
    code = np.arange(256) / 255.0
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4).astype(np.float16)


_LINEAR = _srgb_to_linear()
