"""The uniform blocks: what a ray depends on, what shading depends on, and every number of the scene.

`ray_block` and the scene's ``hole`` and ``rays`` numbers are all that the hits depend on; its bytes are part of the hit map's key.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cache

from ..glsl.blocks import Block
from ..glsl.declared import defines
from ..physics import accretion, observer, plunging, projection, shear, tilted_disk
from ..planning import GRID_MARGIN, HALF_MARGIN, INNERMOST_CROSSING, REFINE_STEP, Plan
from ..scene import Scene, catalogue, fields, met
from ..scene.frozen import changed
from ..scene.schema import Value
from ..scene.tables import Number
from . import instances, pictures

_RAY_MEMBERS = (
    ("observer_map", "mat4"),  # (E, w', n'_θ, n'_φ) from (1, n_r, n_θ, n_φ); see observer.py
    ("camera_n", "vec4"),  # from the hole to the camera, in the plan's frame; w: sine of the inclination
    ("camera_e_theta", "vec4"),
    ("camera_e_phi", "vec4"),
    ("view_back", "vec4"),  # world axes of the view, as camera_n, e_θ and e_φ for a camera that looks at the hole
    ("view_down", "vec4"),
    ("view_right", "vec4"),
    ("seen_colour", "vec4"),  # what light from (1, n) counts as, for colours and for brightness; read where parts of the observer's motion are switched off
    ("seen_beaming", "vec4"),
    ("picture_size", "vec2"),  # pixels of the whole picture
    ("picture_offset", "vec2"),  # of the drawn part in it, with the sub-pixel shift
    ("picture_ring", "vec4"),  # of a part that is kept in a ring: the pixel of the ring that its first one has, and the ring's size; else 0
    ("picture_hole", "vec2"),  # pixel in the direction of the hole, far off where it is not ahead
    ("disk_axis_x", "vec4"),  # the disk's own axes, in the plan's frame: two in its plane, and that which stands on it
    ("disk_axis_y", "vec4"),
    ("disk_axis_z", "vec4"),
    ("hole_w_factors", "vec2"),  # r₊, r₋ in M: Δ w² = (1 − w r₊)(1 − w r₋)
    ("picture_scale", "float"),  # half height of the picture per pixel, at distance 1 (or in M); of pictures all round half a pixel's angle
    ("camera_w", "float"),  # M/r, 0 at infinity
    ("hole_w_stop", "float"),  # M/r inside which an inward ray is captured
    ("crossing_r_min", "float"),  # r_s
    ("march_bound", "float"),  # r_s
    ("plan_step_length", "float"),  # r_s
    ("plan_step_angle", "float"),  # rad
    ("plan_max_steps", "int"),
)

_SHADE_MEMBERS = (
    ("shear_phase", "vec4"),  # ages and weights of the two patterns, r_s/c; see shear.py
    ("shear_seed", "vec4"),
    ("camera_heading", "vec2"),  # (cos, sin) of the angle that turns hits from the plan's frame to the world
    ("disk_veil", "vec2"),  # of the share of light that a disk of density 1 lets through: log₂; and 1 over what it hides
    ("disk_fall", "vec4"),  # of what falls in from the ISCO: its radius in M, energy, angular momentum in M along the orbit; 0
    ("disk_r_in", "float"),  # r_s, as used; where circular orbits end
    ("disk_r_edge", "float"),  # where matter ends
    ("disk_r_out", "float"),
    ("disk_spin_sign", "float"),  # +1: the matter turns counter-clockwise seen from +z
    ("hole_spin_complement", "float"),  # 1 − |a*|
    ("plan_medium_step", "float"),  # share of a medium's scale
)


_NOTHING: Mapping[str, object] = {"float": 0.0, "int": 0, "vec2": (0.0,) * 2, "vec4": (0.0,) * 4, "mat4": ((0.0,) * 4,) * 4}

NO_RING = 0, 0, 0, 0
"""Of what is drawn as it lies in its picture."""


@cache
def ray_block() -> Block:
    """What a ray depends on: numbers of ours, and those that the plug-ins of rays declare."""
    return Block("RayBlock", 0, (*_RAY_MEMBERS, *((number.name, number.type) for number in _numbers(True))))


@cache
def shade_block() -> Block:
    """What shading depends on: numbers of ours, and those that the other plug-ins declare."""
    return Block("ShadeBlock", 1, (*_SHADE_MEMBERS, *((number.name, number.type) for number in _numbers(False))))


@cache
def _numbers(of_rays: bool) -> tuple[Number, ...]:
    """What plug-ins declare for rays, or for shading alone; each once, as several may ask for the same.

    Raises:
        CatalogueError: a name means two things.
    """
    ours = {name for name, _ in (*_RAY_MEMBERS, *_SHADE_MEMBERS)}
    found: dict[str, tuple[Number, bool]] = {}
    for key, slot in catalogue.SLOTS.items():
        for number in (number for plug_in in catalogue.plug_ins(key).values() for number in plug_in.numbers):
            known, for_rays = found.get(number.name, (number, False))
            if number.name in ours or known != number:
                raise catalogue.CatalogueError(f"{number.place}: this name has another meaning already; the number needs a name of its own")
            found[number.name] = number, for_rays or slot.section == "rays"
    return tuple(number for number, for_rays in found.values() if for_rays == of_rays)


@cache
def scene_block() -> Block:
    """Every number of the scene by its key with underscores; angles of the camera are left to the host."""
    return Block("SceneBlock", 2, tuple((name, fields()[key].kind) for key, name in zip(*_number_names())))


@cache
def _number_names() -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The key of every number that shaders know, and its member."""
    known = {key: item.glsl_name for key, item in fields().items() if item.kind in ("float", "int") and not key.endswith("_deg")}
    return tuple(known), tuple(known.values())


