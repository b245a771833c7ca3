"""The text of every program that the shipped presets come to, composed as the renderer composes it; no GL here."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from blackhole_gl.planning import Plan, plan
from blackhole_gl.rendering.diagnostics import most_accurate, prepared
from blackhole_gl.rendering.inputs import FrameInputs
from blackhole_gl.rendering.kept_samples import MOST_SAMPLES
from blackhole_gl.rendering.known_light import TURNED
from blackhole_gl.rendering.post import TONE_TABLE
from blackhole_gl.rendering.programs import Programs
from blackhole_gl.rendering.reach import ALONE, FINER, PARTS
from blackhole_gl.rendering.refinement import FILLED
from blackhole_gl.rendering.turning import can_turn
from blackhole_gl.rendering.uniforms import stars_a_pixel
from blackhole_gl.resources import presets_dir
from blackhole_gl.scene import Scene, SceneError, catalogue, fields, presets

Wanted = tuple[str, str, Plan, Mapping[str, int]]
"""A program's path, what it is for, the plan that shapes it, the switches beyond the scene's own."""

SHIPPED = [info for info in presets.available() if info.path.is_relative_to(presets_dir())]

# What draws a picture, in the order of shaders/README.md.
TRACED = ("trace.frag", "refine_nodes.frag", "refine_cells.frag", "refine_classes.frag", "probe.frag")
EDGES = ("edge_marks.frag", "edge_resolve.frag")
POST = ("post/bloom_down.frag", "post/bloom_up.frag", "post/tone_table.frag", "post/tone_map.frag")
BEAM = ("post/beam_halve.frag", "post/beam_blur.frag", "post/beam_enlarge.frag", "post/brightest.frag")


class NoGL:
    """Stands for a program or its triangle: names nothing, holds nothing."""

    @property
    def program(self) -> NoGL:
        return self

    def __contains__(self, name: str) -> bool:
        return False

    def get(self, name: str, default: None) -> None:
        return default

    def release(self) -> None:
        pass


class Recorder:
    """Stands for a context: keeps the texts that it is given to compile.

    Attributes:
        texts: (vertex text, fragment text) → what was asked for when it came first.
        asked: what is being asked for.
    """

    def __init__(self) -> None:
        self.texts: dict[tuple[str, str], str] = {}
        self.asked = ""

    def program(self, *, vertex_shader: str, fragment_shader: str) -> NoGL:
        self.texts.setdefault((vertex_shader, fragment_shader), self.asked)
        return NoGL()

    def vertex_array(self, program: NoGL, content: list) -> NoGL:
        return NoGL()

    def buffer(self, *, reserve: int, dynamic: bool) -> NoGL:
        return NoGL()


def collect(*, every: int = 1) -> Mapping[tuple[str, str], str]:
    """(vertex text, fragment text) → path and scene of every program, or of each path's first and then one in `every`; of methods those of `pairs`."""
    return _composed(_one_in(every, itertools.chain(_of_scenes(), _of_instances(), _of_views(), _of_methods(every_pair=False))))


def _one_in(every: int, wanted: Iterable[Wanted]) -> Iterator[Wanted]:
    asked: Counter[str] = Counter()
    for program in wanted:
        if asked[program[0]] % every == 0:
            yield program
        asked[program[0]] += 1


def collect_methods() -> Mapping[tuple[str, str], str]:
    """As `collect`, for every integrator and step control with every ray model that they fit."""
    return _composed(_of_methods(every_pair=True))


def _composed(wanted: Iterable[Wanted]) -> Mapping[tuple[str, str], str]:
    recorder = Recorder()
    programs = Programs(recorder)
    for path, name, made, switches in wanted:
        recorder.asked = f"{path} for {name}"
        programs.get(path, FrameInputs.whole(made, 0.0, (16, 16)), switches)
    return recorder.texts


