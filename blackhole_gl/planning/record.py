"""The plan of a frame: the scene with nothing left open, its space-time, and how its rays are traced."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from ..physics import disk_profile
from ..physics.space_time import SpaceTime
from ..scene import Scene, catalogue, met
from ..scene.catalogue import PlugIn
from ..scene.traits import IntegratorTraits, RayModelTraits, StepControlTraits
from ..shapes import Float

REFINE_STEP = 4
"""Pixels between the exact rays of a refined hit map's coarse grid."""

REACH_STEP = 2 * REFINE_STEP
"""Pixels between the coarse rays that first tell where things can be seen, at least: twice `REFINE_STEP`, which is what there is between those that tell it of
cells."""

GRID_MARGIN = 2
"""Nodes of that grid outside the picture on each side: those whose differences the picture's edge needs, and what they are differences from."""

HALF_STEP = 2
"""Pixels between the exact rays of a refined hit map where its coarse grid is too coarse."""

HALF_MARGIN = 1
"""Of these rays, those before the first of the picture's each way, as differences are taken; after the last there are twice as many."""

INNERMOST_CROSSING = 1.02
"""The innermost crossing that is kept, in horizon radii: closer in, azimuth and g diverge."""

INNERMOST_MATTER = 1.03
"""Where falling matter ends, in horizon radii: just outside the innermost crossing, so that its edge is seen."""

Frame = Literal["meridian", "world"]
MERIDIAN: Frame = "meridian"
WORLD: Frame = "world"


@dataclass(frozen=True)
class Plan:
    """What a picture of a scene is made by.

    Attributes:
        scene: the scene with nothing left open.
        space_time: what light runs in there.
        model, integrator, step_control: plug-ins; the last two are None for closed models.
        step_length: Δt₀ in r_s, as used.
        step_angle: κ in radians, as used.
        max_steps: no ray takes more.
        march_bound: radius in r_s beyond which outward rays are finished in closed form.
        orders: crossings of the disk's plane that are kept, 0 without a disk.
        disk_inner, disk_outer: the edges of the disk's circular orbits in r_s, as used.
        disk_edge: how far in there is matter, in r_s: `disk_inner`, or the innermost crossing of the plane that can be told where matter falls in.
        meetings: how many of the scene's things and media are kept of each ray, 0 where there are none.
        reach: radius in r_s beyond which there is none of them.
        reach_steps: steps in which coarse rays tell where in a picture the things and media can be seen; 0: that is not known, and they may be anywhere.
        error_px: that of the march in a field at 99 % of the rays, by the chart, in pixels of a picture 1080 high; NaN where it was not measured, and
            about holes.
        error_order: the power of the step by which that grows up to the next longer one that was measured; NaN where none was.
        refine_px: error in pixels that interpolation between exact rays may add while the camera moves; 0: every pixel has its own ray.
        frame: what rays are traced in: the camera's ``meridian`` (the world turned about the spin axis so that the camera's azimuth is 0), so that a camera
            which turns about the axis keeps its hits, where all that bends rays and that they meet is symmetric about the axis; else the ``world``.
        reasons: why, a sentence each, for people.
        warnings: what turns out worse than the scene asks, a sentence each.
    """

    scene: Scene
    space_time: SpaceTime
    model: PlugIn[RayModelTraits]
    integrator: PlugIn[IntegratorTraits] | None
    step_control: PlugIn[StepControlTraits] | None
    step_length: float
    step_angle: float
    max_steps: int
    march_bound: float
    orders: int
    disk_inner: float
    disk_outer: float
    disk_edge: float
    meetings: int
    reach: float
    reach_steps: int
    error_px: float
    error_order: float
    refine_px: float
    frame: Frame
    reasons: tuple[str, ...]
    warnings: tuple[str, ...]

    @cached_property
    def plug_ins(self) -> Mapping[str, tuple[PlugIn[Any], ...]]:
        """By slot those that it and its scene use."""
        scene, layers = self.scene, catalogue.plug_ins("disk_layer")
        return {
            "ray_model": (self.model,),
            "integrator": (self.integrator,) if self.integrator else (),
            "step_control": (self.step_control,) if self.step_control else (),
            "disk_layer": tuple(layers[key] for key in scene.disk_layers()) if self.shows_disk else (),
            "sky": (catalogue.plug_ins("sky")[scene.sky.model],) if scene.sky.enabled else (),
            **{slot: met.kinds(scene, slot) for slot in met.SLOTS},
        }

    @property
    def azimuth_deg(self) -> float:
        """Azimuth of the camera in the frame that rays are traced in."""
        return 0.0 if self.frame == MERIDIAN else self.scene.camera.azimuth_deg

    @property
    def shows_disk(self) -> bool:
        """Whether a disk is seen; crossings of its plane may be kept without."""
        return self.orders > 0 and self.scene.disk.enabled

    def disk_temperatures(self, radii: Float[np.ndarray, "*radii"]) -> Float[np.ndarray, "*radii"]:
        """T/T_peak of the disk's matter at `radii` in r_s, by its temperature law; 0 inside of all matter, and going on beyond the outer edge."""
        disk = self.scene.disk
        return disk_profile.temperature(
            disk.temperature_law,
            radii,
            spin=self.space_time.matter_spin(disk),
            orbit=disk.orbit,
            r_in=self.disk_inner,
            r_out=self.disk_outer,
            torque=disk.inner_torque,
            edge=self.disk_edge,
        )

    @property
    def times(self) -> bool:
        """Whether it is kept how long light is under way."""
        return self.scene.rays.light_travel

    @property
    def is_inside(self) -> bool:
        """Whether the camera is inside the horizon, or on it."""
        return self.scene.camera.distance <= self.space_time.horizon_radius

    @property
    def turn_deg(self) -> float:
        """Angle about the spin axis that takes this frame to the world."""
        return self.scene.camera.azimuth_deg - self.azimuth_deg

    @property
    def evaluations_per_step(self) -> int:
        """Right-hand-side evaluations in one step, tried ones included; 0 for closed models."""
        if self.integrator is None or self.step_control is None:
            return 0
        scheme, control = self.integrator.traits, self.step_control.traits
        pair = scheme.pair_evaluations if control.needs_pair else None
        return (scheme.evaluations if pair is None else pair) * control.integrator_steps

    @property
    def method(self) -> str:
        """The method in a few words, e.g. ``kerr, rk4, κ = 0.2``."""
        if self.integrator is None or self.step_control is None:
            return self.model.key
        step = f"κ = {self.step_angle:.3g}" if self.model.traits.marches_in == "mino" else f"Δt₀ = {self.step_length:.3g}"
        control = "" if self.step_control.key == "mino" else f"{self.step_control.key}, "
        return f"{self.model.key}, {self.integrator.key}, {control}{step}"
