"""The scenes that the chart measured (assets/measurements.csv), and which of them are most like a given one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

from ..physics import projection
from ..physics.space_time import is_field
from ..resources import assets_dir
from ..scene import Scene, catalogue
from . import hardness
from .measured import Measured, read

# A measured scene this near (see `_distance`) is the scene itself; otherwise the worse of the two nearest is believed.
_SAME = 0.02


@lru_cache(maxsize=1)
def measurements() -> Mapping[str, Sequence[Measured]]:
    """The rows of the chart's tables, of holes and of fields, by the scene they were measured in; empty where there are none."""
    paths = (assets_dir() / name for name in ("measurements.csv", "measurements_fields.csv"))
    models = catalogue.plug_ins("ray_model")
    return {name: rows for path in paths if path.is_file() for name, rows in read(path, models).items()}


@lru_cache(maxsize=64)
def nearest_scenes(scene: Scene) -> tuple[str, ...]:
    """The measured scene that is `scene`, or the two that are most like it, the likest first."""
    camera = scene.camera
    here = _likeness(scene.hole.spin, camera.distance, camera.inclination_deg, math.degrees(projection.view_angle(camera)))
    spins = scene.hole.spin != 0.0
    apart = sorted((_distance(here, spins, rows[0]), name) for name, rows in _alike(scene))
    if not apart:
        return ()
    return (apart[0][1],) if apart[0][0] <= _SAME else tuple(name for _, name in apart[:2])


def _alike(scene: Scene) -> Iterator[tuple[str, Sequence[Measured]]]:
    """The measured scenes of the same field as `scene`, or of holes from outside where it has none: their names and rows.

    A field that was not measured is like those of its kind that are as hard to march through; where none is, like the one that is as it comes.
    """
    models = catalogue.plug_ins("ray_model")
    fields = (hardness.as_hard(scene, _measured_fields(scene.rays.model)) or {""}) if is_field(scene) else None
    for name, rows in measurements().items():
        row = rows[0]
        of_hole = not models[row.model].traits.field and not row.from_inside
        if of_hole if fields is None else row.model == scene.rays.model and row.field in fields:
            yield name, rows


def bounds_steps(scene: Scene) -> bool:
    """Whether steps of any length were measured in the field of `scene`, or in one that is as hard to march through."""
    return bool(hardness.as_hard(scene, _measured_fields(scene.rays.model)))


@lru_cache(maxsize=64)
def _measured_fields(model: str) -> frozenset[str]:
    return frozenset(rows[0].field for rows in measurements().values() if rows[0].model == model)


def _distance(here: tuple[float, ...], spins: bool, row: Measured) -> float:
    """How unlike a measured scene is to that with the likeness `here`, whose hole `spins` or not.

    In spin, in how large the hole is in the picture, in how deep the camera sits, in inclination.
    """
    # A measured hole that spins says little of one that does not, and the other way round.
    kind = 1.0 if spins != (row.spin != 0.0) else 0.0
    return kind + math.dist(here, _likeness(row.spin, row.distance, row.inclination_deg, row.fov_deg))


@lru_cache(maxsize=512)
def _likeness(spin: float, distance: float, inclination_deg: float, fov_deg: float) -> tuple[float, float, float, float]:
    near = 1.0 / distance
    return abs(spin), 0.3 * math.log10(max(2.6 * near, 2.6e-4) / math.radians(fov_deg)), 2.0 * near, 0.3 * abs(math.cos(math.radians(inclination_deg)))


def forget() -> None:
    """To be called when `measurements` has changed."""
    nearest_scenes.cache_clear()
    _measured_fields.cache_clear()