def blocks() -> tuple[Block, ...]:
    """All uniform blocks."""
    return ray_block(), shade_block(), scene_block()


def ray_values(plan: Plan, size: tuple[int, int], offset: tuple[float, float] = (0.0, 0.0), ring: tuple[int, int, int, int] = NO_RING) -> Mapping[str, object]:
    """Values of `ray_block` for a picture of `size` (width, height) pixels, all worked out in float64, in the plan's frame.

    Raises:
        ValueError: the camera is inside the horizon, or looks where it cannot.
    """
    scene, where = plan.scene, plan.space_time
    seen = observer.observe(changed(scene, camera=changed(scene.camera, azimuth_deg=plan.azimuth_deg)))
    picture_scale = projection.half_height(scene.camera) / projection.filled(scene.camera, size)[1]
    right, up = seen.hole_on_screen if projection.is_perspective(scene.camera) else observer.NOWHERE
    back, down, aside = seen.axes
    x, y, z = tilted_disk.axes(scene.disk)  # where it is tilted, the plan's frame is the world
    return dict(
        observer_map=seen.observer_map,
        camera_n=(*seen.n, math.hypot(seen.n[0], seen.n[1])),
        camera_e_theta=(*seen.e_theta, 0.0),
        camera_e_phi=(*seen.e_phi, 0.0),
        view_back=(*back, 0.0),
        view_down=(*down, 0.0),
        view_right=(*aside, 0.0),
        seen_colour=seen.shown_energies[0],
        seen_beaming=seen.shown_energies[1],
        picture_size=size,
        picture_offset=offset,
        picture_ring=ring,
        picture_hole=(0.5 * size[0] + 0.5 * right / picture_scale, 0.5 * size[1] + 0.5 * up / picture_scale),
        disk_axis_x=(*x, 0.0),
        disk_axis_y=(*y, 0.0),
        disk_axis_z=(*z, 0.0),
        hole_w_factors=(2.0 * where.horizon_radius, 2.0 * where.inner_horizon_radius),
        picture_scale=picture_scale,
        camera_w=seen.w,
        hole_w_stop=0.5 / where.stop_radius if where.has_hole else 0.0,
        crossing_r_min=INNERMOST_CROSSING * where.horizon_radius,
        march_bound=plan.march_bound,
        plan_step_length=plan.step_length,
        plan_step_angle=plan.step_angle,
        plan_max_steps=plan.max_steps,
        **_made(plan, of_rays=True, make=lambda number: number.made(number.arguments(scene))),
    )


