"""What a plan asks of the text of programs: the plug-ins of each slot, and switches. Numbers are no part of it, so that a slider never compiles anything."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property, lru_cache
from operator import attrgetter

from ..planning import Plan
from ..scene import Scene, catalogue, met
from ..scene import fields as scene_fields
from . import instances, uniforms

RAY_SLOTS = ("ray_model", "integrator", "step_control")
SHADE_SLOTS = ("disk_layer", "sky")
MET_SLOTS = ("thing", "medium")

_sections = attrgetter(*(section.name for section in fields(Scene) if section.name != "camera"))


@dataclass(frozen=True)
class Structure:
    """What a plan asks of a program's text: (slot, paths) and (switch, value) pairs, and what reads the tables of instances."""

    chosen: tuple[tuple[str, tuple[str, ...]], ...]
    switches: tuple[tuple[str, int], ...]
    instances: str

    @cached_property
    def _hash(self) -> int:
        return hash((self.chosen, self.switches, self.instances))

    def __hash__(self) -> int:
        return self._hash


def structure_of(plan: Plan) -> Structure:
    """What `plan` asks of a program's text."""
    things = met.seen_kinds(plan.scene, "thing")
    groups = [*((slot, chosen(plan, slot)) for slot in (*RAY_SLOTS, *SHADE_SLOTS, "medium")), ("thing", things)]
    groups += [(f"thing_by_{way}", [kind for kind in things if kind.traits.meets == way]) for way in ("distance", "crossing")]
    groups.append(("thing_told_apart", [kind for kind in things if kind.traits.tells_apart]))
    groups.append(("thing_not_placed", [kind for kind in things if kind.traits.meets == "crossing" and not kind.traits.tells_apart]))
    groups.append(("steady_medium", [kind for kind in chosen(plan, "medium") if not kind.traits.changes]))
    paths = ((slot, tuple(plug_in.path for plug_in in found)) for slot, found in groups)
    return Structure(tuple(paths), tuple(uniforms.switches(plan).items()), instances.glsl(chosen(plan, *MET_SLOTS)))


def told_apart(plan: Plan) -> tuple:
    """Plans for which this is equal surely ask for the same text, as they differ in numbers of the camera and of steps alone: so do the frames of a camera
    that moves."""
    scene = plan.scene
    of_plan = plan.model, plan.integrator, plan.step_control, plan.orders, plan.meetings, plan.space_time.kind
    return *of_plan, *_sections(scene), *scene.several(_camera_words())


@lru_cache(maxsize=1)
def _camera_words() -> tuple[str, ...]:
    """The keys of all choices and switches of cameras."""
    return tuple(key for key, item in scene_fields().items() if key.startswith("camera.") and item.kind in ("choice", "switch"))


def chosen(plan: Plan, *slots: str) -> tuple[catalogue.PlugIn, ...]:
    """The plug-ins of `slots` that the plan and its scene use, in the order of `slots`."""
    return tuple(plug_in for slot in slots for plug_in in plan.plug_ins[slot])
