"""Scene → Plan: everything that is decided once a frame, and the reason for each decision."""

from __future__ import annotations

import math
from functools import lru_cache

from ..physics import motion, projection
from ..physics.space_time import SpaceTime, is_field, is_inside, ray_model, space_time
from ..scene import Scene, SceneError, catalogue, instances, met
from ..scene.catalogue import PlugIn
from . import choice, media_steps, steps
from .record import INNERMOST_MATTER, MERIDIAN, WORLD, Plan

# What is marched, or tells its paths, in each space-time.
_MARCHED = {"flat": "flat", "schwarzschild": "schwarzschild", "kerr": "kerr"}

# What tells how long light is under way, in each.
_TELLING_TIME = {"schwarzschild": "schwarzschild_binet", "kerr": "kerr"}

# Share of the tolerance that interpolation may take; the march's own error at most pixels is far below its share.
_REFINE_SHARE = 0.8


@lru_cache(maxsize=64)
def plan(scene: Scene, *, keep_crossings: bool = False) -> Plan:
    """The plan for `scene`. The same scene gives the same object while it is among the last few.

    Args:
        keep_crossings: keep crossings of the disk's plane even where the scene shows no disk.

    Raises:
        SceneError: the chosen model, integrator and step control do not fit together.
    """
    projection.refuse(scene)
    scene, why_other = _meeting_things(met.with_thickness(scene))
    chosen, why_times = _telling_time(scene, sky_alone=not keep_crossings)
    reasons = list(chosen.reasons if scene.rays.lensing else ("flat: lensing is off",)) + why_times
    in_media = media_steps.chosen(chosen.scene)
    scene = in_media.scene
    reasons += (*why_other, *in_media.reasons)
    model, where = ray_model(scene), space_time(scene)
    orders = scene.rays.orders if keep_crossings else _visible_orders(scene)
    meetings = _meetings(scene)
    reasons += _why_orders(scene, orders, keep_crossings)
    if scene.rays.light_travel and meetings == 2 and orders > 2:
        orders = 2
        reasons.append("2 orders: where light takes its time there is no room for the times of a third beside those of media")
    integrator = control = None
    stretch, max_steps = 1.0, 1
    if model.traits.kind != "closed":
        scene, why = _fitting(scene, model)
        reasons += why
        integrator, control = catalogue.plug_ins("integrator")[scene.rays.integrator], catalogue.plug_ins("step_control")[scene.rays.step_control]
        max_steps = scene.rays.max_steps
        stretch = max(1.0, steps.steps_needed(scene, model, control) / max_steps)
    reach, reach_steps = met.reach(scene), steps.reach_steps(scene, model, control)
    refine, why_refine = _refines(scene, model, chosen, reach_steps)
    reasons.append(why_refine)
    reasons += _what_lens(scene)
    scene, why_upright = _tilted(scene, model)
    scene, why_no_glow = _without_glow(scene)
    scene, why_still = _plunging(scene, where)
    reasons += why_still
    inner, outer = where.disk_radii(scene.disk)
    return Plan(
        scene=scene,
        space_time=where,
        model=model,
        integrator=integrator,
        step_control=control,
        step_length=scene.rays.step_length * stretch,
        step_angle=scene.rays.step_angle * stretch,
        max_steps=max_steps,
        march_bound=steps.march_bound(scene, model),
        orders=orders,
        disk_inner=inner,
        disk_outer=outer,
        disk_edge=INNERMOST_MATTER * where.horizon_radius if scene.disk.plunging else inner,
        meetings=meetings,
        reach=reach,
        reach_steps=reach_steps,
        error_px=choice.stated_error_px(scene) if is_field(scene) and stretch == 1.0 else math.nan,
        error_order=choice.error_order(scene) if is_field(scene) and stretch == 1.0 else math.nan,
        refine_px=refine_px(scene) if refine else 0.0,
        frame=MERIDIAN if met.is_empty(scene) and not is_field(scene) and not scene.disk.tilt_deg else WORLD,
        reasons=tuple(reasons),
        warnings=(*why_upright, *why_no_glow, *_why_longer(stretch, max_steps), *_why_coarse(scene, chosen), *in_media.warnings, *_why_slower(scene, where)),
    )


