"""Things and media as shaders see them: for each kind a table with a row an instance, and GLSL that reads it by the parameters' names.

A row begins with where the instance is at the frame's time (`_MOTION`), its parameters follow. A slider writes into a table, and one instance more makes it
longer: neither compiles anything.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

import moderngl
import numpy as np

from ..physics import motion
from ..planning import Plan
from ..scene import FrozenMap, Scene, met, surfaces
from ..scene.instances import Instances
from ..scene.plug_in import PlugIn
from ..scene.schema import Field, Value, number_of
from . import hierarchy, lamps, meshes, pictures

_NUMBERS = ("float", "int", "switch", "choice")
"""Kinds of parameters that shaders know, beside lists of two to four numbers; a choice is known by its place among the
options, a picture by its layer in the array of pictures and a mesh by the first node of its hierarchy, 0 for none."""

_MOTION = ("bound", "velocity", "spin", "attitude")
"""A texel each: centre and reach, then as in `motion.Motion`. Of a kind that does not move there is the first alone."""

_SPHERES_A_CIRCLE = 48

_EARLIER = {"bound": ("bound", "velocity"), "velocity": ("bound", "velocity"), "attitude": ("attitude", "spin")}
"""What was another when the light left that is seen (shaders/common/earlier.glsl), and what that follows from."""


def glsl(kinds: Iterable[PlugIn]) -> str:
    """What `_glsl` gives, which is kept: each frame of a moving camera asks for it."""
    return _glsl(tuple(kinds))


@lru_cache(maxsize=16)
def _glsl(kinds: tuple[PlugIn, ...]) -> str:
    """Declarations for shaders: ``thing_ball_count``, ``thing_ball_centre(i)`` and the like, ``thing_ball_radius(i)`` for each parameter of the kind; the
    array of pictures, if any kind has one. With the switch ``ROWS_HELD`` each kind of medium has one instance, whose row ``read_rows()`` reads once for all."""
    lines = ["uniform sampler2D lamps_table;", "#define lamp_count textureSize(lamps_table, 0).y"] if kinds else []
    lines += ["#ifndef ROWS_HELD", "#define ROWS_HELD 0", "#endif"]
    if any(pictures.is_picture(item) for kind in kinds for item in kind.parameters.values()):
        lines.append(f"uniform sampler2DArray {pictures.ARRAY};")
    if any(meshes.is_mesh(item) for kind in kinds for item in kind.parameters.values()):
        lines.append(f"uniform isampler2D mesh_nodes;\nuniform sampler2D mesh_triangles;\n#define MESH_TEXELS {meshes.TEXELS}\n#define MESH_ROW {meshes.ROW}")
    lines += _finish() if any(_has_surface(kind) for kind in kinds) else []
    for kind in kinds:
        name = f"{kind.slot}_{kind.key}"
        fetched = [f"#define {name}_count textureSize({name}_table, 0).y", *_accessors(kind, "")]
        lines += [f"uniform sampler2D {name}_table;", *(_held_or(kind, fetched) if kind.slot == "medium" else fetched)]
    media = [line for kind in kinds if kind.slot == "medium" for line in _reads(kind)]
    return "\n".join([*lines, *(["#if ROWS_HELD", "void read_rows() {", *media, "}", "#endif"] if media else [])])


def _fetch(name: str, place: int, row: str) -> str:
    """The nearest texel: docs/llvmpipe.md, texels."""
    return f"textureLod({name}_table, (vec2({place}, {row}) + 0.5) / vec2(textureSize({name}_table, 0)), 0.0)"


def _held_or(kind: PlugIn, fetched: list[str]) -> list[str]:
    """What reads the one instance of a kind in variables, where a program says so, and what is `fetched` else."""
    name = f"{kind.slot}_{kind.key}"
    variables = ", ".join(f"{name}_row{place}" for place in range(_places(kind)[1] // 4))
    held = [f"vec4 {variables};", f"#define {name}_count 1", *_accessors(kind, f"{name}_row")]
    return ["#if ROWS_HELD", *held, "#else", *fetched, "#endif"]


def _reads(kind: PlugIn) -> list[str]:
    name = f"{kind.slot}_{kind.key}"
    return [f"    {name}_row{place} = {_fetch(name, place, '0')};" for place in range(_places(kind)[1] // 4)]


def _accessors(kind: PlugIn, held: str) -> list[str]:
    """What reads an instance's motion and parameters by their names: from its row in the table, or from the variables that begin with `held`, if any are."""
    name = f"{kind.slot}_{kind.key}"

    def texel(place: int) -> str:
        return f"{held}{place}" if held else _fetch(name, place, "i")

    now = {word: texel(place) for place, word in enumerate(_motion_names(kind))}
    lines = [f"#define {name}_{word}(i) {text}" for word, text in now.items()]
    if kind.traits.moves:
        then = {word: f"earlier_{word}({now[first]}, {now[second]})" for word, (first, second) in _EARLIER.items()}
        earlier = [f"#define {name}_{word}(i) {then.get(word, text)}" for word, text in now.items()]
        lines = ["#if RAYS_LIGHT_TRAVEL", *earlier, "#else", *lines, "#endif"]
    lines.append(f"#define {name}_centre(i) {name}_bound(i).xyz")
    for item, place in _places(kind)[0]:
        value = f"{texel(place // 4)}.{'xyzw'[place % 4 : place % 4 + _width(item)]}"
        read = {"float": value, "list": value, "switch": f"({value} > 0.5)"}.get(item.kind, f"int({value})")
        lines.append(f"#define {name}_{item.key}(i) {read}")
    if _has_surface(kind):
        lines.append(f"#define {name}_finish(i) Finish({', '.join(f'{name}_{key}(i)' for key in surfaces.SURFACE)})")
    return lines


