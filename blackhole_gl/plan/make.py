"""Scene → RayPlan: which model and method trace it, with which steps, and the reason for each."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..physics import observer, relativity
from ..scene import Scene, SceneError, catalogue
from ..scene.catalogue import PlugIn
from . import choice

# A ray that comes near the critical curve winds round the hole; one pixel in a 4K picture lies closer than 1e-7 to it only by
# rare chance, and 3 turns reach that: each turn takes a factor e^{2π} of distance.
SPARE_TURNS = 3.0

# Beyond this radius (r_s, times the gravity strength) an outward ray is finished in closed form; see common/central_orbit.glsl.
# Models whose closed form is a first-order one state a larger march_bound in their header.
MARCH_BOUND = 6.0

# The innermost crossing that is kept, in horizon radii: closer in, azimuth and g diverge.
INNERMOST_CROSSING = 1.02

# Share of the tolerance that interpolation may take; the march's own error at most pixels is far below its share.
_REFINE_SHARE = 0.8

REFINE_STEP = 4
"""Pixels between the exact rays of a refined hit map's coarse grid."""


@dataclass(frozen=True)
class RayPlan:
    """How a scene's rays are traced.

    Attributes:
        model, integrator, step_control: plug-ins; the last two are None for closed models.
        step_length: Δt₀ in r_s, as used.
        step_angle: κ in radians, as used.
        max_steps: no ray takes more.
        orders: crossings of the disk's plane that are kept, 0 without a disk.
        refine_px: error in pixels that interpolation between exact rays may add while the camera moves; 0: every pixel has its own ray.
        reasons: why, a sentence each, for people.
    """

    model: PlugIn
    integrator: PlugIn | None
    step_control: PlugIn | None
    step_length: float
    step_angle: float
    max_steps: int
    orders: int
    refine_px: float
    reasons: tuple[str, ...]

    @property
    def evaluations_per_step(self) -> int:
        """Right-hand-side evaluations in one step, tried ones included; 0 for closed models."""
        if self.integrator is None:
            return 0
        scheme, control = self.integrator.traits, self.step_control.traits
        return (scheme.pair_evaluations if control.needs_pair else scheme.evaluations) * control.integrator_steps

    @property
    def method(self) -> str:
        """The method in a few words, e.g. ``kerr, rk4, κ = 0.2``."""
        if self.integrator is None:
            return self.model.key
        step = f"κ = {self.step_angle:.3g}" if self.model.traits.marches_in == "mino" else f"Δt₀ = {self.step_length:.3g}"
        control = "" if self.step_control.key == "mino" else f"{self.step_control.key}, "
        return f"{self.model.key}, {self.integrator.key}, {control}{step}"


def resolved(scene: Scene) -> Scene:
    """`scene` with everything chosen that it leaves to the plan."""
    return choice.choose(scene).scene


def plan(scene: Scene, *, keep_crossings: bool = False) -> RayPlan:
    """The plan for `scene`.

    Args:
        keep_crossings: keep crossings of the disk's plane even where the scene shows no disk.

    Raises:
        SceneError: the chosen model, integrator and step control do not fit together.
    """
    made = choice.choose(scene)
    scene, reasons = made.scene, list(made.reasons if scene.rays.lensing else ("flat: lensing is off",))
    model = observer.ray_model(scene)
    orders = scene.rays.orders if keep_crossings else _visible_orders(scene)
    if orders == 0:
        reasons.append("no crossings are looked for: the disk is off")
    elif orders < scene.rays.orders and not keep_crossings:
        reasons.append(f"{orders} of {scene.rays.orders} orders: the next ring is too thin to change a picture {choice.PICTURE_HEIGHT} pixels high by 1/255")
    if model.traits.kind == "closed":
        refine, why = _refines(scene, model, made)
        return RayPlan(model, None, None, scene.rays.step_length, scene.rays.step_angle, 1, orders, refine_px(scene) if refine else 0.0, (*reasons, why))
    control = scene.rays.step_control
    against = catalogue.reasons_against(model.key, scene.rays.integrator, control)
    if against:
        control = model.traits.step_control
        scene = scene.with_values({"rays.step_control": control})
        reasons.append(f"steps by {control}: {'; '.join(against)}")
    against = catalogue.reasons_against(model.key, scene.rays.integrator, control)
    if against:
        raise SceneError("rays.integrator", "; ".join(against))
    stretch = _steps_needed(scene, model, catalogue.plug_ins("step_control")[control]) / scene.rays.max_steps
    if stretch > 1.0:
        reasons.append(f"steps are {stretch:.2f} times longer than asked, so that {scene.rays.max_steps} of them cross the scene")
    stretch = max(1.0, stretch)
    refine, why = _refines(scene, model, made)
    reasons.append(why)
    return RayPlan(
        model,
        catalogue.plug_ins("integrator")[scene.rays.integrator],
        catalogue.plug_ins("step_control")[control],
        scene.rays.step_length * stretch,
        scene.rays.step_angle * stretch,
        scene.rays.max_steps,
        orders,
        refine_px(scene) if refine else 0.0,
        tuple(reasons),
    )