def _why_longer(stretch: float, max_steps: int) -> tuple[str, ...]:
    """What to say of steps that are `stretch` times as long as the scene asks for."""
    if stretch <= 1.0:
        return ()
    return (f"steps are {stretch:.2f} times longer than asked, so that {max_steps} of them cross the scene: where light bends most it may be false",)


def _why_coarse(scene: Scene, made: choice.Choice) -> tuple[str, ...]:
    """What to say of `scene`, which leaves nothing open, where it errs more than its tolerance allows.

    Nothing where that was not measured, and of models that are looks or know no gravity, which say so themselves.
    """
    traits = ray_model(scene).traits
    if not traits.exact or traits.space_time == "flat":
        return ()
    allowed = scene.rays.tolerance
    if not made.meets:
        return (f"{allowed:g} px of error cannot be met here, the floor of what was measured is {made.floor_px:.2g} px: the nearest is used",)
    error = math.nan if made.chosen is not None else choice.stated_error_px(scene)
    if error > allowed:
        return (f"the steps stated err by {error:.2g} px, more than the {allowed:g} px allowed: without them a method within it would be taken",)
    return ()


def _why_slower(scene: Scene, where: SpaceTime) -> tuple[str, ...]:
    """What to say of things and media that are to move faster than light."""
    found = []
    for section, slot in instances.SLOTS.items():
        for mover in motion.movers(scene, slot):
            if motion.outruns_light(mover.instance, mover.traits, where):
                found.append(f"{section}.{mover.name} goes round faster than light can: its light is shifted as if it were just slower than that")
    return tuple(found)


def _what_lens(scene: Scene) -> list[str]:
    """Where the Einstein ring of the lens over the finished picture is."""
    if not scene.post.lens:
        return []
    if math.isinf(scene.camera.distance):
        return ["post.lens displaces nothing from infinity"]
    ring = math.degrees(math.atan(math.sqrt(2.0 * scene.post.lens_radius / scene.camera.distance)))
    bent = "" if scene.rays.model == "flat" or not scene.rays.lensing else ", on top of what the rays do"
    return [f"post.lens displaces the picture about an Einstein ring of {ring:.3g}° round the hole's place{bent}"]


def _meetings(scene: Scene) -> int:
    """Meetings that are kept of a ray: one where whatever it meets first ends it; two where light comes through, as into and out of a medium.

    Raises:
        SceneError: there are things or media, and the camera is inside the horizon; media reach beyond the sphere of a field, where rays are not marched.
    """
    if met.is_empty(scene):
        return 0
    if is_inside(scene):
        text = f"got {scene.camera.distance:g} r_s, inside the horizon, from where things and media are not met: allowed is outside"
        raise SceneError("camera.distance", text)
    media = met.reach_of(scene, "medium")
    if is_field(scene) and scene.rays.lensing and media > scene.rays.field_radius:
        text = f"got {scene.rays.field_radius:g} r_s, and media reach {media:g} r_s from the middle: allowed is as far as they do, or farther"
        raise SceneError("rays.field_radius", text)
    return 2 if scene.media or not all(kind.traits.opaque for kind in met.kinds(scene, "thing")) else 1


def forget_measurements() -> None:
    """To be called when the chart's table has changed: what was planned by the old one is planned anew."""
    choice.forget_choices()
    plan.cache_clear()


def _meeting_things(scene: Scene) -> tuple[Scene, list[str]]:
    """`scene` with a ray model whose rays can meet what there is to meet, and why another than it states."""
    model = ray_model(scene)
    if met.is_empty(scene) or model.traits.meets_things:
        return scene, []
    other = _MARCHED[model.traits.space_time]
    why = f"{other} instead of {model.key}, which goes from pixel to disk at once and cannot meet things on the way"
    return scene.with_values({"rays.model": other}), [why]