def _finish() -> list[str]:
    """How an instance looks, as a record, and numbers for the options of its choices, such as ``SURFACE_CHECKER``."""
    types = {"choice": "int", "file": "int", "switch": "bool", "list": "vec3"}
    members = (f"{types.get(item.kind, item.kind)} {key};" for key, item in surfaces.SURFACE.items())
    options = ((f"{key}_{word}", number) for key, item in surfaces.SURFACE.items() for number, word in enumerate(item.options))
    return [f"struct Finish {{ {' '.join(members)} }};", *(f"#define {name.upper()} {number}" for name, number in options)]


def _has_surface(kind: PlugIn) -> bool:
    return kind.slot == "thing" and kind.traits.surface


def switches(scene: Scene) -> dict[str, int]:
    """Name → number: what tells the kinds of `scene` apart in a hit, which are opaque, whether any tells its parts apart or its distance, and which parts of
    media there are."""
    kinds = used(scene)
    found = {"MEETINGS_TOLD_APART": int(any(kind.slot == "thing" and kind.traits.tells_apart for kind in kinds))}
    found |= {"MEETINGS_BY_DISTANCE": int(any(kind.slot == "medium" or kind.traits.meets == "distance" for kind in kinds))}
    for number, kind in enumerate(kinds):
        name = f"{kind.slot}_{kind.key}".upper()
        found[name] = number
        if kind.slot == "thing":
            found[f"{name}_OPAQUE"] = int(kind.traits.opaque)
        else:
            found |= {f"{name}_BOLOMETRIC": int(kind.traits.bolometric), f"{name}_SOFT": int(kind.traits.soft)}
            own = [one.values for one in scene.media.values() if one.kind == kind.key]
            found |= {f"{name}_{part.upper()}": int(any(number_of(values[part]) > 0.0 for values in own)) for part in kind.traits.parts}
    return found


def used(scene: Scene) -> list[PlugIn]:
    """The kinds that `scene` has instances of, numbered as in `switches`."""
    return [kind for slot in met.SLOTS for kind in met.kinds(scene, slot)]


