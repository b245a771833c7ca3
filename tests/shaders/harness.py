"""Runs a piece of GLSL with the project's includes on a small target and hands back floats.

Uniforms stand alone here instead of in the renderer's blocks, so that these tests need neither scene packing nor the
trace pass.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import moderngl
import numpy as np

from blackhole_gl.glsl.compose import compose
from blackhole_gl.glsl.declared import defines
from blackhole_gl.rendering import mip_levels, star_cells, star_index
from blackhole_gl.resources import assets_dir, shaders_dir

VERTEX = "#version 330 core\nvoid main() { gl_Position = vec4(vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1), 0.0, 1.0); }"

SWITCHES = {
    "ORDERS": 1,
    "RAYS_LISTED": 0,
    **defines(),
    "CAMERA_ABERRATION": 1,
    "CAMERA_DOPPLER_COLOUR": 1,
    "CAMERA_BEAMING": 1,
    "DISK_FREQUENCY_SHIFT_S0": 0,
    "DISK_FREQUENCY_SHIFT_S1": 0,
    "DISK_PLUNGING": 0,
    "DISK_TILTED": 0,
    "DISK_LIMB_DARKENING_NONE": 1,
    "DISK_LIMB_DARKENING_GREY": 0,
    "RAYS_MODEL_KERR_LIKE": 0,
    "RAYS_KERR_LIKE_FLOW": 0,
    "RAYS_KERR_LIKE_PATTERN": 0,
    "DISK_REDSHIFT": 1,
    "DISK_DOPPLER_COLOUR": 1,
    "DISK_BEAMING": 1,
    "DISK_COMPOSITING_OPACITY": 1,
    "SKY_ENABLED": 0,
    "SKY_PROCEDURAL_FREQUENCY_SHIFT": 1,
    "SKY_CATALOGUE_FREQUENCY_SHIFT": 1,
    "SKY_IMAGE_FREQUENCY_SHIFT": 1,
    "SKY_CATALOGUE_CONSTELLATIONS": 0,
    **star_index.CONSTANTS,
    "POST_BLOOM": 0,
    "POST_DITHER": 0,
    "POST_TONE_MAP_REINHARD": 0,
    "POST_TONE_MAP_ACES": 0,
    "POST_TONE_MAP_AGX": 0,
}

UNIFORMS: dict[str, tuple[str, Any]] = {
    "hole_spin": ("float", 0.0),
    "hole_spin_complement": ("float", 1.0),
    "disk_spin_sign": ("float", 1.0),
    "disk_r_in": ("float", 3.0),
    "disk_r_edge": ("float", 3.0),
    "disk_fall": ("vec4", (6.0, 0.942809, 3.464102, 0.0)),
    "hole_w_factors": ("vec2", (2.0, 0.0)),
    "disk_r_out": ("float", 10.0),
    "disk_temperature_k": ("float", 6500.0),
    "disk_beaming_exponent": ("float", 4.0),
    "disk_emission_strength": ("float", 0.18),
    "disk_density_gain": ("float", 9200.0),
    "disk_noise_scale": ("float", 0.68),
    "disk_noise_speed": ("float", 1.0),
    "disk_turbulence_octaves": ("int", 4),
    "disk_turbulence_contrast": ("float", 2.0),
    "disk_turbulence_stretch": ("float", 5.0),
    "disk_turbulence_eddy_rate": ("float", 0.03),
    "disk_point_field_share": ("float", 0.75),
    "disk_point_field_rings": ("float", 26.0),
    "disk_point_field_inward_bias": ("float", 1.0),
    "disk_point_field_ring_gain": ("float", 2.5),
    "disk_point_field_turbulence": ("float", 0.6),
    "disk_point_field_radial_turbulence": ("float", 0.0),
    "disk_point_field_taper_inside": ("float", 0.06),
    "disk_point_field_taper_outside": ("float", 0.25),
    "disk_lanes_strength": ("float", 1.0),
    "disk_lanes_number": ("float", 1.0),
    "disk_micro_turbulence_strength": ("float", 1.0),
    "disk_dust_strength": ("float", 1.0),
    "disk_dust_octaves": ("int", 5),
    "disk_dust_scale": ("float", 0.8),
    "disk_dust_stretch": ("float", 1.0),
    "disk_dust_rate": ("float", 0.06),
    "disk_dust_falloff": ("float", 0.0),
    "disk_relativistic_lanes_strength": ("float", 1.0),
    "disk_lensing_flare_strength": ("float", 1.8),
    "disk_hot_spot_size": ("float", 0.15),
    "disk_hot_spot_brightness": ("float", 8.0),
    "disk_spot": ("vec4", (1.0, 0.0, 5.0, 0.0)),
    "disk_beaming_boost_strength": ("float", 1.0),
    "rays_kerr_like_drag": ("float", 1.0),
    "sky_brightness": ("float", 1.0),
    "sky_procedural_star_brightness": ("float", 1.0),
    "sky_procedural_galaxy_brightness": ("float", 1.0),
    "sky_procedural_star_size": ("float", 0.00025),
    "sky_catalogue_star_brightness": ("float", 1.0),
    "sky_catalogue_galaxy_brightness": ("float", 0.0),
    "sky_catalogue_line_brightness": ("float", 1.0),
    "sky_catalogue_star_size": ("float", 0.00025),
    "sky_image_brightness": ("float", 1.0),
    "image_attitude": ("vec4", (0.0, 0.0, 0.0, 1.0)),
    "catalogue_attitude": ("vec4", (0.0, 0.0, 0.0, 1.0)),
    "post_exposure": ("float", 0.0),
    "post_gamma": ("float", 1.0),
    "post_bloom_intensity": ("float", 0.45),
    "shear_phase": ("vec4", (0.0, 48.0, 0.0, 1.0)),
    "shear_seed": ("vec4", (1.0, 2.0, 0.0, 0.0)),
    "observer_map": ("mat4", tuple(np.eye(4).ravel())),
    "camera_heading": ("vec2", (1.0, 0.0)),
    "camera_n": ("vec4", (1.0, 0.0, 0.0, 1.0)),
    "camera_e_theta": ("vec4", (0.0, 0.0, -1.0, 0.0)),
    "camera_e_phi": ("vec4", (0.0, 1.0, 0.0, 0.0)),
    "camera_w": ("float", 0.02),
    "picture_size": ("vec2", (8.0, 8.0)),
    "picture_offset": ("vec2", (0.0, 0.0)),
    "picture_scale": ("float", 0.05),
}


class Piece:
    """A composed, compiled fragment shader and its inputs.

    Args:
        ctx: the context.
        path: a shader below ``shaders/``, or an absolute path.
        chosen: slot → plug-in paths, as for `compose`.
        switches, uniforms: what differs from SWITCHES and UNIFORMS; uniforms of the shader's own are set too.
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
        blocks = "\n".join(f"uniform {kind} {name};" for name, (kind, _) in UNIFORMS.items())
        slots = {"disk_layer": [], "sky": [], **(chosen or {})}
        composed = compose((shaders_dir(),), str(path), chosen=slots, switches={**SWITCHES, **(switches or {})}, blocks=lambda _: blocks)
        try:
            self.program = ctx.program(vertex_shader=VERTEX, fragment_shader=composed.text)
        except moderngl.Error as error:
            raise composed.explain(str(error)) from None
        self.ctx = ctx
        self.textures: list[moderngl.Texture] = []
        self.set(**{name: value for name, (_, value) in UNIFORMS.items()})
        self.set(**uniforms)
        self.table("galaxy_band", (np.load(assets_dir() / "galaxy_band.npz")["root"] / 255.0), mipmap=True)
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
