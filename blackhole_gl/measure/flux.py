"""The flux of a picture: its radiance times the angles that its pixels have, with what finer steps and pixels change in it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..physics import angular_size, projection
from ..planning import plan
from ..rendering.frame import Renderer
from ..scene import Camera, Scene, SceneError, met

EMISSIVITY_UNIT = 1e-18
"""erg/(s cm³ sr Hz): of media whose light is of one frequency, 1 r_s of which has radiance 1 in the picture."""

JANSKY = 1e-23
"""erg/(s cm² Hz)."""

_MOST_SIDE = 8192  # pixels of a picture drawn at twice the size


@dataclass(frozen=True)
class Flux:
    """A picture's flux.

    Attributes:
        value: in `unit`.
        unit: ``Jy``, or of radiance: ``radiance·M²`` seen from infinity, ``radiance·sr`` from near by.
        halved: share that it changes by where all steps are half as long.
        doubled: the same for a picture with twice the pixels along each side; NaN where that would be too large.
    """

    value: float
    unit: str
    halved: float
    doubled: float

    def __str__(self) -> str:
        lines = [f"flux = {self.value:.5g} {self.unit}", f"  steps half as long: {self.halved:+.2%}"]
        lines += [] if math.isnan(self.doubled) else [f"  twice the pixels along each side: {self.doubled:+.2%}"]
        return "\n".join(lines)


def measured(renderer: Renderer, scene: Scene, time: float, size: tuple[int, int], progress: Callable[[float], None]) -> Flux:
    """The flux of the picture of `scene` at scene time `time`, `size` (width, height) pixels large.

    Raises:
        SceneError: the scene asks for a view, whose colours are no light; or as drawing it.
    """
    if scene.post.view != "picture":
        raise SceneError("post.view", f"got {scene.post.view!r}, whose colours are no light; allowed for a flux is picture")
    value = _summed(renderer, scene, time, size)
    progress(0.2)
    halved = _summed(renderer, with_half_steps(scene), time, size) / value - 1.0 if value else 0.0
    progress(0.4)
    twice = 2 * size[0], 2 * size[1]
    doubled = _summed(renderer, scene, time, twice) / value - 1.0 if value and max(twice) <= _MOST_SIDE else math.nan
    progress(1.0)
    unit, factor = _unit(scene)
    return Flux(value * factor, unit, halved, doubled)


def with_half_steps(scene: Scene) -> Scene:
    """`scene` with the method that its plan chooses, and all steps half as long; no shorter than is allowed."""
    made = plan(scene)
    halved: dict[str, float | str] = {"rays.medium_step": 0.5 * made.scene.rays.medium_step} if scene.media else {}
    if made.integrator is not None and made.step_control is not None:
        halved |= {"rays.model": made.model.key, "rays.integrator": made.integrator.key, "rays.step_control": made.step_control.key}
        halved |= {"rays.step_angle": 0.5 * made.step_angle, "rays.step_length": 0.5 * made.step_length}
    return scene.with_values(halved)


def _summed(renderer: Renderer, scene: Scene, time: float, size: tuple[int, int]) -> float:
    """Radiance times solid angle, of the mean of the colours; M² for the angle seen from infinity."""
    renderer.render(scene, time, size)
    return float((renderer.radiance().astype(float).mean(axis=-1) * pixel_angles(scene.camera, size)).sum())


def pixel_angles(camera: Camera, size: tuple[int, int]) -> np.ndarray:
    """Solid angle of each pixel of a picture of `size` (width, height), float64 (height, width): in sr, or in M² for a camera at infinity."""
    width, height = size
    if not projection.is_perspective(camera):
        raise SceneError("camera.projection", f"got {camera.projection}; fluxes are summed over a plane picture: allowed is {projection.PERSPECTIVE}")
    if math.isinf(camera.distance):
        return np.full((height, width), (camera.field_m / height) ** 2)
    side = 2.0 * math.tan(math.radians(0.5 * camera.fov_deg)) / height
    x, y = np.meshgrid((np.arange(width) + 0.5 - 0.5 * width) * side, (np.arange(height) + 0.5 - 0.5 * height) * side)
    return side**2 * (1.0 + x**2 + y**2) ** -1.5


def _unit(scene: Scene) -> tuple[str, float]:
    """The unit of the flux, and what radiance times angle is to be multiplied by.

    Janskys, where the scene stands for a real object, its observer is as far away as we are, and all that shines in it is of one frequency.
    """
    if not math.isinf(scene.camera.distance):
        return "radiance·sr", 1.0
    one_frequency = scene.media and not any(kind.traits.bolometric for kind in met.kinds(scene, "medium"))
    if not (scene.source.real and one_frequency) or scene.disk.enabled or scene.sky.enabled or scene.things:
        return "radiance·M²", 1.0
    angle = angular_size.m_uas(scene.source) * angular_size.MICROARCSECOND
    radius = 100.0 * 2.0 * angular_size.SUN_GM * scene.source.mass_suns / angular_size.LIGHT_SPEED**2  # r_s in cm
    return "Jy", EMISSIVITY_UNIT * radius * angle**2 / JANSKY
