"""The way of single rays through space, by the steps of the march that pictures are traced with: the shader's own, in its 32-bit floats.

A model that goes from pixel to hits at once has no steps. Its ways are told by their ends and by what they meet; in flat space they are lines.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property

import moderngl
import numpy as np

from ..glsl.declared import Fate
from ..physics import observer, projection, tilted_disk
from ..planning import Plan
from ..planning import plan as make_plan
from ..scene import Scene
from ..shapes import Bool, Float, Int
from .hit_map import HitMap
from .hit_texels import HitArrays
from .inputs import FrameInputs
from .programs import Programs
from .tables import Tables
from .target import Target

Array = np.ndarray

_POINTS = 400  # that a ray has about, so that long steps are seen to bend
_LEAST_PARTS = 4  # points a step
_MOST_WITH_PARTS = 300  # steps of a ray; more of them are short enough to be drawn as lines
_MOST_STEPS = 1500  # of which there are points; of a longer way every second or third step has one
_FAR = 1e4  # r_s: no place beyond is told
_WITHIN = 0.99  # of the hole's radius; the rest is for rounding, and for lines between points of a bent way


@dataclass(frozen=True)
class RayPath:
    """The way of one ray, from the camera on.

    Attributes:
        points: float64 (P, 3) in r_s in the world; the camera first, if it is not infinitely far away.
        step: int (P,): the step that leads to each point; 0 at the start and on a way in that is known in closed form, −1 on a way out that is.
        is_state: bool (P,): whether a step ends there; between them are points on the way.
        error: float64 (P,): by how much that step differs from two of half its length, about an angle in radians; NaN where none ends.
        nearest: float64 (P,): how near the way from the point before it comes to the hole's middle, in r_s.
        drift: float64 (P,): relative drift of what the model conserves; NaN where it tells none.
        crossings: float64 (C, 3): where it meets the disk's plane, in their order.
        direction: float64 (3,): asymptotic; zeros unless it escapes.
        fate: what became of it.
        steps: how many it took.
        hole_radius: of the black ball, in r_s.
        method: that it was traced by, in a few words.
    """

    points: Float[Array, "P 3"]
    step: Int[Array, " P"]
    is_state: Bool[Array, " P"]
    nearest: Float[Array, " P"]
    error: Float[Array, " P"]
    drift: Float[Array, " P"]
    crossings: Float[Array, "C 3"]
    direction: Float[Array, " 3"]
    fate: Fate
    steps: int
    hole_radius: float
    method: str

    @cached_property
    def tunnels(self) -> tuple[int, ...]:
        """The steps that lead through the hole and out of it: what no ray can do."""
        outside = np.flatnonzero(np.linalg.norm(self.points, axis=1) > self.hole_radius)
        through = self.nearest < _WITHIN * self.hole_radius
        through[outside[-1] + 1 if outside.size else 0 :] = False  # there a ray that falls in ends
        return tuple(int(step) for step in np.unique(self.step[through]) if step > 0)


def pixel_direction(scene: Scene, size: tuple[int, int], pixel: tuple[float, float]) -> Float[Array, " 3"]:
    """Where the point `pixel` (x, y) of a picture of `size` looks, counted in pixels from its bottom left, in the frame of the view (common/observer.glsl)."""
    return projection.directions(scene.camera, size, np.asarray(pixel, float))


class Recorder:
    """Records rays with programs of its own, and leaves the picture's hit map alone.

    Args:
        programs: those of the picture, so that an edited shader is taken up here too.
    """

    def __init__(self, ctx: moderngl.Context, programs: Programs):
        self._ctx, self._programs = ctx, programs
        self._tables = Tables(ctx)
        self._hits = HitMap(ctx, programs, self._tables)

    def record(self, scene: Scene, local: Float[Array, " 3"]) -> RayPath:
        """The way of the ray that the camera of `scene` has in the direction `local` of the view's frame (`pixel_direction`).

        Raises:
            SceneError, ValueError: the scene cannot be drawn.
            ShaderError: a shader has a mistake.
        """
        plan = make_plan(scene, keep_crossings=True)
        self._ctx.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        hits = self._hits.trace_listed(plan, local[None])
        begin = _beginning(plan, local)
        if plan.integrator is None:
            return _path(plan, hits, begin, _closed(plan, hits, begin))
        return _path(plan, hits, begin, self._marched(plan, local, int(hits.steps[0])))

    def release(self) -> None:
        """Gives the GL objects back."""
        self._hits.release()
        self._tables.release()

    def _marched(self, plan: Plan, local: Array, steps: int) -> _Points:
        stride = -(-steps // _MOST_STEPS)
        ends = np.unique(np.append(np.arange(0, steps + 1, stride), steps)).astype(float)
        ways = ends
        if steps <= _MOST_WITH_PARTS:
            parts = max(_LEAST_PARTS, _POINTS // max(steps, 1))
            ways = np.concatenate([[0.0], (np.arange(steps)[:, None] + np.arange(1, parts + 1) / parts).ravel()])
        places, told = self._run(replace(plan, meetings=0), local, ways)
        there = (places[:, 3] > 1.0 / _FAR) & np.all(np.isfinite(places), axis=1)
        is_end = ways == np.round(ways)
        there &= ~(is_end & (ways > 0.0) & (told[:, 3] == 0.0))  # a step that was tried and refused leads nowhere
        points = places[there, :3] / places[there, 3:]
        c, s = observer.cos_sin_deg(plan.turn_deg)
        points = points @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        straight = plan.model.traits.marches_in == "cartesian"
        is_state = (is_end & (ways > 0.0))[there]
        error = np.where(is_state, told[there, 0], np.nan)
        drift = np.where(is_state & (told[there, 1] >= 0.0), told[there, 1], np.nan)
        return _Points(points, np.ceil(ways[there]).astype(int), is_state, _nearest(points, straight), error, drift)

    def _run(self, plan: Plan, local: Array, ways: Array) -> tuple[Array, Array]:
        """Homogeneous places and what is told of the steps, float64 (N, 4) each, after `ways` (N,) steps of the ray `local`."""
        number = len(ways)
        width, height = 64, -(-number // 256) * 4  # whole blocks of 4 × 4: docs/llvmpipe.md
        listed = np.zeros((height * width, 4), np.float32)
        listed[:, :3] = local
        listed[:number, 3] = ways
        source = self._ctx.texture((width, height), 4, listed.tobytes(), dtype="f4")
        target = Target.of(self._ctx, [self._ctx.texture((width, height), 4, dtype="f4") for _ in range(2)])
        draw = self._programs.get("record.frag", FrameInputs.whole(plan, 0.0, (width, height)))
        self._tables.bind(draw)
        draw.set(listed_rays=0)
        source.use(0)
        target.frame.use()
        draw.draw()
        places, told = (np.frombuffer(texture.read(), np.float32).reshape(-1, 4)[:number].astype(float) for texture in target.textures)
        target.release()
        source.release()
        return places, told


@dataclass(frozen=True)
class _Points:
    """Points of a way; see `RayPath`."""

    points: Array
    step: Array
    is_state: Array
    nearest: Array
    error: Array
    drift: Array

    @classmethod
    def without_steps(cls, points: Array, step: int) -> _Points:
        """`points` (P, 3) that no step leads to."""
        none = np.full(len(points), np.nan)
        return cls(points, np.full(len(points), step), np.zeros(len(points), bool), np.linalg.norm(points, axis=1), none, none)

    def then(self, other: _Points) -> _Points:
        """These, and then the others."""
        return _Points(*(np.concatenate([getattr(self, item.name), getattr(other, item.name)]) for item in fields(self)))

    def first(self, number: int) -> _Points:
        """The first `number` of them."""
        return _Points(*(getattr(self, item.name)[:number] for item in fields(self)))


def _nearest(points: Array, straight: bool) -> Array:
    """How near (P,) the way to each of `points` (P, 3) comes to the origin: on a straight line from the one before, or at the point itself.

    A march in spherical coordinates goes round the hole as fast as it likes, at a radius that lies between those of two points close together.
    """
    distance = np.linalg.norm(points, axis=1)
    if not straight:
        return distance
    before = np.concatenate([points[:1], points[:-1]])
    way = points - before
    share = np.clip(-np.sum(before * way, axis=1) / np.maximum(np.sum(way * way, axis=1), 1e-300), 0.0, 1.0)
    return np.minimum(np.linalg.norm(before + share[:, None] * way, axis=1), distance)


def _beginning(plan: Plan, local: Array) -> Array:
    """Where the ray begins, and which way it goes there in a flat space: float64 (2, 3) in the world. For a camera at infinity, far out on its line."""
    seen = observer.observe(plan.scene)
    back, down, right = seen.axes
    if seen.w == 0.0:
        return np.stack([_FAR * back + 0.5 * (local[1] * down + local[2] * right), -back])
    return np.stack([0.5 / seen.w * seen.n, local @ seen.axes])


def _closed(plan: Plan, hits: HitArrays, begin: Array) -> _Points:
    """What is known of a way in closed form: what it meets, and where it ends in the hole."""
    met = _crossings(plan, hits)
    if hits.fate[0] != Fate.CAPTURED:
        return _Points.without_steps(met, 0)
    last, radius = (met[-1] if len(met) else begin[0]), plan.space_time.horizon_radius
    if plan.space_time.kind == "flat":
        along = float(last @ begin[1])
        end = last + (-along - np.sqrt(max(along**2 + radius**2 - float(last @ last), 0.0))) * begin[1]
    else:
        end = last * radius / np.linalg.norm(last)
    return _Points.without_steps(np.concatenate([met, [end]]), 0)


def _path(plan: Plan, hits: HitArrays, begin: Array, found: _Points) -> RayPath:
    met, direction, fate = _crossings(plan, hits), hits.direction[0].astype(float), Fate(int(hits.fate[0]))
    radius = plan.space_time.horizon_radius * (plan.scene.hole.horizon_size if plan.model.traits.marches_in == "cartesian" else 1.0)
    if plan.integrator is not None:
        found = _with_ends(_until_it_falls_in(found, radius) if fate == Fate.CAPTURED else found, met, escapes=fate == Fate.ESCAPED)
    found = _Points.without_steps(begin[:1], 0).then(found)
    if fate == Fate.ESCAPED:
        found = found.then(_Points.without_steps((found.points[-1] + _FAR * direction)[None], -1))
    return RayPath(
        points=found.points,
        step=found.step,
        is_state=found.is_state,
        nearest=found.nearest,
        error=found.error,
        drift=found.drift,
        crossings=met,
        direction=direction,
        fate=fate,
        steps=int(hits.steps[0]) if plan.integrator is not None else 0,
        hole_radius=radius,
        method=plan.method,
    )


def _until_it_falls_in(found: _Points, radius: float) -> _Points:
    """`found` up to where its last step comes within `radius`, with the rim there for an end: in coordinates of a far observer nothing comes after."""
    distance = np.linalg.norm(found.points, axis=1)
    inside = np.flatnonzero((found.step == found.step[-1]) & (distance < radius))
    if not inside.size or inside[0] == 0:
        return found
    before = int(inside[0]) - 1
    rim = _Points.without_steps(found.points[before : before + 1] * radius / distance[before], int(found.step[-1]))
    return found.first(before + 1).then(rim)


def _with_ends(found: _Points, met: Array, *, escapes: bool) -> _Points:
    """`found` with those of the crossings `met` (C, 3) that lie outside of the march, which is finished in closed form on the way in and on the way out."""
    distance = np.linalg.norm(met, axis=1)
    ends = np.linalg.norm(found.points[[0, -1]], axis=1)
    outward = (distance > ends[1]) & (np.arange(len(met)) == len(met) - 1) & escapes
    inward = (distance > ends[0]) & (np.arange(len(met)) == 0) & ~outward
    return _Points.without_steps(met[inward], 0).then(found).then(_Points.without_steps(met[outward], -1))


def _crossings(plan: Plan, hits: HitArrays) -> Array:
    """Where the one ray of `hits` crosses the disk's plane, float64 (C, 3)."""
    crossing = hits.crossing[0]
    return tilted_disk.placed(crossing[np.any(crossing != 0.0, axis=-1)], plan.scene.disk)
