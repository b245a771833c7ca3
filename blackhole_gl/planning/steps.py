"""How many steps rays need, how long they may be in motion, and how far out they are marched at all."""

from __future__ import annotations

import math

from ..physics import projection
from ..scene import Scene, met
from ..scene.catalogue import PlugIn
from . import choice
from .record import Plan

# A ray that comes near the critical curve winds round the hole; one pixel in a 4K picture lies closer than 1e-7 to it only by
# rare chance, and 3 turns reach that: each turn takes a factor e^{2π} of distance.
SPARE_TURNS = 3.0

# Coarse rays that tell where things can be seen are given up after half a turn more than they need to pass the hole; beside those anything may be seen.
_REACH_TURNS = 0.5

# Ways through a field's sphere by its width, at most, that are looked at so.
_WINDING = 1.5

# More steps would cost as much as what they spare.
_MOST_REACH_STEPS, _MOST_FIELD_STEPS = 64, 256

# Beyond this radius (r_s, times the gravity strength) an outward ray is finished in closed form; see common/central_orbit.glsl.
# Models whose closed form is a first-order one state a larger march_bound in their header.
MARCH_BOUND = 6.0

# How far beyond all that rays may meet the march reaches: from infinity it begins there, and it must not begin on a surface.
_BEYOND = 1.05

# Orders by which errors of long steps grow faster than the scheme's, and how many times as long steps in motion may be at most.
_MORE_ORDERS, _LONGEST_IN_MOTION = 1, 1.5


def steps_in_motion(plan: Plan, height: int) -> float:
    """How many times as long steps are under a moving camera, of rays that meet nothing, in a picture `height` pixels high.

    A tolerance is in pixels of a picture 1080 high; one that moves and is drawn with fewer has it in its own. The error grows as a power of the step: as was
    measured, and that of long steps faster than by the scheme's order.
    """
    if math.isnan(plan.error_px) or plan.integrator is None or plan.step_control is None or plan.step_control.traits.adapts:
        return 1.0
    allowed = plan.scene.rays.tolerance * max(choice.PICTURE_HEIGHT / height, 1.0)
    least = plan.integrator.traits.order + _MORE_ORDERS
    order = least if math.isnan(plan.error_order) else max(least, plan.error_order)
    return min(max(allowed / max(plan.error_px, 1e-9), 1.0) ** (1.0 / order), _LONGEST_IN_MOTION)


def march_bound(scene: Scene, model: PlugIn) -> float:
    """Radius in r_s beyond which outward rays are finished in closed form: beyond all that they may meet."""
    return max((model.traits.march_bound or MARCH_BOUND) * max(1.0, scene.hole.gravity_strength), _BEYOND * met.reach(scene))


def reach_steps(scene: Scene, model: PlugIn, control: PlugIn | None) -> int:
    """`Plan.reach_steps`. Neighbours have to take steps of like length, and things to be bound to a place beside the hole."""
    if scene.rays.light_travel or met.is_empty(scene) or control is None or control.traits.adapts:
        return 0
    if math.isinf(scene.camera.distance) or not projection.is_perspective(scene.camera):
        return 0
    if not all(kind.traits.moves or kind.traits.centre for slot in met.SLOTS for kind in met.kinds(scene, slot)):
        return 0
    if model.traits.field:
        needed = _WINDING * 2.0 * scene.rays.field_radius / scene.rays.step_length
    else:
        needed = steps_needed(scene, model, control, _REACH_TURNS)
    steps = math.ceil(needed) + 2
    return steps if steps <= (_MOST_FIELD_STEPS if model.traits.field else _MOST_REACH_STEPS) else 0


def steps_needed(scene: Scene, model: PlugIn, control: PlugIn, turns: float = SPARE_TURNS) -> float:
    """Steps of the asked length that take a ray in from the camera, `turns` times round the hole, and out again.

    Adaptive controls find their own lengths: 0.
    """
    if control.traits.adapts:
        return 0.0
    shortest = control.traits.shortest
    if model.traits.field:
        return scene.rays.field_way / (scene.rays.step_length * shortest)
    if model.traits.marches_in == "mino":
        return (math.pi + 2.0 * math.pi * turns) / (scene.rays.step_angle * shortest)
    bound = march_bound(scene, model)
    far = min(scene.camera.distance, 1e6) if math.isfinite(scene.camera.distance) else bound
    photon_sphere = 1.5 * scene.hole.gravity_strength
    turn = 2.0 * math.pi * photon_sphere / math.sqrt(3.0)  # in σ: |v|² = 3 on the photon sphere
    if control.key == "fixed":
        aside = 1.7 * far  # the longest way of a ray that passes too far out to be taken in closed form
        return max(aside, min(far, bound) + 1.7 * bound + turns * turn) / scene.rays.step_length
    # 1.0 for what an artistic horizon lets run on inside r = G
    legs = math.log(max(min(far, bound) / photon_sphere, 1.0)) + math.log(2.0 * bound / photon_sphere) + 1.0
    return 3.0 * (legs + turns * turn / photon_sphere) / (scene.rays.step_length * shortest)