def _of_scenes() -> Iterator[Wanted]:
    for name, scene in _scenes():
        made = plan(scene)
        yield from ((path, name, made, {}) for path in (*TRACED, *EDGES))
        yield from ((path, name, made, TONE_TABLE) for path in POST)
        yield from ((path, name, made, {}) for path in BEAM)
        yield from ((path, name, made, {"HIT_MAP_REFINED": refined, **TONE_TABLE}) for path, refined in _readers(made))
        if can_turn(made):
            around = plan(scene.with_values({"camera.projection": "equirectangular"}))
            yield "turned.frag", name, around, {}
            if stars_a_pixel(scene):
                yield "star_layer.frag", name, around, {**TURNED, **TONE_TABLE}
        if scene.post.show_sky_grid:
            yield from (("shade_overlays.frag", name, made, {"OVERLAY_SKY": 1, "HIT_MAP_REFINED": refined}) for refined in (0, 1))


def _readers(made: Plan) -> Iterator[tuple[str, int]]:
    """(path, HIT_MAP_REFINED) of what reads the hit map: sharp, refined, or where a refined one is flat."""
    yield "shade_classes.frag", 0
    yield "refine_resolve.frag", 1
    if made.orders:
        yield from (("shade_matter.frag", refined) for refined in (0, 1))
    if made.scene.sky.enabled:
        yield from (("shade_sky.frag", refined) for refined in (0, 1, 2))
    if stars_a_pixel(made.scene):
        yield from (("star_layer.frag", refined) for refined in (0, 1))
    if made.scene.post.show_horizon or made.scene.post.lines_in_plane:
        yield from (("shade_overlays.frag", refined) for refined in (0, 1))


def _scenes() -> Iterator[tuple[str, Scene]]:
    """(name, scene): each shipped preset, looks and qualities over one that shows them, and each switch and choice at each of its values."""
    for info in SHIPPED:
        yield info.name, presets.load([info.name] if info.group in ("physics", "scene") else ["kerr_06", info.name])
    kerr = presets.load(["kerr"])
    for key, item in fields().items():
        options = {"choice": item.options, "switch": (False, True)}.get(item.kind, ())
        if not key.startswith(("rays.model", "rays.integrator", "rays.step_control", "post.view")):
            yield from ((f"{key} = {value}", kerr.with_values({key: value})) for value in options)


def _of_instances() -> Iterator[Wanted]:
    """What a thing or a medium of every kind adds, by every ray model that can meet one."""
    for slot, section in (("thing", "things"), ("medium", "media")):
        for kind, model in itertools.product(catalogue.keys(slot), catalogue.keys("ray_model")):
            scene = presets.load(["kerr"], {"rays.model": model, f"{section}.one.kind": kind, f"{section}.two.kind": kind})
            try:
                made = plan(scene)
            except SceneError:
                continue  # this model cannot
            drawn = [(path, {}) for path in ("trace.frag", "shade_classes.frag", "shade_matter.frag", "shade_sky.frag")]
            changes = slot == "medium" and catalogue.plug_ins(slot)[kind].traits.changes
            beside_none = {"MEETINGS": 0, "NO_MEETINGS": made.meetings}
            if made.meetings == 1 and made.reach_steps:
                drawn += [("trace.frag", {"BALLS_KNOWN": 1}), ("shade_matter.frag", {"HIT_MAP_REFINED": 3, **FILLED})]
                drawn += [(path, {"HIT_MAP_REFINED": 1, **FILLED}) for path in ("refine_resolve.frag", "shade_sky.frag")]
            drawn += [("transfer.frag", {"HIT_MAP_REFINED": refined}) for refined in (0, 1) if slot == "medium"]
            drawn += [("transfer.frag", {"FROM_CAMERA": 1, "GRID": grid, "HIT_MAP_REFINED": grid}) for grid in (0, 1) if slot == "medium"]
            kept = {"FROM_CAMERA": 1, "GRID": 1, "SAMPLES": 1}
            drawn += [("transfer.frag", kept), ("transfer_samples.frag", {"MOST_SAMPLES": MOST_SAMPLES})] if changes else []
            drawn += [("transfer_join.frag", {"LISTED": 1})] if slot == "medium" else []
            drawn += [(path, {}) for path in ("transfer_cells.frag", "transfer_marks.frag", "transfer_join.frag", "shade_media.frag") if slot == "medium"]
            drawn += [("shade_matter.frag", {"STRETCHES": 1, "MEETINGS": 0, "HIT_MAP_REFINED": refined}) for refined in (0, 1) if slot == "medium"]
            drawn += [("transfer.frag", {"ROWS_HELD": 1})] if slot == "medium" else []
            for path, switches in (*drawn, ("trace.frag", {"RAYS_LISTED": 1}), ("trace.frag", beside_none)):
                yield path, f"{kind} by {model}", made, switches
            if made.integrator is not None:  # rays in closed form are not looked for coarsely
                yield "reach_field.frag" if made.model.traits.field else "reach_nodes.frag", f"{kind} by {model}", made, ALONE
                yield from (("reach_cells.frag", f"{kind} by {model}", made, switches) for switches in ({}, FINER))
                yield "reach_marks.frag", f"{kind} by {model}", made, {}
                if slot == "thing" and catalogue.plug_ins(slot)[kind].traits.tells_apart and not made.model.traits.field and made.reach_steps:
                    yield "reach_nodes.frag", f"{kind} by {model}", made, PARTS
                if made.meetings == 1:
                    plain = ("marks", "things", "bends", "half_marks", "half_ends", "half_put")
                    filled = *((f"refine_{name}.frag", {}) for name in plain), ("refine_cells.frag", FILLED)
                    halves = ((f"refine_half_{name}.frag", {"MEETINGS": seeking}) for name in ("cells", "fill") for seeking in (0, 1))
                    yield from ((path, f"{kind} by {model}", made, switches) for path, switches in (*filled, *halves))