def _telling_time(scene: Scene, sky_alone: bool) -> tuple[choice.Choice, list[str]]:
    """What is chosen for `scene`; where light is to take its time, with a ray model that tells how much, or without, and why."""
    made = choice.choose(scene, sky_alone=sky_alone)
    model = ray_model(made.scene)
    if not scene.rays.light_travel:
        return made, []
    why = _why_no_time(made.scene)
    if why:
        return choice.choose(scene.with_values({"rays.light_travel": False}), sky_alone=sky_alone), [f"light takes no time: {why}"]
    if model.traits.tells_time:
        return made, []
    other = _TELLING_TIME[model.traits.space_time]
    why = f"{other} instead of {model.key}, which does not tell how long light is under way"
    return choice.choose(scene.with_values({"rays.model": other}), sky_alone=sky_alone), [why]


def _why_no_time(scene: Scene) -> str:
    """Why it is not known how long light is under way in `scene`; empty where it is."""
    model = ray_model(scene)
    if not model.traits.tells_time and (not model.traits.exact or model.traits.space_time not in _TELLING_TIME):
        return f"{model.key} is light of no hole's own space-time"
    if scene.hole.gravity_strength != 1.0 or scene.hole.horizon_size != 1.0:
        return "artistic gravity has no clocks"
    if is_inside(scene):
        return "at the horizon the time of those far away has no end, and the camera is inside"
    return ""


def _fitting(scene: Scene, model: PlugIn) -> tuple[Scene, list[str]]:
    """`scene` with a step control that its marched model and its integrator go with, and what was changed.

    Raises:
        SceneError: no step control mends it.
    """
    against = catalogue.reasons_against(model.key, scene.rays.integrator, scene.rays.step_control)
    if not against:
        return scene, []
    control = model.traits.step_control
    why = f"steps by {control}: {'; '.join(against)}"
    against = catalogue.reasons_against(model.key, scene.rays.integrator, control)
    if against:
        raise SceneError("rays.integrator", "; ".join(against))
    return scene.with_values({"rays.step_control": control}), [why]


def _why_orders(scene: Scene, orders: int, keep_crossings: bool) -> list[str]:
    if orders == 0:
        return ["no crossings are looked for: the disk is off"]
    if orders < scene.rays.orders and not keep_crossings:
        height = choice.PICTURE_HEIGHT
        return [f"{orders} of {scene.rays.orders} orders: the next ring is too thin to change a picture {height} pixels high by 1/255"]
    return []


def unfit_options(key: str, scene: Scene) -> dict[str, str]:
    """The integrators or step controls (by `key`) that do not go with the rest of how `scene` is traced, each with the reason.

    Empty for other keys, and for a scene whose parts do not fit as they are: any change may then be the right one.
    """
    if key not in ("rays.integrator", "rays.step_control"):
        return {}
    try:
        made = plan(scene)
    except SceneError:
        return {}
    found = {}
    for option in catalogue.keys(key.removeprefix("rays.")):
        if made.integrator is None or made.step_control is None:
            reasons = [f"{made.model.key} goes from pixel to hits at once and takes no steps"]
        elif key == "rays.integrator":
            reasons = catalogue.reasons_against(made.model.key, option, made.step_control.key)
        else:
            reasons = catalogue.reasons_against(made.model.key, made.integrator.key, option)
        if reasons:
            found[option] = "; ".join(reasons)
    return found


def refine_px(scene: Scene) -> float:
    """Error in pixels that interpolation between exact rays may add in `scene` where its hit map is refined."""
    return _REFINE_SHARE * scene.rays.tolerance


