"""A bar of a round angle on the sky, and the beam's circle beside it, as labels: for scenes that stand for a real object. No GL here.

Places are those of `labels`.
"""

from __future__ import annotations

import math

import numpy as np

from ..physics import projection
from ..physics.angular_size import is_told, picture_height_uas
from ..scene import Scene
from .labels import WHITE, Curve, Labels, Name

_LONGEST = 0.25  # of the picture's width
_MARGIN = 0.04
_CAP = 0.008  # half height of the bar's ends
_GAP = 0.02
_ANGLES = np.linspace(0.0, 2.0 * np.pi, 61)
_UNITS = ((1e6, "as"), (1e3, "mas"), (1.0, "µas"))
_NONE = Labels()


def of(scene: Scene, aspect: float) -> Labels:
    """The bar of a picture of `scene` whose width is `aspect` heights, with its length told; nothing where the scene stands for no real object."""
    if not is_told(scene) or not projection.is_perspective(scene.camera):
        return _NONE
    height = picture_height_uas(scene.camera, scene.source)
    angle = round_below(_LONGEST * aspect * height)
    left, right, y = _MARGIN, _MARGIN + angle / height, 1.0 - _MARGIN
    curves = [_line(((left, y - _CAP), (left, y + _CAP))), _line(((left, y), (right, y))), _line(((right, y - _CAP), (right, y + _CAP)))]
    names = [Name(words(angle), (right, y), (right + _GAP, y), WHITE)]
    if scene.post.beam:
        radius = 0.5 * scene.post.beam_uas / height
        middle = left + radius, y - 2.0 * _GAP - radius
        curves.append(_line(np.stack([middle[0] + radius * np.cos(_ANGLES), middle[1] + radius * np.sin(_ANGLES)], axis=-1)))
        edge = middle[0] + radius, middle[1]
        names.append(Name(f"beam {words(scene.post.beam_uas)}", edge, (edge[0] + _GAP, edge[1]), WHITE))
    return Labels(tuple(curves), tuple(names))


def round_below(angle: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is no larger than `angle` > 0."""
    power = 10.0 ** math.floor(math.log10(angle))
    return max(step * power for step in (0.5, 1.0, 2.0, 5.0) if step * power <= angle)


def words(angle_uas: float) -> str:
    """An angle in µas, in the unit that suits it."""
    size, unit = next((pair for pair in _UNITS if angle_uas >= pair[0]), _UNITS[-1])
    return f"{angle_uas / size:.3g} {unit}"


def _line(places: object) -> Curve:
    return Curve(np.asarray(places, float), WHITE)