def key(plan: Plan, time: float) -> tuple:
    """What hits depend on here, an entry for each instance: its slot, kind and values but for its surface, its mesh, and the places of those that move.

    Raises:
        SceneError: a mesh cannot be used.
    """
    found: list[tuple] = []
    named_meshes = meshes.of(plan.scene)
    for slot in met.SLOTS:
        shapes = list(_shapes(met.named(plan.scene, slot), met.kinds(plan.scene, slot), named_meshes))
        for mover in motion.movers(plan.scene, slot):
            if motion.moves(mover.instance, mover.traits):
                here = motion.of(mover.instance, mover.traits, plan.space_time, time)
                shapes[mover.place] = *shapes[mover.place], here.centre.tobytes(), b"" if mover.traits.round else here.attitude.tobytes()
        found += shapes
    return tuple(found)


@lru_cache(maxsize=met.SCENES_KEPT)
def _shapes(named: Instances, kinds: tuple[PlugIn, ...], named_meshes: meshes.Meshes | None) -> tuple[tuple, ...]:
    """Of each instance what its hits depend on beside its place."""
    places = named_meshes.places if named_meshes else {}
    of_mesh = {kind.key: [name for name, item in kind.parameters.items() if meshes.is_mesh(item)] for kind in kinds}
    seen = {kind.key: [name for name in kind.parameters if not (_has_surface(kind) and name in surfaces.SURFACE)] for kind in kinds}
    slots = {kind.key: kind.slot for kind in kinds}
    return tuple(
        (slots[one.kind], one.kind, tuple(one.values[name] for name in seen[one.kind]), tuple(places.get(str(one.values[name])) for name in of_mesh[one.kind]))
        for one in named.values()
    )


@dataclass(frozen=True, eq=False)
class _Made:
    """Textures by their samplers' names, and what they are of."""

    plan: Plan
    time: float
    frame: object
    meshes: meshes.Meshes | None
    samplers: dict[str, moderngl.Texture]


class InstanceTables:
    """The tables of the kinds in use, that of the lamps, and the hierarchy of boxes round all instances."""

    def __init__(self, ctx: moderngl.Context):
        self._ctx = ctx
        self._kept: dict[str, tuple[np.ndarray, moderngl.Texture]] = {}
        self._made: _Made | None = None
        self._of_places: tuple[tuple, dict[str, np.ndarray]] | None = None  # what no camera changes, and what it depends on

    def samplers(self, plan: Plan, time: float, frame: object = None) -> dict[str, moderngl.Texture]:
        """Sampler's name → table, as the scene of `plan` has them at scene time `time`; files are looked at once in a `frame` of `FrameInputs`."""
        made = self._made
        same = made is not None and made.plan is plan and made.time == time
        if made is None or not same or frame is None or made.frame is not frame:
            found = meshes.of(plan.scene)
            stands = made is not None and made.meshes is found and (same or made.plan is plan and not anything_moves(plan))
            made = self._made = _Made(plan, time, frame, found, made.samplers if made is not None and stands else self._textures(plan, time, found))
        return made.samplers

    def release(self) -> None:
        """Gives the GL objects back."""
        for _, texture in self._kept.values():
            texture.release()
        self._kept, self._made = {}, None

    def _textures(self, plan: Plan, time: float, found: meshes.Meshes | None) -> dict[str, moderngl.Texture]:
        files = FrozenMap({**pictures.layers(plan.scene), **(found.roots if found else {})})
        tables = {**self._tables(plan, time, files), "lamps_table": lamps.rows(plan, time)}
        if found:
            tables |= {"mesh_nodes": found.nodes, "mesh_triangles": found.triangles}
        return {name: self._texture(name, table) for name, table in tables.items()}

    def _tables(self, plan: Plan, time: float, files: FrozenMap[str, int]) -> dict[str, np.ndarray]:
        """Sampler's name → values of the kinds' tables, and of the hierarchy: the same objects until anything of them is another."""
        scene = plan.scene
        depends_on = scene.things, scene.media, plan.space_time, plan.times, files, time if anything_moves(plan) else None
        if self._of_places is None or self._of_places[0] != depends_on:
            kinds = used(scene)
            rows = [_rows(kind, plan, time, files) for kind in kinds]
            bounds = [_bounds(table, plan.times and kind.traits.moves) for kind, table in zip(kinds, rows)]
            nodes = _nodes(bounds, [_moving(kind, plan, files) for kind in kinds])
            self._of_places = depends_on, {f"{kind.slot}_{kind.key}_table": table for kind, table in zip(kinds, rows)} | {"meeting_nodes": nodes}
        return self._of_places[1]

    def _texture(self, name: str, values: np.ndarray) -> moderngl.Texture:
        size = values.shape[1], values.shape[0]
        before, texture = self._kept.get(name, (None, None))
        if texture is None or texture.size != size:
            if texture is not None:
                texture.release()
            texture = self._ctx.texture(size, 4, values.tobytes(), dtype="i4" if values.dtype == np.int32 else "f4")
            texture.filter = moderngl.NEAREST, moderngl.NEAREST
            texture.repeat_x = texture.repeat_y = False
        elif before is None or values is not before and values.tobytes() != before.tobytes():
            texture.write(values.tobytes())
        self._kept[name] = values, texture
        return texture