def shade_values(plan: Plan, time: float) -> Mapping[str, object]:
    """Values of `shade_block` at scene time `time` (r_s/c)."""
    scene = plan.scene
    ages, weights, seeds = shear.shear_phases(time)
    clear = min(max(1.0 - scene.disk.opacity, 1e-3), 0.999)
    return dict(
        shear_phase=(*ages, *weights),
        shear_seed=(*seeds, 0.0, 0.0),
        camera_heading=observer.cos_sin_deg(plan.turn_deg),
        disk_veil=(math.log2(clear), 1.0 / (1.0 - clear)),
        disk_fall=(*plunging.constants(plan.space_time.spin, scene.disk.orbit), 0.0),
        disk_r_in=plan.disk_inner,
        disk_r_edge=plan.disk_edge,
        disk_r_out=plan.disk_outer,
        disk_spin_sign=plan.space_time.orbit_sense(scene.disk.orbit),
        hole_spin_complement=1.0 - abs(plan.space_time.spin),
        plan_medium_step=plan.scene.rays.medium_step,
        **_made(plan, of_rays=False, make=lambda number: number.at(scene, time)),
    )


def _made(plan: Plan, *, of_rays: bool, make: Callable[[Number], object]) -> dict[str, object]:
    """What plug-ins declare, by name: of those that `plan` does not use no shader reads it, and nothing is made."""
    used = {number.name for found in plan.plug_ins.values() for plug_in in found for number in plug_in.numbers}
    return {number.name: make(number) if number.name in used else _NOTHING[number.type] for number in _numbers(of_rays)}


def scene_values(plan: Plan) -> dict[str, object]:
    """Values of `scene_block`. The spin is that of the space-time: 0 where the model has none; infinite distances are given as 0."""
    keys, names = _number_names()
    values: dict[str, object] = dict(zip(names, plan.scene.several(keys)))
    values["hole_spin"] = plan.space_time.spin
    values["disk_temperature_k"] = accretion.hottest(plan.scene)
    if math.isinf(plan.scene.camera.distance):
        values["camera_distance"] = 0.0
    return values


def switches(plan: Plan) -> dict[str, int]:
    """Every ``#define`` that shader text may ask for."""
    found = {"ORDERS": plan.orders, "MARCHED": int(plan.integrator is not None), "RAYS_LISTED": 0, "HIT_MAP_REFINED": 0}
    found |= {"REFINE_STEP": REFINE_STEP, "GRID_MARGIN": GRID_MARGIN, "HALF_MARGIN": HALF_MARGIN, "CELLS_FILLED": 0}
    found |= {"REACH_FINER": 0, "REACH_PARTS": 0, "BALLS_KNOWN": 0}
    found |= {"MEETINGS": plan.meetings, "NO_MEETINGS": 0, "MEDIA": int(bool(plan.scene.media)), **instances.switches(plan.scene)}
    found |= {"DISK_TILTED": int(plan.scene.disk.tilt_deg != 0.0), "THINGS": int(bool(plan.scene.things)), "STRETCHES": 0, "GRID": 0}
    found |= {"SKY_BEHIND": 0, "TURNED": 0}
    found |= {"LISTED": 0, "FROM_CAMERA": 0, "SAMPLES": 0, "OVERLAY_SKY": 0}
    found |= {"ROWS_HELD": int(len(plan.scene.media) == len(met.kinds(plan.scene, "medium")))}
    found["CAMERA_FALLS"] = int(plan.model.traits.crosses_horizon and plan.scene.camera.observer in observer.FALLING)
    found |= {"INSTANCE_PICTURES": int(bool(pictures.layers(plan.scene)))}
    found |= {"SKY_STARS": stars_a_pixel(plan.scene), "SKY_SHIFTS": int(_sky_shifts(plan.scene))}
    found["HOLE_SPINS"] = int(plan.space_time.spin != 0.0)
    found |= {"SPACE_TIME_FLAT": int(plan.space_time.kind == "flat"), "IN_FIELD": int(plan.model.traits.field), **defines(), **shear.DEFINES, **_constants()}
    keys, names = _switch_names()
    found |= {name: int(on is True) for name, on in zip(names, plan.scene.several(keys))}
    keys, options = _choice_names()
    for value, defined in zip(plan.scene.several(keys), options):
        found |= defined[value]
    return found


