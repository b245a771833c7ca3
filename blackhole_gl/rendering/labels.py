"""Names and outlines for a lecture: what is where in a picture, by the closed forms of `physics.lensed_circles`. No GL here; whoever draws them is told places.

Places are (right, down) from the picture's top left, in heights of the picture.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from ..physics import lensed_circles, projection, relativity
from ..physics.observer import Observer, observe
from ..physics.space_time import space_time
from ..planning import Plan
from ..planning import plan as make_plan
from ..scene import Scene
from ..shapes import Float
from .views import Colour

_POINTS = 180  # of a curve
_LEAST_AHEAD = 1e-3
_BESIDE = 0.12  # of a picture's height: from the outermost curve to the names
_MARGIN = 0.03
_LINE_SPACING = 0.05  # of names above one another

WHITE: Colour = (0.95, 0.95, 0.95)
AMBER: Colour = (0.98, 0.72, 0.35)
GREEN: Colour = (0.45, 0.90, 0.62)
BLUE: Colour = (0.60, 0.68, 1.00)


@dataclass(frozen=True, eq=False)
class Curve:
    """A thin line: places, float64 (N, 2), NaN where it is behind the camera or breaks off; `width` is in those of an outline."""

    places: Float[np.ndarray, "N 2"]
    colour: Colour
    width: float = 1.0


@dataclass(frozen=True)
class Name:
    """Words with a line that leads from them to what they name.

    Attributes:
        at: the place named.
        place: where the words begin, or end where they stand on the left of it.
    """

    text: str
    at: tuple[float, float]
    place: tuple[float, float]
    colour: Colour

    @property
    def is_on_the_left(self) -> bool:
        """Whether the words stand on the left of what they name."""
        return self.place[0] < self.at[0]


@dataclass(frozen=True, eq=False)
class Outlines:
    """Where an observer sees the critical curve and circles of the disk's plane at `_Maker.angles`, as `lensed_circles` has them.

    Attributes:
        edge: of the critical curve, float64 (N,).
        circles: (radius in r_s, order of the crossing) of each circle.
        away: of the circles, float64 (circles, N).
    """

    edge: Float[np.ndarray, " N"]
    circles: tuple[tuple[float, int], ...]
    away: Float[np.ndarray, "circles N"]


@dataclass(frozen=True)
class Labels:
    """What is drawn over a picture.

    Attributes:
        note: why there is nothing, where there is nothing.
        note_line: which of the lines at the top it stands in, from 0.
        outlines: what the curves were made from, where there are any.
    """

    curves: tuple[Curve, ...] = ()
    names: tuple[Name, ...] = ()
    note: str = ""
    note_line: int = 0
    outlines: Outlines | None = None


def of(scene: Scene, aspect: float) -> Labels:
    """The labels of a picture of `scene` whose width is `aspect` heights.

    Raises:
        SceneError, ValueError: the scene cannot be drawn; the text says why.
    """
    return _of(shape_of(scene), aspect)


def after(before: Labels, scene: Scene, aspect: float) -> Labels:
    """What `of` gives, sooner where `scene` is much like that of `before`, as from frame to frame of a camera that moves or a value that is dragged.

    Raises:
        As `of`.
    """
    return _made(shape_of(scene), aspect, before.outlines)


def shape_of(scene: Scene) -> Scene:
    """`scene` with nothing but what labels depend on, so that a slider of colours, or a turn about the axis, finds those that are there."""
    disk, bare = scene.disk, Scene()
    kept = ("enabled", "inner_radius", "outer_radius", "orbit", "tilt_deg")
    bare_disk = replace(bare.disk, **{name: getattr(disk, name) for name in kept})
    return replace(bare, hole=scene.hole, camera=replace(scene.camera, azimuth_deg=0.0), rays=scene.rays, disk=bare_disk)


@lru_cache(maxsize=4)
def _of(scene: Scene, aspect: float) -> Labels:
    return _made(scene, aspect, None)


def _made(scene: Scene, aspect: float, near: Outlines | None) -> Labels:
    plan = make_plan(scene)
    why = without_closed_forms(plan, "labels")
    return Labels(note=why) if why else _Maker(plan, observe(scene), aspect, near).labels()


def places(observer: Observer, scene: Scene, aspect: float, directions: Float[np.ndarray, "*at 3"]) -> Float[np.ndarray, "*at 2"]:
    """Where local `directions` (…, 3) of the observer's tetrad lie in the picture; NaN behind the camera."""
    seen = np.asarray(directions, float) @ observer.look
    ahead = np.where(-seen[..., 0] > _LEAST_AHEAD, -seen[..., 0], np.nan)
    half = projection.half_height(scene.camera)
    return np.stack([0.5 * aspect + 0.5 * seen[..., 2] / (half * ahead), 0.5 + 0.5 * seen[..., 1] / (half * ahead)], axis=-1)