def anything_moves(plan: Plan) -> bool:
    """Whether any table is another at another time, be it that a sphere turns."""
    return any(motion.movers(plan.scene, slot) for slot in met.SLOTS)


def _nodes(bounds: list[tuple[np.ndarray, np.ndarray]], moving: list[np.ndarray]) -> np.ndarray:
    """The hierarchy's texels, from the `_bounds` of each kind and which of its instances move. A leaf holds 32 times the instance's number,
    and its kind's.

    What stands has a hierarchy of its own, which is kept: where one of a thousand moves, little is made anew.
    """
    number = np.concatenate([32 * own + kind for kind, (_, own) in enumerate(bounds)])
    spheres, moves = np.concatenate([spheres for spheres, _ in bounds]), np.concatenate([some[own] for some, (_, own) in zip(moving, bounds)])
    there = spheres[:, 3] > 0.0  # not lamps that are not seen
    stands, moves = there & ~moves, there & moves
    standing = _tree(spheres[stands].tobytes(), number[stands].tobytes())
    if not moves.any():
        return standing.texels
    made = hierarchy.build(*_boxes(spheres[moves]))
    whole = hierarchy.both(standing.tree, made) if stands.any() else made
    return whole.texels(np.concatenate([number[stands], number[moves]])[whole.order[whole.first]])


@dataclass(frozen=True, eq=False)
class _Standing:
    """What stands: its hierarchy, and the texels of that alone."""

    tree: hierarchy.Hierarchy
    texels: np.ndarray


@lru_cache(maxsize=met.SCENES_KEPT)
def _tree(spheres: bytes, number: bytes) -> _Standing:
    """That of bounding spheres, float32, and what the leaves hold that they lie in, both as bytes."""
    tree = hierarchy.build(*_boxes(np.frombuffer(spheres, np.float32).reshape(-1, 4)))
    return _Standing(tree, tree.texels(np.frombuffer(number, int)[tree.order[tree.first]]))


