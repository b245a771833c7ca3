"""What is measured: methods (model, integrator, step control) and their step settings, all from the catalogue."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

from ..physics import observer
from ..physics.space_time import is_field
from ..planning.choice import REFINED_TOLERANCE
from ..scene import Scene, catalogue
from ..scene.catalogue import PlugIn
from ..scene.traits import RayModelTraits

# From steps that only just hold together to steps that add more rounding than they take away; the κ of every preset that states one is among them.
ANGLES = (0.8, 0.56, 0.4, 0.28, 0.2, 0.1, 0.05, 0.025)  # κ, rad
LENGTHS = (1.2, 0.8, 0.5, 0.3, 0.15, 0.08, 0.04)  # Δt₀, r_s
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)  # rad a step
QUICK_ANGLES = (0.8, 0.4, 0.2, 0.1, 0.05)
QUICK_LENGTHS = (0.8, 0.5, 0.3, 0.15, 0.08)
QUICK_TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)

# The finest κ that refined maps are measured with: the errors of finer marches do not show behind that of interpolation.
FINEST_REFINED = 0.1

# Long first trials, which an adaptive control shortens where it must.
_FIRST_TRIAL = {"rays.step_angle": 0.4, "rays.step_length": 0.5}

_BEST = ("rk4", "dopri5", "nystrom5")
_BEST_OF_PLACES = ("nystrom4", "nystrom5")  # where forces depend on places alone

# Enough that no step is ever stretched: what is measured is what was asked for.
MAX_STEPS = 8192


@dataclass(frozen=True)
class Combination:
    """A ray model, an integrator and a step control that go together: a method but for its step. The last two are empty for closed models.

    Attributes:
        changes: switches and whole numbers of a closed model that are not as they come, as (key, value) pairs.
        refined: whether the hit map is refined, as while a camera moves: a coarse grid of exact rays, and the pixels that cannot be interpolated.
    """

    model: str
    integrator: str = ""
    step_control: str = ""
    changes: tuple[tuple[str, bool | int], ...] = ()
    refined: bool = False

    @property
    def name(self) -> str:
        """A short name for tables and curves, e.g. ``kerr, rk4, mino``."""
        return ", ".join(part for part in (self.model, self.integrator, self.step_control, self.variant, "refined" if self.refined else "") if part)

    @property
    def variant(self) -> str:
        """Its `changes` as text; empty for most."""
        return " ".join(f"{key.rsplit('.', 1)[-1]} {'on' if value else 'off'}" for key, value in self.changes)

    @property
    def knob(self) -> str:
        """What its step setting is: ``angle`` (κ), ``length`` (Δt₀), ``tolerance``, or ``none``."""
        if not self.integrator:
            return "none"
        if catalogue.plug_ins("step_control")[self.step_control].traits.adapts:
            return "tolerance"
        return "angle" if catalogue.plug_ins("ray_model")[self.model].traits.marches_in == "mino" else "length"

    @property
    def knob_key(self) -> str:
        """The scene key of the step setting; empty for closed models."""
        return {"angle": "rays.step_angle", "length": "rays.step_length", "tolerance": f"rays.{self.step_control}.tolerance", "none": ""}[self.knob]

    def settings(self, quick: bool = False) -> tuple[float, ...]:
        """Its step settings, coarse to fine; one meaningless 0 for closed models."""
        if self.knob == "none":
            return (0.0,)
        ladder = {
            "angle": (ANGLES, QUICK_ANGLES),
            "length": (LENGTHS, QUICK_LENGTHS),
            "tolerance": (TOLERANCES, QUICK_TOLERANCES),
        }
        return tuple(setting for setting in ladder[self.knob][quick] if not self.refined or setting >= FINEST_REFINED)

    def values(self, setting: float) -> dict[str, Any]:
        """The scene values, by dotted key, that make a scene be traced by this method with `setting`."""
        values: dict[str, Any] = {"rays.model": self.model, "rays.lensing": True, "rays.max_steps": MAX_STEPS, **dict(self.changes)}
        if self.integrator:
            values |= {"rays.integrator": self.integrator, "rays.step_control": self.step_control, **_FIRST_TRIAL, self.knob_key: setting}
        if self.refined:
            values["rays.tolerance"] = REFINED_TOLERANCE
        return values

    def applied(self, scene: Scene, setting: float) -> Scene:
        """`scene` traced by this method with `setting`, all orders of crossings kept and no times of light, which not every model tells."""
        return scene.with_values({**self.values(setting), "rays.orders": 3, "rays.light_travel": False})


def sensible(scene: Scene, whole: bool = True) -> list[Combination]:
    """The methods worth measuring for `scene`, in the catalogue's order.

    A model that is exact for the scene's hole is tried with every integrator (and its own step control) and every step control (and
    the best integrator that fits), or, unless `whole`, with the best of both; any other model has a floor that no integrator lowers,
    and is tried once. A field is its own truth, and the only model of its scene.
    """
    if is_field(scene):
        return _methods_of_field(scene.rays.model, whole)
    found: dict[Combination, None] = {}
    for model in catalogue.plug_ins("ray_model").values():
        if not model.traits.field and _has_camera(model, scene):
            found |= dict.fromkeys(_methods_of(model, scene, whole))
    return list(found)


def worth_refining(scene: Scene, quick: bool = False) -> list[Combination]:
    """The methods worth measuring with refinement for `scene`.

    Those that the plan may come to: the model made for this kind of hole, or any that leads through its horizon to a camera inside, marched in Mino time by its
    separated equations (any other march costs several times as much), with the best integrators; and exact closed models. Where there is one the plan takes a
    march only when it is told to: one integrator will do.
    """
    exact = [model for model in catalogue.plug_ins("ray_model").values() if exact_for(model, scene) and _has_camera(model, scene)]
    separated = [model for model in exact if _is_separated(model)]
    models = [model for model in separated if model.traits.spins == (scene.hole.spin != 0.0)] or separated
    closed = [Combination(model.key) for model in exact if model.traits.kind == "closed"]
    integrators = ("rk4",) if closed or quick else _BEST
    marched = [method for model in models for method in _fitting(model.key, integrators, _own_control(model))]
    return [replace(method, refined=True) for method in marched + closed]


def _has_camera(model: PlugIn, scene: Scene) -> bool:
    return observer.is_possible(scene.with_values({"rays.model": model.key, "rays.lensing": True}))


def _is_separated(model: PlugIn) -> bool:
    """Whether `model` is marched in Mino time by equations in which places alone act."""
    return model.traits.marches_in == "mino" and model.traits.second_order


def _methods_of(model: PlugIn, scene: Scene, whole: bool) -> Iterator[Combination]:
    if model.traits.kind == "closed":
        yield Combination(model.key)
        yield from (Combination(model.key, changes=((key, not item.default),)) for key, item in model.parameters.items() if item.kind == "switch")
        return
    own = _own_control(model)
    if not exact_for(model, scene):
        yield from _fitting(model.key, ["rk4"], own)
    elif not whole:
        yield from _fitting(model.key, _BEST, own)
        yield from _fitting(model.key, _BEST, _pair_controls())
    else:
        yield from _fitting(model.key, catalogue.keys("integrator"), own)
        yield from _fitting(model.key, ["rk4"], [key for key in catalogue.keys("step_control") if key not in own])
        yield from _fitting(model.key, catalogue.keys("integrator"), _pair_controls())
        yield from _fitting(model.key, ["euler", "verlet"], ["fixed"])


def _methods_of_field(model: str, whole: bool) -> list[Combination]:
    found = list(_fitting(model, catalogue.keys("integrator") if whole else _BEST, ["fixed"]))
    own = _own_control(catalogue.plug_ins("ray_model")[model])
    found += _fitting(model, _BEST_OF_PLACES, [key for key in own if key != "fixed"])
    found += _fitting(model, catalogue.keys("integrator") if whole else _BEST, _pair_controls())
    return found + list(_fitting(model, ["rk4"], ["doubling"]))


def _own_control(model: PlugIn[RayModelTraits]) -> list[str]:
    """The step control that suits `model` best; none for a closed one."""
    return [] if model.traits.step_control is None else [model.traits.step_control]


def _pair_controls() -> list[str]:
    return [key for key, control in catalogue.plug_ins("step_control").items() if control.traits.needs_pair]


def exact_for(model: PlugIn, scene: Scene) -> bool:
    """Whether `model` solves the very space-time of `scene`."""
    return model.traits.exact and model.traits.space_time != "flat" and (model.traits.spins or scene.hole.spin == 0.0)


def _fitting(model: str, integrators: Iterable[str], controls: Iterable[str]) -> Iterator[Combination]:
    for integrator in integrators:
        for control in controls:
            if not catalogue.reasons_against(model, integrator, control):
                yield Combination(model, integrator, control)


