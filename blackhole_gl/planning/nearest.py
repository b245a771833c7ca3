"""The scenes that the chart measured (assets/measurements.csv), and which of them are most like a given one."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache

from ..physics import projection
from ..physics.space_time import is_field
from ..resources import assets_dir
from ..scene import Scene, catalogue
from . import hardness
from .measured import Measured, read

_Field = tuple[str, frozenset[str]]  # the ray model, and its measured fields that count
_Likeness = tuple[float, float, float, float]

# A measured scene this near (see `_likeness`) is the scene itself; otherwise the worse of the two nearest is believed.
_SAME = 0.02


@lru_cache(maxsize=1)
def measurements() -> Mapping[str, Sequence[Measured]]:
    """The rows of the chart's tables, of holes and of fields, by the scene they were measured in; empty where there are none."""
    paths = (assets_dir() / name for name in ("measurements.csv", "measurements_fields.csv"))
    models = catalogue.plug_ins("ray_model")
    return {name: rows for path in paths if path.is_file() for name, rows in read(path, models).items()}


def nearest_scenes(scene: Scene) -> tuple[str, ...]:
    """The measured scene that is `scene`, or the two that are most like it, the likest first."""
    camera, field = scene.camera, _field(scene) if is_field(scene) else None
    return _nearest(field, scene.hole.spin, camera.distance, camera.inclination_deg, math.degrees(projection.view_angle(camera)))


@lru_cache(maxsize=64)
def _nearest(field: _Field | None, spin: float, distance: float, inclination_deg: float, fov_deg: float) -> tuple[str, ...]:
    """Those for a hole that spins so, or in that `field`."""
    here = _likeness(spin, distance, inclination_deg, fov_deg)
    # A measured hole that spins says little of one that does not, and the other way round.
    apart = sorted((math.dist(here, there) + (1.0 if spins != (spin != 0.0) else 0.0), name) for name, spins, there in _measured_like(field))
    if not apart:
        return ()
    return (apart[0][1],) if apart[0][0] <= _SAME else tuple(name for _, name in apart[:2])


def _field(scene: Scene) -> _Field:
    """A field that was not measured is like those of its kind that are as hard to march through; where none is, like the one that is as it comes."""
    return scene.rays.model, hardness.as_hard(scene, _measured_fields(scene.rays.model)) or frozenset([""])


@lru_cache(maxsize=16)
def _measured_like(field: _Field | None) -> tuple[tuple[str, bool, _Likeness], ...]:
    """The measured scenes of that `field`, or of holes from outside where there is none: names, whether the hole spins, and what tells how alike they are."""
    models, found = catalogue.plug_ins("ray_model"), []
    for name, rows in measurements().items():
        row = rows[0]
        of_hole = not models[row.model].traits.field and not row.from_inside
        if of_hole if field is None else row.model == field[0] and row.field in field[1]:
            found.append((name, row.spin != 0.0, _likeness(row.spin, row.distance, row.inclination_deg, row.fov_deg)))
    return tuple(found)


def bounds_steps(scene: Scene) -> bool:
    """Whether steps of any length were measured in the field of `scene`, or in one that is as hard to march through."""
    return bool(hardness.as_hard(scene, _measured_fields(scene.rays.model)))


@lru_cache(maxsize=64)
def _measured_fields(model: str) -> frozenset[str]:
    return frozenset(rows[0].field for rows in measurements().values() if rows[0].model == model)


def _likeness(spin: float, distance: float, inclination_deg: float, fov_deg: float) -> _Likeness:
    """Of two scenes tells how unlike they are by its distance.

    In spin, in how large the hole is in the picture, in how deep the camera sits, in inclination.
    """
    near = 1.0 / distance
    return abs(spin), 0.3 * math.log10(max(2.6 * near, 2.6e-4) / math.radians(fov_deg)), 2.0 * near, 0.3 * abs(math.cos(math.radians(inclination_deg)))


def forget() -> None:
    """To be called when `measurements` has changed."""
    for kept in (_nearest, _measured_like, _measured_fields):
        kept.cache_clear()
