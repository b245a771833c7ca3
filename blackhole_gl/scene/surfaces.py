"""How an instance looks: the parameters that every kind has whose header says ``surface = true``, and those of lamps, ``shines = true``."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .files import PICTURES
from .schema import Field


def _colour(name: str, default: tuple[float, float, float], help: str) -> Field:
    part = Field("", "float", 1.0, 0.0, 1.0, help="Red, green, blue.")
    return Field(name, "list", default, 3, 3, help=help, element=part)


def _share(name: str, default: float, help: str) -> Field:
    return Field(name, "float", default, 0.0, 1.0, help=help)


_IMAGE = (
    "A picture of all longitudes and latitudes, north above; its middle lies at longitude 0. On a mesh it lies by the texture coordinates of its file, "
    "if there are any."
)

_SURFACE = (
    Field("surface", "choice", "plain", options=("plain", "checker", "image", "black_body"), help="One colour, two, a picture, or a black body's glow."),
    _colour("colour", (0.85, 0.8, 0.7), "Red, green and blue of its surface, as shares of the light that falls on it; of its light, where it glows."),
    _colour("other_colour", (0.1, 0.2, 0.5), "The same of every other square."),
    Field("squares_around", "int", 16, 2, 720, help="How many squares go once around it. Odd numbers are rounded up, for the pattern to close."),
    Field("squares_along", "int", 8, 1, 360, help="How many squares lie between its poles."),
    Field("image", "file", "", help=_IMAGE, suffixes=PICTURES),
    Field("temperature_k", "float", 6000.0, 1000.0, 40000.0, "K", "Of a black body, at rest."),
    Field("lighting", "choice", "lit", options=("lit", "glowing"), help="By lamps, or without any from the camera; or it glows by itself."),
    Field("brightness", "float", 1.0, 0.0, 1000.0, help="Of light of its own; the disk's hottest ring has about 1."),
    _share("ambient", 0.15, "Light that falls on it from all around."),
    _share("specular", 0.2, "How much it shines as a polished surface does."),
    Field("shininess", "float", 40.0, 1.0, 1000.0, help="How small a highlight is: the exponent of Blinn and Phong."),
    Field("frequency_shift", "switch", True, help="Whether motion and gravity change its colour and brightness."),
)

_LAMP = (
    _colour("colour", (1.0, 0.95, 0.9), "Red, green and blue of its light."),
    Field("brightness", "float", 1.0, 0.0, 1000.0, help="Of white matter that faces it at a distance of 10 r_s."),
    Field("thins_out", "switch", True, help="Whether its light grows fainter with the square of the distance; else it is as bright everywhere."),
)

SURFACE: Mapping[str, Field] = MappingProxyType({item.key: item for item in _SURFACE})
"""The parameters of a surface by name; none of them changes where rays meet it."""

LAMP: Mapping[str, Field] = MappingProxyType({item.key: item for item in _LAMP})
"""The parameters of a lamp by name."""