def unfit_options(key: str, scene: Scene) -> dict[str, str]:
    """The integrators or step controls (by `key`) that do not go with the rest of how `scene` is traced, each with the reason.

    Empty for other keys, and for a scene whose parts do not fit as they are: any change may then be the right one.
    """
    if key not in ("rays.integrator", "rays.step_control"):
        return {}
    try:
        made = plan(scene)
    except SceneError:
        return {}
    found = {}
    for option in catalogue.keys(key.removeprefix("rays.")):
        if made.integrator is None:
            reasons = [f"{made.model.key} goes from pixel to hits at once and takes no steps"]
        elif key == "rays.integrator":
            reasons = catalogue.reasons_against(made.model.key, option, made.step_control.key)
        else:
            reasons = catalogue.reasons_against(made.model.key, made.integrator.key, option)
        if reasons:
            found[option] = "; ".join(reasons)
    return found


def refine_px(scene: Scene) -> float:
    """Error in pixels that interpolation between exact rays may add in `scene` where its hit map is refined."""
    return _REFINE_SHARE * scene.rays.tolerance


def _refines(scene: Scene, model: PlugIn, made: choice.Choice) -> tuple[bool, str]:
    """Whether the hit map of `scene`, which leaves nothing open, is refined while the camera moves, and why.

    The method stays that of the picture at rest, though a coarser one might do for the camera's way: another method would be another
    program to wait for and a jump when the camera stops.
    """
    if model.traits.kind == "closed" and (model.traits.space_time == "flat" or not model.traits.exact):
        return False, "moving: a ray for every pixel, as it costs no more than interpolating"
    if not scene.rays.refine:
        return False, "moving: a ray for every pixel, as rays.refine is off"
    found = choice.refinement(scene)
    if found is None:
        return True, f"moving: refined within {refine_px(scene):.2g} px; what that costs here was not measured"
    # Steps stated by hand, or a tolerance below the floor, miss it at rest too: then the bound on what interpolation adds is all there is to keep.
    kept = made.chosen is None or not made.meets or found.error_px <= scene.rays.tolerance
    if kept and found.cost < found.cost_unrefined:
        return True, f"moving: refined, {found}"
    return False, f"moving: a ray for every pixel; refined would be {found}"


def _visible_orders(scene: Scene) -> int:
    """Orders of crossings that can be seen: 0 without a disk; of the others, those whose ring is not too thin for one grey level.

    Each half turn thins the ring by e^{−π} in Schwarzschild (Ohanian 1987), the first being about as wide as the shadow; a spinning
    hole's rings are wider on the receding side, for which a factor of 8 is left.
    """
    if not scene.disk.enabled:
        return 0
    if not scene.rays.lensing:
        return 1
    camera = scene.camera
    half_height = 0.5 * camera.field_m / 2.0 if math.isinf(camera.distance) else camera.distance * math.tan(math.radians(0.5 * camera.fov_deg))
    shadow_px = 0.5 * choice.PICTURE_HEIGHT * 2.6 * scene.hole.gravity_strength / half_height
    seen = sum(8.0 * shadow_px * math.exp(-math.pi * order) >= 1.0 / 255.0 for order in range(1, 3))
    return min(scene.rays.orders, 1 + seen)


def march_bound(scene: Scene) -> float:
    """Radius in r_s beyond which outward rays are finished in closed form."""
    return (observer.ray_model(scene).traits.march_bound or MARCH_BOUND) * max(1.0, scene.hole.gravity_strength)


def _steps_needed(scene: Scene, model: PlugIn, control: PlugIn) -> float:
    """Steps of the asked length that take a ray in from the camera, `SPARE_TURNS` round the hole, and out again.

    Adaptive controls find their own lengths: 0.
    """
    if control.traits.adapts:
        return 0.0
    shortest = control.traits.shortest
    if model.traits.marches_in == "mino":
        return (math.pi + 2.0 * math.pi * SPARE_TURNS) / (scene.rays.step_angle * shortest)
    bound = march_bound(scene)
    far = min(scene.camera.distance, 1e6) if math.isfinite(scene.camera.distance) else bound
    photon_sphere = 1.5 * scene.hole.gravity_strength
    turn = 2.0 * math.pi * photon_sphere / math.sqrt(3.0)  # in σ: |v|² = 3 on the photon sphere
    if control.key == "fixed":
        aside = 1.7 * far  # the longest way of a ray that passes too far out to be taken in closed form
        return max(aside, min(far, bound) + 1.7 * bound + SPARE_TURNS * turn) / scene.rays.step_length
    # 1.0 for what an artistic horizon lets run on inside r = G
    legs = math.log(max(min(far, bound) / photon_sphere, 1.0)) + math.log(2.0 * bound / photon_sphere) + 1.0
    return 3.0 * (legs + SPARE_TURNS * turn / photon_sphere) / (scene.rays.step_length * shortest)


def effective_disk_radii(scene: Scene) -> tuple[float, float]:
    """(inner, outer) edge of the disk in r_s: the inner one never inside the ISCO, the outer one never inside the inner.

    The ISCO is that of the space-time in which light runs: with `kerr_like` that is Schwarzschild's, whatever the spin, for light
    and matter of two space-times make no sense together close in.
    """
    isco = float(relativity.isco_radius(observer.horizon_spin(scene), scene.disk.orbit))
    inner = max(scene.disk.inner_radius, isco)
    return inner, max(scene.disk.outer_radius, inner * 1.0001)