def _of_views() -> Iterator[Wanted]:
    for view, model in itertools.product(fields()["post.view"].options, ("kerr", "schwarzschild_table")):
        if view != "picture":
            made = prepared(plan(presets.load(["kerr"], {"post.view": view, "rays.model": model})))
            yield "trace.frag", f"the view {view} of {model}", made, {}
            yield f"views/{view}.frag", f"the view {view} of {model}", made, {}
            yield "trace.frag", f"the reference of {model}", most_accurate(made), {}


def _of_methods(*, every_pair: bool) -> Iterator[Wanted]:
    kerr = presets.load(["kerr"])
    for name, values in _methods(every_pair=every_pair):
        for orders, view, listed in ((0, "picture", 0), (1, "conservation", 0), (3, "picture", 1)):
            made = replace(plan(kerr.with_values({**values, "post.view": view})), orders=orders)
            yield "trace.frag", f"{name}, {orders} orders", made, {"RAYS_LISTED": listed}
            if listed and made.integrator is not None:
                yield "record.frag", name, made, {}


def _methods(*, every_pair: bool) -> Iterator[tuple[str, Mapping[str, object]]]:
    """(name, scene values) of every ray model, and of a marched one with integrators and step controls."""
    for key, model in catalogue.plug_ins("ray_model").items():
        if model.traits.kind == "closed":
            yield key, {"rays.model": key}
            switches = [(name, value) for name, item in model.parameters.items() if item.kind == "switch" for value in (False, True)]
            yield from ((f"{key}, {name} {value}", {"rays.model": key, name: value}) for name, value in switches)
            continue
        for integrator, control in pairs(key, every_pair=every_pair):
            yield f"{key}, {integrator}, {control}", {"rays.model": key, "rays.integrator": integrator, "rays.step_control": control}


def pairs(model: str, *, every_pair: bool = False) -> Iterator[tuple[str, str]]:
    """Integrators and step controls to try with `model`, which is marched: all that fit one model of each way to march, and for the others each part once."""
    usual = catalogue.plug_ins("ray_model")[model].traits.step_control
    for integrator, control in itertools.product(catalogue.keys("integrator"), catalogue.keys("step_control")):
        if every_pair or model in ("schwarzschild", "kerr") or integrator == "rk4" or control == usual:
            if not catalogue.reasons_against(model, integrator, control):
                yield integrator, control
