"""Plan and scene → composed, compiled, kept programs. A changed file is taken up anew; a mistake in it keeps the last good program."""

from __future__ import annotations

import math
import time as clock
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import moderngl

from ..glsl.carried import carry
from ..glsl.compose import Composed, ShaderError, compose
from ..plan import RayPlan
from ..resources import shaders_dir, user_shaders_dir
from ..scene import Scene, catalogue
from . import uniforms

MOST_KEPT = 64
"""Compiled programs kept, those used last. A frame uses about ten, so the last few scenes come back at once; what else comes back takes milliseconds, as drivers keep what they compiled on disk."""

RAY_SLOTS = ("ray_model", "integrator", "step_control")
SHADE_SLOTS = ("disk_layer", "sky")

_MOST_RECIPES = 4 * MOST_KEPT  # switches that a text does not mention give further recipes for the same program


class Unready(RuntimeError):
    """A program is still missing, and compiling it was left to a later frame: see `Programs.deadline`."""


@dataclass(frozen=True)
class _Structure:
    """What a scene and its plan ask of a program's text: (slot, paths) and (switch, value) pairs."""

    chosen: tuple[tuple[str, tuple[str, ...]], ...]
    switches: tuple[tuple[str, int], ...]

    @cached_property
    def _hash(self) -> int:
        return hash((self.chosen, self.switches))

    def __hash__(self) -> int:
        return self._hash


class Programs:
    """The programs of one GL context, kept by the structure of what they draw: a slider never compiles anything.

    Attributes:
        errors: mistakes found by the last `reload`, until a later one mends them.
        deadline: ``time.perf_counter()`` after which `get` compiles nothing and raises `Unready` instead. Whoever draws a window sets it before
            each frame, and so spreads the programs of a new scene over several.
        compiled: how many programs have been compiled.
    """

    def __init__(self, ctx: moderngl.Context, root: Path | None = None):
        self.ctx = ctx
        self.roots = root or shaders_dir(), user_shaders_dir()
        self.errors: list[ShaderError] = []
        self.deadline = math.inf
        self.compiled = 0
        self._composed: OrderedDict[tuple, Composed] = OrderedDict()
        self._triangles: OrderedDict[str, moderngl.VertexArray] = OrderedDict()
        self._asked: tuple[Scene, RayPlan, _Structure] | None = None
        self._seen = self._times()

    def get(self, path: str, scene: Scene, ray_plan: RayPlan, extra: Mapping[str, int] | None = None) -> moderngl.VertexArray:
        """The triangle that draws fragment shader `path` for `scene`; its ``program`` takes the samplers.

        Args:
            extra: switches beyond the scene's own.

        Raises:
            ShaderError: the text cannot be composed or compiled; it names file and line.
            Unready: it would have to be compiled, and the `deadline` has passed.
        """
        recipe = path, self._structure(scene, ray_plan), tuple((extra or {}).items())
        if recipe not in self._composed:
            self._composed[recipe] = self._compose(*recipe)
            if len(self._composed) > _MOST_RECIPES:
                self._composed.popitem(last=False)
        self._composed.move_to_end(recipe)
        return self._compiled(self._composed[recipe], by=self.deadline)

    def release(self) -> None:
        """Gives the GL objects back."""
        for triangle in self._triangles.values():
            _release(triangle)
        self._triangles.clear()

    def reload(self) -> list[ShaderError]:
        """Looks at the files' times; composes and compiles anew what changed. Returns the mistakes that stand."""
        times = self._times()
        if times == self._seen:
            return self.errors
        self._seen, self.errors = times, []
        for recipe in self._composed:
            try:
                composed = self._compose(*recipe)
                self._compiled(composed, by=math.inf)
                self._composed[recipe] = composed
            except ShaderError as error:
                if str(error) not in map(str, self.errors):
                    self.errors.append(error)
        return self.errors

    def _structure(self, scene: Scene, ray_plan: RayPlan) -> _Structure:
        """A frame asks for several programs with the same two objects: worked out once. One that is as before is the same object, found by its identity."""
        if self._asked is None or self._asked[0] is not scene or self._asked[1] is not ray_plan:
            paths = ((slot, tuple(plug_in.path for plug_in in chosen(scene, ray_plan, slot))) for slot in (*RAY_SLOTS, *SHADE_SLOTS))
            found = _Structure(tuple(paths), tuple(uniforms.switches(scene, ray_plan).items()))
            same = self._asked is not None and self._asked[2] == found
            self._asked = scene, ray_plan, self._asked[2] if same else found
        return self._asked[2]

    def _compose(self, path: str, structure: _Structure, extra: tuple) -> Composed:
        switches = dict(structure.switches + extra)
        return compose(self.roots, path, chosen=dict(structure.chosen), switches=switches, blocks=lambda words: carry(uniforms.blocks(), words).fragment)

    def _compiled(self, composed: Composed, *, by: float) -> moderngl.VertexArray:
        if composed.text not in self._triangles:
            if clock.perf_counter() > by:
                raise Unready("the programs of this scene are still being compiled")
            self._triangles[composed.text] = self._compile(composed)
            if len(self._triangles) > MOST_KEPT:
                _release(self._triangles.popitem(last=False)[1])
        self._triangles.move_to_end(composed.text)
        return self._triangles[composed.text]

    def _compile(self, composed: Composed) -> moderngl.VertexArray:
        vertex = compose(self.roots, "fullscreen.vert", blocks=lambda _: carry(uniforms.blocks(), composed.words).vertex).text
        try:
            program = self.ctx.program(vertex_shader=vertex, fragment_shader=composed.text)
        except moderngl.Error as error:
            raise composed.explain(str(error)) from None
        for block in uniforms.blocks():
            if block.name in program:
                program[block.name].binding = block.binding
        self.compiled += 1
        return self.ctx.vertex_array(program, [])

    def _times(self) -> tuple:
        files = (path for root in self.roots for path in root.rglob("*") if path.suffix in (".glsl", ".frag", ".vert"))
        return tuple(sorted((str(path), path.stat().st_mtime_ns) for path in files))


def bind_samplers(program: moderngl.Program, samplers: dict[str, moderngl.Texture], first: int = 0) -> None:
    """Binds those of `samplers` (name → texture) that `program` uses, to texture units from `first` on."""
    used = [name for name in samplers if name in program]
    for unit, name in enumerate(used, first):
        samplers[name].use(unit)
        program[name].value = unit


def draw(triangle: moderngl.VertexArray) -> None:
    """Draws the triangle that covers the bound target."""
    triangle.render(moderngl.TRIANGLES, vertices=3)


def _release(triangle: moderngl.VertexArray) -> None:
    program = triangle.program
    triangle.release()
    program.release()


def chosen(scene: Scene, ray_plan: RayPlan, *slots: str) -> list[catalogue.PlugIn]:
    """The plug-ins of `slots` that `scene` and its plan use, in the order of `slots`."""
    rays = {"ray_model": ray_plan.model, "integrator": ray_plan.integrator, "step_control": ray_plan.step_control}
    found: list[catalogue.PlugIn] = []
    for slot in slots:
        if slot in rays:
            found += [rays[slot]] if rays[slot] else []
        elif slot == "disk_layer":
            found += [layer for layer in catalogue.plug_ins(slot).values() if ray_plan.orders and scene.get(f"disk.{layer.key}")]
        else:
            found += [catalogue.plug_ins("sky")[scene.sky.model]] if scene.sky.enabled else []
    return found
