"""Runs a piece of GLSL with the project's includes on a small target and hands back floats.

Uniforms stand alone here instead of in the renderer's blocks, so that these tests need neither scene packing nor the
trace pass. Their names and values are the default scene's: a new switch or number needs no word here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import moderngl
import numpy as np

from blackhole_gl.glsl.compose import compose
from blackhole_gl.planning import Plan, plan
from blackhole_gl.rendering import galaxy_band, mip_levels, star_cells, uniforms
from blackhole_gl.resources import shaders_dir
from blackhole_gl.scene import Scene

VERTEX = "#version 330 core\nvoid main() { gl_Position = vec4(vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1), 0.0, 1.0); }"

# What these tests have otherwise than the default scene: one crossing, no sky and no post, so that each asks for what it tests.
SWITCHES = {"ORDERS": 1, "SKY_ENABLED": 0, "POST_BLOOM": 0, "POST_DITHER": 0, "POST_TONE_MAP_ACES": 0}
# Round numbers, and a camera whose frame is the world's.
VALUES: dict[str, Any] = {
    "disk_temperature_k": 6500.0,
    "disk_noise_speed": 1.0,
    "disk_turbulence_stretch": 5.0,
    "sky_catalogue_galaxy_brightness": 0.0,
    "image_attitude": (0.0, 0.0, 0.0, 1.0),
    "shear_seed": (1.0, 2.0, 0.0, 0.0),
    "observer_map": np.eye(4),
    "camera_n": (1.0, 0.0, 0.0, 1.0),
    "camera_e_theta": (0.0, 0.0, -1.0, 0.0),
    "camera_w": 0.02,
    "picture_scale": 0.05,
}


@cache
def _default_plan() -> Plan:
    return plan(Scene())


@cache
def switches_of_default() -> dict[str, int]:
    """Every switch that shader text may ask for, as the default scene has it but for SWITCHES."""
    return {**uniforms.switches(_default_plan()), **SWITCHES}


@cache
def _declarations() -> str:
    """Every member of the uniform blocks, each a uniform of its own."""
    return "\n".join(f"uniform {kind} {name};" for block in uniforms.blocks() for name, kind in block.members)


@cache
def _values() -> dict[str, Any]:
    """Every member of the uniform blocks, as the default scene has it in a picture of 8×8 pixels but for VALUES."""
    made = _default_plan()
    values = {**uniforms.ray_values(made, (8, 8)), **uniforms.shade_values(made, 0.0), **uniforms.scene_values(made), **VALUES}
    return {name: tuple(np.ravel(np.transpose(value)).tolist()) if np.ndim(value) else value for name, value in values.items()}


class Piece:
    """A composed, compiled fragment shader and its inputs.

    Args:
        ctx: the context.
        path: a shader below ``shaders/``, or an absolute path.
        chosen: slot → plug-in paths, as for `compose`.
        switches, uniforms: what differs from SWITCHES, VALUES and the default scene; uniforms of the shader's own are set too.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        path: str | Path,
        *,
        chosen: Mapping[str, Sequence[str]] | None = None,
        switches: Mapping[str, int] | None = None,
        **uniforms: Any,
    ):
        slots = {"disk_layer": [], "sky": [], **(chosen or {})}
        composed = compose((shaders_dir(),), str(path), chosen=slots, switches={**switches_of_default(), **(switches or {})}, blocks=lambda _: _declarations())
        try:
            self.program = ctx.program(vertex_shader=VERTEX, fragment_shader=composed.text)
        except moderngl.Error as error:
            raise composed.explain(str(error)) from None
        self.ctx = ctx
        self.textures: list[moderngl.Texture] = []
        self.set(**_values())
        self.set(**uniforms)
        self.table("galaxy_band", galaxy_band.table() / 255.0, mipmap=True)
        self.table("star_cells", star_cells.table(), nearest=True)
        self.table("temperature_profile", np.ones((1, 64, 1)))

    def set(self, **uniforms: Any) -> Piece:
        """Sets those of `uniforms` that the shader uses."""
        for name, value in uniforms.items():
            if name in self.program:
                self.program[name].value = value
        return self

    def table(self, name: str, values: np.ndarray, *, mipmap: bool = False, nearest: bool = False) -> Piece:
        """Binds float values (h, w, components) to the sampler `name`, if the shader uses it."""
        if name in self.program:
            height, width, components = values.shape
            texture = self.ctx.texture((width, height), components, np.ascontiguousarray(values, np.float32).tobytes(), dtype="f4", alignment=4)
            texture.filter = (moderngl.NEAREST, moderngl.NEAREST) if nearest else (moderngl.LINEAR, moderngl.LINEAR)
            texture.repeat_x = texture.repeat_y = False
            if mipmap:
                texture.build_mipmaps()
                texture.repeat_x = True
            self.program[name].value = len(self.textures)
            self.textures.append(texture)
        return self

    def levels(self, name: str, levels: Sequence[np.ndarray]) -> Piece:
        """Binds float16 `levels` (h, w, components), the largest first, to the sampler `name`, filtered in and between them."""
        height, width, components = levels[0].shape
        texture = self.ctx.texture((width, height), components, levels[0].tobytes(), dtype="f2", alignment=1)
        mip_levels.build(self.ctx, texture, levels[0], list(levels[1:]))
        texture.filter = moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR
        texture.repeat_x = texture.repeat_y = False
        self.program[name].value = len(self.textures)
        self.textures.append(texture)
        return self

    def draw(self, size: tuple[int, int]) -> np.ndarray:
        """The picture as floats (height, width, 4), lowest row first."""
        target = self.ctx.texture(size, 4, dtype="f4")
        frame = self.ctx.framebuffer([target])
        frame.use()
        for unit, texture in enumerate(self.textures):
            texture.use(unit)
        array = self.ctx.vertex_array(self.program, [])
        array.render(moderngl.TRIANGLES, vertices=3)
        values = np.frombuffer(target.read(), np.float32).reshape(size[1], size[0], 4).copy()
        for item in (array, frame, target):
            item.release()
        return values
