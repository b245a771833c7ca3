"""The cheapest method that is accurate enough for a scene, by what the chart measured (assets/measurements.csv).

What a scene leaves open (a model, integrator or step control named ``auto``, a step of 0) is chosen here; what it states is kept.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from operator import attrgetter
from types import MappingProxyType

from ..physics import projection
from ..physics.space_time import is_field, is_inside, ray_model
from ..scene import Rays, Scene, catalogue, met
from ..scene.schema import number_of
from . import nearest, thin_lens
from .measured import Measured, Method

AUTO = "auto"

PICTURE_HEIGHT = 1080
"""Pixels in the height of the picture whose pixels a tolerance is given in."""

REFINED_SIZE, REFINED_TOLERANCE = (1280, 720), 0.5
"""Picture in pixels, and ``rays.tolerance``, that refined rows of the table are measured with: how much is interpolated depends on both."""

# A method may end no more than 1 % of the rays wrongly: the tolerance speaks of 99 % of the pixels.
_WRONG_FATES = 0.01

# Errors below are rounding, px.
_EXACT_PX = 1e-9

# Measured costs are no better known than this.
_AS_CHEAP = 1.03

# Steps where nothing was measured: κ = 0.2 rad and Δt₀ = 0.1 r_s are half a pixel in the default scene.
_PLAIN_ANGLE, _PLAIN_LENGTH = 0.2, 0.1

# Inside the horizon those of rk4 err by 0.5 to 33 pixels; these by less than half of one over the whole sky, at spins up to 0.998
# (tests/shaders/test_through_horizon.py). The chart's views from there look at the hole, and errors behind the camera are ten times as large.
_INSIDE_INTEGRATOR, _INSIDE_ANGLE = "nystrom5", 0.14

_TRIAL_ANGLE, _TRIAL_LENGTH = 0.4, 0.5


@dataclass(frozen=True)
class Prediction:
    """A method with what the chart lets expect of it in a scene.

    Attributes:
        error_px: at 99 % of the pixels, in pixels of a picture 1080 high.
        cost: trace time as a ratio to the flat frame of the same scene.
    """

    method: Method
    error_px: float
    cost: float


@dataclass(frozen=True)
class Refinement:
    """What the chart lets expect of a scene's method with refined hit maps, in a picture of `REFINED_SIZE`.

    Attributes:
        error_px: at 99 % of the pixels, in pixels of that picture.
        cost: trace time as a ratio to the flat frame of that size.
        cost_unrefined: the same with a ray for every pixel.
    """

    error_px: float
    cost: float
    cost_unrefined: float

    def __str__(self) -> str:
        width, height = REFINED_SIZE
        return f"{self.error_px:.2g} px at {self.cost:.2g} flat frames of {width}×{height} against {self.cost_unrefined:.2g} for every pixel"


@dataclass(frozen=True)
class Choice:
    """What was chosen.

    Attributes:
        scene: the scene with nothing left open.
        chosen, runner_up: predictions; None where nothing was measured that fits.
        floor_px: the least error that any measured method has here; NaN where none was.
        meets: whether the tolerance is met; True also where a method was stated by hand.
        reasons: why, a sentence each.
    """

    scene: Scene
    chosen: Prediction | None
    runner_up: Prediction | None
    floor_px: float
    meets: bool
    reasons: tuple[str, ...]


@lru_cache(maxsize=64)
def choose(scene: Scene, *, sky_alone: bool = True) -> Choice:
    """The cheapest method that meets ``rays.tolerance`` in `scene`, as far as the scene leaves it open; of marches as cheap the most accurate.

    Args:
        sky_alone: whether a method will do that shows nothing but the sky rightly, where there is nothing else.
    """
    if not is_open(scene):
        return Choice(scene, None, None, math.nan, True, (f"{ray_model(scene).key}: stated by rays.model and the steps",))
    if scene.rays.model == AUTO and (scene.rays.step_angle or scene.rays.step_length):
        return Choice(_plainly(scene), None, None, math.nan, True, ("the steps are stated by hand: the exact model for this hole",))
    why_not = _not_measured(scene)
    if why_not:
        return Choice(_plainly(scene), None, None, math.nan, True, (why_not,))
    ranked = _ranked(_asked(scene), _lens(scene, sky_alone))
    if ranked is None:
        return Choice(_plainly(scene), None, None, math.nan, True, ("nothing was measured that fits: plain steps",))
    return Choice(_stated(scene, ranked.best), ranked.best, ranked.rival, ranked.floor_px, ranked.meets, ranked.reasons)


@dataclass(frozen=True)
class _Ranked:
    """What is best of the methods that fit, as `Choice` has it."""

    best: Prediction
    rival: Prediction | None
    floor_px: float
    meets: bool
    reasons: tuple[str, ...]


@lru_cache(maxsize=64)
def _ranked(asked: _Asked, lens: Prediction | None) -> _Ranked | None:
    """None where nothing fits. Kept, as most cameras that move change none of it."""
    found = sorted(_marched(asked) + ((lens,) if lens else ()), key=attrgetter("cost"))
    if not found:
        return None
    floor, tolerance = min(p.error_px for p in found), asked.rays.tolerance
    good = [p for p in found if p.error_px <= tolerance]
    by_things = asked.in_field and asked.has_things and any(map(_adapts, good)) and not all(map(_adapts, good))
    if by_things:
        good.sort(key=_adapts)
    ranked = good or sorted(found, key=attrgetter("error_px"))
    best = _of_those_as_cheap(ranked) if good else ranked[0]
    rival = next((p for p in ranked if p.method.kind != best.method.kind), None)
    reasons = [f"{best.method}: {_why(tolerance, best, bool(good), floor)}"]
    if by_things:
        reasons.append("methods whose steps have one length come first: by those coarse rays tell where things are seen while the camera moves")
    if rival is not None:
        reasons.append(f"runner-up: {rival.method}, {rival.error_px:.2g} px at {rival.cost:.3g} flat frames")
    return _Ranked(best, rival, floor, bool(good), tuple(reasons))


def _of_those_as_cheap(ranked: Sequence[Prediction]) -> Prediction:
    """What is taken of those that are as cheap as the first of `ranked`: the displacement on the screen, which is the least that a scene can need; any other
    closed form as it comes; of marches the most accurate."""
    first = ranked[0]
    alike = [p for p in ranked if p.cost <= _AS_CHEAP * first.cost]
    if not first.method.integrator:
        return next((p for p in alike if p.method.model == thin_lens.MODEL), first)
    return min((p for p in alike if p.method.integrator and _adapts(p) == _adapts(first)), key=attrgetter("error_px"))


def _adapts(found: Prediction) -> bool:
    control = found.method.step_control
    return bool(control) and catalogue.plug_ins("step_control")[control].traits.adapts


def is_open(scene: Scene) -> bool:
    """Whether `scene` leaves anything to choose: never without lensing."""
    if not scene.rays.lensing:
        return False
    if scene.rays.model == AUTO:
        return True
    traits = ray_model(scene).traits
    if traits.kind == "closed":
        return False
    step = scene.rays.step_angle if traits.marches_in == "mino" else scene.rays.step_length
    return AUTO in (scene.rays.integrator, scene.rays.step_control) or step == 0.0


def predictions(scene: Scene, sky_alone: bool = True) -> tuple[Prediction, ...]:
    """What the chart lets expect of every measured method that fits what `scene` states; `sky_alone` as `choose` has it."""
    lens = _lens(scene, sky_alone)
    return _marched(_asked(scene)) + ((lens,) if lens else ())


@dataclass(frozen=True)
class _Asked:
    """What the chart is asked for a scene.

    Attributes:
        near: measured scenes, the likest first.
        rays: those of the scene.
        spins, has_things, in_field: whether its hole does, it has any, and it is of a field.
        any_control: whether any step control will do, or those alone that judge their steps.
        pixels: of its picture.
    """

    near: tuple[str, ...]
    rays: Rays
    spins: bool
    has_things: bool
    in_field: bool
    any_control: bool
    pixels: _Pixels


def _asked(scene: Scene) -> _Asked:
    in_field = is_field(scene)
    # A harder field asks for shorter steps; a control that judges its steps finds them.
    any_control = not in_field or nearest.bounds_steps(scene)
    return _Asked(nearest.nearest_scenes(scene), scene.rays, scene.hole.spin != 0.0, not met.is_empty(scene), in_field, any_control, _pixels(scene))


def _lens(scene: Scene, sky_alone: bool) -> Prediction | None:
    """What is expected of the displacement on the screen, where it may be taken for `scene` and was measured."""
    if not (sky_alone and scene.rays.model == AUTO and thin_lens.draws(scene)):
        return None
    # Its error is known in closed form, so that no measured scene has to be like this one; its cost is the same in all.
    row = next((row for row in _measured_in(nearest.nearest_scenes(scene)) if row.model == thin_lens.MODEL), None)
    return None if row is None else Prediction(row.stated, thin_lens.error_px(scene, PICTURE_HEIGHT), row.cost_flat_ratio)


@lru_cache(maxsize=64)
def _marched(asked: _Asked) -> tuple[Prediction, ...]:
    """What is expected of `_candidates`; unless `any_control` will do, of those that judge their steps alone."""
    of = asked.pixels.of
    return tuple(
        Prediction(method, max(of(row.direction_99, row.crossing_r_99) for row in rows), rows[0].cost_flat_ratio)
        for method, rows in _candidates(asked.near, asked.rays, asked.spins, asked.has_things)
        if asked.any_control or method.step_tolerance
    )


@lru_cache(maxsize=64)
def _candidates(near: tuple[str, ...], rays: Rays, spins: bool, has_things: bool) -> tuple[tuple[Method, tuple[Measured, ...]], ...]:
    """Methods that fit `rays` round a hole that `spins` or not, in a scene that `has_things` or not.

    Each with its rows in the measured scenes `near`, in their order.

    Kept, as every frame of a moving camera is a scene to choose for.
    """
    by_method: dict[Method, list[Measured]] = {}
    for row in _measured_in(near):
        if not row.refined and _fits(rays, spins, has_things, row):
            by_method.setdefault(row.stated, []).append(row)
    return tuple((method, tuple(rows)) for method, rows in by_method.items() if len(rows) == len(near) and all(row.wrong_fates <= _WRONG_FATES for row in rows))


@lru_cache(maxsize=64)
def refinement(scene: Scene) -> Refinement | None:
    """What to expect of refined hit maps in `scene`, which leaves nothing open; None where its method was not measured with them."""
    if _not_measured(scene):
        return None
    near = nearest.nearest_scenes(scene)
    rows = _rows_by_method(near).get(_stated_method(scene), {})
    if len(rows) < 2 * len(near):
        return None
    likest = rows[near[0], True]
    error = max(_refined_error_px(scene, rows[name, False], rows[name, True]) for name in near)
    if any(rows[name, True].wrong_fates > _WRONG_FATES for name in near):
        error = math.inf
    # Interpolation's error goes as the second derivative, which falls as the square of the distance to the critical curve: pixels with rays
    # of their own grow as 1/√tolerance. They are taken for all of the cost but a flat frame's: rather too much than too little.
    more = max(1.0, math.sqrt(REFINED_TOLERANCE / scene.rays.tolerance))
    return Refinement(error, 1.0 + (likest.cost_flat_ratio - 1.0) * more, likest.cost_unrefined)


def stated_error_px(scene: Scene) -> float:
    """What the chart lets expect of the method of `scene`, which leaves nothing open, in pixels of a picture 1080 high; NaN where it was not measured."""
    if not scene.rays.lensing or _not_measured(scene):
        return math.nan
    return _measured_error_px(scene, _stated_method(scene))


def error_order(scene: Scene) -> float:
    """The power of the step by which the error of `scene`, which leaves nothing open, grows up to the next longer step measured; NaN where there is none."""
    method, error = _stated_method(scene), stated_error_px(scene)
    if math.isnan(error):
        return math.nan
    known = _rows_by_method(nearest.nearest_scenes(scene))
    alike = (other for other in known if other.kind == method.kind and other.step_length > method.step_length > 0.0)
    longer = min(alike, key=attrgetter("step_length"), default=None)
    if longer is None:
        return math.nan
    return math.log(_measured_error_px(scene, longer) / max(error, _EXACT_PX)) / math.log(longer.step_length / method.step_length)


def _measured_error_px(scene: Scene, method: Method) -> float:
    """What the chart lets expect of `method` in `scene`; NaN where it was not measured."""
    near = nearest.nearest_scenes(scene)
    rows = _rows_by_method(near).get(method, {})
    in_px = _pixels(scene).of
    found = [in_px(row.direction_99, row.crossing_r_99) for row in (rows.get((name, False)) for name in near) if row is not None]
    return max(found) if found and len(found) == len(near) else math.nan


@lru_cache(maxsize=64)
def _rows_by_method(near: tuple[str, ...]) -> dict[Method, dict[tuple[str, bool], Measured]]:
    """Method → its rows in the measured scenes `near`, by scene and whether they are refined."""
    found: dict[Method, dict[tuple[str, bool], Measured]] = {}
    for row in _measured_in(near):
        found.setdefault(row.stated, {})[row.scene, bool(row.refined)] = row
    return found


def _refined_error_px(scene: Scene, marched: Measured, refined: Measured) -> float:
    """What `scene` may expect from a measured scene's two rows.

    The march errs by an angle, whatever a pixel is; interpolation by a share of a pixel, there as here, which follows the tolerance.
    """
    height = REFINED_SIZE[1]
    march, both = (_pixels(scene, row.fov_deg, row.distance, height).of(row.direction_99, row.crossing_r_99) for row in (marched, refined))
    added = max(both - march, 0.0) * scene.rays.tolerance / REFINED_TOLERANCE
    return error_px(scene, marched.direction_99, marched.crossing_r_99, height) + added


def _stated_method(scene: Scene) -> Method:
    """The method of `scene`, which leaves nothing open, as the table names it."""
    rays, model = scene.rays, ray_model(scene)
    if model.traits.kind == "closed":
        return Method(model.key, "", "", 0.0, 0.0, 0.0)
    if catalogue.plug_ins("step_control")[rays.step_control].traits.adapts:
        return Method(model.key, rays.integrator, rays.step_control, 0.0, 0.0, number_of(scene.get(f"rays.{rays.step_control}.tolerance")))
    angular = model.traits.marches_in == "mino"
    return Method(model.key, rays.integrator, rays.step_control, 0.0 if angular else rays.step_length, rays.step_angle if angular else 0.0, 0.0)


def error_px(scene: Scene, direction: float, crossing_r: float, height: int = PICTURE_HEIGHT) -> float:
    """Errors in pixels of a picture of `scene` `height` pixels high: of the escape direction (rad), or of where on the disk a pixel looks (relative radius)."""
    return _pixels(scene, height=height).of(direction, crossing_r)


@dataclass(frozen=True)
class _Pixels:
    """What makes pixels of errors, as `error_px` does.

    Attributes:
        pixel: an angle in rad.
        moved: what is seen of the disk moves by so much, in rad, for each relative error of its radius.
    """

    pixel: float
    moved: float

    def of(self, direction: float, crossing_r: float) -> float:
        return direction / self.pixel if math.isnan(crossing_r) else max(direction, crossing_r * self.moved) / self.pixel


def _pixels(scene: Scene, fov_deg: float | None = None, distance: float | None = None, height: int = PICTURE_HEIGHT) -> _Pixels:
    """That for the disk of `scene` seen by its own camera or by another."""
    camera = scene.camera
    pixel = (projection.view_angle(camera) if fov_deg is None else math.radians(fov_deg)) / height
    distance = camera.distance if distance is None else distance
    sees_disk, outer = scene.disk.enabled and not math.isinf(distance), scene.disk.outer_radius
    return _Pixels(pixel, outer / max(distance, outer) if sees_disk else 0.0)


def forget_choices() -> None:
    """To be called when `measurements` has changed: what was chosen by the old ones is chosen anew."""
    nearest.forget()
    for kept in (_candidates, _marched, _ranked, _rows_by_method, choose, refinement):
        kept.cache_clear()


def _measured_in(scenes: tuple[str, ...]) -> Iterator[Measured]:
    for name in scenes:
        yield from nearest.measurements()[name]


def _not_measured(scene: Scene) -> str:
    """Why the chart says nothing of `scene`; empty when it does."""
    if is_field(scene):
        return "" if nearest.nearest_scenes(scene) else "a field of which nothing was measured: plain steps"
    if scene.hole.gravity_strength != 1.0 or scene.hole.horizon_size != 1.0:
        return "artistic gravity has no truth to be measured against: the marched Schwarzschild model with plain steps"
    if is_inside(scene):
        return f"from inside the horizon: the model that leads through it; {_INSIDE_INTEGRATOR} with κ = {_INSIDE_ANGLE} errs by less than half a pixel there"
    return "" if nearest.nearest_scenes(scene) else "no measurements are stored: plain steps"


def _plainly(scene: Scene, stated: Mapping[str, object] = MappingProxyType({})) -> Scene:
    """`scene` with what is `stated`, by key: else with the exact general model for its hole, and plain steps where it leaves them open."""
    model = catalogue.plug_ins("ray_model")[str(stated["rays.model"])] if stated else ray_model(scene)
    integrator, angle = (_INSIDE_INTEGRATOR, _INSIDE_ANGLE) if is_inside(scene) else ("rk4", _PLAIN_ANGLE)
    values = {
        "rays.model": model.key,
        "rays.integrator": integrator if scene.rays.integrator == AUTO else scene.rays.integrator,
        "rays.step_control": (model.traits.step_control or "radius") if scene.rays.step_control == AUTO else scene.rays.step_control,
        "rays.step_length": scene.rays.step_length or _PLAIN_LENGTH,
        "rays.step_angle": scene.rays.step_angle or angle,
    }
    return scene.with_values({**values, **stated})


def _stated(scene: Scene, best: Prediction) -> Scene:
    """`scene` with the method of `best` written into it."""
    method = best.method
    values: dict[str, object] = {"rays.model": method.model}
    if method.integrator:
        values |= {"rays.integrator": method.integrator, "rays.step_control": method.step_control}
        values |= {"rays.step_length": method.step_length or _PLAIN_LENGTH, "rays.step_angle": method.step_angle or _PLAIN_ANGLE}
    if method.step_tolerance:
        # an adaptive control starts from a long trial, as when it was measured, and shortens it where it must
        values |= {f"rays.{method.step_control}.tolerance": method.step_tolerance, "rays.step_length": _TRIAL_LENGTH, "rays.step_angle": _TRIAL_ANGLE}
    return _plainly(scene, values)


def _fits(rays: Rays, spins: bool, has_things: bool, row: Measured) -> bool:
    model = catalogue.plug_ins("ray_model")[row.model]
    if rays.model == AUTO and (spins and not model.traits.spins or model.traits.space_time == "flat"):
        return False
    if rays.light_travel and not model.traits.tells_time and rays.model == AUTO:
        return False
    if has_things and not model.traits.meets_things:
        return False
    angular = model.traits.marches_in == "mino"
    step, stated_step = (row.step_angle, rays.step_angle) if angular else (row.step_length, rays.step_length)
    return (
        rays.model in (AUTO, row.model)
        and (not row.integrator or rays.integrator in (AUTO, row.integrator))
        and (not row.integrator or rays.step_control in (AUTO, row.step_control))
        and (not row.integrator or stated_step in (0.0, step))
    )


def _why(tolerance: float, best: Prediction, good: bool, floor: float) -> str:
    expected = f"{best.error_px:.2g} px expected at 99 % of the pixels, {best.cost:.3g} flat frames"
    if good:
        return f"the cheapest measured method within {tolerance:g} px ({expected})"
    return f"no measured method meets {tolerance:g} px here; this one is nearest ({expected}); the floor is {floor:.2g} px"