def without_closed_forms(plan: Plan, what: str) -> str:
    """Why there are no closed forms for `what`; empty where there are."""
    hole, camera = plan.scene.hole, plan.scene.camera
    if not projection.is_perspective(camera):
        return f"No {what}: with camera.projection = {camera.projection} none are drawn, with {projection.PERSPECTIVE} they are."
    if plan.space_time.kind == "flat" or not plan.model.traits.exact:
        return f"No {what}: the ray model {plan.model.key} has no closed forms; the exact models of a hole have."
    if (hole.gravity_strength, hole.horizon_size) != (1.0, 1.0) and plan.model.traits.space_time == "schwarzschild":
        return f"No {what}: hole.gravity_strength and hole.horizon_size are art, and closed forms are physics."
    return ""


class _Maker:
    """Puts the labels of one picture together.

    Args:
        near: outlines of a scene that is much like it.
    """

    def __init__(self, plan: Plan, observer: Observer, aspect: float, near: Outlines | None):
        self._plan, self._observer, self._aspect = plan, observer, aspect
        self._angles = np.linspace(0.0, 2.0 * np.pi, _POINTS + 1)
        self._hole = self._place(observer.hole)
        self._isco = space_time(plan.scene).isco_radius(plan.scene.disk)
        self._outlines = self._outlined(near)

    def labels(self) -> Labels:
        """All of them."""
        edge = self._place(self._directions(self._outlines.edge))
        curves, named = [Curve(edge, WHITE)], [("shadow, inside the critical curve", self._outermost(edge, 62.0), 62.0, WHITE)]
        for text, circle, at_deg, colour in self._named_circles():
            if circle in self._outlines.circles:
                line = self._place(self._seen(circle))
                curves.append(Curve(line, colour))
                named.append((text, self._outermost(line, at_deg), at_deg, colour))
        named += self._sides()
        named.append(("centre of the hole", self._hole, 270.0, WHITE))
        reach = _BESIDE + max(float(np.nanmax(np.linalg.norm(curve.places - self._hole, axis=-1), initial=0.0)) for curve in curves)
        found = [self._name(text, at, angle, colour, reach) for text, at, angle, colour in named]
        return Labels(tuple(curves), tuple(_apart(name for name in found if name is not None)), outlines=self._outlines)

    def _named_circles(self) -> list[tuple[str, tuple[float, int], float, Colour]]:
        """(name, circle, angle of the name on the screen, colour) of the circles in the disk's plane that are outlined, seen from far enough.

        None of a tilted disk's: the closed forms are of circles in the equator.
        """
        if self._plan.scene.disk.tilt_deg:
            return []
        rings = ("first ring (n = 1)", 36.0, GREEN), ("second ring (n = 2)", 12.0, BLUE)
        found = [(f"innermost stable orbit (ISCO), r = {self._isco:.3g} r_s", (self._isco, 0), 118.0, AMBER)]
        return found + [
            (text, (self._plan.disk_inner, order), angle, colour) for order, (text, angle, colour) in enumerate(rings, 1) if order < self._plan.orders
        ]

    def _outlined(self, near: Outlines | None) -> Outlines:
        edge = lensed_circles.shadow_edge(self._observer, self._angles)
        disk = self._plan.scene.disk
        wanted = [circle for _, circle, _, _ in self._named_circles()] + [(self._plan.disk_inner, 0)] * (disk.enabled and not disk.tilt_deg)
        circles = tuple(circle for circle in dict.fromkeys(wanted) if 2.0 * circle[0] * self._observer.w < 1.0)
        if not circles:
            return Outlines(edge, (), np.empty((0, len(edge))))
        radii, orders = (np.array(column) for column in zip(*circles))
        # Beside the critical curve, and in its size, an image stays much where it is.
        alike = near is not None and [order for _, order in near.circles] == list(orders)
        guess = near.away * (edge / near.edge) if near is not None and alike else None
        return Outlines(edge, circles, lensed_circles.circles(self._observer, radii, orders, self._angles, guess))

    def _sides(self) -> Iterator[tuple[str, Float[np.ndarray, " 2"], float, Colour]]:
        """(name, place, angle, colour) of the approaching and the receding side of the disk's inner edge."""
        plan, observer = self._plan, self._observer
        inner, orbit = plan.disk_inner, plan.scene.disk.orbit
        if not plan.scene.disk.enabled or (inner, 0) not in self._outlines.circles:
            return
        directions = self._seen((inner, 0))
        rays = lensed_circles.light(observer, directions)
        g = relativity.circular_orbit_g(inner, rays.lam, plan.space_time.spin, orbit) / rays.energy
        for text, index, colour in (("approaching", int(np.nanargmax(g)), BLUE), ("receding", int(np.nanargmin(g)), AMBER)):
            at = self._place(directions[index])
            away = at - self._hole
            yield f"{text} side, g = {g[index]:.2f}", at, math.degrees(math.atan2(-away[1], away[0])), colour

    def _seen(self, circle: tuple[float, int]) -> Float[np.ndarray, "N 3"]:
        return self._directions(self._outlines.away[self._outlines.circles.index(circle)])

    def _directions(self, away: Float[np.ndarray, " N"]) -> Float[np.ndarray, "N 3"]:
        return lensed_circles.directions(self._observer, away, self._angles)

    def _place(self, directions: Float[np.ndarray, "*at 3"]) -> Float[np.ndarray, "*at 2"]:
        return places(self._observer, self._plan.scene, self._aspect, directions)

    def _outermost(self, line: Float[np.ndarray, "N 2"], angle_deg: float) -> Float[np.ndarray, " 2"]:
        """The place of `line` farthest from the hole in a direction on the screen; NaN where there is none."""
        along = (line - self._hole) @ _screen_direction(angle_deg)
        return line[int(np.nanargmax(along))] if np.isfinite(along).any() else np.full(2, np.nan)

    def _name(self, text: str, at: Float[np.ndarray, " 2"], angle_deg: float, colour: Colour, reach: float) -> Name | None:
        """`text` beside the outermost curve, within the picture; None where what it names is not in the picture."""
        if not (0.0 <= at[0] <= self._aspect and 0.0 <= at[1] <= 1.0):
            return None
        place = self._hole + reach * _screen_direction(angle_deg)
        x, y = np.clip(place, _MARGIN, (self._aspect - _MARGIN, 1.0 - _MARGIN)).tolist()
        return Name(text, (float(at[0]), float(at[1])), (x, y), colour)


def _apart(names: Iterable[Name]) -> Iterator[Name]:
    """`names` moved down where they would stand on one another, on either side of the picture."""
    lowest: dict[bool, float] = {}
    for name in sorted(names, key=lambda name: name.place[1]):
        x, y = name.place
        side = name.is_on_the_left
        y = max(y, lowest.get(side, -1.0) + _LINE_SPACING)
        lowest[side] = y
        yield replace(name, place=(x, y))


def _screen_direction(angle_deg: float) -> Float[np.ndarray, " 2"]:
    """From right towards up, as (right, down)."""
    return np.array([math.cos(math.radians(angle_deg)), -math.sin(math.radians(angle_deg))])
