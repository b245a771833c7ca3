"""Draws diagnostic views into the radiance, in the place of shading."""

from __future__ import annotations

from dataclasses import replace

import moderngl
import numpy as np

from ..glsl.declared import Fate
from ..physics.space_time import is_field
from ..planning import Plan
from ..planning import plan as make_plan
from ..scene import Scene, presets
from .hit_map import HitMap
from .inputs import FrameInputs
from .programs import Programs
from .temperatures import TemperatureProfile
from .views import Ends, Scale, View, ends_of, linear_light, view_of

_COLOURS = 256

# The tolerance is that below which rounding is what is measured.
_EXACT_FIELD = {"rays.integrator": "dopri5", "rays.step_control": "embedded", "rays.embedded.tolerance": 1e-6}

# Post that leaves colours as they are.
_AS_IT_IS = {
    "post.exposure": 0.0, "post.bloom": False, "post.beam": False, "post.colours": "light", "post.lens": False, "post.tone_map": "linear", "post.gamma": 1.0,
    "post.dither": False,
}  # fmt: skip


def is_on(scene: Scene) -> bool:
    """Whether `scene` asks for a view instead of the picture."""
    return scene.post.view != "picture"


def prepared(plan: Plan) -> Plan:
    """`plan` as it is drawn: unchanged for the picture, without exposure and glow for a view."""
    scene = plan.scene
    if not is_on(scene):
        return plan
    orders = max(plan.orders, 1) if scene.post.view == "conservation" else plan.orders  # its value lies beside the first crossing
    return replace(plan, scene=scene.with_values(_AS_IT_IS), orders=orders)


def most_accurate(drawn: Plan) -> Plan:
    """The scene of `drawn` by the exact model of its hole at the steps of the preset ``reference``; crossings as in `drawn`.

    A field is its own model, whose steps are chosen by their error: where it is strong is the field's to say.
    """
    own = _EXACT_FIELD if is_field(drawn.scene) else {"rays.model": "auto"}
    exact = make_plan(drawn.scene.with_values({**presets.read("reference").values, **own, "rays.lensing": True}))
    return replace(exact, orders=drawn.orders)


class ViewPass:
    """Draws shaders/views/*.frag and owns their colour scales; `temperatures` stay their owner's."""

    def __init__(self, ctx: moderngl.Context, programs: Programs, temperatures: TemperatureProfile):
        self._ctx, self._programs, self._temperatures = ctx, programs, temperatures
        self._scales: dict[bool, moderngl.Texture] = {}
        self._steps: Ends | None = None

    def fit(self, scene: Scene, hit_map: HitMap, *, moving: bool = False) -> None:
        """Makes the scale of what follows one for the values in `hit_map`, which has to be sharp; where the camera is `moving` it only grows."""
        if scene.post.view != "steps":
            return
        fate, steps = hit_map.fates_and_steps()
        ends = ends_of(steps[fate != Fate.UNRESOLVED])
        if moving and self._steps is not None:
            ends = min(ends[0], self._steps[0]), max(ends[1], self._steps[1])
        self._steps = ends

    def view_of(self, scene: Scene) -> View | None:
        """The view that `scene` asks for, with the scale that it is drawn by; None for the picture itself."""
        return view_of(scene, self._steps)

    def draw(self, inputs: FrameInputs, hit_map: HitMap, reference: HitMap, target: moderngl.Framebuffer) -> None:
        """Draws the view of `hit_map` that the scene asks for into `target` (RGBA16F, of the map's size).

        Args:
            reference: hits of the most accurate method, traced before for the view ``difference``; not looked at by others.

        Raises:
            ValueError: the scene asks for no view.
        """
        scene = inputs.plan.scene
        view = self.view_of(scene)
        if view is None:
            raise ValueError(f"post.view: got {scene.post.view!r}, which is shaded; allowed here are the views in false colours")
        prepared = self._programs.get(f"views/{scene.post.view}.frag", inputs)
        samplers = hit_map.samplers()
        samplers |= {f"exact{k}": texture for k, texture in enumerate(reference.textures)}
        samplers["temperature_profile"] = self._temperatures.of(inputs.plan)
        if view.scale is not None:
            samplers["colour_scale"] = self._colours(view.scale)
        prepared.sample(samplers)
        if view.scale is not None and prepared.takes("view_range"):
            prepared.set(view_range=_range(view.scale))
        legend = prepared.program.get("view_legend", None)
        if isinstance(legend, moderngl.Uniform):
            _write_legend(legend, view)
        target.use()
        self._ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        prepared.draw()

    def release(self) -> None:
        """Gives the GL objects back."""
        for texture in self._scales.values():
            texture.release()
        self._scales = {}

    def _colours(self, scale: Scale) -> moderngl.Texture:
        if scale.is_diverging not in self._scales:
            colours = linear_light(scale.colours(_COLOURS)).astype(np.float32)
            texture = self._ctx.texture((_COLOURS, 1), 3, colours.tobytes(), dtype="f4", alignment=4)
            texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            texture.repeat_x = texture.repeat_y = False
            self._scales[scale.is_diverging] = texture
        return self._scales[scale.is_diverging]


def _range(scale: Scale) -> tuple[float, float, float]:
    """The scale's ends, or their logarithms, and whether they are logarithms."""
    ends = np.array((scale.low, scale.high))
    low, high = np.log(ends) if scale.is_log else ends
    return low, high, float(scale.is_log)


def _write_legend(legend: moderngl.Uniform, view: View) -> None:
    colours = np.zeros((legend.array_length, 3), np.float32)  # drivers cut off what a shader does not use
    known = linear_light(np.array([colour for _, colour in view.legend]))[: len(colours)]
    colours[: len(known)] = known
    legend.write(colours.tobytes())
