"""Lines over the picture where exact light paths put them: what is drawn in the disk's plane, on the sky and on the horizon. Nothing is drawn, or compiled, for
a scene that asks for none."""

from __future__ import annotations

import moderngl

from ..physics import relativity
from ..planning import Plan
from .hit_map import HitMap
from .inputs import FrameInputs
from .programs import Programs

_ON_SKY = {"OVERLAY_SKY": 1}


class Overlays:
    """Draws shaders/shade_overlays.frag over radiance."""

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs

    def draw_sky(self, inputs: FrameInputs, hit_map: HitMap, target: moderngl.Framebuffer) -> None:
        """The lines of the sky, which come before all matter, where the scene asks for them."""
        if inputs.plan.scene.post.show_sky_grid:
            self._draw(inputs, hit_map, target, _ON_SKY)

    def draw_hole(self, inputs: FrameInputs, hit_map: HitMap, target: moderngl.Framebuffer) -> None:
        """What is drawn of the hole and in the disk's plane, over all else, where the scene asks for it."""
        plan = inputs.plan
        if plan.scene.post.show_horizon or (plan.orders and plan.scene.post.lines_in_plane):
            self._draw(inputs, hit_map, target, {})

    def _draw(self, inputs: FrameInputs, hit_map: HitMap, target: moderngl.Framebuffer, switches: dict[str, int]) -> None:
        lines = self._programs.get("shade_overlays.frag", inputs, {**hit_map.switches(), **switches})
        lines.sample(hit_map.samplers())
        hit_map.tell_blocks(lines)
        if lines.takes("plane_radii"):
            lines.set(plane_radii=_radii(inputs.plan))
        target.use()
        target.color_mask = True, True, True, False  # alpha says where single stars are left out
        self._ctx.depth_func = "1"  # always
        self._ctx.enable(moderngl.BLEND)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        lines.draw()
        self._ctx.disable(moderngl.BLEND)
        self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        self._ctx.depth_func = "<"
        target.color_mask = True, True, True, True


def _radii(plan: Plan) -> tuple[float, float, float, float]:
    """In r_s, 0 without a hole: the innermost stable orbit of the disk's matter, the orbits of light that goes with the spin and against it; then a*²."""
    where = plan.space_time
    if not where.has_hole or where.kind == "flat":
        return 0.0, 0.0, 0.0, 0.0
    spin = abs(where.horizon_spin)
    return where.isco_radius(plan.scene.disk), where.prograde_photon_orbit, float(relativity.photon_orbit_radius(-spin)), spin * spin
