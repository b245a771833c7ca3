"""Plan and scene → composed, compiled, kept programs. A changed file is taken up anew; a mistake in it keeps the last good program."""

from __future__ import annotations

from pathlib import Path
from typing import Mapping, Sequence

import moderngl

from .. import catalogue
from ..glsl.carried import carry
from ..glsl.compose import Composed, ShaderError, compose
from ..plan import RayPlan
from ..resources import shaders_dir
from ..scene import Scene
from . import uniforms


class Programs:
    """The programs of one GL context, kept by the structure of what they draw: a slider never compiles anything.

    Attributes:
        errors: mistakes found by the last `reload`, until a later one mends them.
    """

    def __init__(self, ctx: moderngl.Context, root: Path | None = None):
        self.ctx = ctx
        self.root = root or shaders_dir()
        self.errors: list[ShaderError] = []
        self._by_structure: dict[tuple, Composed] = {}
        self._by_text: dict[str, moderngl.VertexArray] = {}
        self._recipes: dict[tuple, tuple] = {}
        self._seen = self._times()

    def get(self, path: str, scene: Scene, ray_plan: RayPlan, extra: Mapping[str, int] | None = None) -> moderngl.VertexArray:
        """The triangle that draws fragment shader `path` for `scene`; its ``program`` takes the samplers.

        Args:
            extra: switches beyond the scene's own.

        Raises:
            ShaderError: the text cannot be composed or compiled; it names file and line.
        """
        chosen = _chosen(scene, ray_plan)
        switches = {**uniforms.switches(scene, ray_plan), **(extra or {})}
        key = (path, tuple(chosen.items()), tuple(switches.items()))
        if key not in self._by_structure:
            self._recipes[key] = (path, chosen, switches)
            self._by_structure[key] = self._compose(path, chosen, switches)
        return self._compiled(self._by_structure[key])

    def reload(self) -> list[ShaderError]:
        """Looks at the files' times; composes and compiles anew what changed. Returns the mistakes that stand."""
        times = self._times()
        if times == self._seen:
            return self.errors
        self._seen, self.errors = times, []
        for key, recipe in list(self._recipes.items()):
            try:
                composed = self._compose(*recipe)
                self._compiled(composed)
                self._by_structure[key] = composed
            except ShaderError as error:
                if str(error) not in map(str, self.errors):
                    self.errors.append(error)
        return self.errors

    def _compose(self, path: str, chosen: Mapping[str, Sequence[str]], switches: Mapping[str, int]) -> Composed:
        return compose(self.root, path, chosen=chosen, switches=switches, blocks=lambda words: carry(uniforms.blocks(), words).fragment)

    def _compiled(self, composed: Composed) -> moderngl.VertexArray:
        if composed.text not in self._by_text:
            vertex = compose(self.root, "fullscreen.vert", blocks=lambda _: carry(uniforms.blocks(), composed.words).vertex).text
            try:
                program = self.ctx.program(vertex_shader=vertex, fragment_shader=composed.text)
            except moderngl.Error as error:
                raise composed.explain(str(error)) from None
            for block in uniforms.blocks():
                if block.name in program:
                    program[block.name].binding = block.binding
            self._by_text[composed.text] = self.ctx.vertex_array(program, [])
        return self._by_text[composed.text]

    def _times(self) -> tuple:
        return tuple(sorted((str(path), path.stat().st_mtime_ns) for path in self.root.rglob("*") if path.suffix in (".glsl", ".frag", ".vert")))


def bind_samplers(program: moderngl.Program, samplers: dict[str, moderngl.Texture]) -> None:
    """Binds those of `samplers` (name → texture) that `program` uses, to texture units 0, 1, …"""
    used = [name for name in samplers if name in program]
    for unit, name in enumerate(used):
        samplers[name].use(unit)
        program[name].value = unit


def draw(triangle: moderngl.VertexArray) -> None:
    """Draws the triangle that covers the bound target."""
    triangle.render(moderngl.TRIANGLES, vertices=3)


def _chosen(scene: Scene, ray_plan: RayPlan) -> dict[str, tuple[str, ...]]:
    """Slot → paths of the plug-ins that the scene and its plan use."""
    layers = [p.path for p in catalogue.plug_ins("disk_layer").values() if scene.get(f"disk.{p.key}")]
    return {
        "ray_model": (ray_plan.model.path,),
        "integrator": (ray_plan.integrator.path,) if ray_plan.integrator else (),
        "step_control": (ray_plan.step_control.path,) if ray_plan.step_control else (),
        "disk_layer": tuple(layers) if ray_plan.orders else (),
        "sky": (catalogue.plug_ins("sky")[scene.sky.model].path,) if scene.sky.enabled else (),
    }