def stars_a_pixel(scene: Scene) -> int:
    """How many points of light the sky of `scene` may have in a pixel; 0 where it draws none apart."""
    return catalogue.plug_ins("sky")[scene.sky.model].traits.stars if scene.sky.enabled else 0


def _sky_shifts(scene: Scene) -> bool:
    """Whether the sky of `scene` shows the observer's shift: a sky that does has a switch ``frequency_shift``."""
    switch = f"sky.{scene.sky.model}.frequency_shift"
    return switch in fields() and bool(scene.get(switch))


@cache
def _constants() -> Mapping[str, int]:
    """What the makers of plug-ins' tables have shaders know of them."""
    tables = (table for slot in catalogue.SLOTS for plug_in in catalogue.plug_ins(slot).values() for table in plug_in.tables)
    return {name: value for table in tables for name, value in table.defines().items()}


@cache
def _switch_names() -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The key of every switch of the scene, and its ``#define``."""
    known = {key: item.glsl_name.upper() for key, item in fields().items() if item.kind == "switch"}
    return tuple(known), tuple(known.values())


@cache
def _choice_names() -> tuple[tuple[str, ...], tuple[Mapping[Value, Mapping[str, int]], ...]]:
    """The key of every choice of the scene, and the ``#define`` of each option by the one that is taken."""
    known = {key: item for key, item in fields().items() if item.kind == "choice"}
    return tuple(known), tuple(
        {taken: {f"{item.glsl_name}_{option}".upper(): int(option == taken) for option in item.options} for taken in item.options} for item in known.values()
    )


def as_bytes(plan: Plan, time: float, picture: tuple[int, int], offset: tuple[float, float], ring: tuple[int, int, int, int] = NO_RING) -> dict[str, bytes]:
    """The packed blocks by name, for a `picture` of so many pixels of which the part from `offset` on is drawn."""
    of_rays, of_scene = _without_time(plan, picture, offset, ring)
    return {ray_block().name: of_rays, shade_block().name: shade_block().pack(shade_values(plan, time)), scene_block().name: of_scene}


def _without_time(plan: Plan, picture: tuple[int, int], offset: tuple[float, float], ring: tuple[int, int, int, int]) -> tuple[bytes, bytes]:
    """The packed blocks that time does not change, of rays and of the scene: the same objects for the same plan until another is asked for, as a camera at rest
    asks for them in every frame."""
    global _last_without_time
    if _last_without_time is not None:
        kept, (of_plan, *of_rest) = _last_without_time
        if of_plan is plan and of_rest == [picture, offset, ring]:
            return kept
    made = ray_block().pack(ray_values(plan, picture, offset, ring)), scene_block().pack(scene_values(plan))
    _last_without_time = made, (plan, picture, offset, ring)
    return made


def in_longer_steps(blocks: Mapping[str, bytes], plan: Plan, times: float) -> dict[str, bytes]:
    """The packed `blocks` of `plan`, for steps so many times as long as it has."""
    of_rays = ray_block()
    return {**blocks, of_rays.name: of_rays.changed(blocks[of_rays.name], "plan_step_length", times * plan.step_length)}


_last_without_time: tuple[tuple[bytes, bytes], tuple[Plan, tuple[int, int], tuple[float, float], tuple[int, int, int, int]]] | None = None