def _boxes(spheres: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    centre, radius = spheres[:, :3].astype(float), spheres[:, 3:].astype(float)
    return centre - radius, centre + radius


def _width(item: Field) -> int:
    """Numbers that shaders are given for it; 0: they do not know it."""
    if item.kind == "list":
        return int(item.low) if item.low == item.high and 2 <= item.low <= 4 and item.element is not None and item.element.kind in ("float", "int") else 0
    return int(item.kind in _NUMBERS or pictures.is_picture(item) or meshes.is_mesh(item))


def _places(kind: PlugIn) -> tuple[list[tuple[Field, int]], int]:
    """Where in a row of `kind` each parameter's first number is, no parameter in two texels; and how long the row is, in whole texels.

    Those of a surface lie by themselves, pictures last, in as few texels as hold them: a lit pixel reads them all.
    """
    finish = [item for item in kind.parameters.values() if _has_surface(kind) and item.key in surfaces.SURFACE]
    others = [item for item in kind.parameters.values() if item not in finish]
    found: list[tuple[Field, int]] = []
    free = 4 * len(_motion_names(kind))
    for lot in (others, sorted(finish, key=pictures.is_picture)):
        free += -free % 4
        for item in lot:
            width = _width(item)
            if width:
                free += -free % 4 if free % 4 + width > 4 else 0
                found.append((item, free))
                free += width
    return found, free + -free % 4


def _motion_names(kind: PlugIn) -> tuple[str, ...]:
    return _MOTION if kind.traits.moves else _MOTION[:1]


def _rows(kind: PlugIn, plan: Plan, time: float, files: FrozenMap[str, int]) -> np.ndarray:
    """float32 (instances, columns, 4); `files` are the numbers of what file parameters name."""
    own, values = _values(met.named(plan.scene, kind.slot), kind, files)
    rows, texels = values.copy(), len(_motion_names(kind))
    rows[:, :texels] = motion.rows(plan.scene, kind.slot, plan.space_time, time)[own, :texels]
    return rows


def _bounds(rows: np.ndarray, seen_late: bool) -> tuple[np.ndarray, np.ndarray]:
    """Spheres (K, 4) that hold the instances of a kind, from its rows, and which each holds, (K,). Where light takes its time, who is on a circle may be seen
    anywhere on it: spheres all along the circle hold such a one."""
    bound, own = rows[:, 0], np.arange(len(rows))
    if not seen_late:
        return bound, own
    around = np.flatnonzero((rows[:, 1, 3] != 0.0) & (bound[:, 3] > 0.0))
    centre, velocity = bound[around, None, :3].astype(float), rows[around, 1, None, :3].astype(float)
    radius = np.linalg.norm(centre, axis=-1, keepdims=True)
    across = velocity * (radius / np.maximum(np.linalg.norm(velocity, axis=-1, keepdims=True), 1e-30))
    angle = 2.0 * np.pi * np.arange(_SPHERES_A_CIRCLE)[:, None] / _SPHERES_A_CIRCLE
    reach = np.broadcast_to(bound[around, None, 3:] + radius * math.sin(math.pi / _SPHERES_A_CIRCLE), (len(around), _SPHERES_A_CIRCLE, 1))
    circles = np.concatenate([np.cos(angle) * centre + np.sin(angle) * across, reach], axis=-1).reshape(-1, 4).astype(np.float32)
    rest = np.setdiff1d(own, around)
    return np.concatenate([bound[rest], circles]), np.concatenate([rest, np.repeat(around, _SPHERES_A_CIRCLE)])


def _moving(kind: PlugIn, plan: Plan, files: FrozenMap[str, int]) -> np.ndarray:
    """Which of the instances of `kind` move or turn, bool (instances,)."""
    own, _ = _values(met.named(plan.scene, kind.slot), kind, files)
    return np.isin(own, [mover.place for mover in motion.movers(plan.scene, kind.slot)])


@lru_cache(maxsize=met.SCENES_KEPT)
def _values(named: Instances, kind: PlugIn, files: FrozenMap[str, int]) -> tuple[np.ndarray, np.ndarray]:
    """Which of the instances are of `kind`, by their places; and their rows without their motion."""
    own = [(place, instance) for place, instance in enumerate(named.values()) if instance.kind == kind.key]
    places, length = _places(kind)
    rows = np.zeros((len(own), length), np.float32)
    for row, (_, instance) in zip(rows, own):
        for item, place in places:
            row[place : place + _width(item)] = _numbers(item, instance.values[item.key], files)
    rows.setflags(write=False)
    return np.array([place for place, _ in own], int), rows.reshape(len(own), -1, 4)


def _numbers(item: Field, value: Value, files: Mapping[str, int]) -> tuple[float, ...]:
    if isinstance(value, tuple):
        return tuple(map(number_of, value))
    if isinstance(value, str):
        return (float(files.get(value, -1) if item.kind == "file" else item.options.index(value)),)
    return (number_of(value),)