def _refines(scene: Scene, model: PlugIn, made: choice.Choice, reach_steps: int) -> tuple[bool, str]:
    """Whether the hit map of `scene`, which leaves nothing open, is refined while the camera moves, and why.

    The method stays that of the picture at rest, though a coarser one might do for the camera's way: another method would be another
    program to wait for and a jump when the camera stops.
    """
    if model.traits.kind == "closed" and (model.traits.space_time == "flat" or not model.traits.exact):
        return False, "moving: a ray for every pixel, as it costs no more than interpolating"
    if not met.is_empty(scene) and not reach_steps:
        return False, "moving: a ray for every pixel, as it is not known where things and media can be seen"
    if scene.rays.light_travel:
        return False, "moving: a ray for every pixel, as the times of light are not interpolated"
    if not projection.is_perspective(scene.camera):
        return False, f"moving: a ray for every pixel, as in {scene.camera.projection} pictures none is interpolated"
    if not scene.rays.refine:
        return False, "moving: a ray for every pixel, as rays.refine is off"
    found = choice.refinement(scene)
    if found is None:
        return True, f"moving: refined within {refine_px(scene):.2g} px; what that costs here was not measured"
    # Steps stated by hand, or a tolerance below the floor, miss it at rest too: then the bound on what interpolation adds is all there is to keep.
    kept = made.chosen is None or not made.meets or found.error_px <= scene.rays.tolerance
    if kept and found.cost < found.cost_unrefined:
        return True, f"moving: refined, {found}"
    return False, f"moving: a ray for every pixel; refined would be {found}"


def _visible_orders(scene: Scene) -> int:
    """Orders of crossings that can be seen: 0 without a disk; round a hole, those whose ring is not too thin for one grey level.

    Each half turn thins the ring by e^{−π} in Schwarzschild (Ohanian 1987), the first being about as wide as the shadow; a spinning
    hole's rings are wider on the receding side, for which a factor of 8 is left.
    """
    if not (scene.disk.enabled or scene.post.lines_in_plane and not scene.media):
        return 0
    if not scene.rays.lensing:
        return 1
    if is_field(scene):
        return scene.rays.orders
    camera = scene.camera
    half_height = projection.half_height(camera) / 2.0 if math.isinf(camera.distance) else camera.distance * projection.half_height(camera)
    shadow_px = 0.5 * choice.PICTURE_HEIGHT * 2.6 * scene.hole.gravity_strength / half_height
    seen = sum(8.0 * shadow_px * math.exp(-math.pi * order) >= 1.0 / 255.0 for order in range(1, 3))
    return min(scene.rays.orders, 1 + seen)


def _tilted(scene: Scene, model: PlugIn) -> tuple[Scene, list[str]]:
    """`scene` with its disk in the equator where its ray model finds no crossings of another plane, and what to say of it."""
    if not scene.disk.tilt_deg or model.traits.tilted_disk:
        return scene, []
    return scene.with_values({"disk.tilt_deg": 0.0}), [f"the disk is not tilted: {model.key} finds crossings of the equator alone"]


def _without_glow(scene: Scene) -> tuple[Scene, list[str]]:
    """`scene` without bloom where that would show the edges of a cube's faces, and what to say of it."""
    if scene.camera.projection != projection.CUBE or not scene.post.bloom:
        return scene, []
    return scene.with_values({"post.bloom": False}), ["no glow: it would end at the edges of the cube's faces; camera.projection equirectangular has it"]


def _plunging(scene: Scene, where: SpaceTime) -> tuple[Scene, list[str]]:
    """`scene` with no matter that falls in where there can be none, and why."""
    why = _why_none_falls(scene, where) if scene.disk.plunging else ""
    if why:
        return scene.with_values({"disk.plunging": False}), [f"no matter inside the innermost stable orbit: {why}"]
    return scene, []


def _why_none_falls(scene: Scene, where: SpaceTime) -> str:
    """Why there can be no matter inside the innermost stable orbit of `scene`; empty where there can."""
    if not where.has_hole or not ray_model(scene).traits.exact or scene.hole.gravity_strength != 1.0 or scene.hole.horizon_size != 1.0:
        return "the rays are not those of a hole's own space-time"
    if scene.disk.tilt_deg:
        return "the disk is tilted, and what falls in freely would leave its plane"
    if scene.disk.frequency_shift != "exact":
        return "the older viewers' formulas for g know none"
    if scene.disk.inner_radius > where.isco_radius(scene.disk):
        return "the disk is cut off outside of it"
    return ""
