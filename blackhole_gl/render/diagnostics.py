"""Draws diagnostic views into the radiance, in the place of shading."""

from __future__ import annotations

from dataclasses import replace

import moderngl
import numpy as np

from .. import plan
from ..plan import RayPlan
from ..scene import Scene, presets
from .hit_map import HitMap
from .programs import Programs, bind_samplers, draw
from .views import View, linear_light, view_of

_COLOURS = 256

# Post that leaves colours as they are.
_AS_IT_IS = {"post.exposure": 0.0, "post.bloom": False, "post.tone_map": "linear", "post.gamma": 1.0, "post.dither": False}


def is_on(scene: Scene) -> bool:
    """Whether `scene` asks for a view instead of the picture."""
    return scene.post.view != "picture"


def prepared(scene: Scene, ray_plan: RayPlan) -> tuple[Scene, RayPlan]:
    """`scene` and its plan as they are drawn: unchanged for the picture, without exposure and glow for a view."""
    if not is_on(scene):
        return scene, ray_plan
    if scene.post.view == "conservation":  # its value lies beside the first crossing
        ray_plan = replace(ray_plan, orders=max(ray_plan.orders, 1))
    return scene.with_values(_AS_IT_IS), ray_plan


def most_accurate(scene: Scene, ray_plan: RayPlan) -> tuple[Scene, RayPlan]:
    """`scene` with the exact model of its hole at the steps of the preset ``reference``, and the plan for it; crossings as in `ray_plan`."""
    steps = presets.read("reference").values
    exact = scene.with_values({**steps, "rays.model": "auto", "rays.lensing": True})
    return plan.resolved(exact), replace(plan.plan(exact), orders=ray_plan.orders)


class ViewPass:
    """Draws shaders/views/*.frag and owns their colour scales."""

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._scales: dict[bool, moderngl.Texture] = {}

    def draw(self, scene: Scene, ray_plan: RayPlan, hit_map: HitMap, reference: HitMap, target: moderngl.Framebuffer) -> None:
        """Draws the view of `hit_map` that `scene` asks for into `target` (RGBA16F, of the map's size). The uniform blocks are bound.

        Args:
            reference: hits of the most accurate method, traced before for the view ``difference``; not looked at by others.
        """
        view = view_of(scene)
        triangle = self._programs.get(f"views/{scene.post.view}.frag", scene, ray_plan)
        samplers = hit_map.samplers()
        samplers |= {f"exact{k}": texture for k, texture in enumerate(reference.textures)}
        if view.scale is not None:
            samplers["colour_scale"] = self._scale(view)
        bind_samplers(triangle.program, samplers)
        _set_scale(triangle.program, view)
        target.use()
        self._ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        draw(triangle)

    def release(self) -> None:
        """Gives the GL objects back."""
        for texture in self._scales.values():
            texture.release()
        self._scales = {}

    def _scale(self, view: View) -> moderngl.Texture:
        if view.scale.is_diverging not in self._scales:
            colours = linear_light(view.scale.colours(_COLOURS)).astype(np.float32)
            texture = self._ctx.texture((_COLOURS, 1), 3, colours.tobytes(), dtype="f4", alignment=4)
            texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            texture.repeat_x = texture.repeat_y = False
            self._scales[view.scale.is_diverging] = texture
        return self._scales[view.scale.is_diverging]


def _set_scale(program: moderngl.Program, view: View) -> None:
    if "view_range" in program:
        ends = np.array((view.scale.low, view.scale.high))
        low, high = np.log(ends) if view.scale.is_log else ends
        program["view_range"].value = low, high, float(view.scale.is_log)
    if "view_legend" in program:
        legend = program["view_legend"]
        colours = np.zeros((legend.array_length, 3), np.float32)  # drivers cut off what a shader does not use
        known = linear_light(np.array([colour for _, colour in view.legend]))[: len(colours)]
        colours[: len(known)] = known
        legend.write(colours.tobytes())
